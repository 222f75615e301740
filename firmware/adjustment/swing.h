// SPDX-License-Identifier: MIT
// S7 for the body itself: whether a turn on the spot would bring it nearer to what is seen.
#ifndef ARGUS_SWING_H
#define ARGUS_SWING_H

#include "knowledge/echoes.h"

// `echoes`: what is remembered, NULL: only what sonars in use hear now. Cost: one pass over both, up to some
// twenty places of the body each.
bool argus_swing_meets(const argus_knowledge_t *knowledge, const argus_echoes_t *echoes, int32_t by_cdeg);

#endif
