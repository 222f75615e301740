// SPDX-License-Identifier: MIT
// Distances between the body and solids (body.py) in C: the same sums in the same order.
#include "body.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

double argus_sim_length(const double dx, const double dy) {
    return sqrt(dx * dx + dy * dy);
}

static segment_t to_body(const pose_t robot, const segment_t segment) {
    const double heading = robot.th * DEGREE;
    const double c = cos(heading), s = sin(heading);
    const double x1 = segment.x1 - robot.x, y1 = segment.y1 - robot.y;
    const double x2 = segment.x2 - robot.x, y2 = segment.y2 - robot.y;
    return (segment_t){x1 * c + y1 * s, y1 * c - x1 * s, x2 * c + y2 * s, y2 * c - x2 * s};
}

static bool meets(const body_t *const body, const segment_t segment) {
    const double dx = segment.x2 - segment.x1, dy = segment.y2 - segment.y1;
    const double step[] = {-dx, dx, -dy, dy};
    const double room[] = {segment.x1 + body->rear_mm, body->front_mm - segment.x1,
                           segment.y1 + body->half_mm, body->half_mm - segment.y1};
    double low = 0.0, high = 1.0;
    for (int32_t k = 0; k < 4; k++) {
        if (step[k] == 0) {
            if (room[k] < 0) {
                return false;
            }
        } else if (step[k] < 0) {
            low = fmax(low, room[k] / step[k]);
        } else {
            high = fmin(high, room[k] / step[k]);
        }
    }
    return low <= high;
}

static double outside(const body_t *const body, const double x, const double y) {
    return argus_sim_length(fmax(fmax(x - body->front_mm, -body->rear_mm - x), 0.0),
                            fmax(fabs(y) - body->half_mm, 0.0));
}

static double from_point(const double px, const double py, const segment_t segment) {
    const double dx = segment.x2 - segment.x1, dy = segment.y2 - segment.y1;
    const double length = dx * dx + dy * dy;
    double t = length > 0 ? ((px - segment.x1) * dx + (py - segment.y1) * dy) / length : 0.0;
    t = fmin(1.0, fmax(0.0, t));
    return argus_sim_length(segment.x1 + t * dx - px, segment.y1 + t * dy - py);
}

double argus_sim_body_distance(const body_t *const body, const pose_t robot, const segment_t segment) {
    const segment_t seen = to_body(robot, segment);
    if (meets(body, seen)) {
        return 0.0;
    }
    const double x[] = {body->front_mm, -body->rear_mm}, y[] = {body->half_mm, -body->half_mm};
    double nearest = fmin(outside(body, seen.x1, seen.y1), outside(body, seen.x2, seen.y2));
    for (int32_t k = 0; k < 4; k++) {
        nearest = fmin(nearest, from_point(x[k / 2], y[k % 2], seen));
    }
    return nearest;
}

double argus_sim_clearance(const body_t *const body, const double x, const double y, const double th,
                           const segment_t *const segments, const int32_t count, const double limit_mm) {
    double nearest = limit_mm;
    for (int32_t k = 0; k < count; k++) {
        // The rectangle lies within the reach of the centre: most solids are too far to improve on it.
        if (from_point(x, y, segments[k]) - body->reach_mm < nearest) {
            nearest = fmin(nearest, argus_sim_body_distance(body, (pose_t){x, y, th}, segments[k]));
        }
    }
    return nearest;
}
