// SPDX-License-Identifier: MIT
// The memory that tick.c shares with the Python of robot and ring: state.py has the same in both rooms.
#ifndef ARGUS_SIM_TICK_H
#define ARGUS_SIM_TICK_H

#include "../sonar/echo.h"
#include "../world/moving.h"

#include <stdbool.h>
#include <stdint.h>

enum { HISTORY = 64, ARRAYS = 4, ORDER = 16, KEPT = 128 };

typedef struct {
    double v_max, rv_max, accel, decel, raccel, rdecel;
    int32_t bumpstall;
} settings_t;

typedef struct {
    double v, w, v_set, w_set, move_left, head_left, head_set, left_part, right_part;
    bool motors, move_mode, head_mode, vel2;
} drive_t;

typedef struct {
    double x, y, th, odo_x, odo_y, odo_th, left_mm, right_mm;
    double travelled_mm, free_mm, true_distance, true_turn, drift_deg_mm;
    double kept[3 * HISTORY];
    int32_t contact_front, contact_rear, kept_at, kept_count;
} chassis_t;

typedef struct {
    int64_t blocked_ms, relax_until_ms;
    bool left, right, seen_left, seen_right;
} stall_t;

typedef struct {
    double idle_s, sonar_s, wheel_m, accel_j;
} energy_t;

typedef struct {
    int64_t now_ms, last_heard_ms;
    int32_t bumpers, rear_segments, fault_bumpers, anport;
    bool connected, watchdog_stops, fires_in_turn;
} robot_t;

typedef struct {
    double next_ms, last_ms; // next_ms: NaN until it is known
    int32_t last_number, place, count;
    int32_t numbers[ORDER];
} array_t;

typedef struct {
    double t_ms;
    int32_t number, range_mm, true_mm, kind;
} reading_t;

typedef struct {
    int64_t count;
    reading_t rows[KEPT];
} rows_t;

typedef struct {
    int64_t cycle_ms;
    double fire_ms, ready_ms, last_ms;
    array_t arrays[ARRAYS];
    int32_t live_at[ARRAYS];
    int32_t lives;
    bool quiet;
    rows_t under_way, heard;
} ring_t;

// A generator of numpy's, as it lets C use it.
typedef struct {
    void *state;
    uint64_t (*next_uint64)(void *state);
    uint32_t (*next_uint32)(void *state);
    double (*next_double)(void *state);
    uint64_t (*next_raw)(void *state);
} bitgen_t;

// What a fault waits for: of t, x, y and the way driven; Python looks at it once it has come.
typedef struct {
    double value, sign;
    int32_t variable;
} wait_t;

// What is heard of people and doors (patch.py), as they were at a moment.
typedef struct {
    int64_t moment;
    patch_t *here;
    const patch_t *shape;
    const int32_t *owner, *corner_owner;
    double *places;
} others_t;

enum { WAITS = 32 };

// A robot in a world, and what of its tables a sub-step asks for.
typedef struct {
    robot_t *robot;
    drive_t *drive;
    settings_t *settings;
    chassis_t *chassis;
    stall_t *stall;
    energy_t *energy;
    ring_t *ring;
    echo_t *echo;
    bitgen_t *bitgen;
    double (*normal)(bitgen_t *bitgen);
    void (*learn)(double x, double y); // the cell at a place is unknown to the echo model
    movers_t *movers;                  // NULL: nothing moves but the robot
    others_t *others;
    double closing_mm; // by which the nearest of them comes nearer in a sub-step, at most
    double swing_mm, track_mm, accel_top, rotaccel_top;
    double mass_kg, inertia, rad2, accel_factor;
    double noise_mm, noise_part, crosstalk, min_mm, no_echo_mm;
    const double *mount; // x, y, heading of each sonar
    int64_t watchdog_ms, resume_ms;
    int32_t bumper_mask, stalls_front, stalls_rear, waits;
    uint64_t afflicted; // sonars whose pings Python makes
    wait_t wait[WAITS];
    bool sonar_on, ready; // ready: false: each sub-step is for Python
} parts_t;

// Lets sub-steps pass until `stop_ms`, none beyond `limit_ms`; false: the next one is for Python.
bool argus_sim_run(const parts_t *parts, double stop_ms, double limit_ms);

// The drive is on, heard of its client of late, and has somewhere to go.
bool argus_sim_wants_motion(const parts_t *parts);

// Segments of the bumpers that are pressed, as the robot reports them.
int32_t argus_sim_front_pressed(const parts_t *parts);
int32_t argus_sim_rear_pressed(const parts_t *parts);

// How fast the wheels turn, mm/s.
typedef struct {
    double left, right;
} wheels_t;

wheels_t argus_sim_wheels(const parts_t *parts);

#endif
