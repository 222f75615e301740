// SPDX-License-Identifier: MIT
// Active verification (profile argus). First come turns that let a sonar look at what another has heard. Then
// come looks to either side, which show every sonar the bearings of its neighbours.
#ifndef ARGUS_INQUIRY_H
#define ARGUS_INQUIRY_H

#include "awareness/evidence.h"

// Like the verification it only says which heading it wants; the readings go through the evidence by
// themselves.
typedef struct {
    bool active;
    bool returning; // the last turn, back to the base heading
    bool marked;    // settled on the present heading
    bool aiming;    // one suspect that hears nothing at what another has heard
    uint8_t aims;   // so often
    uint8_t aimed;  // that suspect
    uint8_t look;   // index of the present heading
    int32_t aim_cdeg;
    int32_t look_cdeg;          // of the present look, from the base heading
    argus_mask_t suspects;      // what it is held for; empty: a look at all
    argus_mask_t watched;       // sonars that are waited for
    uint8_t seen[ARGUS_SONARS]; // low bits of their counters when the robot had settled
    int32_t base_cdeg;
    uint32_t settled_ms;
} argus_inquiry_t;

void argus_inquiry_init(argus_inquiry_t *self);

// `suspects` may be empty. `base_cdeg`: the present heading.
void argus_inquiry_begin(argus_inquiry_t *self, const argus_knowledge_t *knowledge,
                         const argus_evidence_t *evidence, argus_mask_t suspects, int32_t base_cdeg);

// Takes in more suspects while it is under way.
void argus_inquiry_add(argus_inquiry_t *self, const argus_knowledge_t *knowledge, argus_mask_t suspects);

int32_t argus_inquiry_heading_cdeg(const argus_inquiry_t *self);

// Call on each SIP while settled on that heading. True when the heading changed, or it is over (`active`
// false).
bool argus_inquiry_step(argus_inquiry_t *self, const argus_knowledge_t *knowledge,
                        const argus_evidence_t *evidence);

#endif
