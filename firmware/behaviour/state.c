// SPDX-License-Identifier: MIT
// Answers what several parts of the manager ask of its state.
#include "behaviour/state.h"

#include "knowledge/angle.h"

#define SQUEEZE_MS 3000u
#define HEMMED_IN_MS 10000u // people who stand beside it walk on

argus_policy_t argus_policy(const argus_t *const self) {
    const argus_policy_t policy = (argus_policy_t)self->config.policy;
    return policy == ARGUS_POLICY_ADAPTIVE && !argus_rules(self)->adapts_plan ? ARGUS_POLICY_PAPER : policy;
}

bool argus_is_active(const argus_t *const self) {
    return !self->orders.passive && !self->orders.shutdown;
}

bool argus_is_stopped(const argus_t *const self) {
    return (self->orders.stay & (ARGUS_STAY_OPERATOR | ARGUS_STAY_CLIENT)) != 0;
}

bool argus_is_open(const argus_t *const self) {
    return argus_session_is_open(&self->session);
}

bool argus_is_shown_blind(const argus_t *const self, const argus_guard_t *const guard) {
    return self->reflexes.touched_unheard && !argus_guard_is_heard(guard);
}

bool argus_is_unseen(const argus_t *const self, const argus_guard_t *const guard) {
    return argus_is_shown_blind(self, guard) || !argus_guard_may_step(&self->plan);
}

// Segments on the end that leads, by CONFIGpac: bumpers are an accessory, and a table knows not which robot
// has one.
static bool leads_with_bumper(const argus_t *const self) {
    const argus_configpac_t *const told = &self->session.robot; // zero until it has come
    const argus_robot_t *const robot = self->knowledge.robot;
    return robot->front_bumpers > 0 && (robot->reversed ? told->rear_bumpers : told->front_bumpers) > 0;
}

// People who stand beside it have had time to walk on; what is left needs no more room than the body.
static bool is_waiting_to_turn(const argus_t *const self) {
    const argus_waiting_t *const waiting = &self->waiting;
    return waiting->last == ARGUS_WAIT_TURN && self->now_ms - waiting->since_ms >= SQUEEZE_MS;
}

argus_guard_t argus_guard(const argus_t *const self) {
    argus_guard_t guard = {.config = &self->config,
                           .profile = argus_rules(self),
                           .knowledge = &self->knowledge,
                           .echoes = &self->echoes,
                           .rays = &self->rays,
                           .now_ms = self->now_ms,
                           .reverse = self->reverse,
                           .faster_mm_s = self->pace.seen_mm_s,
                           .late_ms = self->latency.late_ms,
                           .bumpers = self->reflexes.bumpers,
                           .backed = self->turning.backed,
                           .active = argus_is_active(self),
                           .linked = argus_is_open(self) && !self->stalled && !self->latency.stands,
                           .checked = self->checked,
                           .squeezes = is_waiting_to_turn(self)};
    guard.creeps = self->config.creep_mm_s > 0 && leads_with_bumper(self) && argus_is_unseen(self, &guard);
    return guard;
}

int32_t argus_base_cdeg(const argus_t *const self) {
    return self->base.taken ? self->base.cdeg : self->knowledge.pose.heading_cdeg;
}

argus_mask_t argus_wanted_sonars(const argus_t *const self) {
    return (argus_mask_t)(argus_robot_forward(self->knowledge.robot) &
                          ~(unsigned)argus_out(&self->knowledge));
}

argus_mask_t argus_open_suspects(const argus_t *const self) {
    return (argus_mask_t)(argus_with_health(&self->knowledge, ARGUS_SUSPECT) &
                          ~(unsigned)self->algorithm1.verified);
}

bool argus_is_hemmed_in(const argus_t *const self) {
    const argus_waiting_t *const waiting = &self->waiting;
    if (!argus_rules(self)->leaves_ahead || waiting->last != ARGUS_WAIT_TURN ||
        self->now_ms - waiting->since_ms < HEMMED_IN_MS) {
        return false;
    }
    const argus_guard_t guard = argus_guard(self);
    return self->mission == ARGUS_MISSION_RUNNING && !self->orders.paused && guard.bumpers == 0 &&
           !argus_guard_may_turn(&guard) && !argus_guard_may_back_off(&guard);
}

void argus_turn_failed(const argus_t *const self, argus_intent_t *const intent) {
    ARGUS_ASSERT(self->motion.failed);
    const int32_t off_cdeg =
        argus_angle_abs_diff(self->knowledge.pose.heading_cdeg, self->motion.target_cdeg);
    argus_to_say(intent, ARGUS_EV_TURN_FAILED, ARGUS_NO_SONAR, off_cdeg / 100);
    argus_to_wait(intent, ARGUS_WAIT_MOTORS);
}

bool argus_is_home(const argus_t *const self, const bool again, argus_intent_t *const intent) {
    ARGUS_ASSERT(intent != NULL);
    if (self->orders.passive) {
        return true;
    }
    if (self->motion.failed) {
        argus_turn_failed(self, intent);
        return false;
    }
    if (!self->motion.settled) {
        return false;
    }
    const argus_guard_t guard = argus_guard(self);
    if (argus_is_hemmed_in(self)) { // it may get out ahead
        intent->base = ARGUS_BASE_RENEW;
        return true;
    }
    intent->base = ARGUS_BASE_TAKE;
    if (argus_guard_is_home(&guard, argus_base_cdeg(self))) {
        return true;
    }
    if (!self->turning.again || again) {
        argus_to_turn(intent, argus_base_cdeg(self));
    }
    return false;
}

// It has no name of a fault and shows no gaps: what is there it hears again. The echo itself may be what it
// is doubted for.
static bool is_steady(const argus_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < self->knowledge.sonars);
    return argus_trusted(&self->knowledge, sonar) && !argus_evidence_shows_gaps(&self->evidence, sonar);
}

static bool only_steady_forbid_to_turn(const argus_t *const self, const argus_guard_t *const guard) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    for (int i = 0; i < self->knowledge.sonars; i++) {
        if (argus_guard_echo_blocks(guard, i) && !is_steady(self, i)) {
            return false;
        }
    }
    return true;
}

// Once for each try, since echoes that jump are never remembered as of one thing.
bool argus_may_be_crosstalk(const argus_t *const self, const argus_guard_t *const guard) {
    return guard->profile->reads_again && !self->turning.again && guard->bumpers == 0 &&
           !argus_guard_memory_blocks(guard) && only_steady_forbid_to_turn(self, guard);
}

// A few times backing away may help.
void argus_instead_of_turn(const argus_t *const self, argus_intent_t *const intent) {
    ARGUS_ASSERT(argus_is_active(self));
    const argus_guard_t guard = argus_guard(self);
    if (argus_may_be_crosstalk(self, &guard)) {
        intent->act = ARGUS_DO_CHECK;
        intent->again = true;
        return;
    }
    const int32_t nearest_mm = argus_guard_nearest_mm(&guard, 0);
    argus_to_say(intent, ARGUS_EV_TURN_BLOCKED, argus_guard_barring(&guard),
                 nearest_mm == INT32_MAX ? 0 : nearest_mm);
    argus_to_wait(intent, ARGUS_WAIT_TURN);
    if (argus_guard_may_back_off(&guard)) {
        intent->act = ARGUS_DO_BACK;
        intent->mm = argus_guard_back_mm(&guard);
        intent->speed_mm_s = argus_guard_back_speed_mm_s(&guard);
    }
}
