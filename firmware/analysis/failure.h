// SPDX-License-Identifier: MIT
// The failure state over the forward-facing six (paper: Fig. 6).
#ifndef ARGUS_FAILURE_H
#define ARGUS_FAILURE_H

#include <stdint.h>

typedef enum {
    ARGUS_IS_NORMAL,      // none disabled
    ARGUS_IS_MINOR,       // 1 or 2
    ARGUS_IS_MAJOR,       // 3 to 5
    ARGUS_IS_CATASTROPHIC // all 6
} argus_failure_t;

// `disabled`: bit mask over sonar numbers; only 1..6 count.
argus_failure_t argus_failure_of(uint16_t disabled);
const char *argus_failure_name(argus_failure_t failure); // IsNormal, IsMinor, IsMajor, IsCatastrophic

#endif
