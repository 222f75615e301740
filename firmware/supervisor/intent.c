// SPDX-License-Identifier: MIT
// The intents that most modes come to.
#include "supervisor/intent.h"

argus_intent_t argus_to(const argus_act_t act) {
    return (argus_intent_t){.act = (uint8_t)act};
}

argus_intent_t argus_to_nothing(void) {
    return argus_to(ARGUS_DO_NOTHING);
}

argus_intent_t argus_to_check(const bool full) {
    return (argus_intent_t){.act = ARGUS_DO_CHECK, .full = full};
}

argus_intent_t argus_to_turn(const int32_t heading_cdeg) {
    return (argus_intent_t){.act = ARGUS_DO_TURN, .cdeg = heading_cdeg};
}

argus_intent_t argus_to_wait(const argus_wait_t why) {
    ARGUS_ASSERT(why > ARGUS_WAIT_NONE && why <= ARGUS_WAIT_ECHO);
    return (argus_intent_t){.act = ARGUS_DO_WAIT, .why = (uint8_t)why};
}
