// SPDX-License-Identifier: MIT
// Weighs a look against the stop that it costs, and draws the conclusions.
#include "supervisor/looks.h"

#include <string.h>

#include "arcos/gen_arcos.h"
#include "knowledge/angle.h"
#include "supervisor/faults.h"
#include "supervisor/state.h"

#define HOLD_MM 400u         // a cleared sonar is not looked at again before this distance,
#define HOLD_DOUBLINGS 2     // ... doubled each time it is cleared, so often
#define HOLD_FORGET_MM 4000u // ... and forgotten after this one
#define LOOK_COST_MS 9000u   // what a look takes: two turns aside, the way back, two rounds of readings each
#define PROOFS 3             // looks in a row that leave a sonar its name,
#define PROOFS_AT_GOAL 2     // ... where one follows at once upon the other
#define NAME_STANDS_MS 1000u // three rounds, before a name is said: many for a healthy sonar pass sooner
#define SETTLE_MOST 8        // looks at the goal: a verdict takes disagreements at more than one time

static bool is_held(const argus_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < self->knowledge.sonars);
    const argus_hold_t *const hold = &self->looks.hold[sonar];
    const int32_t doublings = argus_min(hold->cleared - 1, HOLD_DOUBLINGS);
    return hold->cleared > 0 &&
           self->knowledge.odometer_mm - hold->odometer_mm < HOLD_MM << (unsigned)argus_max(0, doublings);
}

argus_mask_t argus_doubted(const argus_t *const self) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    ARGUS_ASSERT(argus_rules(self)->evidence);
    unsigned mask = 0;
    for (int i = 0; i < self->knowledge.sonars; i++) {
        mask |= argus_evidence_suspects(&self->evidence, i) ? 1u << i : 0u;
    }
    return (argus_mask_t)(mask & ~(unsigned)argus_out(&self->knowledge) & ~(unsigned)self->orders.pinned);
}

// Those in question: named, and not yet looked at here.
static unsigned open_names(const argus_t *const self) {
    return argus_named(&self->knowledge) & argus_open_suspects(self);
}

// Looks prove nothing of those that do not look ahead: after two they tell no more.
argus_mask_t argus_to_settle(const argus_t *const self) {
    const argus_guard_t guard = argus_guard(self);
    if (!argus_guard_may_turn(&guard) || self->looks.settling >= SETTLE_MOST) {
        return 0;
    }
    const unsigned proves = self->looks.settling < PROOFS_AT_GOAL
                                ? argus_robot_all(self->knowledge.robot)
                                : argus_robot_forward(self->knowledge.robot);
    return (argus_mask_t)(argus_named(&self->knowledge) & proves);
}

argus_mask_t argus_to_try(const argus_t *const self) {
    const argus_guard_t guard = argus_guard(self);
    const bool others = (self->knowledge.heard & ~(unsigned)argus_out(&self->knowledge)) != 0;
    const bool may = argus_rules(self)->evidence && argus_guard_may_turn(&guard) && !argus_is_stopped(self);
    const bool due = others && !self->looks.tried && !argus_guard_is_heard(&guard);
    return may && due ? (argus_mask_t)(argus_wanted_sonars(self) & ~(unsigned)self->orders.pinned) : 0;
}

// Those ahead that no other sonar sees for, and that were not cleared a moment ago.
static argus_mask_t alone(const argus_t *const self) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    const argus_guard_t guard = argus_guard(self);
    const unsigned open = argus_guard_alone(&guard) & argus_open_suspects(self);
    unsigned mask = 0;
    for (int i = 0; i < self->knowledge.sonars; i++) {
        mask |= (open >> i & 1u) != 0 && !is_held(self, i) ? 1u << i : 0u;
    }
    return (argus_mask_t)mask;
}

// A sonar that is named ahead costs what the robot would drive faster without it.
void argus_count_loss(const argus_t *const self, argus_looks_t *const mine) {
    if ((open_names(self) & argus_robot_ahead(self->knowledge.robot)) == 0) {
        mine->lost_ms = 0;
        return;
    }
    const argus_guard_t guard = argus_guard(self);
    const int32_t seen_mm = argus_guard_seen_mm(&guard);
    const int32_t free_mm_s = argus_guard_free_speed_mm_s(&guard, seen_mm);
    const int32_t lost_mm_s = free_mm_s - argus_guard_speed_mm_s(&guard, seen_mm);
    ARGUS_ASSERT(free_mm_s > 0 && lost_mm_s >= 0);
    mine->lost_ms += ARCOS_TIMING_SIP_CYCLE_MS * (uint32_t)lost_mm_s / (uint32_t)free_mm_s;
}

// To hire or to buy: a look is bought when its cost has been lost to the doubt. So both together are never
// more than twice the cheaper one. Where no other sonar sees what a suspect may not, it is bought at once.
bool argus_look_pays(const argus_t *const self) {
    const argus_looks_t *const looks = &self->looks;
    const bool pays = looks->asked || alone(self) != 0 || looks->lost_ms >= LOOK_COST_MS;
    if (!pays || self->orders.passive || argus_is_stopped(self)) {
        return false;
    }
    const argus_guard_t guard = argus_guard(self);
    return argus_guard_may_turn(&guard);
}

// A law of its readings that was found and given up again is none: what stays is that others contradict it.
argus_fault_kind_t argus_named_kind(const argus_t *const self, const int sonar,
                                    const argus_finding_t *const finding) {
    ARGUS_ASSERT(sonar >= 0 && sonar < self->knowledge.sonars);
    const argus_fault_kind_t kind = finding->named;
    if (kind == ARGUS_KIND_NONE && finding->doubted) {
        return ARGUS_KIND_OFF; // it fails with the whole of its array
    }
    return kind == ARGUS_KIND_SLOW && self->looks.hold[sonar].lawless ? ARGUS_KIND_WRONG : kind;
}

void argus_looks_forget(argus_looks_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    self->hold[sonar].borne_out = 0;
    self->hold[sonar].lawless = false;
}

static void clear(argus_looks_t *const looks, argus_knowledge_t *const knowledge,
                  argus_events_t *const events, const int sonar) {
    ARGUS_ASSERT(!argus_is_out(knowledge, sonar));
    argus_hold_t *const hold = &looks->hold[sonar];
    const argus_sonar_t *const s = &knowledge->sonar[sonar];
    if (knowledge->odometer_mm - hold->odometer_mm > HOLD_FORGET_MM) {
        hold->cleared = 0;
    }
    argus_looks_forget(looks, sonar);
    hold->cleared = argus_one_more(hold->cleared);
    hold->odometer_mm = knowledge->odometer_mm;
    if (s->health == ARGUS_SUSPECT) {
        argus_emit_change(events, knowledge, sonar, ARGUS_CHANGE_CLEARED, ARGUS_KIND_NONE, s->reading_mm);
    }
}

void argus_leave_open(const argus_knowledge_t *const knowledge, argus_algorithm1_t *const algorithm1,
                      argus_events_t *const events, const argus_mask_t sonars) {
    ARGUS_ASSERT((sonars & ~(unsigned)argus_robot_all(knowledge->robot)) == 0);
    ARGUS_ASSERT((sonars & argus_out(knowledge)) == 0);
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((sonars >> i & 1u) != 0) {
            argus_algorithm1_settle(algorithm1, i);
            argus_emit_of(events, ARGUS_EV_SONAR_UNPROVEN, i, knowledge->sonar[i].reading_mm);
        }
    }
}

// A name that looks do not clear while nothing moves about. For that alone others have looked along its
// bearing, each time anew (paper: Algorithm 2). What its own readings tell, looks do not prove, nor anything
// of one at the end of an array. A look that leaves it another name neither proves nor clears.
static bool is_proved(const argus_t *const self, argus_hold_t *const hold, const int sonar,
                      const argus_fault_kind_t kind) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT((unsigned)kind < ARGUS_KINDS);
    const bool beset = argus_robot_faces_forward(self->knowledge.robot, sonar); // neighbours on either side
    const bool by_others = beset && (kind == ARGUS_KIND_OFF || kind == ARGUS_KIND_WRONG);
    if (!by_others || kind != self->knowledge.sonar[sonar].kind || self->evidence.busy) {
        return false;
    }
    hold->borne_out = (uint8_t)argus_min(hold->borne_out + 1, PROOFS);
    return hold->borne_out >= (self->looks.settling > 0 ? PROOFS_AT_GOAL : PROOFS);
}

// What the looks have shown of one sonar.
static void conclude(argus_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const bool suspect = self->knowledge.sonar[sonar].health == ARGUS_SUSPECT;
    const bool asked = suspect || (self->verifying.inquiry.suspects >> sonar & 1u) != 0;
    if (argus_is_out(&self->knowledge, sonar)) {
        return;
    }
    const argus_finding_t finding = argus_finding(&self->evidence, &self->extremes, &self->common, sonar);
    const argus_fault_kind_t kind = argus_named_kind(self, sonar, &finding);
    if (asked && kind == ARGUS_KIND_NONE) {
        clear(&self->looks, &self->knowledge, &self->events, sonar);
    } else if (suspect && is_proved(self, &self->looks.hold[sonar], sonar, kind)) {
        argus_disable(self, sonar, kind);
    } else if (suspect) {
        argus_leave_open(&self->knowledge, &self->algorithm1, &self->events, (argus_mask_t)(1u << sonar));
    }
}

void argus_conclude_looks(argus_t *const self) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    ARGUS_ASSERT(!self->verifying.inquiry.active);
    for (int i = 0; i < self->knowledge.sonars; i++) {
        conclude(self, i);
    }
    self->looks.asked = false;
    self->looks.lost_ms = 0;
    argus_replan(self);
}

void argus_looks_init(argus_looks_t *const self) {
    memset(self, 0, sizeof *self);
}

void argus_looks_open(argus_looks_t *const self) {
    self->tried = false;
    self->unheard_said = false;
}

void argus_looks_checked(argus_looks_t *const self, const uint32_t now_ms) {
    self->check_ms = now_ms;
}

void argus_looks_leave(argus_looks_t *const self) {
    self->settling = 0;
}

void argus_looks_begin(argus_looks_t *const self, const bool arriving) {
    self->settling = (uint8_t)(arriving ? self->settling + 1 : 0);
}

void argus_looks_tried(argus_looks_t *const self) {
    self->tried = true;
}

bool argus_looks_unheard(argus_looks_t *const self) {
    const bool is_new = !self->unheard_said;
    self->unheard_said = true;
    return is_new;
}

void argus_looks_ask(argus_looks_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    self->hold[sonar].cleared = 0;
    self->asked = true;
}

bool argus_looks_stands(argus_looks_t *const self, const int sonar, const argus_fault_kind_t kind,
                        const uint32_t now_ms) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT((unsigned)kind < ARGUS_KINDS);
    argus_naming_t *const naming = &self->naming[sonar];
    if (naming->named != kind) {
        naming->named = (uint8_t)kind;
        naming->since_ms = now_ms;
    }
    return kind != ARGUS_KIND_NONE && now_ms - naming->since_ms >= NAME_STANDS_MS;
}

void argus_looks_rename(argus_looks_t *const self, const int sonar, const argus_fault_kind_t from,
                        const argus_fault_kind_t to) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    self->hold[sonar].lawless |= from == ARGUS_KIND_SLOW && to == ARGUS_KIND_WRONG;
}
