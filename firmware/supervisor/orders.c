// SPDX-License-Identifier: MIT
// Turns the orders of an operator into settings and intents.
#include "supervisor/orders.h"

#include "behaviour/looks.h"
#include "behaviour/state.h"
#include "knowledge/angle.h"
#include "supervisor/body.h"
#include "supervisor/faults.h"
#include "supervisor/journey.h"
#include "supervisor/modes.h"
#include "supervisor/motions.h"

static void check(const argus_t *const self, const argus_stop_t stop, const bool full,
                  argus_intent_t *const intent) {
    intent->stop = (uint8_t)stop;
    intent->act = argus_is_open(self) ? ARGUS_DO_CHECK : ARGUS_DO_NOTHING;
    intent->full = full;
}

static void enable_motors(const argus_t *const self, argus_outbox_t *const out) {
    if (!self->orders.passive && argus_is_open(self)) {
        argus_enable_motors(self, out);
    }
}

// The whole robot ------------------------------------------------------------------------------------------

static void pause(argus_orders_t *const orders, argus_intent_t *const intent) {
    orders->paused = true;
    orders->stay = ARGUS_STAY_OPERATOR;
    intent->base = ARGUS_BASE_DROP;
}

static void resume(argus_t *const self) {
    self->orders.paused = false;
    enable_motors(self, &self->session.outbox);
    argus_journey_restart(&self->travel);
    if (self->mission == ARGUS_MISSION_FAILED) {
        self->mission = ARGUS_MISSION_RUNNING;
    }
}

static void go_passive(argus_orders_t *const orders, argus_events_t *const events) {
    orders->passive = true;
    orders->barred = false;
    argus_emit(events, ARGUS_EV_PASSIVE, 0);
}

static void go_active(argus_t *const self, argus_intent_t *const intent) {
    if (self->orders.locked || argus_find_bar(self, &self->orders, &self->events)) {
        return;
    }
    self->orders.passive = false;
    if (self->orders.unbegun && self->mission == ARGUS_MISSION_FAILED) {
        self->mission = ARGUS_MISSION_RUNNING;
    }
    self->orders.unbegun = false;
    self->reflexes.motors_said = false;
    self->reflexes.active_ms = self->now_ms;
    argus_emit(&self->events, ARGUS_EV_ACTIVE, 0);
    enable_motors(self, &self->session.outbox);
    if (self->plan.disabled != 0 || self->firing.ordered) { // the plan may have gone meanwhile
        argus_share_slots(self, &self->session.outbox, &self->firing);
    }
    check(self, ARGUS_STOP_NONE, true, intent);
}

// Ahead for the operator is where the robot is built to drive.
static void jog(const argus_t *const self, argus_travel_t *const travel, const int32_t built_mm,
                argus_intent_t *const intent) {
    const int32_t distance_mm = self->knowledge.robot->reversed ? -argus_max(built_mm, -INT32_MAX) : built_mm;
    const argus_guard_t guard = argus_guard(self);
    if (!argus_guard_may_translate(&guard) || distance_mm == 0) {
        return;
    }
    if (argus_open_suspects(self) != 0) { // S6: verified first
        argus_journey_jog(travel, argus_between(0, self->config.step_mm, distance_mm));
        check(self, ARGUS_STOP_NONE, true, intent);
    } else if (distance_mm < 0) {
        intent->act = ARGUS_DO_BACK;
        intent->mm = -argus_max(distance_mm, -self->config.backoff_mm);
        intent->speed_mm_s = self->config.step_speed_mm_s;
    } else {
        argus_journey_jog(travel, argus_min(distance_mm, self->config.step_mm));
        intent->act = ARGUS_DO_DECIDE;
    }
}

// The check that follows turns to the base heading first.
static void jog_turn(const argus_knowledge_t *const knowledge, argus_base_t *const base,
                     argus_algorithm1_t *const algorithm1, const int32_t degrees) {
    argus_base_renew(base, argus_angle_wrap(knowledge->pose.heading_cdeg + degrees % 360 * 100));
    argus_algorithm1_moved(algorithm1, 0);
}

// Another order lets the manager move again. A client stays held until it is let go, or the manager drives.
static uint8_t stay_after(const uint8_t stay, const argus_op_t op) {
    const bool held = (stay & (ARGUS_STAY_OPERATOR | ARGUS_STAY_HELD)) != 0;
    return held && op != ARGUS_OP_GO && op != ARGUS_OP_ACTIVE ? ARGUS_STAY_HELD : 0;
}

static void obey_for_all(argus_t *const self, const argus_op_t op, const int32_t argument,
                         argus_intent_t *const intent) {
    self->orders.stay = stay_after(self->orders.stay, op);
    switch (op) {
    case ARGUS_OP_STOP:
        pause(&self->orders, intent);
        check(self, ARGUS_STOP_STOP, false, intent);
        break;
    case ARGUS_OP_GO:
        resume(self);
        check(self, ARGUS_STOP_NONE, true, intent);
        break;
    case ARGUS_OP_RECHECK:
        if (argus_is_open(self)) {
            argus_algorithm1_init(&self->algorithm1);
            check(self, ARGUS_STOP_STOP, true, intent);
        }
        break;
    case ARGUS_OP_MOVE:
        jog(self, &self->travel, argument, intent);
        break;
    case ARGUS_OP_TURN:
        jog_turn(&self->knowledge, &self->base, &self->algorithm1, argument);
        intent->act = ARGUS_DO_CHECK;
        break;
    case ARGUS_OP_PASSIVE:
        argus_stop_and_do(self, ARGUS_STOP_STOP, ARGUS_DO_NOTHING, false);
        go_passive(&self->orders, &self->events);
        check(self, ARGUS_STOP_NONE, false, intent);
        break;
    case ARGUS_OP_ACTIVE:
        go_active(self, intent);
        break;
    default:
        break;
    }
}

// One sonar ------------------------------------------------------------------------------------------------

// One in use becomes a suspect that the next health check looks at. One that is out begins its probation
// anew, its relapses forgiven, since nothing but evidence brings it back.
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

// One in use becomes a suspect that the next health check looks at. One that is out begins its probation
// anew, its relapses forgiven, since nothing but evidence brings it back.
static void retest(argus_t *const self, const int sonar) {
    ARGUS_ASSERT((self->orders.pinned >> sonar & 1u) == 0);
    const argus_sonar_t *const s = &self->knowledge.sonar[sonar];
    const argus_mask_t bit = (argus_mask_t)(1u << sonar);
    if (!argus_rules(self)->evidence) {
        argus_algorithm1_init(&self->algorithm1);
        return;
    }
    argus_evidence_forget(&self->evidence, sonar);
    argus_extremes_forget(&self->extremes, sonar);
    argus_health_forgive(&self->knowledge, sonar);
    argus_looks_ask(&self->looks, sonar);
    argus_algorithm1_reopen(&self->algorithm1, bit);
    if (argus_is_out(&self->knowledge, sonar)) {
        argus_emit_change(&self->events, &self->knowledge, sonar, ARGUS_CHANGE_RETESTED, s->kind,
                          s->reading_mm);
    } else {
        argus_flag_suspects(self, &self->knowledge, &self->events, bit);
    }
}

static void pin(argus_orders_t *const orders, argus_events_t *const events, const int sonar, const bool on) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const unsigned bit = 1u << sonar;
    orders->pinned = (argus_mask_t)(on ? orders->pinned | bit : orders->pinned & ~bit);
    argus_emit_of(events, ARGUS_EV_SONAR_PINNED, sonar, on ? 1 : 0);
}

static void obey_for_one(argus_t *const self, const argus_op_t op, const int sonar,
                         argus_intent_t *const intent) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    if (op == ARGUS_OP_RETEST) {
        self->orders.stay = stay_after(self->orders.stay, op); // the others order no motion
        retest(self, sonar);
        check(self, ARGUS_STOP_STOP, true, intent);
        return;
    }
    if (op == ARGUS_OP_DISABLE) {
        if (self->knowledge.sonar[sonar].health != ARGUS_DISABLED) {
            argus_disable(self, sonar, ARGUS_KIND_WRONG);
        }
        check(self, ARGUS_STOP_NONE, false, intent);
    }
    pin(&self->orders, &self->events, sonar, op != ARGUS_OP_UNPIN);
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
    argus_emit(&self->events, ARGUS_EV_OPERATOR, (int32_t)op);
    argus_intent_t intent = {0};
    if (for_one) {
        obey_for_one(self, op, argument, &intent);
    } else {
        obey_for_all(self, op, argument, &intent);
    }
    argus_do(self, &intent);
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
