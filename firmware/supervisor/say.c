// SPDX-License-Identifier: MIT
// Puts events into the queue, with the time and the failure state of now.
#include "supervisor/say.h"

void argus_say_event(argus_t *const self, argus_event_t event) {
    ARGUS_ASSERT(event.id == 0 || event.sonar >= ARGUS_NO_SONAR);
    event.t_ms = self->now_ms;
    event.state = (uint8_t)self->failure;
    if (event.id != 0) {
        argus_events_push(&self->events, event);
    }
}

void argus_say(argus_t *const self, const argus_event_id_t id, const int sonar, const int32_t value) {
    ARGUS_ASSERT(sonar >= ARGUS_NO_SONAR && sonar < ARGUS_SONARS);
    argus_say_event(self, (argus_event_t){.id = (uint16_t)id, .sonar = (int8_t)sonar, .value = value});
}

void argus_tell(argus_t *const self, const argus_event_id_t id, const int32_t value) {
    argus_say(self, id, ARGUS_NO_SONAR, value);
}

void argus_say_change(argus_t *const self, const int sonar, const argus_change_t change,
                      const argus_fault_kind_t kind, const int32_t value) {
    ARGUS_ASSERT((unsigned)kind < ARGUS_KINDS);
    ARGUS_ASSERT(argus_health_may(&self->knowledge, sonar, change));
    argus_say_event(self, argus_health_set(&self->knowledge, sonar, change, kind, value, self->now_ms));
}
