// SPDX-License-Identifier: MIT
// Carries out intents and changes the mode; no other file does.
#ifndef ARGUS_MODES_H
#define ARGUS_MODES_H

#include "behaviour/core.h"
#include "behaviour/intent.h"

// The intent and what follows from it.
void argus_do(argus_t *self, const argus_intent_t *wanted);

// ... of a stop and an act alone; `full` is of a check.
void argus_stop_and_do(argus_t *self, argus_stop_t stop, argus_act_t act, bool full);

// One SIP: what must happen at once; what the evidence says; what the present mode wants.
void argus_react(argus_t *self, const argus_alarm_t *alarm);
void argus_judge_all(argus_t *self);
void argus_run_mode(argus_t *self);

// Whether the course is to be given up for want of progress, also while no mode may go on; the reason is
// reported.
bool argus_is_in_vain(const argus_t *self, argus_travel_t *travel, argus_events_t *events);

// Time alone: WAITING says so, CLOSING ends.
void argus_process_mode(argus_t *self);

#endif
