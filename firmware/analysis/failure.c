// SPDX-License-Identifier: MIT
// Classes the failure over the forward-facing sonars (paper: Fig. 6).
#include "analysis/failure.h"

#include "knowledge/angle.h"

#define MINOR_PARTS 3 // of all: so much of them is out in a minor failure

argus_failure_t argus_failure_of(const argus_robot_t *const any_end, const argus_mask_t disabled) {
    const argus_robot_t *const robot = argus_robot_built(any_end);
    ARGUS_ASSERT(robot->forward_count <= ARGUS_FORWARD_MAX);
    const int out = argus_count_bits(disabled & argus_robot_forward(robot));
    if (out == 0) {
        return ARGUS_IS_NORMAL;
    }
    if (out >= robot->forward_count) {
        return ARGUS_IS_CATASTROPHIC;
    }
    return out * MINOR_PARTS <= robot->forward_count ? ARGUS_IS_MINOR : ARGUS_IS_MAJOR;
}
