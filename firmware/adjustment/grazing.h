// SPDX-License-Identifier: MIT
// Smooth walls: one that the robot slants into and the sonars ahead do not hear, one that they hear no more.
#ifndef ARGUS_GRAZING_H
#define ARGUS_GRAZING_H

#include "awareness/pings.h"

// Whether the last pings of a sonar that looks abeam show a wall that the robot slants into. It is so near
// that the body would touch it within `stop_mm` of way. False also when they were not made on a way straight
// ahead of 80 mm or more.
bool argus_grazing_wall(const argus_pings_t *pings, const argus_robot_t *robot, int sonar, int32_t stop_mm);

#endif
