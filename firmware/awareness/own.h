// SPDX-License-Identifier: MIT
// The tests of a sonar's own readings: stuck, garbage, intermittent, late.
#ifndef ARGUS_OWN_H
#define ARGUS_OWN_H

#include "awareness/facts.h"

// One more reading, not in the log yet.
void argus_own_take(argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar,
                    const argus_ping_t *now);

#endif
