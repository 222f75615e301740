// SPDX-License-Identifier: MIT
// Another robot behind the wire of the one before.
#ifndef ARGUS_ROBOT_CHANGED_H
#define ARGUS_ROBOT_CHANGED_H

#include "behaviour/core.h"

// It is not driven until an operator says so, and nothing of what was known of the other one is kept.
void argus_robot_changed(argus_t *self);

#endif
