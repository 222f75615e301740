// SPDX-License-Identifier: MIT
// The modes in which the robot stays where it is: CHECKING, VERIFYING, IDLE, WAITING; and BACKING.
#ifndef ARGUS_RESTING_H
#define ARGUS_RESTING_H

#include "behaviour/core.h"
#include "behaviour/intent.h"

// Each says on every SIP what is to be done, and writes its own state alone.
void argus_run_checking(const argus_t *self, argus_checking_t *mine, argus_intent_t *intent);
void argus_run_verifying(const argus_t *self, argus_verifying_t *mine, argus_intent_t *intent);
void argus_run_idle(const argus_t *self, argus_intent_t *intent);
void argus_run_waiting(const argus_t *self, argus_waiting_t *mine, argus_intent_t *intent);
void argus_run_backing(const argus_t *self, argus_intent_t *intent);

// WAITING says so each 10 s.
void argus_go_on_waiting(const argus_t *self, argus_waiting_t *mine, argus_intent_t *intent);

#endif
