// SPDX-License-Identifier: MIT
// Turns the orders of an operator into settings and intents.
#include "supervisor/orders.h"

#include "knowledge/angle.h"
#include "supervisor/body.h"
#include "supervisor/faults.h"
#include "supervisor/journey.h"
#include "supervisor/looks.h"
#include "supervisor/modes.h"
#include "supervisor/motions.h"
#include "supervisor/say.h"
#include "supervisor/state.h"

static argus_act_t check_if_open(const argus_t *const self) {
    return argus_is_open(self) ? ARGUS_DO_CHECK : ARGUS_DO_NOTHING;
}

static void check(argus_t *const self, const bool full) {
    argus_stop_and_do(self, ARGUS_STOP_NONE, check_if_open(self), full);
}

static void stop_and_check(argus_t *const self, const bool full) {
    argus_stop_and_do(self, ARGUS_STOP_STOP, check_if_open(self), full);
}

static void enable_motors(argus_t *const self) {
    if (!self->orders.passive && argus_is_open(self)) {
        argus_enable_motors(self);
    }
}

// The whole robot ------------------------------------------------------------------------------------------

static void pause(argus_t *const self) {
    self->orders.paused = true;
    self->orders.stay = ARGUS_STAY_OPERATOR;
    argus_base_drop(&self->base);
    argus_journey_jog(&self->travel, 0);
    stop_and_check(self, false);
}

static void resume(argus_t *const self) {
    self->orders.paused = false;
    enable_motors(self);
    argus_journey_restart(&self->travel);
    if (self->mission == ARGUS_MISSION_FAILED) {
        self->mission = ARGUS_MISSION_RUNNING;
    }
    check(self, true);
}

static void recheck(argus_t *const self) {
    if (argus_is_open(self)) {
        argus_algorithm1_init(&self->algorithm1);
        stop_and_check(self, true);
    }
}

static void go_passive(argus_t *const self) {
    argus_stop_and_do(self, ARGUS_STOP_STOP, ARGUS_DO_NOTHING, false);
    self->orders.passive = true;
    self->orders.barred = false;
    argus_tell(self, ARGUS_EV_PASSIVE, 0);
    check(self, false);
}

static void go_active(argus_t *const self) {
    if (self->orders.locked || argus_say_barred(self)) {
        return;
    }
    self->orders.passive = false;
    if (self->orders.unbegun && self->mission == ARGUS_MISSION_FAILED) {
        self->mission = ARGUS_MISSION_RUNNING;
    }
    self->orders.unbegun = false;
    self->reflexes.motors_said = false;
    self->reflexes.active_ms = self->now_ms;
    argus_tell(self, ARGUS_EV_ACTIVE, 0);
    enable_motors(self);
    if (self->plan.disabled != 0 || self->ordered) { // the plan may have gone while nothing was commanded
        argus_share_slots(self);
    }
    check(self, true);
}

// Ahead for the operator is where the robot is built to drive.
static void jog(argus_t *const self, const int32_t built_mm) {
    const int32_t distance_mm = self->knowledge.robot->reversed ? -argus_max(built_mm, -INT32_MAX) : built_mm;
    const argus_guard_t guard = argus_guard(self);
    if (!argus_guard_may_translate(&guard) || distance_mm == 0) {
        return;
    }
    if (argus_open_suspects(self) != 0) { // S6: verified first
        argus_journey_jog(&self->travel, argus_between(0, self->config.step_mm, distance_mm));
        check(self, true);
        return;
    }
    if (distance_mm < 0) {
        argus_do(self, &(argus_intent_t){.act = ARGUS_DO_BACK,
                                         .mm = -argus_max(distance_mm, -self->config.backoff_mm),
                                         .speed_mm_s = self->config.step_speed_mm_s});
        return;
    }
    argus_journey_jog(&self->travel, argus_min(distance_mm, self->config.step_mm));
    argus_stop_and_do(self, ARGUS_STOP_NONE, ARGUS_DO_DECIDE, false);
}

// The check that follows turns to the base heading first.
static void jog_turn(argus_t *const self, const int32_t degrees) {
    argus_base_renew(&self->base, argus_angle_wrap(self->knowledge.pose.heading_cdeg + degrees % 360 * 100));
    argus_algorithm1_moved(&self->algorithm1, 0);
    argus_stop_and_do(self, ARGUS_STOP_NONE, ARGUS_DO_CHECK, false);
}

// Another order lets the manager move again. A client stays held until it is let go, or the manager drives.
static uint8_t stay_after(const uint8_t stay, const argus_op_t op) {
    const bool held = (stay & (ARGUS_STAY_OPERATOR | ARGUS_STAY_HELD)) != 0;
    return held && op != ARGUS_OP_GO && op != ARGUS_OP_ACTIVE ? ARGUS_STAY_HELD : 0;
}

static void obey_for_all(argus_t *const self, const argus_op_t op, const int32_t argument) {
    self->orders.stay = stay_after(self->orders.stay, op);
    switch (op) {
    case ARGUS_OP_STOP:
        pause(self);
        break;
    case ARGUS_OP_GO:
        resume(self);
        break;
    case ARGUS_OP_RECHECK:
        recheck(self);
        break;
    case ARGUS_OP_MOVE:
        jog(self, argument);
        break;
    case ARGUS_OP_TURN:
        jog_turn(self, argument);
        break;
    case ARGUS_OP_PASSIVE:
        go_passive(self);
        break;
    case ARGUS_OP_ACTIVE:
        go_active(self);
        break;
    default:
        break;
    }
}

// One sonar ------------------------------------------------------------------------------------------------

// One in use becomes a suspect that the next health check looks at. One that is out begins its probation
// anew, its relapses forgiven, since nothing but evidence brings it back.
static void begin_retest(argus_t *const self, const int sonar) {
    ARGUS_ASSERT(argus_rules(self)->evidence && (self->orders.pinned >> sonar & 1u) == 0);
    const argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    const argus_mask_t bit = (argus_mask_t)(1u << sonar);
    argus_evidence_forget(&self->evidence, sonar);
    argus_extremes_forget(&self->extremes, sonar);
    argus_health_forgive(&self->knowledge, sonar);
    argus_looks_ask(&self->looks, sonar);
    argus_algorithm1_reopen(&self->algorithm1, bit);
    if (argus_is_out(&self->knowledge, sonar)) {
        argus_say_change(self, sonar, ARGUS_CHANGE_RETESTED, s->kind, s->reading_mm);
    } else {
        argus_flag_suspects(self, bit);
    }
}

static bool may_serve(const argus_t *const self, const argus_op_t op, const int32_t sonar) {
    if (sonar < 0 || sonar >= self->knowledge.sonars || op > ARGUS_OP_DISABLE) {
        return false;
    }
    const bool pinned = (self->orders.pinned >> sonar & 1u) != 0;
    if (op == ARGUS_OP_RETEST) {
        return argus_is_open(self) && !pinned;
    }
    return argus_rules(self)->evidence && pinned == (op == ARGUS_OP_UNPIN);
}

static void retest(argus_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    self->orders.stay = stay_after(self->orders.stay, ARGUS_OP_RETEST); // the others order no motion
    if (argus_rules(self)->evidence) {
        begin_retest(self, sonar);
    } else {
        argus_algorithm1_init(&self->algorithm1);
    }
    stop_and_check(self, true);
}

static void pin(argus_t *const self, const int sonar, const bool on) {
    ARGUS_ASSERT(sonar >= 0 && sonar < self->knowledge.sonars);
    const unsigned bit = 1u << sonar;
    self->orders.pinned = (argus_mask_t)(on ? self->orders.pinned | bit : self->orders.pinned & ~bit);
    argus_say(self, ARGUS_EV_SONAR_PINNED, sonar, on ? 1 : 0);
}

static void take_out(argus_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    if (self->knowledge.sonar[sonar].health != ARGUS_DISABLED) {
        argus_disable(self, sonar, ARGUS_KIND_WRONG);
    }
    pin(self, sonar, true);
    check(self, false);
}

static void obey_for_one(argus_t *const self, const argus_op_t op, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    if (op == ARGUS_OP_RETEST) {
        retest(self, sonar);
    } else if (op == ARGUS_OP_DISABLE) {
        take_out(self, sonar);
    } else {
        pin(self, sonar, op == ARGUS_OP_PIN);
    }
}

static bool may_jog(const argus_t *const self) {
    return self->mode == ARGUS_MODE_IDLE && !self->orders.passive;
}

bool argus_obey(argus_t *const self, const argus_op_t op, const int32_t argument) {
    const bool for_one = op >= ARGUS_OP_RETEST;
    const bool jogs = op == ARGUS_OP_MOVE || op == ARGUS_OP_TURN;
    if (self->orders.shutdown || (for_one && !may_serve(self, op, argument)) || (jogs && !may_jog(self))) {
        return false;
    }
    argus_tell(self, ARGUS_EV_OPERATOR, (int32_t)op);
    if (for_one) {
        obey_for_one(self, op, argument);
    } else {
        obey_for_all(self, op, argument);
    }
    return true;
}

void argus_yield_to_client(argus_t *const self) {
    const uint8_t stay = self->orders.stay & (ARGUS_STAY_OPERATOR | ARGUS_STAY_HELD);
    argus_obey(self, ARGUS_OP_PASSIVE, 0);
    self->orders.stay = stay;
}

void argus_stop_for_client(argus_t *const self) {
    const uint8_t stay = self->orders.stay;
    argus_obey(self, ARGUS_OP_STOP, 0);
    self->orders.stay = stay | ARGUS_STAY_CLIENT;
}
