// SPDX-License-Identifier: MIT
// Walls put into a grid.
#ifndef TEST_FLOOR_H
#define TEST_FLOOR_H

#include "knowledge/grid.h"

// Between two places of the course: mm.
void draw_wall(argus_grid_t *grid, argus_point_t from, argus_point_t to);

#endif
