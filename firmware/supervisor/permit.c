// SPDX-License-Identifier: MIT
// Asks who may move: session, operator, body, bumpers, and what a turn would sweep.
#include "supervisor/permit.h"

#include "adjustment/guard.h"
#include "knowledge/angle.h"
#include "supervisor/state.h"

#define ROOM_MM 25    // a turning body keeps from what is seen
#define NEARER_MM 3   // ... than it is already: readings scatter
#define PART_CDEG 800 // the body is asked at each such part of a turn

// The body in a turn ---------------------------------------------------------------------------------------

// From the body, were it turned by so much, to a point in the robot's frame of now; negative within.
static int32_t gap_mm(const argus_robot_t *const robot, const argus_point_t at, const int32_t by_cdeg) {
    const argus_point_t turned = argus_in_frame(at, by_cdeg);
    const int32_t along_mm = argus_max(turned.x_mm - robot->front_mm, -robot->rear_mm - turned.x_mm);
    return argus_max(along_mm, argus_abs(turned.y_mm) - argus_robot_half_width_mm(robot));
}

// What is nearer than the room already may stay so near, not come nearer.
static bool is_met(const argus_robot_t *const robot, const argus_point_t at, const int32_t by_cdeg) {
    if (argus_hypot(at.x_mm, at.y_mm) > robot->swing_radius_mm + ROOM_MM) {
        return false;
    }
    const int32_t parts = argus_abs(by_cdeg) / PART_CDEG + 1;
    const int32_t least_mm = argus_min(ROOM_MM, gap_mm(robot, at, 0) - NEARER_MM);
    for (int32_t part = 1; part <= parts; part++) {
        if (gap_mm(robot, at, by_cdeg * part / parts) < least_mm) {
            return true;
        }
    }
    return false;
}

// An echo is anywhere in its cone.
static bool meets_cone(const argus_knowledge_t *const knowledge, const int sonar, const int32_t by_cdeg) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_robot_t *const robot = knowledge->robot;
    const argus_sonar_pose_t pose = argus_robot_pose(robot, sonar);
    const int32_t reading_mm = knowledge->sonar[sonar].reading_mm;
    for (int k = -1; k <= 1; k++) {
        const int32_t bearing = pose.heading_deg * 100 + robot->cone_deg * 50 * k;
        const argus_point_t at = {pose.x_mm + reading_mm * argus_cos(bearing) / ARGUS_TRIG_ONE,
                                  pose.y_mm + reading_mm * argus_sin(bearing) / ARGUS_TRIG_ONE};
        if (is_met(robot, at, by_cdeg)) {
            return true;
        }
    }
    return false;
}

static bool meets_echo(const argus_knowledge_t *const knowledge, const int32_t by_cdeg) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    for (int i = 0; i < knowledge->sonars; i++) {
        if (argus_usable(knowledge, i) && meets_cone(knowledge, i, by_cdeg)) {
            return true;
        }
    }
    return false;
}

static bool meets_memory(const argus_t *const self, const int32_t by_cdeg) {
    for (int i = 0; i < self->echoes.count; i++) {
        argus_point_t at;
        if (argus_echoes_near(&self->echoes, &self->knowledge, i, &at) &&
            is_met(self->knowledge.robot, at, by_cdeg)) {
            return true;
        }
    }
    return false;
}

static bool meets(const argus_t *const self, const int32_t by_cdeg) {
    return meets_echo(&self->knowledge, by_cdeg) ||
           (argus_rules(self)->remembers && meets_memory(self, by_cdeg));
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
