// SPDX-License-Identifier: MIT
// The health check: what it finds, at rest and beside the main task, and what Algorithm 2 makes of a suspect.
#ifndef ARGUS_CHECK_H
#define ARGUS_CHECK_H

#include "behaviour/core.h"
#include "behaviour/intent.h"

// At rest, all have reported. Suspects are to be verified; without any, each sonar that reported is healthy.
void argus_conclude_check(argus_t *self, argus_intent_t *intent);

// The periodic one beside the main task. Nothing to do: ARGUS_DO_NOTHING.
void argus_check_beside(argus_t *self, argus_intent_t *intent);

// Says what the witnesses saw and applies the verdict.
void argus_apply_verdict(argus_t *self);

// The looks are over: each sonar that was asked is cleared, given up or left open.
void argus_conclude_looks(argus_t *self);

// They are not to be looked at in this place, and covered for like those that are out.
void argus_leave_open(const argus_knowledge_t *knowledge, argus_algorithm1_t *algorithm1,
                      argus_events_t *events, argus_mask_t sonars);

#endif
