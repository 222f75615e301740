// SPDX-License-Identifier: MIT
// Walls put into a grid.
#include "floor.h"

#define PARTS 200

void draw_wall(argus_grid_t *grid, argus_point_t from, argus_point_t to) {
    for (int part = 0; part <= PARTS; part++) {
        const argus_point_t at = {from.x_mm + (to.x_mm - from.x_mm) * part / PARTS,
                                  from.y_mm + (to.y_mm - from.y_mm) * part / PARTS};
        argus_grid_mark(grid, at, true);
    }
}
