// SPDX-License-Identifier: MIT
// The modes: entering them, what follows the end of each, idling and waiting (paper: Fig. 2).
#include "knowledge/angle.h"
#include "supervisor/manager_internal.h"

#define RETRY_MS 1000u
#define SAY_EVERY_S 10u

void argus_enter(argus_t *const self, const argus_mode_t mode) {
    self->mode = mode;
    self->since_ms = self->now_ms;
    if (mode != ARGUS_MODE_WAITING) {
        self->wait = ARGUS_WAIT_NONE;
    }
    if (mode != ARGUS_MODE_VERIFYING) {
        argus_verify_init(&self->verify);
        argus_inquiry_init(&self->inquiry);
    }
}

// Waiting for the same thing again without having driven in between counts on.
void argus_enter_waiting(argus_t *const self, const argus_wait_t why) {
    if (self->wait_last != why) {
        self->wait_last = why;
        self->wait_since_ms = self->now_ms;
        self->waited_s = 0;
        argus_say(self, why == ARGUS_WAIT_WAY ? ARGUS_EV_NO_WAY : ARGUS_EV_WAITING, ARGUS_NO_SONAR, 0);
    }
    self->wait = why;
    self->tried_ms = self->now_ms;
    argus_enter(self, ARGUS_MODE_WAITING);
}

// Whatever is under way must not go on beside a check.
static void come_to_rest(argus_t *const self) {
    const bool under_way = self->motion.kind == ARGUS_MOTION_MOVE || self->motion.kind == ARGUS_MOTION_TURN;
    if (self->motion.settled) {
        return;
    }
    if (under_way && !self->motion.failed) {
        argus_stop(self, ARCOS_CMD_STOP);
    } else if (self->motion.kind != ARGUS_MOTION_STOP || self->motion.failed) {
        argus_motion_hold(&self->motion, self->now_ms);
    }
}

// At rest on the base heading; `full`: as many rounds of readings as Algorithm 1 wants for a suspect.
void argus_enter_checking(argus_t *const self, const bool full) {
    if (self->mode == ARGUS_MODE_CLOSING || self->mode == ARGUS_MODE_CLOSED) {
        return;
    }
    self->rounds = full || !self->checked ? (uint8_t)self->config.suspect_readings : 1;
    self->arriving = false;
    self->marked = false;
    self->all_round = false;
    come_to_rest(self);
    argus_enter(self, ARGUS_MODE_CHECKING);
}

void argus_enter_verifying(argus_t *const self, const argus_mask_t suspects) {
    argus_flag_suspects(self, suspects);
    argus_halt(self);
    if (!self->motion.settled && self->motion.kind != ARGUS_MOTION_STOP) {
        argus_motion_hold(&self->motion, self->now_ms);
    }
    argus_enter(self, ARGUS_MODE_VERIFYING);
}

static void enter_travel(argus_t *const self) {
    self->aimed = false;
    self->has_base = false;
    self->arriving = false;
    argus_enter(self, self->plan.disabled == 0 ? ARGUS_MODE_DRIVING : ARGUS_MODE_SWEEPING);
    self->drive.done = false;
    self->drive.base_cdeg = 0;
}

static void fail_mission(argus_t *const self) {
    if (self->mission == ARGUS_MISSION_RUNNING) {
        self->mission = ARGUS_MISSION_FAILED;
        argus_say(self, ARGUS_EV_MISSION_FAILED, ARGUS_NO_SONAR,
                  argus_task_goal_mm(&self->task, &self->knowledge));
    }
}

void argus_decide(argus_t *const self) {
    const bool jogging = self->jog_mm > 0;
    const bool wants = jogging || (self->mission == ARGUS_MISSION_RUNNING && !self->paused);
    if (self->passive || !wants) {
        self->has_base = false;
        self->swing_again = false;
        self->wait_last = ARGUS_WAIT_NONE;
        argus_enter(self, ARGUS_MODE_IDLE);
    } else if (self->plan.disabled != 0 &&
               !self->plan.complete) { // all six are out, or suspects that no one can judge
        fail_mission(self);
        argus_enter_waiting(self, ARGUS_WAIT_CATASTROPHIC);
    } else if (self->bumpers != 0) {
        argus_enter_waiting(self, ARGUS_WAIT_BUMPER);
    } else if (!argus_may_translate(self)) {
        argus_enter_waiting(self, ARGUS_WAIT_MOTORS);
    } else {
        enter_travel(self);
    }
}

static void run_idle(argus_t *const self) {
    if (!self->motion.settled && self->motion.kind == ARGUS_MOTION_NONE) {
        argus_motion_hold(&self->motion, self->now_ms);
    }
    argus_health_check(self);
}

// A bumper: E_STALL may have cut the motors; then back off, or wait for the way behind to clear.
static void leave_bumper(argus_t *const self) {
    const bool motors = (self->knowledge.flags & ARCOS_FLAG_MOTORS) != 0;
    const bool button = (self->knowledge.flags & ARCOS_FLAG_ESTOP) != 0;
    if (self->paused) {
        return; // an operator has the robot
    }
    if (!motors && !button) {
        argus_outbox_int(&self->session.outbox, ARCOS_CMD_ENABLE, 1);
    } else if (motors && self->bumpers == 0 && !argus_rear_is_clear(self)) {
        argus_enter_checking(self, true); // freed, or a stall: no need to back away
    } else if (motors && self->knowledge.bumpers_rear == 0 && argus_at_rest(&self->knowledge)) {
        argus_back_off(self, self->config.backoff_mm);
    }
}

static void leave_waiting(argus_t *const self) {
    switch (self->wait) {
    case ARGUS_WAIT_BUMPER:
        if (!self->passive) {
            leave_bumper(self);
        } else if (self->bumpers == 0) {
            argus_enter_checking(self, true);
        }
        break;
    case ARGUS_WAIT_MOTORS:
        if (!self->motors_said) {
            argus_enter_checking(self, true);
        }
        break;
    case ARGUS_WAIT_TURN:
    case ARGUS_WAIT_WAY:
        argus_task_forgive(&self->task, &self->knowledge);
        argus_enter_checking(self, true);
        break;
    case ARGUS_WAIT_NONE:
    case ARGUS_WAIT_CATASTROPHIC:
    default:
        break;
    }
}

static void run_waiting(argus_t *const self) {
    const uint32_t pause_ms = self->wait == ARGUS_WAIT_BUMPER ? RETRY_MS / 2 : RETRY_MS * 3;
    if (self->now_ms - self->tried_ms >= pause_ms) {
        self->tried_ms = self->now_ms;
        leave_waiting(self);
    }
}

void argus_wait_process(argus_t *const self) {
    const uint32_t waited_s = (self->now_ms - self->wait_since_ms) / 1000u;
    if (self->mode != ARGUS_MODE_WAITING || waited_s < self->waited_s + SAY_EVERY_S) {
        return;
    }
    self->waited_s = waited_s;
    argus_say(self, self->wait == ARGUS_WAIT_WAY ? ARGUS_EV_NO_WAY : ARGUS_EV_WAITING, ARGUS_NO_SONAR,
              (int32_t)waited_s);
}

static bool run_travel(argus_t *const self) {
    switch ((int)self->mode) {
    case ARGUS_MODE_DRIVING:
        argus_run_driving(self);
        return true;
    case ARGUS_MODE_SWEEPING:
        argus_run_sweeping(self);
        return true;
    case ARGUS_MODE_STEPPING:
        argus_run_stepping(self);
        return true;
    case ARGUS_MODE_BACKING:
        argus_run_backing(self);
        return true;
    default:
        return false;
    }
}

static void run_rest(argus_t *const self) {
    switch ((int)self->mode) {
    case ARGUS_MODE_CHECKING:
        argus_run_checking(self);
        break;
    case ARGUS_MODE_VERIFYING:
        argus_run_verifying(self);
        break;
    case ARGUS_MODE_IDLE:
        run_idle(self);
        break;
    case ARGUS_MODE_WAITING:
        run_waiting(self);
        break;
    default:
        break; // no session, or leaving it
    }
}

void argus_run_mode(argus_t *const self) {
    if (!run_travel(self)) {
        run_rest(self);
    }
}
