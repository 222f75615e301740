// SPDX-License-Identifier: MIT
// The counter-rotation to a wheel that turns less than it should.
#ifndef ARGUS_TRIM_H
#define ARGUS_TRIM_H

#include "analysis/wheel.h"

// Whether the way is to be countered now: a wheel is named, and it is not time to measure it again.
bool argus_trim_is_due(const argus_wheel_t *wheel, const argus_knowledge_t *knowledge);

// On each SIP the robot is to be turned so much off the bearing. When the order arrives it will have drifted
// back by half of that. Before the next one arrives it drifts as much beyond.
int32_t argus_trim_cdeg(const argus_wheel_t *wheel, const argus_knowledge_t *knowledge);

#endif
