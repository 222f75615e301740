// SPDX-License-Identifier: MIT
// The queue of events that were not taken yet.
#ifndef ARGUS_EVENTS_H
#define ARGUS_EVENTS_H

#include "knowledge/health.h"

// A first-in first-out queue; when full the newest event is dropped and counted.
#define ARGUS_EVENT_QUEUE 64
typedef struct {
    uint32_t now_ms; // stamped on what is emitted,
    uint8_t state;   // ... as is the failure state of the robot, argus_failure_t
    uint16_t head;
    uint16_t count;
    uint32_t lost; // monotonic
    uint32_t lost_said;
    argus_event_t slot[ARGUS_EVENT_QUEUE];
} argus_events_t;

void argus_events_push(argus_events_t *self, argus_event_t event);
bool argus_events_pop(argus_events_t *self, argus_event_t *event);

// An event about the robot, or about one sonar, with time and failure state of now.
void argus_emit(argus_events_t *self, argus_event_id_t id, int32_t value);
void argus_emit_of(argus_events_t *self, argus_event_id_t id, int sonar, int32_t value);

// One whose time and failure state are filled in; id 0: none.
void argus_emit_event(argus_events_t *self, argus_event_t event);

// Changes the health of a sonar and reports that.
void argus_emit_change(argus_events_t *self, argus_knowledge_t *knowledge, int sonar, argus_change_t change,
                       argus_fault_kind_t kind, int32_t value);

#endif
