// SPDX-License-Identifier: MIT
// Checks, verifies, idles, waits and backs away: one SIP of each mode.
#include "behaviour/resting.h"

#include "behaviour/state.h"
#include "knowledge/angle.h"

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

void argus_run_checking(const argus_t *const self, argus_checking_t *const mine,
                        argus_intent_t *const intent) {
    if (!argus_is_home(self, has_round(self, mine), intent)) {
        mine->marked = false;
        return;
    }
    if (!mine->marked) {
        mine->marked = true;
        mine->mark = self->orders.passive ? argus_mark_now(&self->knowledge) : self->motion.mark;
    }
    if (!has_round(self, mine)) {
        return;
    }
    mine->mark = argus_mark_now(&self->knowledge);
    mine->mark.from_ms =
        self->now_ms + ARGUS_REFRESH_MS; // counts only where a server lists every sonar in every SIP
    if (mine->rounds > 1) {
        mine->rounds--;
        return;
    }
    intent->act = ARGUS_DO_CONCLUDE;
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

static void begin_verification(const argus_t *const self, argus_verify_t *const mine,
                               argus_intent_t *const intent) {
    argus_verify_init(mine);
    if (!argus_is_home(self, true, intent)) {
        return;
    }
    const int sonar = next_suspect(self);
    if (sonar < 0) {
        intent->act = ARGUS_DO_CHECK;
        return;
    }
    argus_verify_begin(mine, self->knowledge.robot, sonar, argus_base_cdeg(self));
    argus_to_say(intent, ARGUS_EV_SONAR_VERIFYING, sonar, self->knowledge.sonar[sonar].reading_mm);
}

// Algorithm 2.
static void verify(const argus_t *const self, argus_verify_t *const mine, argus_intent_t *const intent) {
    if (mine->phase == ARGUS_VERIFY_IDLE || mine->phase == ARGUS_VERIFY_DONE) {
        begin_verification(self, mine, intent);
    } else if (self->motion.failed) {
        argus_to_check(intent, false);
    } else if (!self->motion.settled || !argus_verify_step(mine, &self->knowledge, &self->motion.mark)) {
        return;
    } else if (mine->phase == ARGUS_VERIFY_DONE) {
        intent->act = ARGUS_DO_VERDICT;
    } else {
        argus_to_turn(intent, argus_verify_heading_cdeg(mine));
    }
}

static void begin_looks(const argus_t *const self, argus_inquiry_t *const mine,
                        argus_intent_t *const intent) {
    const argus_mask_t suspects = argus_open_suspects(self);
    intent->base = ARGUS_BASE_TAKE;
    intent->act = ARGUS_DO_LOOK;
    intent->sonars = suspects;
    if (suspects != 0 && (suspects & argus_robot_forward(self->knowledge.robot)) == 0 &&
        argus_is_hemmed_in(self)) {
        intent->act = ARGUS_DO_LEAVE_OPEN; // no look is to be had, and none of them looks ahead
        return;
    }
    argus_inquiry_begin(mine, &self->knowledge, &self->evidence, suspects, argus_base_cdeg(self));
    intent->cdeg = argus_inquiry_heading_cdeg(mine);
}

static void look(const argus_t *const self, argus_inquiry_t *const mine, argus_intent_t *const intent) {
    if (self->motion.failed) {
        argus_inquiry_init(mine);
        argus_turn_failed(self, intent);
        return;
    }
    if (!self->motion.settled) {
        return;
    }
    if (!mine->active) {
        begin_looks(self, mine, intent);
        return;
    }
    mine->watched &= (argus_mask_t) ~(unsigned)argus_out(&self->knowledge);
    if (!argus_inquiry_step(mine, &self->knowledge, &self->evidence)) {
        return;
    }
    if (mine->active) {
        argus_to_turn(intent, argus_inquiry_heading_cdeg(mine));
    } else {
        intent->act = ARGUS_DO_LOOKED;
    }
}

void argus_run_verifying(const argus_t *const self, argus_verifying_t *const mine,
                         argus_intent_t *const intent) {
    ARGUS_ASSERT(self->verifying.verify.phase <= ARGUS_VERIFY_DONE);
    if (argus_rules(self)->evidence) {
        look(self, &mine->inquiry, intent);
    } else {
        verify(self, &mine->verify, intent);
    }
}

void argus_run_idle(const argus_t *const self, argus_intent_t *const intent) {
    intent->more = !self->motion.settled && self->motion.kind == ARGUS_MOTION_NONE;
    intent->act = intent->more ? ARGUS_DO_HOLD : ARGUS_DO_CHECK_BESIDE;
}

// A bumper: E_STALL may have cut the motors; then back off, or wait for the way behind to clear.
static void leave_bumper(const argus_t *const self, argus_intent_t *const intent) {
    const argus_guard_t guard = argus_guard(self);
    const bool motors = (self->knowledge.flags & ARCOS_FLAG_MOTORS) != 0;
    const bool button = (self->knowledge.flags & ARCOS_FLAG_ESTOP) != 0;
    if (self->orders.paused) {
        return; // an operator has the robot
    }
    if (!motors && !button) {
        intent->act = ARGUS_DO_ENABLE;
    } else if (motors && guard.bumpers == 0 && !argus_guard_may_back(&guard)) {
        argus_to_check(intent, true); // freed, or a stall: no need to back away
    } else if (motors && self->knowledge.bumpers_rear == 0 && argus_at_rest(&self->knowledge)) {
        intent->act = ARGUS_DO_BACK;
        intent->mm = self->config.backoff_mm;
        intent->speed_mm_s = self->config.step_speed_mm_s;
    }
}

// Passive, it moves for nothing: a person has to free it.
static void leave_touch(const argus_t *const self, argus_intent_t *const intent) {
    if (!self->orders.passive) {
        leave_bumper(self, intent);
    } else if (self->reflexes.bumpers == 0) {
        argus_to_check(intent, true);
    }
}

static void leave_waiting(const argus_t *const self, const argus_wait_t why, argus_intent_t *const intent) {
    ARGUS_ASSERT((unsigned)why <= ARGUS_WAIT_ECHO);
    const argus_guard_t guard = argus_guard(self);
    switch (why) {
    case ARGUS_WAIT_BUMPER:
        leave_touch(self, intent);
        break;
    case ARGUS_WAIT_MOTORS:
        if (!self->reflexes.motors_said) {
            argus_to_check(intent, true);
        }
        break;
    case ARGUS_WAIT_TURN:
    case ARGUS_WAIT_WAY:
        argus_to_check(intent, true);
        intent->way = ARGUS_WAY_FORGIVE;
        break;
    case ARGUS_WAIT_ECHO:
        if (argus_guard_is_heard(&guard)) {
            argus_to_check(intent, true);
        }
        break;
    case ARGUS_WAIT_NONE:
    case ARGUS_WAIT_CATASTROPHIC:
    default:
        break;
    }
}

void argus_run_waiting(const argus_t *const self, argus_waiting_t *const mine, argus_intent_t *const intent) {
    const uint32_t pause_ms = mine->why == ARGUS_WAIT_BUMPER ? RETRY_MS / 2 : RETRY_MS * 3;
    if (self->now_ms - mine->tried_ms < pause_ms) {
        return;
    }
    mine->tried_ms = self->now_ms;
    leave_waiting(self, mine->why, intent);
}

void argus_go_on_waiting(const argus_t *const self, argus_waiting_t *const mine,
                         argus_intent_t *const intent) {
    const uint32_t waited_s = (self->now_ms - mine->since_ms) / 1000u;
    if (self->mode != ARGUS_MODE_WAITING || waited_s < mine->said_s + SAY_EVERY_S) {
        return;
    }
    mine->said_s = waited_s;
    argus_to_say(intent, mine->why == ARGUS_WAIT_WAY ? ARGUS_EV_NO_WAY : ARGUS_EV_WAITING, ARGUS_NO_SONAR,
                 (int32_t)waited_s);
}

void argus_run_backing(const argus_t *const self, argus_intent_t *const intent) {
    const argus_guard_t guard = argus_guard(self);
    if (!self->motion.settled) {
        const bool watched = guard.creeps || argus_guard_rear_is_watched(&guard);
        intent->stop = watched ? ARGUS_STOP_NONE : ARGUS_STOP_HALT;
        return;
    }
    argus_to_check(intent, argus_rules(self)->disparity);
    intent->base = ARGUS_BASE_DROP;
    intent->all_round = argus_rules(self)->evidence;
    if (guard.bumpers != 0) {
        argus_to_wait(intent, ARGUS_WAIT_BUMPER);
    }
}
