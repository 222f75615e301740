// SPDX-License-Identifier: MIT
// What the turns of a robot show: which blind bearings are seen after each, by sonars that may look.
#ifndef ARGUS_TURNS_H
#define ARGUS_TURNS_H

#include "adjustment/cover.h"

typedef struct {
    const argus_robot_t *robot;
    uint8_t blind[ARGUS_FORWARD_MAX]; // sonar numbers
    uint8_t blinds;
    uint8_t count;
    int16_t deg[ARGUS_TURNS_MAX];  // ascending, -179 to 180, never 0
    uint8_t sees[ARGUS_TURNS_MAX]; // bit i: the bearing of blind[i]
} argus_turns_t;

// All that there are for plan->disabled and plan->looks.
void argus_turns_of(argus_turns_t *self, const argus_robot_t *robot, const argus_plan_t *plan);

// Bit i: the bearing of blind[i] is open.
unsigned argus_turns_open(const argus_turns_t *self);

#endif
