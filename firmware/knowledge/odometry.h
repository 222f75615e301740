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
    uint32_t late_ms;    // they may be so old: the next ones may make up for it
} argus_span_t;

// What a robot that hears nobody goes on with.
typedef struct {
    bool under_way;       // a motion was asked for
    uint16_t way_mm;      // ... that ends after this, 0: a turn on the spot,
    uint16_t speed_mm_s;  // ... and becomes this fast,
    uint16_t accel_mm_s2; // ... by this,
    uint16_t watchdog_ms; // ... until it has heard nothing for so long,
    uint16_t decel_mm_s2; // and brakes by this
} argus_order_t;

typedef struct {
    int32_t way_mm;
    int32_t turn_cdeg;
} argus_way_turn_t;

// A step as the odometry says it, in the robot's frame.
typedef struct {
    int32_t ahead_mm;
    int32_t aside_mm; // to the left
    int32_t turn_cdeg;
} argus_moved_t;

// What has built up of late beyond what the wheels say, one way and the other. All zero: nothing.
typedef struct {
    int32_t ahead_mm;
    int32_t back_mm;
    int32_t aside_mm; // either side
    int32_t left_cdeg;
    int32_t right_cdeg;
    int32_t out_mm;    // what was built up, ahead positive, when a step could not be;
    int32_t out_cdeg;  // ... to the left positive
    int32_t credit_ms; // time without a SIP: those that come in a bunch after it make up for it
} argus_excess_t;

// Whether a wheel can turn so fast; and what it can, where it is stated to turn faster.
bool argus_odometry_is_speed(int32_t mm_s);
int32_t argus_odometry_speed_mm_s(int32_t mm_s);

// What the wheels say that it has moved: ahead, and counter-clockwise.
argus_way_turn_t argus_odometry_by_wheels(const argus_span_t *span);

// It was in motion, or asked to be, and more than a SIP is missing. Only the odometry can tell how far it got
// in between. And the farthest that a wheel can have made.
bool argus_odometry_is_unseen(const argus_span_t *span, const argus_order_t *order);
int32_t argus_odometry_unseen_mm(const argus_span_t *span, const argus_order_t *order);

// Of a way that nobody has seen: whether counters that say `from_zero` may have begun there within it. Then
// this place cannot be joined to the one before. The step itself vouches against it where it is what the
// order and the watchdog make of the gap, or what the next SIP in line would say, as after the host slept.
// So does a place away from zero where it turned on the spot, and a heading where it drove to a place.
bool argus_odometry_may_be_anew(const argus_span_t *span, const argus_order_t *order,
                                const argus_moved_t *step, const argus_way_turn_t *from_zero);

// Whether the robot can have moved by this between the two SIPs, alone and with what has built up. The wheels
// say how far, whither, and within which time; it cannot stand while they turn. SIPs come late, in bunches
// and not at all, and wheels speed up and brake in between. So single steps of some 20 mm and 3 degrees at
// rest, and 45 mm at half a metre a second, pass. False: what has built up is in `out_mm` and `out_cdeg`,
// and begins anew.
bool argus_odometry_may_be(argus_excess_t *excess, const argus_span_t *span, const argus_moved_t *moved);

#endif
