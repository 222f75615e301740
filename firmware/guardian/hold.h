// SPDX-License-Identifier: MIT
// Gives the robot what a client wants of its wheels, within the bounds, and takes it back as they close.
#ifndef ARGUS_HOLD_H
#define ARGUS_HOLD_H

#include "behaviour/core.h"
#include "guardian/bounds.h"
#include "guardian/heed.h"
#include "guardian/wish.h"

// What a guard port has of the manager: it reads all, and writes what goes out, the speed of the set-up while
// the client has the robot, and where the robot counts from.
typedef struct {
    const argus_t *core;
    argus_outbox_t *out;
    argus_events_t *events;
    argus_motion_t *motion;
    argus_knowledge_t *knowledge;
} argus_grant_t;

// What the robot was ordered last, and what was said of it.
typedef struct {
    int32_t mm_s; // VEL, or the way of VEL2
    int8_t right; // VEL2, in its units
    int8_t left;
    bool rolls;           // it moves along by our word
    bool moves;           // ... by MOVE
    int32_t move_mm;      // MOVE, from there on
    uint32_t odometer_mm; // ... where it was given
    uint32_t move_ms;     // ... and when
    int32_t setv_mm_s;    // SETV
    bool turn_held;       // RVEL 0 in the place of a turn
    bool has_head;        // HEAD
    int32_t head_cdeg;    // ... to this, in the robot's own odometry frame
    argus_weave_t weave;  // so that others see a blind bearing
    int32_t base_cdeg;    // ... about this heading, course frame
    uint16_t bumpers;     // pressed at the last SIP
    uint8_t stalls;       // wheels that stalled then
    bool slanted;         // the way ahead slanted into a wall beside
    int32_t slant_cdeg;   // ... at this heading, course frame
    uint32_t slant_mm;    // ... and this odometer
    bool slowed_said;     // since the last GUARD_FREE
    bool held_said;
    bool turn_said;
    uint8_t open_sips; // the way was not closed, one after the other
    uint8_t free_sips; // without any bound, one after the other
} argus_given_t;

typedef struct {
    argus_wish_t wish;
    argus_given_t given;
    int32_t setv_mm_s; // the client's own SETV: what MOVE drives at, and VEL at most
    bool way_due;      // to be given with the next SIP: the outbox was full, or the client says too much
    bool turn_due;
    argus_heed_t way_heed; // whether the wheels do what was given
    argus_heed_t turn_heed;
} argus_hold_client_t;

// Nothing is wanted any more, and nothing is sent for that.
void argus_hold_forget(argus_hold_client_t *self);

// After a command about the way, or both the way and the turn; about the turn: passed on as far as it may be.
void argus_hold_way(const argus_grant_t *grant, argus_hold_client_t *self);
void argus_hold_turn(const argus_grant_t *grant, argus_hold_client_t *self);

// STOP at once. What is wanted is given again when it may be.
void argus_hold_still(const argus_grant_t *grant, argus_hold_client_t *self);

// Once for each time that it is held: what it asks for it may not have at all now.
void argus_hold_tell(const argus_grant_t *grant, argus_hold_client_t *self, argus_permit_t permit);

// After each SIP, and when an operator stops the robot: what was given is taken back or given again.
void argus_hold_watch(const argus_grant_t *grant, argus_hold_client_t *self);

#endif
