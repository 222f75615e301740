// SPDX-License-Identifier: MIT
// The way to a waypoint over the grid: a wave from the waypoint to the robot through what is free (the
// distance transform: R. A. Jarvis, 1984; C. Y. Lee, 1961), followed back, and its first straight part.
#ifndef ARGUS_WAY_H
#define ARGUS_WAY_H

#include "knowledge/grid.h"

// Room for the wave: a bit for each cell, rows as in argus_grid_row().
typedef struct {
    uint64_t wide[ARGUS_GRID_CELLS];     // the robot may stand there and turn
    uint64_t narrow[ARGUS_GRID_CELLS];   // ... pass
    uint64_t reached[ARGUS_GRID_CELLS];  // the wave has come
    uint64_t label[4][ARGUS_GRID_CELLS]; // ... when: 1 to 15 in turn, 0: not yet
} argus_wave_t;

typedef struct {
    argus_point_t to;
    int32_t to_go_mm; // from its end to the waypoint, about
    bool direct;      // `to` is the waypoint
    bool narrow;      // there is no room to turn on all of it
} argus_leg_t;

typedef struct {
    const argus_knowledge_t *knowledge;
    const argus_grid_t *grid;
    bool stopped; // something is so near that the robot cannot go on ahead
} argus_ground_t;

// The first leg of the way. What is not known is free. A waypoint outside the window is made for from that
// cell of its border from which the whole way is shortest. False: no way. Cost: a pass over the rows for each
// 100 mm of way, 1000 at most; some 30 us on a PC, some ms on a Cortex-M4.
bool argus_way_find(argus_wave_t *wave, const argus_ground_t *ground, argus_point_t waypoint,
                    argus_leg_t *leg);

// Whether what is known by now leaves the next metre of a leg free. Cost: at most 11 places of 37 cells.
bool argus_way_is_free(const argus_ground_t *ground, const argus_leg_t *leg);

#endif
