// SPDX-License-Identifier: MIT
// The event queue.
#include "supervisor/events.h"

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
