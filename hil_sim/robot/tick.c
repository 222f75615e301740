// SPDX-License-Identifier: MIT
// Sub-steps of the robot (robot.py, drive.py, chassis.py) in C: the same sums in the same order, on the same
// memory.
//
// A sub-step in which more happens than a drive between walls that are too far to touch is left to Python.
#include "tick.h"

#include "ring.h"

#include <math.h>
#include <stddef.h>

enum { LOOK_MS = 50 };

static const double step_s = (double)STEP_MS / 1000;

// Which of two Python's min and max return where they are equal decides over the sign of a zero.
static double least(const double a, const double b) {
    return b < a ? b : a;
}

static double most(const double a, const double b) {
    return b > a ? b : a;
}

// ---- speeds -----------------------------------------------------------------------------------------------

static double ramp(const double speed, const double target, const double accel, const double decel) {
    if (speed == target) {
        return speed;
    }
    const bool turns_back = speed * target < 0;
    const bool slower = turns_back || fabs(target) < fabs(speed);
    const double step = (slower ? decel : accel) * step_s;
    const double goal = turns_back ? 0.0 : target;
    return fabs(goal - speed) <= step ? goal : speed + copysign(step, goal - speed);
}

typedef struct {
    double speed;
    bool done;
} approach_t;

static double safe_speed(const double left, const double speed, const double step, const double decel) {
    const double rest = left - speed * step_s / 2;
    return rest > 0 ? sqrt(step * step / 4 + 2 * decel * rest) - step / 2 : 0.0;
}

static approach_t approach_ahead(const double speed, const double left, const double top, const double accel,
                                 const double decel) {
    if (speed < 0) {
        return (approach_t){least(0.0, speed + decel * step_s), false};
    }
    const double step = decel * step_s;
    const double safe = safe_speed(left, speed, step, decel);
    const double fresh =
        speed <= top ? least(least(speed + accel * step_s, top), safe) : least(most(top, speed - step), safe);
    if (fresh < speed - step) {
        return (approach_t){speed - step, false};
    }
    return safe <= 0 || left <= step * step_s / 2 ? (approach_t){0.0, true} : (approach_t){fresh, false};
}

static approach_t approach(const double speed, const double left, const double top, const double accel,
                           const double decel) {
    if (left < 0) {
        const approach_t mirrored = approach_ahead(-speed, -left, top, accel, decel);
        return (approach_t){-mirrored.speed, mirrored.done};
    }
    return approach_ahead(speed, left, top, accel, decel);
}

// ---- the drive --------------------------------------------------------------------------------------------

typedef struct {
    double ds, dth;
    bool moved, turned;
} step_t;

static double ahead(const drive_t *const drive) {
    return drive->move_mode ? drive->move_left : drive->v_set;
}

static bool has_set_point(const drive_t *const drive) {
    const double rotation = drive->head_mode ? drive->head_left : drive->w_set;
    return ahead(drive) != 0 || rotation != 0;
}

static step_t as_wheels_turn(const parts_t *const parts, const double ds, const double dth, const bool moved,
                             const bool turned) {
    const double left = parts->drive->left_part, right = parts->drive->right_part;
    if (left == right && right == 1.0) {
        return (step_t){ds, dth, moved, turned};
    }
    const double half = dth * DEGREE * parts->track_mm / 2;
    const double made_left = (ds - half) * left, made_right = (ds + half) * right;
    return (step_t){(made_left + made_right) / 2, (made_right - made_left) / parts->track_mm / DEGREE, moved,
                    turned};
}

static step_t brake(const parts_t *const parts, const double decel, const double rdecel) {
    drive_t *const drive = parts->drive;
    const double v_old = drive->v, w_old = drive->w;
    drive->v = ramp(v_old, 0.0, 0.0, decel);
    drive->w = ramp(w_old, 0.0, 0.0, rdecel);
    return as_wheels_turn(parts, (v_old + drive->v) / 2 * step_s, (w_old + drive->w) / 2 * step_s, false,
                          false);
}

static approach_t channel(const bool to_place, const double speed, const double left, const double set,
                          const double top, const double accel, const double decel) {
    if (to_place) {
        return approach(speed, left, top, accel, decel);
    }
    return (approach_t){ramp(speed, most(-top, least(top, set)), accel, decel), false};
}

static step_t follow(const parts_t *const parts) {
    drive_t *const drive = parts->drive;
    const settings_t *const s = parts->settings;
    const double v_old = drive->v, w_old = drive->w;
    const approach_t v =
        channel(drive->move_mode, v_old, drive->move_left, drive->v_set, s->v_max, s->accel, s->decel);
    const approach_t w =
        channel(drive->head_mode, w_old, drive->head_left, drive->w_set, s->rv_max, s->raccel, s->rdecel);
    drive->v = v.speed;
    drive->w = w.speed;
    const double ds = v.done ? drive->move_left : (v_old + drive->v) / 2 * step_s;
    const double dth = w.done ? drive->head_left : (w_old + drive->w) / 2 * step_s;
    return as_wheels_turn(parts, ds, dth, v.done, w.done);
}

static void done(drive_t *const drive, const step_t *const step) {
    if (drive->move_mode) {
        drive->move_left = step->moved ? 0.0 : drive->move_left - step->ds;
    }
    if (drive->head_mode && drive->head_left != 0) {
        drive->head_left = step->turned ? 0.0 : drive->head_left - step->dth;
    }
}

// ---- stalls -----------------------------------------------------------------------------------------------

static bool watchdog_expired(const parts_t *const parts) {
    const robot_t *const robot = parts->robot;
    return robot->connected && robot->watchdog_stops &&
           robot->now_ms - robot->last_heard_ms > parts->watchdog_ms;
}

bool argus_sim_wants_motion(const parts_t *const parts) {
    return parts->drive->motors && !watchdog_expired(parts) && has_set_point(parts->drive);
}

int32_t argus_sim_front_pressed(const parts_t *const parts) {
    const int32_t pressed = parts->chassis->contact_front | parts->robot->fault_bumpers;
    return parts->robot->bumpers ? pressed & parts->bumper_mask : 0;
}

int32_t argus_sim_rear_pressed(const parts_t *const parts) {
    return parts->robot->rear_segments ? parts->chassis->contact_rear & parts->bumper_mask : 0;
}

static bool bumper_stalls(const parts_t *const parts) {
    const int32_t stalls = parts->settings->bumpstall;
    const double way = ahead(parts->drive);
    if (way > 0) {
        return argus_sim_front_pressed(parts) && (stalls & parts->stalls_front);
    }
    return way < 0 && argus_sim_rear_pressed(parts) && (stalls & parts->stalls_rear);
}

static bool is_relaxed(const parts_t *const parts) {
    stall_t *const stall = parts->stall;
    if (parts->robot->now_ms < stall->relax_until_ms) {
        return true;
    }
    const bool hit = bumper_stalls(parts);
    if (hit || stall->left || stall->right) {
        stall->left = stall->right = hit;
        stall->seen_left |= hit;
        stall->seen_right |= hit;
    }
    return hit;
}

// ---- the way ----------------------------------------------------------------------------------------------

// False: a solid is so near that one must look.
static bool displace(const parts_t *const parts, const step_t *const step) {
    chassis_t *const chassis = parts->chassis;
    const double ds = step->ds, dth = step->dth;
    const double true_ds = ds * chassis->true_distance;
    const double true_dth = dth * chassis->true_turn + ds * chassis->drift_deg_mm;
    chassis->free_mm -= fabs(true_ds) + fabs(true_dth) * DEGREE * parts->swing_mm;
    if (chassis->free_mm <= 0) {
        return false;
    }
    const double middle = (chassis->th + true_dth / 2) * DEGREE;
    chassis->x += true_ds * cos(middle);
    chassis->y += true_ds * sin(middle);
    chassis->th += true_dth;
    const double seen = (chassis->odo_th + dth / 2) * DEGREE;
    chassis->odo_x += ds * cos(seen);
    chassis->odo_y += ds * sin(seen);
    chassis->odo_th += dth;
    const double half = dth * DEGREE * parts->track_mm / 2;
    chassis->left_mm += ds - half;
    chassis->right_mm += ds + half;
    chassis->travelled_mm += fabs(true_ds);
    return true;
}

wheels_t argus_sim_wheels(const parts_t *const parts) {
    const drive_t *const drive = parts->drive;
    const double half = drive->w * DEGREE * parts->track_mm / 2;
    return (wheels_t){(drive->v - half) * drive->left_part, (drive->v + half) * drive->right_part};
}

static void draw_energy(const parts_t *const parts, const double v_old, const double w_old) {
    const drive_t *const drive = parts->drive;
    const wheels_t wheels = argus_sim_wheels(parts);
    const double wheels_mm = (fabs(wheels.left) + fabs(wheels.right)) * step_s;
    parts->energy->wheel_m += wheels_mm / 1000;
    const double turning = parts->inertia * (drive->w * drive->w - w_old * w_old) * parts->rad2 / 2;
    const double gained = parts->mass_kg * (drive->v * drive->v - v_old * v_old) / 2e6 + turning;
    if (gained > 0) {
        parts->energy->accel_j += gained * parts->accel_factor;
    }
}

static bool go(const parts_t *const parts) {
    drive_t *const drive = parts->drive;
    const settings_t *const settings = parts->settings;
    const double v_old = drive->v, w_old = drive->w;
    const bool coasts = !drive->motors || is_relaxed(parts);
    const step_t step = coasts                    ? brake(parts, parts->accel_top, parts->rotaccel_top)
                        : watchdog_expired(parts) ? brake(parts, settings->decel, settings->rdecel)
                                                  : follow(parts);
    if (step.ds != 0 || step.dth != 0) {
        if (!displace(parts, &step)) {
            return false;
        }
        parts->stall->blocked_ms = 0;
        done(drive, &step);
    }
    draw_energy(parts, v_old, w_old);
    return true;
}

// Whether what moves may have come to the robot at rest, which Python looks for now and then.
static bool is_to_look(const parts_t *const parts) {
    const drive_t *const drive = parts->drive;
    return parts->movers != NULL && drive->v == 0 && drive->w == 0 && parts->robot->now_ms % LOOK_MS == 0 &&
           !(parts->chassis->free_mm > 0);
}

static bool move(const parts_t *const parts) {
    const drive_t *const drive = parts->drive;
    if (drive->v != 0 || drive->w != 0 || argus_sim_wants_motion(parts)) {
        return go(parts);
    }
    if (parts->stall->left || parts->stall->right) {
        parts->stall->left = parts->stall->right = false;
    }
    return true;
}

static void remember(chassis_t *const chassis) {
    const int32_t at = chassis->kept_at = (chassis->kept_at + 1) % HISTORY;
    chassis->kept[3 * at] = chassis->x;
    chassis->kept[3 * at + 1] = chassis->y;
    chassis->kept[3 * at + 2] = chassis->th;
    chassis->kept_count += chassis->kept_count < HISTORY;
}

// ---- time -------------------------------------------------------------------------------------------------

// Whether something has come that a fault waits for.
static bool is_awaited(const parts_t *const parts) {
    const chassis_t *const chassis = parts->chassis;
    const double here[] = {(double)parts->robot->now_ms, chassis->x, chassis->y, chassis->travelled_mm};
    for (int32_t k = 0; k < parts->waits; k++) {
        const wait_t *const wait = &parts->wait[k];
        const double beyond = here[wait->variable] - wait->value;
        if (wait->variable == 0 ? beyond >= 0 : beyond * wait->sign > 0) {
            return true;
        }
    }
    return false;
}

static void let_others_move(const parts_t *const parts, moment_t *const before) {
    if (parts->movers == NULL) {
        return;
    }
    chassis_t *const chassis = parts->chassis;
    argus_sim_movers_keep(parts->movers, before);
    argus_sim_movers_step(parts->movers, (pose_t){chassis->x, chassis->y, argus_sim_wrapped(chassis->th)});
    chassis->free_mm -= parts->closing_mm;
}

// False: nothing has happened, and Python has to let this sub-step pass.
static bool tick(const parts_t *const parts) {
    robot_t *const robot = parts->robot;
    const bool rings = parts->sonar_on && robot->fires_in_turn;
    if (rings && !argus_sim_can_fire(parts, (double)(robot->now_ms + STEP_MS))) {
        return false;
    }
    const drive_t drive = *parts->drive;
    const stall_t stall = *parts->stall;
    const chassis_t *const chassis = parts->chassis;
    const double before[] = {chassis->x,       chassis->y,           chassis->th,      chassis->odo_x,
                             chassis->odo_y,   chassis->odo_th,      chassis->left_mm, chassis->right_mm,
                             chassis->free_mm, chassis->travelled_mm};
    const energy_t energy = *parts->energy;
    moment_t moment;
    robot->now_ms += STEP_MS;
    let_others_move(parts, &moment);
    if (!move(parts) || is_to_look(parts) || is_awaited(parts)) {
        robot->now_ms -= STEP_MS;
        *parts->drive = drive;
        *parts->stall = stall;
        *parts->energy = energy;
        chassis_t *const back = parts->chassis;
        back->x = before[0], back->y = before[1], back->th = before[2];
        back->odo_x = before[3], back->odo_y = before[4], back->odo_th = before[5];
        back->left_mm = before[6], back->right_mm = before[7];
        back->free_mm = before[8], back->travelled_mm = before[9];
        if (parts->movers != NULL) {
            argus_sim_movers_restore(parts->movers, &moment);
        }
        return false;
    }
    remember(parts->chassis);
    parts->energy->idle_s += step_s;
    if (parts->sonar_on) {
        parts->energy->sonar_s += step_s;
    }
    if (rings) {
        argus_sim_ring_advance(parts, (double)robot->now_ms);
    }
    return true;
}

bool argus_sim_run(const parts_t *const parts, const double stop_ms, const double limit_ms) {
    robot_t *const robot = parts->robot;
    while ((double)(robot->now_ms + STEP_MS) <= limit_ms) {
        if (!parts->ready || !tick(parts)) {
            return false;
        }
        if ((double)robot->now_ms >= stop_ms) {
            break;
        }
    }
    return true;
}
