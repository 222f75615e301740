// SPDX-License-Identifier: MIT
// An occupancy grid that goes with the robot: where echoes were heard, less where beams passed since
// (histogrammic in-motion mapping: J. Borenstein, Y. Koren, IEEE Trans. Robotics and Automation 7(4), 1991).
#ifndef ARGUS_GRID_H
#define ARGUS_GRID_H

#include "knowledge/knowledge.h"

#define ARGUS_GRID_CELLS 64 // to a side: a row of cells is a word of 64 bits
#define ARGUS_GRID_CELL_MM 125
#define ARGUS_PLACED_MM 1000 // an echo from so near tells its place; a far one lies somewhere in a wide cone

// A cell of the course frame: x_mm / ARGUS_GRID_CELL_MM, rounded down, and the same of y.
typedef struct {
    int32_t x;
    int32_t y;
} argus_cell_t;

typedef struct {
    argus_cell_t low;                                       // of the window, whose middle the robot is near
    argus_point_t abeam[2];                                 // the last echo of a flank, right and left
    uint8_t level[ARGUS_GRID_CELLS * ARGUS_GRID_CELLS / 2]; // two cells to a byte, 0 to 15
} argus_grid_t;

void argus_grid_init(argus_grid_t *self);

// Everything is free again.
void argus_grid_clear(argus_grid_t *self);

// After each SIP the window follows the robot, and what enters it is free. Every fresh reading lowers the
// cells that its axis passed and raises the one of its echo, unless something known at an end of the arc of
// its cone explains it. Sonars out of use and suspects do not count.
// Readings taken in a turn do not count. A wall beside the robot is taken to go on: no sonar hears it ahead.
// Cost: 19 cells a reading.
void argus_grid_see(argus_grid_t *self, const argus_knowledge_t *knowledge);

// Something is there: for sure, or until some beams have passed there.
void argus_grid_mark(argus_grid_t *self, argus_point_t at, bool sure);

// Half of all evidence is forgotten: what is not seen again is free soon.
void argus_grid_fade(argus_grid_t *self);

argus_cell_t argus_grid_cell(argus_point_t at);
argus_point_t argus_grid_centre(argus_cell_t cell);

// Whether a cell is in the window.
bool argus_grid_is_inside(const argus_grid_t *self, argus_cell_t cell);

// Whether something stands there; false outside the window. A whole row of the window, bit x for the cell
// low.x + x; 0 <= row < ARGUS_GRID_CELLS.
bool argus_grid_is_occupied(const argus_grid_t *self, argus_cell_t cell);
uint64_t argus_grid_row(const argus_grid_t *self, int row);

#endif
