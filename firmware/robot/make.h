// SPDX-License-Identifier: MIT
// Makes a robot of a ring that a caller describes.
#ifndef ARGUS_MAKE_H
#define ARGUS_MAKE_H

#include "robot/table.h"

// What is wrong with it, S5 excepted; `own` is whole where nothing is, else unspecified.
argus_ring_report_t argus_robot_make(argus_own_robot_t *own, const argus_ring_t *ring);

#endif
