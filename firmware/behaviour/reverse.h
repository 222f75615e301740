// SPDX-License-Identifier: MIT
// Which end of the robot leads: the rear while the front has failed (profile argus).
#ifndef ARGUS_REVERSE_H
#define ARGUS_REVERSE_H

#include "behaviour/core.h"

// The other end would do better. The one that leads cannot go on, has lost most of its sonars, or is the rear
// though the front is whole. Not twice within 2 m of driving unless it cannot go on; never for an operator's
// step. Cost: one plan.
bool argus_should_turn_about(const argus_t *self);

#endif
