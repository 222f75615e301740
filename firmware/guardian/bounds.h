// SPDX-License-Identifier: MIT
// What a client's motion may be, asked of what trusted sonars see: how far, how fast, whether it may turn.
// Nothing is changed.
#ifndef ARGUS_BOUNDS_H
#define ARGUS_BOUNDS_H

#include "supervisor/core.h"

// Why a way is closed.
typedef enum {
    ARGUS_BOUND_FREE,
    ARGUS_BOUND_OBJECT, // S2: a thing on the way, within the object range
    ARGUS_BOUND_UNSEEN, // S1, S2, S7: the way is not seen, or not lately
    ARGUS_BOUND_BUMPER, // S2: pressed at the end that would lead
    ARGUS_BOUND_HALTED  // an operator's stop, no session, an unknown body
} argus_bound_why_t;

typedef struct {
    int32_t speed_mm_s; // S5: from it the robot stands before what is seen on the way; 0: closed
    int32_t way_mm;     // up to the object range
    argus_bound_why_t why;
    bool slants; // closed by a wall beside that the way slants into: seen by having driven along it
} argus_bound_t;

// Where the robot is built to drive, or back. Cost: one pass over the sonars, five places of a cone each;
// where a bearing ahead is blind that of argus_rays_seen_mm().
argus_bound_t argus_bound_way(const argus_t *self, bool ahead);

// Whether a turn by so much, at most a quarter of one, is free of all that is seen or was a moment ago. What
// is close already only must not come closer: it must get away from there. Cost: a place of the body per 8
// degrees for each echo.
bool argus_bound_may_turn(const argus_t *self, int32_t by_cdeg);

#endif
