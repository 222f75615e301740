// SPDX-License-Identifier: MIT
// Saying events.
#ifndef ARGUS_SAY_H
#define ARGUS_SAY_H

#include "knowledge/health.h"
#include "supervisor/core.h"

void argus_say(argus_t *self, argus_event_id_t id, int sonar, int32_t value);
void argus_tell(argus_t *self, argus_event_id_t id, int32_t value); // about no sonar

// Its time and failure state are filled in; id 0: nothing is said.
void argus_say_event(argus_t *self, argus_event_t event);

// Changes the health of a sonar and says so.
void argus_say_change(argus_t *self, int sonar, argus_change_t change, argus_fault_kind_t kind,
                      int32_t value);

#endif
