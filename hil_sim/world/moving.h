// SPDX-License-Identifier: MIT
// The memory that moving.c shares with the Python of people and doors: state.py has the same.
#ifndef ARGUS_SIM_MOVING_H
#define ARGUS_SIM_MOVING_H

#include "body.h"

#include <stdbool.h>
#include <stdint.h>

enum { PERSON = 0, DOOR = 1, ACTORS_MAX = 32 };

typedef struct {
    double x1, y1, x2, y2, length;
} leg_t;

// What a sub-step changes.
typedef struct {
    double x, y, c, s;
    double along, rest_ms, waited_ms, delay_ms, t_ms;
    int32_t leg, sign, unwatched, held;
} moved_t;

typedef struct {
    moved_t now;
    double step_mm, speed, radius, patience_ms, pause_ms;
    double width, closed, open, period_ms, swing_ms, still_ms, ahead_ms;
    const leg_t *legs;
    int32_t legs_count, kind;
    bool yields;
} actor_t;

typedef struct {
    int64_t moment; // sub-steps in which anything moved
    body_t body;    // for which they wait
    actor_t *const *actors;
    int32_t count;
} movers_t;

// What there is to go back to.
typedef struct {
    int64_t moment;
    moved_t actor[ACTORS_MAX];
} moment_t;

// Lets a sub-step pass in which the robot was at `robot`.
void argus_sim_movers_step(movers_t *movers, pose_t robot);

void argus_sim_movers_keep(const movers_t *movers, moment_t *kept);
void argus_sim_movers_restore(movers_t *movers, const moment_t *kept);

#endif
