// SPDX-License-Identifier: MIT
// Profile argus at work: convictions, active looks and the way back of a sonar that does well again.
#include "knowledge/angle.h"
#include "supervisor/manager_internal.h"

#define HOLD_MM 400u         // an acquitted sonar is not looked at again before this distance,
#define HOLD_DOUBLINGS 2u    // ... doubled with each acquittal so often
#define HOLD_FORGET_MM 4000u // ... and forgotten after this one
#define LOST_HOLD_MM 100u    // for a lost echo one ahead at once, any other after this distance
#define SPACING_MS 3000u     // between two looks for a mere jump
#define ROUTINE_MM_S \
    100u // a look at all beside the main task only when the robot has driven so far in the meantime
#define PROBATION_AGREED 4
#define PROBATION_MS 4000u
#define PROBATION_DOUBLINGS 4

bool argus_judges(const argus_t *const self) {
    return self->config.profile == ARGUS_PROFILE_ARGUS;
}

static void stop_for(argus_t *const self, const int sonar) {
    const bool ahead = (ARGUS_FORWARD_MASK >> sonar & 1u) != 0;
    const bool busy = self->mode == ARGUS_MODE_WAITING || self->mode == ARGUS_MODE_CLOSING ||
                      self->mode == ARGUS_MODE_VERIFYING || self->mode == ARGUS_MODE_BACKING;
    if (ahead && !busy) {
        argus_halt(self);
        argus_enter_checking(self, false);
    }
}

static void convict(argus_t *const self, const int sonar, const argus_fault_kind_t kind) {
    argus_disable(self, sonar, kind);
    argus_evidence_acquit(&self->evidence, &self->knowledge, sonar);
    stop_for(self, sonar);
}

// A suspect carries the kind that the evidence names so far.
static void name(argus_t *const self, const int sonar) {
    argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    const argus_fault_kind_t kind = argus_evidence_renames(&self->evidence, sonar, s->kind);
    if (kind != ARGUS_KIND_NONE) {
        argus_flag_suspects(self, (argus_mask_t)(1u << sonar));
    }
    if (s->health == ARGUS_SUSPECT && argus_evidence_replaces(&self->evidence, sonar, s->kind, kind)) {
        s->kind = kind;
        argus_evidence_note_name(&self->evidence, sonar, kind);
        argus_say(self, ARGUS_EV_SONAR_NAMED, sonar, (int32_t)kind);
    }
    const bool held = self->mode == ARGUS_MODE_VERIFYING || (self->evidence.lost >> sonar & 1u) != 0;
    if (s->health == ARGUS_SUSPECT && !argus_evidence_holds(&self->evidence, sonar) && !held) {
        argus_sonar_set_health(s, ARGUS_HEALTHY, ARGUS_KIND_NONE, self->now_ms);
        argus_say(self, ARGUS_EV_SUSPICION_DROPPED, sonar, s->reading_mm);
        argus_replan(self);
    }
}

static void judge_in(argus_t *const self, const int sonar) {
    const argus_fault_kind_t kind = argus_evidence_convicts(&self->evidence, sonar);
    if (kind != ARGUS_KIND_NONE) {
        convict(self, sonar, kind);
    } else {
        name(self, sonar);
    }
}

static void restore(argus_t *const self, const int sonar, const argus_health_t health) {
    argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    const bool healthy = health == ARGUS_HEALTHY;
    argus_sonar_set_health(s, health, healthy ? ARGUS_KIND_NONE : s->kind, self->now_ms);
    self->evidence.of[sonar].agreed = 0;
    argus_say(self, healthy ? ARGUS_EV_SONAR_HEALTHY : ARGUS_EV_SONAR_PROBATION, sonar, s->reading_mm);
    argus_replan(self);
}

// Probation grows with each relapse.
static uint8_t agreements_wanted(const argus_sonar_t *const s) {
    if (s->health == ARGUS_DISABLED) {
        return PROBATION_AGREED;
    }
    return (uint8_t)(PROBATION_AGREED << argus_min(s->relapses, PROBATION_DOUBLINGS));
}

// What repeated one value, and shows another one now, was not stuck: a name is enough to say what it is. Half
// the truth, where nothing is in range, is the same value each time.
static argus_fault_kind_t kind_of_out(const argus_t *const self, const int sonar) {
    const argus_fault_kind_t convicted = argus_evidence_convicts(&self->evidence, sonar);
    const bool stuck = self->knowledge.sonar[sonar].kind == ARGUS_KIND_STUCK;
    return convicted == ARGUS_KIND_NONE && stuck ? argus_evidence_names(&self->evidence, sonar) : convicted;
}

static void judge_out(argus_t *const self, const int sonar) {
    argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    const argus_fault_kind_t kind = kind_of_out(self, sonar);
    const argus_fault_kind_t named = argus_evidence_relapses(&self->evidence, sonar);
    const bool suspected = argus_evidence_keeps_out(&self->evidence, sonar);
    if (s->health == ARGUS_DISABLED && argus_evidence_replaces(&self->evidence, sonar, s->kind, kind)) {
        s->kind = kind;
        argus_say(self, ARGUS_EV_SONAR_KIND, sonar, (int32_t)kind);
    }
    if (suspected) {
        if (s->health == ARGUS_PROBATION && named != ARGUS_KIND_NONE) {
            argus_disable(self, sonar, named);
        }
        return;
    }
    const bool long_enough = self->now_ms - s->since_ms >= PROBATION_MS;
    const bool silent = argus_silent_ms(&self->knowledge, sonar) > (uint32_t)self->config.stale_ms;
    if (long_enough && !silent && self->evidence.of[sonar].agreed >= agreements_wanted(s)) {
        restore(self, sonar, s->health == ARGUS_DISABLED ? ARGUS_PROBATION : ARGUS_HEALTHY);
    }
}

// Its turn in a round comes late: each new order begins the round anew, so plans that change may pass it
// over.
static bool is_passed_over(const argus_t *const self, const int sonar) {
    const argus_robot_t *const robot = self->knowledge.robot;
    const bool late =
        (argus_robot_polled(robot) >> sonar & 1u) != 0 && !argus_robot_faces_forward(robot, sonar);
    return late && self->ordered && self->now_ms - self->ordered_ms <= (uint32_t)self->config.stale_ms;
}

// The others than 1..6 yield to the same tests; one that yields nothing is out as well.
static void judge_silence(argus_t *const self, const int sonar) {
    const bool other = (ARGUS_FORWARD_MASK >> sonar & 1u) == 0;
    const bool silent = argus_silent_ms(&self->knowledge, sonar) > (uint32_t)self->config.stale_ms;
    if (other && silent && !is_passed_over(self, sonar)) {
        argus_disable(self, sonar, ARGUS_KIND_SILENT);
    }
}

void argus_judge(argus_t *const self) {
    if (!argus_judges(self) || self->mode == ARGUS_MODE_CLOSING) {
        return;
    }
    for (int i = 0; i < self->knowledge.sonars; i++) {
        if ((self->pinned >> i & 1u) != 0) {
            continue;
        }
        if (argus_is_out(&self->knowledge, i)) {
            judge_out(self, i);
        } else {
            judge_silence(self, i);
            judge_in(self, i);
        }
    }
}

static bool was_cleared_within(const argus_t *const self, const int sonar, const uint32_t way_mm) {
    const argus_hold_t *const hold = &self->hold[sonar];
    return hold->acquittals > 0 && self->knowledge.odometer_mm - hold->odometer_mm < way_mm;
}

static bool is_held(const argus_t *const self, const int sonar) {
    const int32_t doublings = argus_min(self->hold[sonar].acquittals - 1, (int32_t)HOLD_DOUBLINGS);
    return was_cleared_within(self, sonar, HOLD_MM << (unsigned)argus_max(0, doublings));
}

// Beside a smooth wall one that looks aside loses its echo in each look anew: it must not keep the robot
// there.
static argus_mask_t lost(const argus_t *const self) {
    unsigned mask = self->evidence.lost;
    for (int i = 0; i < self->knowledge.sonars; i++) {
        const bool ahead = (ARGUS_FORWARD_MASK >> i & 1u) != 0;
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
    return (argus_mask_t)(mask & ~(unsigned)argus_out(&self->knowledge) & ~(unsigned)self->pinned);
}

// What is worth a stop now: evidence that a look can settle, a lost echo ahead, a bearing unseen for too
// long.
argus_mask_t argus_worth_a_look(argus_t *const self) {
    const argus_mask_t unseen = argus_evidence_unseen(&self->evidence, &self->knowledge, &self->config);
    const unsigned ahead = lost(self) | unseen;
    const bool spaced = self->now_ms - self->looked_ms >= SPACING_MS;
    const unsigned jumped = spaced ? self->evidence.jumped & ARGUS_FORWARD_MASK : 0u;
    const unsigned open = without_held(self, suspected(self) | jumped) | ahead;
    return (argus_mask_t)(open & ~(unsigned)argus_out(&self->knowledge) &
                          ~(unsigned)self->awareness.verified & ~(unsigned)self->pinned);
}

bool argus_routine_is_due(const argus_t *const self) {
    const bool first = !self->looked_once;
    const uint32_t every_s = (uint32_t)self->config.look_every_s;
    const bool long_ago = self->now_ms - self->looked_ms >= every_s * 1000u &&
                          self->knowledge.odometer_mm - self->looked_odometer_mm >= every_s * ROUTINE_MM_S;
    return (first || long_ago) && !self->passive && !self->stay && argus_may_turn(self) &&
           self->mission == ARGUS_MISSION_RUNNING;
}

static void acquit(argus_t *const self, const int sonar) {
    argus_hold_t *const hold = &self->hold[sonar];
    argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    if (self->knowledge.odometer_mm - hold->odometer_mm > HOLD_FORGET_MM) {
        hold->acquittals = 0;
    }
    hold->acquittals = (uint8_t)argus_min(hold->acquittals + 1, UINT8_MAX);
    hold->odometer_mm = self->knowledge.odometer_mm;
    argus_evidence_acquit(&self->evidence, &self->knowledge, sonar);
    if (s->health == ARGUS_SUSPECT) {
        argus_sonar_set_health(s, ARGUS_HEALTHY, ARGUS_KIND_NONE, self->now_ms);
        argus_say(self, ARGUS_EV_SONAR_CLEARED, sonar, s->reading_mm);
    }
}

static void leave_open(argus_t *const self, const int sonar) {
    self->awareness.verified |= (argus_mask_t)(1u << sonar);
    argus_say(self, ARGUS_EV_SONAR_UNPROVEN, sonar, self->knowledge.sonar[sonar].reading_mm);
}

// What the looks have shown of one sonar.
static void conclude(argus_t *const self, const int sonar) {
    const bool suspect = self->knowledge.sonar[sonar].health == ARGUS_SUSPECT;
    const bool asked = suspect || (self->inquiry.suspects >> sonar & 1u) != 0;
    if (argus_is_out(&self->knowledge, sonar)) {
        return;
    }
    if (!asked && !argus_evidence_suspects(&self->evidence, sonar)) {
        argus_evidence_acquit(&self->evidence, &self->knowledge, sonar); // it was looked at like the others
    } else if (asked && argus_evidence_names(&self->evidence, sonar) == ARGUS_KIND_NONE) {
        acquit(self, sonar);
    } else if (suspect) {
        leave_open(self, sonar);
    }
}

static void finish(argus_t *const self) {
    for (int i = 0; i < self->knowledge.sonars; i++) {
        conclude(self, i);
    }
    self->looked_ms = self->now_ms;
    self->looked_odometer_mm = self->knowledge.odometer_mm;
    self->looked_once = true;
    argus_inquiry_init(&self->inquiry);
    argus_replan(self);
    argus_enter_checking(self, false);
}

// No look is to be had, and none of them looks ahead: they are left open.
static void go_on_without(argus_t *const self, const argus_mask_t suspects) {
    for (int i = 0; i < self->knowledge.sonars; i++) {
        if ((suspects >> i & 1u) != 0) {
            leave_open(self, i);
        }
    }
    argus_enter_checking(self, false);
}

static void begin(argus_t *const self) {
    const argus_mask_t suspects = argus_open_suspects(self);
    argus_take_base(self);
    if (suspects != 0 && (suspects & ARGUS_FORWARD_MASK) == 0 && argus_is_hemmed_in(self)) {
        go_on_without(self, suspects);
        return;
    }
    argus_inquiry_begin(&self->inquiry, &self->knowledge, &self->evidence, suspects, self->base_cdeg);
    for (int i = 0; i < self->knowledge.sonars; i++) {
        if ((suspects >> i & 1u) != 0) {
            argus_say(self, ARGUS_EV_SONAR_VERIFYING, i, self->knowledge.sonar[i].reading_mm);
        }
    }
    if (suspects == 0) {
        argus_say(self, ARGUS_EV_LOOK, ARGUS_NO_SONAR, 0);
    }
    if (!argus_turn(self, argus_inquiry_heading_cdeg(&self->inquiry))) {
        argus_inquiry_init(&self->inquiry);
    }
}

// In VERIFYING mode, on each SIP.
void argus_run_inquiry(argus_t *const self) {
    if (self->motion.failed) {
        argus_inquiry_init(&self->inquiry);
        argus_give_up_turn(self);
        return;
    }
    if (!self->motion.settled) {
        return;
    }
    if (!self->inquiry.active) {
        begin(self);
        return;
    }
    self->inquiry.watched &= (argus_mask_t) ~(unsigned)argus_out(&self->knowledge);
    if (!argus_inquiry_step(&self->inquiry, &self->knowledge, &self->evidence)) {
        return;
    }
    if (!self->inquiry.active) {
        finish(self);
    } else if (!argus_turn(self, argus_inquiry_heading_cdeg(&self->inquiry))) {
        argus_inquiry_init(&self->inquiry);
    }
}
