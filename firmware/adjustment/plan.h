// SPDX-License-Identifier: MIT
// The policy library: rotations by which the healthy forward-facing sonars cover for the disabled ones
// (paper: Tables IV and V).
#ifndef ARGUS_PLAN_H
#define ARGUS_PLAN_H

#include "analysis/failure.h"
#include "argus/argus.h"

// `paper`: the walk of Algorithm 3, a tie goes to the negative rotation. `fewest`: least count, then least
// sweep, then least sum, then the list that sorted ascending comes first; visited negative side outward, then
// positive side outward. paper: Algorithm 3's lines 27 to 34 stop at 50 degrees and add a rotation twice that
// covers two bearings; not so here.
// Cost: at most 1,023 sets of rotations.
argus_plan_t argus_plan(const argus_robot_t *robot, argus_policy_t policy, argus_mask_t disabled);

// Sonar that looks along the bearing of the disabled sonar `disabled` after a rotation, or -1 when none of
// the healthy does.
int argus_plan_cover(const argus_robot_t *robot, const argus_plan_t *plan, int16_t rotation_deg,
                     int disabled);

// Healthy sonars whose readings count after a rotation, as a mask.
argus_mask_t argus_plan_covering(const argus_robot_t *robot, const argus_plan_t *plan, int16_t rotation_deg);

#endif
