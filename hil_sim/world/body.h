// SPDX-License-Identifier: MIT
// The robot's body among solids (body.py), as far as a sub-step in C asks for it; and how long that is.
#ifndef ARGUS_SIM_BODY_H
#define ARGUS_SIM_BODY_H

#include <stdint.h>

enum { STEP_MS = 10 };

#define DEGREE (3.14159265358979323846 / 180)

// mm and degrees.
typedef struct {
    double x, y, th;
} pose_t;

typedef struct {
    double x1, y1, x2, y2;
} segment_t;

// A rectangle round the centre of rotation; reach_mm: of its furthest corner.
typedef struct {
    double front_mm, rear_mm, half_mm, reach_mm;
} body_t;

double argus_sim_length(double dx, double dy);

// From the body to a segment, 0 where they meet.
double argus_sim_body_distance(const body_t *body, pose_t robot, segment_t segment);

// From the body to the nearest of the segments, at most `limit_mm`.
double argus_sim_clearance(const body_t *body, double x, double y, double th, const segment_t *segments,
                           int32_t count, double limit_mm);

#endif
