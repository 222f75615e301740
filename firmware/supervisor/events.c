// SPDX-License-Identifier: MIT
// The event queue and the look-up in the event catalogue.
#include "supervisor/events.h"

#include <string.h>

// Texts, not pointers to them: a table of pointers is initialized data in a position-independent build.
typedef struct {
    uint16_t id;
    uint8_t level;
    char name[24];
    char subject[13];
} entry_t;

static const entry_t *find(uint16_t id) {
#define ENTRY(number, NAME, LEVEL, about, meaning) {number, ARGUS_LEVEL_##LEVEL, #NAME, about},
    static const entry_t catalogue[] = {ARGUS_EVENT_TABLE(ENTRY)};
#undef ENTRY
    static const entry_t unknown = {0, ARGUS_LEVEL_ERROR, "?", "?"};
    for (size_t i = 0; i < sizeof catalogue / sizeof catalogue[0]; i++) {
        if (catalogue[i].id == id) {
            return &catalogue[i];
        }
    }
    return &unknown;
}

const char *argus_event_name(uint16_t id) {
    return find(id)->name;
}

const char *argus_event_subject(uint16_t id) {
    return find(id)->subject;
}

argus_level_t argus_event_level(uint16_t id) {
    return (argus_level_t)find(id)->level;
}

void argus_events_init(argus_events_t *self) {
    memset(self, 0, sizeof *self);
}

void argus_events_push(argus_events_t *self, argus_event_t event) {
    if (self->count >= ARGUS_EVENT_QUEUE) {
        self->lost++;
        return;
    }
    self->slot[(self->head + self->count) % ARGUS_EVENT_QUEUE] = event;
    self->count++;
}

bool argus_events_pop(argus_events_t *self, argus_event_t *event) {
    if (self->count == 0) {
        return false;
    }
    *event = self->slot[self->head];
    self->head = (uint16_t)((self->head + 1) % ARGUS_EVENT_QUEUE);
    self->count--;
    return true;
}
