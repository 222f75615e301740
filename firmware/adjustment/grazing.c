// SPDX-License-Identifier: MIT
// Smooth walls, which turn echoes away.
#include "adjustment/grazing.h"

#include <stddef.h>

#include "awareness/numbers.h"
#include "knowledge/angle.h"

#define WAY_MM 80 // two readings show a slant when they were made so far apart
#define LOOKED_BACK 9
#define FALL_MM 12   // ... and differ by more than noise
#define UNEVEN_MM 18 // from the line of the two another one differs so much by noise
#define APART_MM 20
#define REFRESH_MM 64 // of the stopping way: from one reading to the next, where all sonars take turns

// Where its corner would touch, the body goes beyond the sonar's face by these.
static int32_t beyond_mm(const argus_robot_t *const robot, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return argus_robot_half_width_mm(robot) - argus_abs(argus_robot_pose(robot, sonar).y_mm);
}

static int32_t ahead_mm(const argus_robot_t *const robot, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return robot->front_mm - argus_robot_pose(robot, sonar).x_mm;
}

// The way of the robot ahead from one reading of a sonar that looks abeam to a later one.
static int32_t way_mm(const argus_robot_t *const robot, const int sonar, const argus_ping_t *const now,
                      const argus_ping_t *const then) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_ping_t along = *now;
    along.bearing_cdeg =
        (int16_t)argus_angle_wrap(now->bearing_cdeg - argus_robot_pose(robot, sonar).heading_deg * 100);
    return argus_ping_shift(&along, then).along_mm;
}

// The latest ping on this bearing from far enough back that shows a fall; NULL: none.
static const argus_ping_t *slant_since(const argus_robot_t *const robot, const int sonar,
                                       const argus_pings_t *const pings, const argus_ping_t *const now) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    for (int i = 2; i <= LOOKED_BACK; i++) {
        const argus_ping_t *const then = argus_pings_at(pings, i);
        if (then == NULL || argus_ping_turned_cdeg(now, then) > ARGUS_SAME_CDEG) {
            return NULL;
        }
        if (then->reading_mm <= ARGUS_FLANK_NEAR_MM && then->reading_mm - now->reading_mm >= FALL_MM &&
            way_mm(robot, sonar, now, then) >= WAY_MM) {
            return then;
        }
    }
    return NULL;
}

static const argus_ping_t *echo_before(const argus_pings_t *const pings) {
    const argus_ping_t *const before = argus_pings_at(pings, 2);
    return argus_ping_is_echo(before) ? before : argus_pings_at(pings, 3);
}

bool argus_grazing_wall(const argus_pings_t *const pings, const argus_robot_t *const robot, const int sonar,
                        const int32_t stop_mm) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_ping_t *const now = argus_pings_at(pings, 1);
    const argus_ping_t *const then = now != NULL ? slant_since(robot, sonar, pings, now) : NULL;
    const argus_ping_t *const before = then != NULL ? echo_before(pings) : NULL;
    if (before == NULL) {
        return false;
    }
    const int32_t fall = then->reading_mm - now->reading_mm;
    const int32_t way = way_mm(robot, sonar, now, then);
    const int32_t step = way_mm(robot, sonar, now, before);
    const bool in_line = argus_abs(before->reading_mm - now->reading_mm - fall * step / way) <= UNEVEN_MM;
    const int32_t left_mm = ahead_mm(robot, sonar) + stop_mm + argus_max(0, step - REFRESH_MM);
    return in_line && now->reading_mm <= beyond_mm(robot, sonar) + left_mm * fall / way + APART_MM;
}
