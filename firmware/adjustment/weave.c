// SPDX-License-Identifier: MIT
// Swings the heading from one side of the way to the other.
#include "adjustment/weave.h"

#include "knowledge/angle.h"

#define SWING_CDEG 1000 // for each sonar of a gap: half the pitch of the ring
#define GAP_MOST 2      // a wider one is left to sweeps
#define THERE_CDEG 300
#define ROUND_SIPS 4 // of the array

int32_t argus_weave_swing_cdeg(const int gap) {
    ARGUS_ASSERT(gap >= 0);
    return argus_min(gap, GAP_MOST) * SWING_CDEG;
}

int32_t argus_weave_cdeg(argus_weave_t *const self, const int gap, const int32_t heading_cdeg,
                         const int32_t base_cdeg) {
    const int32_t swing_cdeg = argus_weave_swing_cdeg(gap);
    const int32_t to_cdeg = argus_angle_wrap(base_cdeg + self->side * swing_cdeg);
    const bool there = argus_angle_abs_diff(heading_cdeg, to_cdeg) <= THERE_CDEG;
    self->sips = there ? (uint8_t)(self->sips + 1) : 0;
    if (self->side != 0 && self->sips < ROUND_SIPS) {
        return to_cdeg;
    }
    self->side = self->side > 0 ? -1 : 1;
    self->sips = 0;
    return argus_angle_wrap(base_cdeg + self->side * swing_cdeg);
}
