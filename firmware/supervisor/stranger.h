// SPDX-License-Identifier: MIT
// Another robot behind the wire of the one before.
#ifndef ARGUS_STRANGER_H
#define ARGUS_STRANGER_H

#include "behaviour/core.h"

// It is not driven until an operator says so, and nothing of what was known of the other one is kept.
void argus_meet_stranger(argus_t *self);

#endif
