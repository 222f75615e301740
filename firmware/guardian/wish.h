// SPDX-License-Identifier: MIT
// What a client wants of the robot's wheels, as its commands have said so far.
#ifndef ARGUS_WISH_H
#define ARGUS_WISH_H

#include "guardian/admit.h"

#define ARGUS_VEL2_UNIT_MM_S 20

typedef enum { ARGUS_WISH_REST, ARGUS_WISH_VEL, ARGUS_WISH_MOVE } argus_wish_way_t;
typedef enum { ARGUS_WISH_STRAIGHT, ARGUS_WISH_RVEL, ARGUS_WISH_HEAD } argus_wish_turn_t;

typedef struct {
    uint8_t way;          // argus_wish_way_t
    uint8_t turn;         // argus_wish_turn_t
    bool paired;          // both by VEL2, and neither by another command since
    int32_t mm_s;         // VEL and VEL2, ahead positive
    int32_t half_mm_s;    // VEL2: half of right less left
    int32_t left_mm;      // MOVE, from there on
    uint32_t odometer_mm; // ... where it was asked for
    int32_t deg_s;        // RVEL
    int32_t heading_deg;  // HEAD, in the robot's own odometry frame
    bool heading_taken;   // a HEAD was asked for: DCHEAD counts from it
} argus_wish_t;

// Takes a command of the topics WAY, TURN and BOTH. `raw_deg`: the robot's heading as it says it itself.
void argus_wish_take(argus_wish_t *self, const argus_said_t *said, uint32_t odometer_mm, int32_t raw_deg);

// Whether the command, of those topics, asks for a motion at all.
bool argus_wish_moves(const argus_said_t *said);

#endif
