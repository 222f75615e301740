// SPDX-License-Identifier: MIT
// Straight ways that bend: how far the heading turns on them though no turn is ordered.
#ifndef ARGUS_BEND_H
#define ARGUS_BEND_H

#include "knowledge/knowledge.h"

// A piece of way without an order to turn.
typedef struct {
    argus_way_turn_t piece;
    uint32_t odometer_mm; // at the last SIP
    int32_t heading_cdeg; // likewise
    int32_t ordered_cdeg; // the last order to turn
    uint32_t ordered_ms;  // when it was given
    bool turning;         // the robot was not there since
    bool begun;
} argus_bend_t;

// A turn to this heading is ordered.
void argus_bend_ordered(argus_bend_t *self, int32_t heading_cdeg, uint32_t now_ms);

// One SIP. `straight`: a MOVE ahead is at work. True: `piece` is done, long enough to tell, or bent enough.
bool argus_bend_sip(argus_bend_t *self, const argus_knowledge_t *knowledge, bool straight,
                    argus_way_turn_t *piece);

#endif
