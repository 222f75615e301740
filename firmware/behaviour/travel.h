// SPDX-License-Identifier: MIT
// The modes in which the robot goes its way: DRIVING, and in failure mode SWEEPING and STEPPING (paper: Fig.
// 10), and CREEPING where no sonar sees the way.
#ifndef ARGUS_TRAVEL_H
#define ARGUS_TRAVEL_H

#include "behaviour/core.h"
#include "behaviour/intent.h"

// Each says on every SIP what is to be done, and writes the state of the travel alone.
void argus_run_driving(const argus_t *self, argus_travel_t *mine, argus_intent_t *intent);
void argus_run_sweeping(const argus_t *self, argus_travel_t *mine, argus_intent_t *intent);
void argus_run_stepping(const argus_t *self, argus_travel_t *mine, argus_intent_t *intent);
void argus_run_creeping(const argus_t *self, argus_travel_t *mine, argus_intent_t *intent);

// A way begins: DRIVING, SWEEPING or CREEPING is entered.
void argus_begin_travel(argus_travel_t *mine);

#endif
