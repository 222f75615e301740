// SPDX-License-Identifier: MIT
// What most intents are filled in with.
#include "behaviour/intent.h"

void argus_to_check(argus_intent_t *const intent, const bool full) {
    intent->act = ARGUS_DO_CHECK;
    intent->full = full;
}

void argus_to_turn(argus_intent_t *const intent, const int32_t heading_cdeg) {
    intent->act = ARGUS_DO_TURN;
    intent->cdeg = heading_cdeg;
}

void argus_to_wait(argus_intent_t *const intent, const argus_wait_t why) {
    ARGUS_ASSERT(why > ARGUS_WAIT_NONE && why <= ARGUS_WAIT_ECHO);
    intent->act = ARGUS_DO_WAIT;
    intent->why = (uint8_t)why;
}

void argus_to_say(argus_intent_t *const intent, const argus_event_id_t event, const int sonar,
                  const int32_t value) {
    ARGUS_ASSERT(sonar >= ARGUS_NO_SONAR && sonar < ARGUS_SONARS);
    intent->event = (uint16_t)event;
    intent->sonar = (int8_t)sonar;
    intent->value = value;
}
