// SPDX-License-Identifier: MIT
// Asks who may move: session, operator, body, bumpers, and what a turn would sweep.
#include "behaviour/permit.h"

#include "adjustment/guard.h"
#include "adjustment/swing.h"
#include "behaviour/state.h"
#include "knowledge/angle.h"

static bool meets(const argus_t *const self, const int32_t by_cdeg) {
    return argus_swing_meets(&self->knowledge, argus_rules(self)->remembers ? &self->echoes : NULL, by_cdeg);
}

// A client's turn keeps its pivot, so the body itself is asked; the manager's has leave for the whole circle,
// or for a nudge.
static bool swings_free(const argus_t *const self, const argus_ask_t order) {
    if (order.mover == ARGUS_MOVER_MANAGER) {
        const argus_guard_t guard = argus_guard(self);
        return argus_guard_may_turn(&guard) || argus_guard_may_nudge(&guard, order.by_cdeg);
    }
    const bool either = argus_abs(order.by_cdeg) > ARGUS_TURN_EITHER_CDEG;
    const int32_t by_cdeg = argus_within(ARGUS_TURN_MOST_CDEG, order.by_cdeg);
    return !meets(self, by_cdeg) && !(either && meets(self, -by_cdeg));
}

// Who ------------------------------------------------------------------------------------------------------

static bool has_robot(const argus_t *const self, const argus_mover_t mover) {
    return self->orders.passive == (mover == ARGUS_MOVER_CLIENT);
}

// The motors of a session that opens stand at a speed of 0.
static bool is_stopped(const argus_t *const self, const argus_ask_t order) {
    if (order.mover == ARGUS_MOVER_CLIENT) {
        return self->orders.stay != 0;
    }
    return argus_is_stopped(self) && order.wants != ARGUS_WANTS_MOTORS;
}

static bool is_body_right(const argus_t *const self) {
    return argus_robot_is_known(self->knowledge.robot) && !self->orders.locked;
}

// Pressed where it would lead, in a turn anywhere; the manager first answers a contact, whichever end it is.
static bool is_pressed(const argus_t *const self, const argus_ask_t order) {
    const unsigned front = self->knowledge.bumpers_front;
    const unsigned rear = self->knowledge.bumpers_rear;
    const unsigned answered = order.mover == ARGUS_MOVER_MANAGER ? self->reflexes.bumpers : 0;
    switch (order.wants) {
    case ARGUS_WANTS_AHEAD:
        return (front | answered) != 0;
    case ARGUS_WANTS_BACK:
        return rear != 0;
    case ARGUS_WANTS_TURN:
        return (front | rear | answered) != 0;
    default:
        return false;
    }
}

// With a link that is too late only the motors may be switched.
static bool is_reached(const argus_t *const self, const argus_wants_t wants) {
    const bool late = self->latency.stands && wants != ARGUS_WANTS_MOTORS;
    return argus_is_open(self) && !self->stalled && !self->orders.shutdown && !late;
}

argus_permit_t argus_permit(const argus_t *const self, const argus_ask_t order) {
    if (!is_reached(self, order.wants)) {
        return ARGUS_PERMIT_NO_ROBOT;
    }
    if (is_stopped(self, order)) {
        return ARGUS_PERMIT_STOPPED;
    }
    if (!is_body_right(self)) {
        return ARGUS_PERMIT_BODY;
    }
    if (!has_robot(self, order.mover)) {
        return ARGUS_PERMIT_OTHER;
    }
    if (is_pressed(self, order)) {
        return ARGUS_PERMIT_BUMPER;
    }
    return order.wants == ARGUS_WANTS_TURN && !swings_free(self, order) ? ARGUS_PERMIT_SWING
                                                                        : ARGUS_PERMIT_GIVEN;
}
