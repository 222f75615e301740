// SPDX-License-Identifier: MIT
// The failure state over the forward-facing six (paper: Fig. 6).
#ifndef ARGUS_FAILURE_H
#define ARGUS_FAILURE_H

#include "argus/argus.h"

// `disabled`: bit mask over sonar numbers; only 1..6 count.
argus_failure_t argus_failure_of(uint16_t disabled);

#endif
