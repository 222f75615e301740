// SPDX-License-Identifier: MIT
// Checks, verifies, idles, waits and backs away: one SIP of each mode.
#include "supervisor/resting.h"

#include "knowledge/angle.h"
#include "supervisor/state.h"

#define REFRESH_MS 320u
#define RETRY_MS 1000u
#define SAY_EVERY_S 10u

static argus_mask_t in_use(const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    unsigned mask = 0;
    for (int i = 0; i < knowledge->sonars; i++) {
        mask |= knowledge->sonar[i].reported && !argus_is_out(knowledge, i) ? 1u << i : 0u;
    }
    return (argus_mask_t)mask;
}

// Those ahead have been read again. After S7 forbade a turn, the others are waited for as well. That is for
// two rounds at most, as one of them may have fallen silent.
static bool has_round(const argus_t *const self, const argus_checking_t *const mine) {
    const argus_knowledge_t *const knowledge = &self->knowledge;
    const bool waits =
        mine->all_round && self->now_ms - self->since_ms < argus_guard_two_rounds_ms(&self->config);
    return argus_all_fresh_since(knowledge, argus_wanted_sonars(self), &mine->mark) &&
           (!waits || argus_all_fresh_since(knowledge, in_use(knowledge), &mine->mark));
}

argus_intent_t argus_run_checking(const argus_t *const self, argus_checking_t *const mine) {
    argus_intent_t intent;
    if (!argus_is_home(self, has_round(self, mine), &intent)) {
        mine->marked = false;
        return intent;
    }
    if (!mine->marked) {
        mine->marked = true;
        mine->mark = self->orders.passive ? argus_mark_now(&self->knowledge) : self->motion.mark;
    }
    if (!has_round(self, mine)) {
        return intent;
    }
    mine->mark = argus_mark_now(&self->knowledge);
    mine->mark.from_ms =
        self->now_ms + REFRESH_MS; // counts only where a server lists every sonar in every SIP
    if (mine->rounds > 1) {
        mine->rounds--;
        return intent;
    }
    intent.act = ARGUS_DO_CONCLUDE;
    return intent;
}

static int next_suspect(const argus_t *const self) {
    ARGUS_ASSERT(self->knowledge.sonars <= ARGUS_SONARS);
    const unsigned open = (unsigned)argus_open_suspects(self) & argus_robot_forward(self->knowledge.robot);
    for (int i = 0; i < self->knowledge.sonars; i++) {
        if ((open >> i & 1u) != 0) {
            return i;
        }
    }
    return -1;
}

static argus_intent_t begin_verification(const argus_t *const self, argus_verify_t *const mine) {
    argus_intent_t intent;
    argus_verify_init(mine);
    if (!argus_is_home(self, true, &intent)) {
        return intent;
    }
    const int sonar = next_suspect(self);
    if (sonar < 0) {
        intent.act = ARGUS_DO_CHECK;
        return intent;
    }
    argus_verify_begin(mine, self->knowledge.robot, sonar, argus_base_cdeg(self));
    intent.event = ARGUS_EV_SONAR_VERIFYING;
    intent.sonar = (int8_t)sonar;
    intent.value = self->knowledge.sonar[sonar].reading_mm;
    return intent;
}

// Algorithm 2.
static argus_intent_t verify(const argus_t *const self, argus_verify_t *const mine) {
    if (mine->phase == ARGUS_VERIFY_IDLE || mine->phase == ARGUS_VERIFY_DONE) {
        return begin_verification(self, mine);
    }
    if (self->motion.failed) {
        return argus_to_check(false);
    }
    if (!self->motion.settled || !argus_verify_step(mine, &self->knowledge, &self->motion.mark)) {
        return argus_to_nothing();
    }
    if (mine->phase == ARGUS_VERIFY_DONE) {
        return argus_to(ARGUS_DO_VERDICT);
    }
    return argus_to_turn(argus_verify_heading_cdeg(mine));
}

static argus_intent_t begin_looks(const argus_t *const self, argus_inquiry_t *const mine) {
    const argus_mask_t suspects = argus_open_suspects(self);
    argus_intent_t intent = {.base = ARGUS_BASE_TAKE, .act = ARGUS_DO_LOOK, .sonars = suspects};
    if (suspects != 0 && (suspects & argus_robot_forward(self->knowledge.robot)) == 0 &&
        argus_is_hemmed_in(self)) {
        intent.act = ARGUS_DO_LEAVE_OPEN; // no look is to be had, and none of them looks ahead
        return intent;
    }
    argus_inquiry_begin(mine, &self->knowledge, &self->evidence, suspects, argus_base_cdeg(self));
    intent.cdeg = argus_inquiry_heading_cdeg(mine);
    return intent;
}

static argus_intent_t look(const argus_t *const self, argus_inquiry_t *const mine) {
    if (self->motion.failed) {
        argus_inquiry_init(mine);
        return argus_turn_failed(self);
    }
    if (!self->motion.settled) {
        return argus_to_nothing();
    }
    if (!mine->active) {
        return begin_looks(self, mine);
    }
    mine->watched &= (argus_mask_t) ~(unsigned)argus_out(&self->knowledge);
    if (!argus_inquiry_step(mine, &self->knowledge, &self->evidence)) {
        return argus_to_nothing();
    }
    return mine->active ? argus_to_turn(argus_inquiry_heading_cdeg(mine)) : argus_to(ARGUS_DO_LOOKED);
}

argus_intent_t argus_run_verifying(const argus_t *const self, argus_verifying_t *const mine) {
    ARGUS_ASSERT(self->verifying.verify.phase <= ARGUS_VERIFY_DONE);
    return argus_rules(self)->evidence ? look(self, &mine->inquiry) : verify(self, &mine->verify);
}

argus_intent_t argus_run_idle(const argus_t *const self) {
    if (!self->motion.settled && self->motion.kind == ARGUS_MOTION_NONE) {
        return (argus_intent_t){.act = ARGUS_DO_HOLD, .more = true};
    }
    return argus_to(ARGUS_DO_CHECK_BESIDE);
}

// A bumper: E_STALL may have cut the motors; then back off, or wait for the way behind to clear.
static argus_intent_t leave_bumper(const argus_t *const self) {
    const argus_guard_t guard = argus_guard(self);
    const bool motors = (self->knowledge.flags & ARCOS_FLAG_MOTORS) != 0;
    const bool button = (self->knowledge.flags & ARCOS_FLAG_ESTOP) != 0;
    if (self->orders.paused) {
        return argus_to_nothing(); // an operator has the robot
    }
    if (!motors && !button) {
        return argus_to(ARGUS_DO_ENABLE);
    }
    if (motors && guard.bumpers == 0 && !argus_guard_may_back(&guard)) {
        return argus_to_check(true); // freed, or a stall: no need to back away
    }
    if (motors && self->knowledge.bumpers_rear == 0 && argus_at_rest(&self->knowledge)) {
        return (argus_intent_t){
            .act = ARGUS_DO_BACK, .mm = self->config.backoff_mm, .speed_mm_s = self->config.step_speed_mm_s};
    }
    return argus_to_nothing();
}

// Passive, it moves for nothing: a person has to free it.
static argus_intent_t leave_touch(const argus_t *const self) {
    if (!self->orders.passive) {
        return leave_bumper(self);
    }
    return self->reflexes.bumpers == 0 ? argus_to_check(true) : argus_to_nothing();
}

static argus_intent_t leave_waiting(const argus_t *const self, const argus_wait_t why) {
    ARGUS_ASSERT((unsigned)why <= ARGUS_WAIT_ECHO);
    const argus_guard_t guard = argus_guard(self);
    argus_intent_t intent = argus_to_check(true);
    switch (why) {
    case ARGUS_WAIT_BUMPER:
        return leave_touch(self);
    case ARGUS_WAIT_MOTORS:
        return self->reflexes.motors_said ? argus_to_nothing() : intent;
    case ARGUS_WAIT_TURN:
    case ARGUS_WAIT_WAY:
        intent.way = ARGUS_WAY_FORGIVE;
        return intent;
    case ARGUS_WAIT_ECHO:
        return argus_guard_is_heard(&guard) ? intent : argus_to_nothing();
    case ARGUS_WAIT_NONE:
    case ARGUS_WAIT_CATASTROPHIC:
    default:
        return argus_to_nothing();
    }
}

argus_intent_t argus_run_waiting(const argus_t *const self, argus_waiting_t *const mine) {
    const uint32_t pause_ms = mine->why == ARGUS_WAIT_BUMPER ? RETRY_MS / 2 : RETRY_MS * 3;
    if (self->now_ms - mine->tried_ms < pause_ms) {
        return argus_to_nothing();
    }
    mine->tried_ms = self->now_ms;
    return leave_waiting(self, mine->why);
}

argus_intent_t argus_go_on_waiting(const argus_t *const self, argus_waiting_t *const mine) {
    const uint32_t waited_s = (self->now_ms - mine->since_ms) / 1000u;
    if (self->mode != ARGUS_MODE_WAITING || waited_s < mine->said_s + SAY_EVERY_S) {
        return argus_to_nothing();
    }
    mine->said_s = waited_s;
    return (argus_intent_t){.event = mine->why == ARGUS_WAIT_WAY ? ARGUS_EV_NO_WAY : ARGUS_EV_WAITING,
                            .sonar = ARGUS_NO_SONAR,
                            .value = (int32_t)waited_s};
}

argus_intent_t argus_run_backing(const argus_t *const self) {
    const argus_guard_t guard = argus_guard(self);
    if (!self->motion.settled) {
        const bool watched = guard.creeps || argus_guard_rear_is_watched(&guard);
        return (argus_intent_t){.stop = watched ? ARGUS_STOP_NONE : ARGUS_STOP_HALT};
    }
    argus_intent_t intent = argus_to_check(argus_rules(self)->disparity);
    intent.base = ARGUS_BASE_DROP;
    intent.all_round = argus_rules(self)->evidence;
    if (guard.bumpers != 0) {
        intent.act = ARGUS_DO_WAIT;
        intent.why = ARGUS_WAIT_BUMPER;
    }
    return intent;
}
