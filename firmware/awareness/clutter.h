// SPDX-License-Identifier: MIT
// Disturbance: what moves about the robot makes healthy sonars disagree.
#ifndef ARGUS_CLUTTER_H
#define ARGUS_CLUTTER_H

#include "awareness/facts.h"

// Something moves before this sonar.
void argus_clutter_note(argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar);

// After all of a SIP: whether more of what the sonars read is contradicted than faults make so.
void argus_clutter_sip(argus_evidence_t *self, const argus_knowledge_t *knowledge);

// Something moved in the last `ms` before any sonar in use but this one (-1: before any).
bool argus_clutter_beside(const argus_evidence_t *self, const argus_knowledge_t *knowledge, int but,
                          uint32_t ms);

#endif
