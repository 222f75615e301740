// SPDX-License-Identifier: MIT
// The queue of events that were not taken yet.
#ifndef ARGUS_EVENTS_H
#define ARGUS_EVENTS_H

#include "argus/argus.h"

// A first-in first-out queue; when full the newest event is dropped and counted.
#define ARGUS_EVENT_QUEUE 64
typedef struct {
    uint16_t head;
    uint16_t count;
    uint32_t lost; // monotonic
    uint32_t lost_said;
    argus_event_t slot[ARGUS_EVENT_QUEUE];
} argus_events_t;

void argus_events_push(argus_events_t *self, argus_event_t event);
bool argus_events_pop(argus_events_t *self, argus_event_t *event);

#endif
