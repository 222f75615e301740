// SPDX-License-Identifier: MIT
// The health check: what it finds, at rest and beside the main task, and what Algorithm 2 makes of a suspect.
#ifndef ARGUS_CHECK_H
#define ARGUS_CHECK_H

#include "supervisor/core.h"
#include "supervisor/intent.h"

// At rest, all have reported. Suspects are to be verified; without any, each sonar that reported is healthy.
void argus_conclude_check(argus_t *self, argus_intent_t *intent);

// The periodic one beside the main task. Nothing to do: ARGUS_DO_NOTHING.
void argus_check_beside(argus_t *self, argus_intent_t *intent);

// Says what the witnesses saw and applies the verdict.
void argus_apply_verdict(argus_t *self);

#endif
