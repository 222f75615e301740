// SPDX-License-Identifier: MIT
// The policies (ARGUS_POLICY_TABLE): how the rotations are found by which living sonars cover for the
// disabled ones that face forward (paper: Tables IV and V).
#ifndef ARGUS_PLAN_H
#define ARGUS_PLAN_H

#include "adjustment/cover.h"
#include "analysis/failure.h"
#include "argus/argus.h"

// `living`: sonars, facing forward or not, that may be relied on; a policy without the ring goes by
// `disabled` alone. Complete under a policy with the ring whenever one of `living` is not disabled. `policy`:
// a row of the table. Cost: below ARGUS_COVER_STEPS_MAX sums and comparisons; some 400 bytes of stack.
argus_plan_t argus_plan(const argus_robot_t *robot, argus_policy_t policy, argus_mask_t disabled,
                        argus_mask_t living);

// Whether others than those that face forward may look along a blind bearing.
bool argus_plan_asks_ring(argus_policy_t policy);

#endif
