// SPDX-License-Identifier: MIT
// Weighs a look against the stop that it costs, and draws the conclusions.
#include "supervisor/looks.h"

#include "knowledge/angle.h"
#include "supervisor/faults.h"
#include "supervisor/say.h"
#include "supervisor/state.h"

#define HOLD_MM 400u         // an acquitted sonar is not looked at again before this distance,
#define HOLD_DOUBLINGS 2     // ... doubled with each acquittal so often
#define HOLD_FORGET_MM 4000u // ... and forgotten after this one
#define LOST_HOLD_MM 100u    // for a lost echo one ahead at once, any other after this distance
#define SPACING_MS 3000u     // between two looks for a mere jump
#define ROUTINE_MM_S \
    100u // a look at all beside the main task only when the robot has driven so far in the meantime

static bool was_cleared_within(const argus_t *const self, const int sonar, const uint32_t way_mm) {
    const argus_hold_t *const hold = &self->looks.hold[sonar];
    return hold->acquittals > 0 && self->knowledge.odometer_mm - hold->odometer_mm < way_mm;
}

static bool is_held(const argus_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < self->knowledge.sonars);
    const int32_t doublings = argus_min(self->looks.hold[sonar].acquittals - 1, HOLD_DOUBLINGS);
    return was_cleared_within(self, sonar, HOLD_MM << (unsigned)argus_max(0, doublings));
}

// Beside a smooth wall one that looks aside loses its echo in each look anew: it must not keep the robot
// there.
static argus_mask_t lost(const argus_t *const self) {
    unsigned mask = argus_evidence_lost(&self->evidence);
    for (int i = 0; i < self->knowledge.sonars; i++) {
        const bool ahead = (argus_robot_forward(self->knowledge.robot) >> i & 1u) != 0;
        mask &= !ahead && was_cleared_within(self, i, LOST_HOLD_MM) ? ~(1u << i) : ~0u;
    }
    return (argus_mask_t)mask;
}

static argus_mask_t without_held(const argus_t *const self, const unsigned mask) {
    unsigned free_mask = 0;
    for (int i = 0; i < self->knowledge.sonars; i++) {
        free_mask |= (mask >> i & 1u) != 0 && !is_held(self, i) ? 1u << i : 0u;
    }
    return (argus_mask_t)free_mask;
}

static argus_mask_t suspected(const argus_t *const self) {
    unsigned mask = 0;
    for (int i = 0; i < self->knowledge.sonars; i++) {
        mask |= argus_evidence_suspects(&self->evidence, i) ? 1u << i : 0u;
    }
    return (argus_mask_t)mask;
}

argus_mask_t argus_worth_a_look(const argus_t *const self) {
    ARGUS_ASSERT(argus_rules(self)->evidence);
    const argus_mask_t unseen = argus_evidence_unseen(&self->evidence, &self->knowledge, &self->config);
    const unsigned ahead = lost(self) | unseen;
    const bool spaced = self->now_ms - self->looks.last_ms >= SPACING_MS;
    const unsigned jumped =
        spaced ? argus_evidence_jumped(&self->evidence) & argus_robot_forward(self->knowledge.robot) : 0u;
    const unsigned open = without_held(self, suspected(self) | jumped) | ahead;
    return (argus_mask_t)(open & ~(unsigned)argus_out(&self->knowledge) &
                          ~(unsigned)self->awareness.verified & ~(unsigned)self->orders.pinned);
}

bool argus_routine_is_due(const argus_t *const self) {
    const argus_looks_t *const looks = &self->looks;
    const uint32_t every_s = (uint32_t)self->config.look_every_s;
    const bool long_ago = self->now_ms - looks->last_ms >= every_s * 1000u &&
                          self->knowledge.odometer_mm - looks->last_odometer_mm >= every_s * ROUTINE_MM_S;
    if ((looks->once && !long_ago) || self->orders.passive || self->orders.stay ||
        self->mission != ARGUS_MISSION_RUNNING) {
        return false;
    }
    const argus_guard_t guard = argus_guard(self);
    return argus_guard_may_turn(&guard);
}

static void acquit(argus_t *const self, const int sonar) {
    ARGUS_ASSERT(!argus_is_out(&self->knowledge, sonar));
    argus_hold_t *const hold = &self->looks.hold[sonar];
    const argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    if (self->knowledge.odometer_mm - hold->odometer_mm > HOLD_FORGET_MM) {
        hold->acquittals = 0;
    }
    hold->acquittals = (uint8_t)argus_min(hold->acquittals + 1, UINT8_MAX);
    hold->odometer_mm = self->knowledge.odometer_mm;
    argus_evidence_acquit(&self->evidence, &self->knowledge, sonar);
    if (s->health == ARGUS_SUSPECT) {
        argus_say_change(self, sonar, ARGUS_CHANGE_CLEARED, ARGUS_KIND_NONE, s->reading_mm);
    }
}

void argus_leave_open(argus_t *const self, const argus_mask_t sonars) {
    ARGUS_ASSERT((sonars & argus_out(&self->knowledge)) == 0);
    for (int i = 0; i < self->knowledge.sonars; i++) {
        if ((sonars >> i & 1u) != 0) {
            self->awareness.verified |= (argus_mask_t)(1u << i);
            argus_say(self, ARGUS_EV_SONAR_UNPROVEN, i, self->knowledge.sonar[i].reading_mm);
        }
    }
}

// What the looks have shown of one sonar.
static void conclude(argus_t *const self, const int sonar) {
    const bool suspect = self->knowledge.sonar[sonar].health == ARGUS_SUSPECT;
    const bool asked = suspect || (self->verifying.inquiry.suspects >> sonar & 1u) != 0;
    if (argus_is_out(&self->knowledge, sonar)) {
        return;
    }
    if (!asked && !argus_evidence_suspects(&self->evidence, sonar)) {
        argus_evidence_acquit(&self->evidence, &self->knowledge, sonar); // it was looked at like the others
    } else if (asked && argus_evidence_names(&self->evidence, sonar) == ARGUS_KIND_NONE) {
        acquit(self, sonar);
    } else if (suspect) {
        argus_leave_open(self, (argus_mask_t)(1u << sonar));
    }
}

void argus_conclude_looks(argus_t *const self) {
    ARGUS_ASSERT(!self->verifying.inquiry.active);
    for (int i = 0; i < self->knowledge.sonars; i++) {
        conclude(self, i);
    }
    self->looks.last_ms = self->now_ms;
    self->looks.last_odometer_mm = self->knowledge.odometer_mm;
    self->looks.once = true;
    argus_replan(self);
}

void argus_forget_acquittals(argus_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < self->knowledge.sonars);
    self->looks.hold[sonar].acquittals = 0;
}
