// SPDX-License-Identifier: MIT
// Draws the conclusions of a health check (paper: Analysis).
#include "supervisor/check.h"

#include "behaviour/looks.h"
#include "behaviour/state.h"
#include "knowledge/angle.h"
#include "supervisor/faults.h"

static void declare_healthy(argus_knowledge_t *const knowledge, argus_events_t *const events) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    for (int i = 0; i < knowledge->sonars; i++) {
        const argus_sonar_t *const s = &knowledge->sonar[i];
        if (s->reported && (s->health == ARGUS_UNKNOWN || s->health == ARGUS_STALE)) {
            argus_emit_change(events, knowledge, i, ARGUS_CHANGE_JUDGED, ARGUS_KIND_NONE, s->reading_mm);
        }
    }
}

static argus_mask_t find_suspects(const argus_t *const self, argus_algorithm1_t *const algorithm1) {
    if (argus_rules(self)->evidence) {
        return (argus_mask_t)(argus_doubted(self) | argus_open_suspects(self));
    }
    return argus_rules(self)->disparity
               ? argus_algorithm1_suspects(algorithm1, &self->knowledge, &self->config)
               : 0;
}

// The paper verifies every suspect at once; elsewhere a look must pay.
static bool is_look_due(const argus_t *const self, const argus_mask_t suspects) {
    return argus_rules(self)->evidence ? argus_look_pays(self) : suspects != 0;
}

static void verify(const argus_mask_t suspects, argus_intent_t *const intent) {
    intent->act = ARGUS_DO_VERIFY;
    intent->sonars = suspects;
}

void argus_conclude_check(argus_t *const self, argus_intent_t *const intent) {
    ARGUS_ASSERT(self->mode == ARGUS_MODE_CHECKING);
    const argus_mask_t suspects =
        (argus_mask_t)(find_suspects(self, &self->algorithm1) | argus_open_suspects(self));
    argus_flag_suspects(self, &self->knowledge, &self->events, suspects);
    argus_looks_checked(&self->looks, self->now_ms);
    if (is_look_due(self, suspects) && !self->orders.passive && !argus_is_stopped(self)) {
        verify(suspects, intent);
        return;
    }
    declare_healthy(&self->knowledge, &self->events);
    argus_replan(self);
    self->checked = true;
    argus_emit(&self->events, ARGUS_EV_HEALTH_CHECK, argus_count_bits(argus_out(&self->knowledge)));
    intent->act = ARGUS_DO_DECIDE;
}

static bool is_due(const argus_t *const self) {
    return argus_rules(self)->evidence ||
           self->now_ms - self->looks.check_ms >= (uint32_t)self->config.health_check_ms;
}

// A robot that may not turn cannot verify: there a suspicion lasts as long as the disparity.
static void drop_suspicions(const argus_t *const self, argus_knowledge_t *const knowledge,
                            argus_events_t *const events) {
    ARGUS_ASSERT(self->orders.passive);
    for (int i = 0; i < knowledge->sonars; i++) {
        if (argus_robot_faces_forward(knowledge->robot, i) && knowledge->sonar[i].health == ARGUS_SUSPECT &&
            self->algorithm1.of[i].in_a_row == 0) {
            argus_emit_change(events, knowledge, i, ARGUS_CHANGE_DROPPED, ARGUS_KIND_NONE, 0);
        }
    }
}

// While the course is paused nothing is looked at, but before an operator's step (S6).
static bool may_verify(const argus_t *const self) {
    return !self->orders.passive && !(self->orders.paused && self->mode == ARGUS_MODE_IDLE);
}

void argus_check_beside(argus_t *const self, argus_intent_t *const intent) {
    ARGUS_ASSERT(self->mode != ARGUS_MODE_VERIFYING && self->mode != ARGUS_MODE_CHECKING);
    if (!is_due(self)) {
        return;
    }
    argus_looks_checked(&self->looks, self->now_ms);
    const argus_mask_t suspects = find_suspects(self, &self->algorithm1);
    if (argus_rules(self)->evidence && self->mode == ARGUS_MODE_DRIVING) {
        argus_count_loss(self, &self->looks);
    }
    if (self->orders.passive && argus_rules(self)->disparity) {
        drop_suspicions(self, &self->knowledge, &self->events);
    }
    argus_flag_suspects(self, &self->knowledge, &self->events, suspects);
    if (may_verify(self) && is_look_due(self, suspects)) {
        verify(suspects, intent);
    }
}

static void emit_witnesses(argus_events_t *const events, const argus_verify_t *const verify) {
    for (int side = 0; side < 2; side++) {
        if ((verify->heard >> side & 1) != 0) {
            argus_emit_of(events, ARGUS_EV_SONAR_WITNESS, verify->by[side], verify->witness_mm[side]);
        }
    }
}

void argus_apply_verdict(argus_t *const self) {
    ARGUS_ASSERT(self->verifying.verify.phase == ARGUS_VERIFY_DONE);
    ARGUS_ASSERT(self->verifying.verify.result != ARGUS_RESULT_NONE);
    const argus_verify_t *const verify = &self->verifying.verify;
    const int sonar = verify->sonar;
    emit_witnesses(&self->events, verify);
    switch (verify->result) { // GCOV_EXCL_BR_LINE: the default, lines tell of the rest
    case ARGUS_RESULT_CONVICTED:
        argus_disable(self, sonar, ARGUS_KIND_WRONG);
        break;
    case ARGUS_RESULT_CLEARED:
        argus_algorithm1_cleared(&self->algorithm1, &self->knowledge, sonar, verify->difference_mm);
        argus_emit_change(&self->events, &self->knowledge, sonar, ARGUS_CHANGE_CLEARED, ARGUS_KIND_NONE,
                          verify->mean_mm);
        break;
    case ARGUS_RESULT_DROPPED:
        argus_algorithm1_dropped(&self->algorithm1, sonar);
        argus_emit_change(&self->events, &self->knowledge, sonar, ARGUS_CHANGE_DROPPED, ARGUS_KIND_NONE,
                          verify->difference_mm);
        break;
    case ARGUS_RESULT_UNPROVEN:
        argus_algorithm1_settle(&self->algorithm1, sonar);
        argus_emit_of(&self->events, ARGUS_EV_SONAR_UNPROVEN, sonar, verify->reading_mm);
        break;
    case ARGUS_RESULT_NONE: // GCOV_EXCL_LINE: it is done, so there is one
    default:                // GCOV_EXCL_LINE
        break;              // GCOV_EXCL_LINE
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
static bool is_proved(const argus_t *const self, argus_looks_t *const looks, const int sonar,
                      const argus_fault_kind_t kind) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT((unsigned)kind < ARGUS_KINDS);
    const bool has_neighbours =
        argus_robot_faces_forward(self->knowledge.robot, sonar); // neighbours on either side
    const bool by_others = has_neighbours && (kind == ARGUS_KIND_OFF || kind == ARGUS_KIND_WRONG);
    if (!by_others || kind != self->knowledge.sonar[sonar].kind || self->evidence.busy) {
        return false;
    }
    return argus_looks_prove(looks, sonar);
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
        argus_looks_clear(&self->looks, &self->knowledge, sonar);
        if (suspect) {
            argus_emit_change(&self->events, &self->knowledge, sonar, ARGUS_CHANGE_CLEARED, ARGUS_KIND_NONE,
                              self->knowledge.sonar[sonar].reading_mm);
        }
    } else if (suspect && is_proved(self, &self->looks, sonar, kind)) {
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
    argus_looks_over(&self->looks);
    argus_replan(self);
}
