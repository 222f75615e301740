// SPDX-License-Identifier: MIT
// What a late link means for driving: slower (S5), no new motion while an order is overdue, and a stand.
#ifndef ARGUS_LATENCY_H
#define ARGUS_LATENCY_H

#include "supervisor/core.h"
#include "supervisor/intent.h"

// A session opens.
void argus_latency_open(argus_latency_t *mine, bool has_robot);

// With each SIP, after the round trip has seen it and before it is used; true: it goes on after a stand, and
// what was read meanwhile was not of its time. And whenever time passes: STOP once too much is overdue.
bool argus_latency_sip(const argus_t *self, argus_latency_t *mine, argus_events_t *events,
                       argus_intent_t *intent);
void argus_latency_process(const argus_t *self, argus_latency_t *mine, argus_events_t *events,
                           argus_intent_t *intent);

// By which the SIPs may be late, the last one too.
int32_t argus_latency_oldest_ms(const argus_latency_t *self);

// What the SIPs say is of now, and orders arrive: a mode may go on.
bool argus_latency_is_prompt(const argus_latency_t *self);

#endif
