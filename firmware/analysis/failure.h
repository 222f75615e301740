// SPDX-License-Identifier: MIT
// The failure state over the forward-facing sonars (paper: Fig. 6).
#ifndef ARGUS_FAILURE_H
#define ARGUS_FAILURE_H

#include "robot/robot.h"

typedef enum {
    ARGUS_IS_NORMAL,      // none disabled
    ARGUS_IS_MINOR,       // a third of them at most: 1 or 2 of six
    ARGUS_IS_MAJOR,       // more, but not all: 3 to 5 of six
    ARGUS_IS_CATASTROPHIC // all
} argus_failure_t;

// `disabled`: bit mask over sonar numbers; only the forward-facing ones count.
argus_failure_t argus_failure_of(const argus_robot_t *robot, argus_mask_t disabled);
const char *argus_failure_name(argus_failure_t failure); // IsNormal, IsMinor, IsMajor, IsCatastrophic

#endif
