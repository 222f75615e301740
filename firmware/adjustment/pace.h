// SPDX-License-Identifier: MIT
// Does the robot keep to the speed that it was set? One that does not is reckoned with at the speed seen
// (S5).
#ifndef ARGUS_PACE_H
#define ARGUS_PACE_H

#include "knowledge/knowledge.h"

typedef struct {
    int32_t may_mm_s;  // what it was set, and what it brakes from
    int32_t seen_mm_s; // the fastest beyond that, 0: it keeps to what it was set
    uint8_t sips;      // in a row beyond it
} argus_pace_t;

// A session opens: SETV was sent.
void argus_pace_init(argus_pace_t *self);

// After each SIP. `set_mm_s`: the last SETV, 0: it is not in a MOVE of ours. True: it has just been found to
// be faster than it may.
bool argus_pace_sip(argus_pace_t *self, const argus_knowledge_t *knowledge, int32_t set_mm_s);

#endif
