// SPDX-License-Identifier: MIT
// One motion at a time: a turn to a heading or a move by a distance, watched until the robot has settled.
#ifndef ARGUS_MOTION_H
#define ARGUS_MOTION_H

#include "arcos/command.h"
#include "argus/argus.h"
#include "knowledge/knowledge.h"

typedef enum {
    ARGUS_MOTION_NONE,
    ARGUS_MOTION_TURN,
    ARGUS_MOTION_MOVE,
    ARGUS_MOTION_STOP
} argus_motion_kind_t;

typedef struct {
    argus_motion_kind_t kind;
    bool settled;
    bool failed;        // the robot does not do it
    uint8_t on_target;  // consecutive SIPs that meet the end condition
    uint8_t off_target; // consecutive SIPs at rest that do not
    uint8_t tries;
    int32_t target_cdeg; // TURN: course frame, as commanded (whole degrees of the robot's own heading)
    int32_t target_mm;   // MOVE: signed, ahead is where the leading end is
    uint32_t end_mm;     // ... where the one that was sent last ends, of the odometer
    uint32_t issued_ms;
    uint32_t late_ms;   // the link: a motion takes longer to show
    int32_t speed_mm_s; // last SETV, 0: the robot's own
    argus_mark_t mark;  // when it settled
} argus_motion_t;

void argus_motion_init(argus_motion_t *self);
void argus_motion_turn(argus_motion_t *self, argus_outbox_t *out, const argus_knowledge_t *knowledge,
                       int32_t heading_cdeg, uint32_t now_ms);
// SETV goes before the MOVE when the speed differs from the last one. A MOVE that ends where the one at work
// ends is not sent again.
void argus_motion_move(argus_motion_t *self, argus_outbox_t *out, const argus_knowledge_t *knowledge,
                       int32_t distance_mm, int32_t speed_mm_s, uint32_t now_ms);
// Sends STOP and waits for rest.
void argus_motion_stop(argus_motion_t *self, argus_outbox_t *out, uint32_t now_ms);
// Waits for rest on whatever heading, without a command.
void argus_motion_hold(argus_motion_t *self, uint32_t now_ms);

// While translating: a heading correction that is not waited for.
void argus_motion_steer(argus_outbox_t *out, const argus_knowledge_t *knowledge, int32_t heading_cdeg);

// A turn or a move was asked for and has not settled.
bool argus_motion_is_under_way(const argus_motion_t *self);

// After each SIP. Settled: two consecutive SIPs with |L|, |R| <= 5 mm/s (a turn: heading within 1 degree of
// the target). True: a turn rests off its target. It is to be commanded again, if it may be: three times at
// most, then it failed.
bool argus_motion_sip(argus_motion_t *self, const argus_knowledge_t *knowledge, uint32_t now_ms);
void argus_motion_again(argus_motion_t *self, argus_outbox_t *out, const argus_knowledge_t *knowledge,
                        bool may, uint32_t now_ms);

#endif
