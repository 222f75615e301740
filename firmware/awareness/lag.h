// SPDX-License-Identifier: MIT
// Whether a sonar hands out its echoes some firings late: it repeats readings that it has given before.
#ifndef ARGUS_LAG_H
#define ARGUS_LAG_H

#include "awareness/facts.h"

// One more reading, not in the log yet, adds to the hypothesis of each lag.
void argus_lag_take(argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar,
                    const argus_ping_t *now);

#endif
