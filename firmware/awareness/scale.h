// SPDX-License-Identifier: MIT
// Whether the ranges along the way change as the odometry does: what does not need other sonars.
#ifndef ARGUS_SCALE_H
#define ARGUS_SCALE_H

#include "awareness/facts.h"

// A ping, before it is logged. A sonar that looks along the way is measured by stretches.
// Cost: four products; one pass over the sonars at the end of a stretch.
void argus_scale_take(argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar,
                      const argus_ping_t *now);

#endif
