// SPDX-License-Identifier: MIT
// Turns the body in thought, and asks what it would meet.
#include "adjustment/swing.h"

#include "knowledge/angle.h"

#define ROOM_MM 25    // a turning body keeps from what is seen
#define NEARER_MM 3   // ... than it is already: readings scatter
#define PART_CDEG 800 // the body is asked at each such part of a turn

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
        const int32_t bearing = pose.heading_deg * 100 + argus_robot_cone_deg(robot, sonar) * 50 * k;
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

static bool meets_memory(const argus_knowledge_t *const knowledge, const argus_echoes_t *const echoes,
                         const int32_t by_cdeg) {
    const argus_view_t from = argus_view(knowledge);
    for (int i = 0; i < echoes->count; i++) {
        argus_point_t at;
        if (argus_echoes_stands(echoes, &from, i, &at) && is_met(knowledge->robot, at, by_cdeg)) {
            return true;
        }
    }
    return false;
}

static bool meets_touched(const argus_knowledge_t *const knowledge, const argus_echoes_t *const echoes,
                          const int32_t by_cdeg) {
    const argus_touches_t *const touches = &echoes->touches;
    for (int i = 0; i < touches->count; i++) {
        if (is_met(knowledge->robot, argus_touches_seen(touches, knowledge, i), by_cdeg)) {
            return true;
        }
    }
    return false;
}

bool argus_swing_meets(const argus_knowledge_t *const knowledge, const argus_echoes_t *const echoes,
                       const int32_t by_cdeg) {
    return meets_echo(knowledge, by_cdeg) || (echoes != NULL && (meets_memory(knowledge, echoes, by_cdeg) ||
                                                                 meets_touched(knowledge, echoes, by_cdeg)));
}
