// SPDX-License-Identifier: MIT
// The order in which the sonars fire while some of them are out.
#ifndef ARGUS_FIRING_H
#define ARGUS_FIRING_H

#include "arcos/command.h"
#include "knowledge/knowledge.h"

// The sonars fire in an order of ours, in this session, begun anew at `ordered_ms`.
typedef struct {
    bool ordered;
    uint32_t ordered_ms;
} argus_firing_t;

// POLLING: the slots of those that are out go to those that look ahead. `tries`: each keeps one of its own,
// to show that it does well again.
void argus_firing_share(argus_firing_t *self, const argus_knowledge_t *knowledge, bool tries,
                        argus_outbox_t *out, uint32_t now_ms);

#endif
