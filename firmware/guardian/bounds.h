// SPDX-License-Identifier: MIT
// What a client's motion may be, asked of what trusted sonars see: how far and how fast. Nothing is changed.
#ifndef ARGUS_BOUNDS_H
#define ARGUS_BOUNDS_H

#include "behaviour/permit.h"

// A turn of a client, at most, and its deceleration, at least: S7 counts on both.
#define ARGUS_CLIENT_TURN_DEG_S 100
#define ARGUS_CLIENT_TURN_DECEL 100
#define ARGUS_DEG_PER_RAD 57
#define ARGUS_CLIENT_REACTION_MS 500 // from a reading to the effect of an order, about that of S5

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

// How fast it turns by its wheels or, where that is faster, by its headings: how far apart wheels that skid
// act is known from these alone. Counter-clockwise positive.
int32_t argus_turn_deg_s(const argus_knowledge_t *knowledge);

// What bounds a client where it may not move at all, or not turn.
argus_bound_why_t argus_bound_why(argus_permit_t permit);

#endif
