// SPDX-License-Identifier: MIT
// A queue of events in any state keeps to its room, gives out the oldest first and unchanged, and counts what
// it had no room for.
// Bounds: any state that its invariant allows, any event: an inductive step
// Sources: firmware/knowledge/events.c
// Unwind: 3
// Ci: yes
// Mutant: firmware/knowledge/events.c | if (self->count >= ARGUS_EVENT_QUEUE) { | if (self->count > ARGUS_EVENT_QUEUE) {
// Mutant: firmware/knowledge/events.c | (self->head + self->count) % ARGUS_EVENT_QUEUE | self->head + self->count
// Mutant: firmware/knowledge/events.c | (self->head + 1) % ARGUS_EVENT_QUEUE | (self->head + 2) % ARGUS_EVENT_QUEUE
#include "proof.h"

#include "knowledge/events.h"

static bool holds(const argus_events_t *const events) {
    return events->count <= ARGUS_EVENT_QUEUE && events->head < ARGUS_EVENT_QUEUE;
}

void proof(void) {
    argus_events_t events;
    argus_event_t event;
    argus_event_t taken;
    ASSUME(holds(&events));
    const uint16_t before = events.count;
    const uint32_t lost = events.lost;
    const uint16_t oldest = events.slot[events.head].id;
    const uint16_t second = events.slot[(events.head + 1) % ARGUS_EVENT_QUEUE].id;
    argus_events_push(&events, event);
    PROVE(holds(&events), "within its room");
    PROVE(events.count == before + 1 || (before == ARGUS_EVENT_QUEUE && events.lost == lost + 1),
          "or counted");
    PROVE(argus_events_pop(&events, &taken) && holds(&events), "one is there");
    PROVE(taken.id == (before > 0 ? oldest : event.id), "the oldest comes first");
    PROVE(before > 0 || taken.value == event.value, "as it was put");
    PROVE(before < 2 || (argus_events_pop(&events, &taken) && taken.id == second), "then the next");
}
