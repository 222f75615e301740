// SPDX-License-Identifier: MIT
// A heading that swings about the way while a bearing is blind, so that living sonars look along it.
#ifndef ARGUS_WEAVE_H
#define ARGUS_WEAVE_H

#include <stdbool.h>
#include <stdint.h>

// All zero: not begun.
typedef struct {
    int8_t side;  // that it swings to, +1 left
    uint8_t sips; // that it has been there
} argus_weave_t;

// How far to either side for a gap of so many sonars side by side.
int32_t argus_weave_swing_cdeg(int gap);

// Once a SIP. The heading to steer to: it swings to one side of `base_cdeg`, first the left, until a round of
// the array has looked from there, then to the other.
int32_t argus_weave_cdeg(argus_weave_t *self, int gap, int32_t heading_cdeg, int32_t base_cdeg);

#endif
