// SPDX-License-Identifier: MIT
// The policies: how the rotations are found by which living sonars cover for the disabled ones that face
// forward (paper: Tables IV and V).
#ifndef ARGUS_PLAN_H
#define ARGUS_PLAN_H

#include "adjustment/cover.h"
#include "analysis/failure.h"
#include "argus/argus.h"

// X(NAME, setting, walks, ring, stop, degree, meaning). `walks`: nearest to 0 first, back after each; else
// the exact planner, one pass and one return. `ring`: every living sonar may look, not only those that face
// forward. `stop`, `degree`: what one costs. A stop takes 1 s, in which the robot turns by 60 degrees.
#define ARGUS_POLICY_TABLE(X)                                                                        \
    X(PAPER, "paper", 1, 0, 0, 0, "Algorithm 3: nearest turn first, back after each")                \
    X(FEWEST, "fewest", 0, 0, 1000, 1, "least stops, then least turning")                            \
    X(LEAST_TURN, "least-turn", 0, 0, 1, 1000, "least turning, then least stops")                    \
    X(RING, "ring", 0, 1, 1000, 1, "least stops, then least turning, abeam and rear look ahead too") \
    X(ADAPTIVE, "adaptive", 0, 1, 60, 1, "least time, abeam and rear look ahead too")

// `living`: sonars, facing forward or not, that may be relied on; a policy without the ring goes by
// `disabled` alone. Complete under a policy with the ring whenever one of `living` is not disabled. `policy`:
// a row of the table. Cost: below ARGUS_COVER_STEPS_MAX sums and comparisons; some 400 bytes of stack.
argus_plan_t argus_plan(const argus_robot_t *robot, argus_policy_t policy, argus_mask_t disabled,
                        argus_mask_t living);

// Whether others than those that face forward may look along a blind bearing.
bool argus_plan_asks_ring(argus_policy_t policy);

#endif
