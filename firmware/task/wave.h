// SPDX-License-Identifier: MIT
// A wave from a waypoint to the robot through what is free (the distance transform: R. A. Jarvis, 1984; C. Y.
// Lee, 1961), a step at a time.
#ifndef ARGUS_WAVE_H
#define ARGUS_WAVE_H

#include "knowledge/grid.h"

#define ARGUS_WAVE_LABELS 15 // neighbours are at most seven steps of the wave apart
#define ARGUS_WAVE_PLANES 4
#define ARGUS_WAVE_OUT_MM \
    450 // about the robot and the waypoint less room will do: it may have to get out there
#define ARGUS_WAVE_MEMORY 8 // steps after which a row where nothing new came is at rest

typedef struct {
    const argus_knowledge_t *knowledge;
    const argus_grid_t *grid;
    bool stopped; // something is so near that the robot cannot go on ahead
} argus_ground_t;

// A bit for each cell, rows as in argus_grid_row(). Cells are counted from the window's lowest one.
typedef struct {
    argus_cell_t low;  // the window's lowest cell
    argus_cell_t from; // the waypoint
    argus_cell_t to;   // the robot
    int32_t beyond;    // cells from the waypoint to the window, 0: it is inside
    int32_t step;      // the next one; the way has one less when the wave is there
    int32_t spread[4]; // how far from its foot it has come along a side of the window, from outside
    uint64_t moved[ARGUS_WAVE_MEMORY];                   // rows that a step brought new cells
    uint64_t wide[ARGUS_GRID_CELLS];                     // the robot may stand there and turn
    uint64_t narrow[ARGUS_GRID_CELLS];                   // ... pass
    uint64_t reached[ARGUS_GRID_CELLS];                  // the wave has come
    uint64_t label[ARGUS_WAVE_PLANES][ARGUS_GRID_CELLS]; // ... when: 1 to 15 in turn, 0: not yet
} argus_wave_t;

typedef enum { ARGUS_WAVE_SPREADS, ARGUS_WAVE_THERE, ARGUS_WAVE_DEAD } argus_wave_news_t;

bool argus_wave_is_within(argus_cell_t cell);

// What is passable, from what is known now; the robot is in the window. Cost: some 100,000 instructions.
void argus_wave_begin(argus_wave_t *self, const argus_ground_t *ground, argus_point_t waypoint);

// One step. `work` grows by what it costs, in units of some 100 instructions of a Cortex-M4; at most 500.
argus_wave_news_t argus_wave_spread(argus_wave_t *self, int32_t *work);

// 1 to 15 in turn: the step that came to a cell; 0: none has.
unsigned argus_wave_label(const argus_wave_t *self, argus_cell_t cell);

// How near things may be where the robot passes, and where it turns.
int32_t argus_wave_narrow_mm(const argus_knowledge_t *knowledge);
int32_t argus_wave_wide_mm(const argus_knowledge_t *knowledge);

// Cells to either side in a row `dy` rows off that are within the radius; -1: none.
int argus_wave_reach(int32_t radius_mm, int dy);

#endif
