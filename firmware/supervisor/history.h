// SPDX-License-Identifier: MIT
// What outlives a mission: the record, and the robot that it is of.
#ifndef ARGUS_HISTORY_H
#define ARGUS_HISTORY_H

#include "behaviour/core.h"

// A session is open: is it the robot of the record? What was taken from another one's is taken back.
void argus_meet_robot(argus_t *self);

#endif
