// SPDX-License-Identifier: MIT
// A robot with a laser in its middle, whose sectors stand behind its sonars.
#ifndef TEST_SECTORS_H
#define TEST_SECTORS_H

#include "knowledge/knowledge.h"
#include "robot/table.h"

// Makes `own` a robot of `sonars` sonars, all ahead in the middle, and `count` sectors of `width_deg` from
// left to right about straight ahead; `k` is of it. Its cones: 30 degrees.
void sectors_begin(argus_own_robot_t *own, argus_knowledge_t *k, int sonars, int count, int width_deg);

#endif
