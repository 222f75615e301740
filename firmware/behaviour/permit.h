// SPDX-License-Identifier: MIT
// Who may move, and why not: the one question before each order to the wheels or the motors. It stands before
// orders of the manager and of a client alike. Nothing is changed.
#ifndef ARGUS_PERMIT_H
#define ARGUS_PERMIT_H

#include "behaviour/core.h"

typedef enum {
    ARGUS_MOVER_MANAGER, // for a course, or an operator's step or turn
    ARGUS_MOVER_CLIENT   // of a guard port
} argus_mover_t;

typedef enum {
    ARGUS_PERMIT_GIVEN,
    ARGUS_PERMIT_NO_ROBOT, // no session, no SIPs, or it is being left
    ARGUS_PERMIT_STOPPED,  // an operator's stop, until another order
    ARGUS_PERMIT_BODY,     // not known, or the settings are unsafe for it
    ARGUS_PERMIT_OTHER,    // the other one has the robot
    ARGUS_PERMIT_BUMPER,   // S2: pressed, where it would lead
    ARGUS_PERMIT_SWING     // S7: the body would meet what is seen
} argus_permit_t;

typedef enum { ARGUS_WANTS_MOTORS, ARGUS_WANTS_AHEAD, ARGUS_WANTS_BACK, ARGUS_WANTS_TURN } argus_wants_t;

// Ahead is where the end that leads now goes. `by_cdeg`: of a turn, at most ARGUS_TURN_MOST_CDEG of it count.
typedef struct {
    argus_mover_t mover;
    argus_wants_t wants;
    int32_t by_cdeg;
} argus_ask_t;

#define ARGUS_TURN_MOST_CDEG 10000
#define ARGUS_TURN_EITHER_CDEG 17000 // beyond, a robot may turn either way: both are asked

// Cost of a turn: a place of the body per 8 degrees for each echo near enough to be met.
argus_permit_t argus_permit(const argus_t *self, argus_ask_t order);

#endif
