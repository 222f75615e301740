// SPDX-License-Identifier: MIT
// The failure state over the forward-facing sonars (paper: Fig. 6).
#ifndef ARGUS_FAILURE_H
#define ARGUS_FAILURE_H

#include "robot/robot.h"

// `disabled`: bit mask over sonar numbers; only the forward-facing ones count.
argus_failure_t argus_failure_of(const argus_robot_t *any_end, argus_mask_t disabled);

#endif
