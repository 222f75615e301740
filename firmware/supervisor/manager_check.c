// SPDX-License-Identifier: MIT
// Health checks at rest and the verification of suspects, on the base heading (paper: Analysis).
#include "knowledge/angle.h"
#include "supervisor/manager_internal.h"

#define REFRESH_MS 320u
#define SLOTS 8u // in a round
#define SIP_MS 100u

void argus_take_base(argus_t *const self) {
    if (!self->has_base) {
        self->has_base = true;
        self->base_cdeg = self->knowledge.pose.heading_cdeg;
    }
}

void argus_give_up_turn(argus_t *const self) {
    argus_say(self, ARGUS_EV_TURN_FAILED, ARGUS_NO_SONAR,
              argus_angle_abs_diff(self->knowledge.pose.heading_cdeg, self->motion.target_cdeg) / 100);
    argus_enter_waiting(self, ARGUS_WAIT_MOTORS);
}

argus_mask_t argus_wanted_sonars(const argus_t *const self) {
    return (argus_mask_t)(ARGUS_FORWARD_MASK & ~(unsigned)argus_out(&self->knowledge));
}

uint32_t argus_two_rounds_ms(const argus_t *const self) {
    return 2u * SLOTS * (uint32_t)self->config.sonar_cycle_ms + SIP_MS;
}

static argus_mask_t in_use(const argus_knowledge_t *const knowledge) {
    unsigned mask = 0;
    for (int i = 0; i < knowledge->sonars; i++) {
        mask |= knowledge->sonar[i].reported && !argus_is_out(knowledge, i) ? 1u << i : 0u;
    }
    return (argus_mask_t)mask;
}

// Those ahead have been read again; before a turn that S7 forbade the others as well, for two rounds at most:
// one of them may have fallen silent.
static bool has_round(const argus_t *const self) {
    const bool waits = self->all_round && self->now_ms - self->since_ms < argus_two_rounds_ms(self);
    return argus_all_fresh_since(&self->knowledge, argus_wanted_sonars(self), &self->mark) &&
           (!waits || argus_all_fresh_since(&self->knowledge, in_use(&self->knowledge), &self->mark));
}

// True when the robot stands on the base heading; else it is on its way there, or S7 forbids.
static bool is_home(argus_t *const self) {
    if (self->passive) {
        return true;
    }
    if (self->motion.failed) {
        argus_give_up_turn(self);
        return false;
    }
    if (!self->motion.settled) {
        return false;
    }
    argus_take_base(self);
    if (argus_is_hemmed_in(self)) { // it may get out ahead
        self->base_cdeg = self->knowledge.pose.heading_cdeg;
    }
    if (argus_angle_abs_diff(self->knowledge.pose.heading_cdeg, self->base_cdeg) > 2 * 100) {
        if (!self->swing_again || has_round(self)) { // an echo that forbade to turn is read once more
            argus_turn(self, self->base_cdeg);
        }
        return false;
    }
    return true;
}

static void declare_healthy(argus_t *const self) {
    for (int i = 0; i < self->knowledge.sonars; i++) {
        argus_sonar_t *const s = &self->knowledge.sonar[i];
        if (s->reported && (s->health == ARGUS_UNKNOWN || s->health == ARGUS_STALE)) {
            argus_sonar_set_health(s, ARGUS_HEALTHY, ARGUS_KIND_NONE, self->now_ms);
            argus_say(self, ARGUS_EV_SONAR_HEALTHY, i, s->reading_mm);
        }
    }
}

// Suspects not verified in this place: also those whose verification was broken off, or could not be begun.
argus_mask_t argus_open_suspects(const argus_t *const self) {
    return (argus_mask_t)(argus_with_health(&self->knowledge, ARGUS_SUSPECT) &
                          ~(unsigned)self->awareness.verified);
}

static argus_mask_t find_suspects(argus_t *const self) {
    return argus_judges(self) ? (argus_mask_t)(argus_worth_a_look(self) | argus_open_suspects(self))
                              : argus_suspects(&self->awareness, &self->knowledge, &self->config);
}

static void finish_check(argus_t *const self) {
    const argus_mask_t suspects = (argus_mask_t)(find_suspects(self) | argus_open_suspects(self));
    const bool routine = argus_judges(self) && argus_routine_is_due(self);
    self->check_ms = self->now_ms;
    if ((suspects != 0 || routine) && !self->passive && !self->stay) {
        argus_enter_verifying(self, suspects);
        return;
    }
    argus_flag_suspects(self, suspects);
    declare_healthy(self);
    argus_replan(self);
    self->checked = true;
    argus_say(self, ARGUS_EV_HEALTH_CHECK, ARGUS_NO_SONAR, argus_count_bits(argus_out(&self->knowledge)));
    argus_decide(self);
}

void argus_run_checking(argus_t *const self) {
    if (!is_home(self)) {
        self->marked = false;
        return;
    }
    if (!self->marked) {
        self->marked = true;
        self->mark = self->passive ? argus_mark_now(&self->knowledge) : self->motion.mark;
    }
    if (!has_round(self)) {
        return;
    }
    self->mark = argus_mark_now(&self->knowledge);
    self->mark.from_ms =
        self->now_ms + REFRESH_MS; // counts only where a server lists every sonar in every SIP
    if (self->rounds > 1) {
        self->rounds--;
        return;
    }
    finish_check(self);
}

static void apply_verdict(argus_t *const self) {
    const int sonar = self->verify.sonar;
    argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    switch (self->verify.result) {
    case ARGUS_RESULT_CONVICTED:
        argus_disable(self, sonar, ARGUS_KIND_WRONG);
        break;
    case ARGUS_RESULT_CLEARED:
        argus_awareness_cleared(&self->awareness, &self->knowledge, sonar, self->verify.difference_mm);
        argus_sonar_set_health(s, ARGUS_HEALTHY, ARGUS_KIND_NONE, self->now_ms);
        argus_say(self, ARGUS_EV_SONAR_CLEARED, sonar, self->verify.mean_mm);
        break;
    case ARGUS_RESULT_DROPPED:
        self->awareness.of[sonar].in_a_row = 0;
        argus_sonar_set_health(s, ARGUS_HEALTHY, ARGUS_KIND_NONE, self->now_ms);
        argus_say(self, ARGUS_EV_SUSPICION_DROPPED, sonar, self->verify.difference_mm);
        break;
    case ARGUS_RESULT_UNPROVEN:
        self->awareness.verified |= (argus_mask_t)(1u << sonar);
        argus_say(self, ARGUS_EV_SONAR_UNPROVEN, sonar, self->verify.reading_mm);
        break;
    case ARGUS_RESULT_NONE:
    default:
        break;
    }
}

static void say_witnesses(argus_t *const self) {
    for (int side = 0; side < 2; side++) {
        if ((self->verify.heard >> side & 1) != 0) {
            argus_say(self, ARGUS_EV_SONAR_WITNESS, self->verify.by[side], self->verify.witness_mm[side]);
        }
    }
}

static int next_suspect(const argus_t *const self) {
    const unsigned open = argus_open_suspects(self);
    for (int i = ARGUS_FORWARD_FIRST; i <= ARGUS_FORWARD_LAST; i++) {
        if ((open >> i & 1u) != 0) {
            return i;
        }
    }
    return -1;
}

static void begin_next_suspect(argus_t *const self) {
    const int sonar = next_suspect(self);
    if (sonar < 0) {
        argus_enter_checking(self, false);
        return;
    }
    argus_verify_begin(&self->verify, self->knowledge.robot, sonar, self->base_cdeg);
    argus_say(self, ARGUS_EV_SONAR_VERIFYING, sonar, self->knowledge.sonar[sonar].reading_mm);
}

void argus_run_verifying(argus_t *const self) {
    if (argus_judges(self)) {
        argus_run_inquiry(self);
        return;
    }
    if (self->verify.phase == ARGUS_VERIFY_IDLE) {
        if (is_home(self)) {
            begin_next_suspect(self);
        }
        return;
    }
    if (self->motion.failed) {
        argus_enter_checking(self, false);
        return;
    }
    if (!self->motion.settled || !argus_verify_step(&self->verify, &self->knowledge, &self->motion.mark)) {
        return;
    }
    if (self->verify.phase != ARGUS_VERIFY_DONE) {
        argus_turn(self, argus_verify_heading_cdeg(&self->verify));
        return;
    }
    say_witnesses(self);
    apply_verdict(self);
    argus_verify_init(&self->verify);
}

static bool check_is_due(const argus_t *const self) {
    return argus_judges(self) || self->now_ms - self->check_ms >= (uint32_t)self->config.health_check_ms;
}

// Who may not turn cannot verify: there a suspicion lasts as long as the disparity.
static void drop_suspicions(argus_t *const self) {
    for (int i = ARGUS_FORWARD_FIRST; i <= ARGUS_FORWARD_LAST; i++) {
        argus_sonar_t *const s = &self->knowledge.sonar[i];
        if (s->health == ARGUS_SUSPECT && self->awareness.of[i].in_a_row == 0) {
            argus_sonar_set_health(s, ARGUS_HEALTHY, ARGUS_KIND_NONE, self->now_ms);
            argus_say(self, ARGUS_EV_SUSPICION_DROPPED, i, 0);
        }
    }
}

// While the course is paused nothing is looked at, but before an operator's step (S6).
static bool may_verify(const argus_t *const self) {
    return !self->passive && !(self->paused && self->mode == ARGUS_MODE_IDLE);
}

// The periodic health check beside the main task; true when it took over.
bool argus_health_check(argus_t *const self) {
    if (!check_is_due(self)) {
        return false;
    }
    self->check_ms = self->now_ms;
    const argus_mask_t suspects = find_suspects(self);
    const bool routine = argus_judges(self) && self->mode == ARGUS_MODE_DRIVING && argus_routine_is_due(self);
    if (self->passive && !argus_judges(self)) {
        drop_suspicions(self);
    }
    if (suspects == 0 && !routine) {
        return false;
    }
    if (!may_verify(self)) {
        argus_flag_suspects(self, suspects);
        return false;
    }
    argus_enter_verifying(self, suspects);
    return true;
}
