// SPDX-License-Identifier: MIT
// The event queue.
#include "knowledge/events.h"

void argus_events_push(argus_events_t *self, argus_event_t event) {
    ARGUS_ASSERT(self->count <= ARGUS_EVENT_QUEUE && self->head < ARGUS_EVENT_QUEUE);
    if (self->count >= ARGUS_EVENT_QUEUE) {
        self->lost++;
        return;
    }
    self->slot[(self->head + self->count) % ARGUS_EVENT_QUEUE] = event;
    self->count++;
}

bool argus_events_pop(argus_events_t *self, argus_event_t *event) {
    ARGUS_ASSERT(self->count <= ARGUS_EVENT_QUEUE && self->head < ARGUS_EVENT_QUEUE);
    if (self->count == 0) {
        return false;
    }
    *event = self->slot[self->head];
    self->head = (uint16_t)((self->head + 1) % ARGUS_EVENT_QUEUE);
    self->count--;
    return true;
}

void argus_emit_event(argus_events_t *const self, argus_event_t event) {
    ARGUS_ASSERT(event.id == 0 || event.sonar >= ARGUS_NO_SONAR);
    event.t_ms = self->now_ms;
    event.state = self->state;
    if (event.id != 0) {
        argus_events_push(self, event);
    }
}

void argus_emit_of(argus_events_t *const self, const argus_event_id_t id, const int sonar,
                   const int32_t value) {
    ARGUS_ASSERT(sonar >= ARGUS_NO_SONAR && sonar < ARGUS_SONARS);
    argus_emit_event(self, (argus_event_t){.id = (uint16_t)id, .sonar = (int8_t)sonar, .value = value});
}

void argus_emit(argus_events_t *const self, const argus_event_id_t id, const int32_t value) {
    argus_emit_of(self, id, ARGUS_NO_SONAR, value);
}

void argus_emit_change(argus_events_t *const self, argus_knowledge_t *const knowledge, const int sonar,
                       const argus_change_t change, const argus_fault_kind_t kind, const int32_t value) {
    ARGUS_ASSERT((unsigned)kind < ARGUS_KINDS);
    ARGUS_ASSERT(argus_health_may(knowledge, sonar, change));
    argus_emit_event(self, argus_health_set(knowledge, sonar, change, kind, value, self->now_ms));
}
