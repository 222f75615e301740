// SPDX-License-Identifier: MIT
// How far a robot can have moved between two SIPs, by its wheels and the time. A step of its position or
// heading beyond that is no motion.
#ifndef ARGUS_ODOMETRY_H
#define ARGUS_ODOMETRY_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    int32_t left_mm_s;
    int32_t right_mm_s;
} argus_wheels_t;

// Of two SIPs, one after the other.
typedef struct {
    argus_wheels_t before; // as the first one says
    argus_wheels_t after;
    int32_t track_mm;    // between the wheels, > 0
    uint32_t elapsed_ms; // between their arrivals
} argus_span_t;

typedef struct {
    int32_t way_mm;
    int32_t turn_cdeg;
} argus_way_turn_t;

// What has built up of late beyond what the wheels say, and what is missing of it. All zero: nothing.
typedef struct {
    int32_t way_mm;
    int32_t turn_cdeg;
    int32_t short_mm;
    int32_t short_cdeg;
} argus_excess_t;

// Whether a wheel can turn so fast.
bool argus_odometry_is_speed(int32_t mm_s);

// What the wheels say that it has moved: ahead, and counter-clockwise.
argus_way_turn_t argus_odometry_by_wheels(const argus_span_t *span);

// It was in motion, or asked to be, and more than a SIP is missing. Only the odometry can tell how far it got
// in between. And the farthest that this can be.
bool argus_odometry_is_unseen(const argus_span_t *span, bool under_way);
int32_t argus_odometry_unseen_mm(const argus_span_t *span);

// Whether the robot can have moved by this, both >= 0, between the two SIPs, alone and with what has built
// up. It cannot stand while its wheels turn. False: what has built up is forgotten. SIPs come late, in
// bunches and not at all, and wheels speed up and brake in between. So steps below some 150 mm and 15 degrees
// pass, one by one.
bool argus_odometry_may_be(argus_excess_t *excess, const argus_span_t *span, const argus_way_turn_t *moved);

#endif
