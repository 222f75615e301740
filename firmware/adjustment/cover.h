// SPDX-License-Identifier: MIT
// Which sonars look along a blind bearing after a rotation of a plan.
#ifndef ARGUS_COVER_H
#define ARGUS_COVER_H

#include "argus/argus.h"
#include "robot/robot.h"

// Sonar that looks along the bearing of the disabled sonar `disabled` after a rotation, or -1 when none does
// that may look.
int argus_plan_cover(const argus_robot_t *robot, const argus_plan_t *plan, int16_t rotation_deg,
                     int disabled);

// The sonars that count after a rotation, and after any of the plan's, as a mask.
argus_mask_t argus_plan_covering(const argus_robot_t *robot, const argus_plan_t *plan, int16_t rotation_deg);
argus_mask_t argus_plan_needs(const argus_robot_t *robot, const argus_plan_t *plan);

#endif
