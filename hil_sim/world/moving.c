// SPDX-License-Identifier: MIT
// People and doors (moving.py, body.py) in C: the same sums in the same order, on the same memory.
#include "moving.h"

#include <math.h>
#include <stddef.h>

enum { LOOK_STEPS = 5 };

static const double step_ms = STEP_MS, step_s = (double)STEP_MS / 1000;
static const double ahead_mm = 400.0, leaf_mm = 100.0, robot_mm_s = 2000.0;

// ---- people -----------------------------------------------------------------------------------------------

// Sub-steps in which such a gap cannot close: the next look can wait.
static int32_t steps_until(const actor_t *const self, const double gap_mm) {
    return (int32_t)(gap_mm / ((robot_mm_s + self->speed) * step_s));
}

static bool is_in_the_way(const movers_t *const movers, actor_t *const self, const pose_t robot) {
    moved_t *const now = &self->now;
    const double away = argus_sim_length(robot.x - now->x, robot.y - now->y);
    const double spare = away - movers->body.reach_mm - ahead_mm - self->radius;
    if (spare > 0) {
        now->unwatched = steps_until(self, spare);
        return false;
    }
    const leg_t *const leg = &self->legs[now->leg];
    const double part = now->sign * ahead_mm / leg->length;
    const segment_t ahead = {now->x, now->y, now->x + (leg->x2 - leg->x1) * part,
                             now->y + (leg->y2 - leg->y1) * part};
    const double gap = argus_sim_body_distance(&movers->body, robot, ahead) - self->radius;
    now->unwatched = steps_until(self, gap);
    return gap <= 0;
}

static void wait_for_robot(actor_t *const self) {
    moved_t *const now = &self->now;
    now->held = (now->held != 0 ? now->held : LOOK_STEPS) - 1;
    now->waited_ms += step_ms;
    if (0 < self->patience_ms && self->patience_ms <= now->waited_ms) {
        now->waited_ms = 0.0;
        now->sign = -now->sign;
        now->unwatched = 0;
    }
}

static void turn_corner(actor_t *const self, double over) {
    moved_t *const now = &self->now;
    now->unwatched = 0;
    for (int32_t next = now->leg + now->sign; 0 <= next && next < self->legs_count; next += now->sign) {
        now->leg = next;
        const double length = self->legs[next].length;
        now->along = now->sign > 0 ? over : length - over;
        if (0 <= now->along && now->along <= length) {
            return;
        }
        over -= length;
    }
    now->along = now->sign > 0 ? self->legs[now->leg].length : 0.0;
    now->sign = -now->sign;
    now->rest_ms = self->pause_ms;
}

static void walk(actor_t *const self) {
    moved_t *const now = &self->now;
    const double length = self->legs[now->leg].length;
    now->along += now->sign * self->step_mm;
    if (!(0 <= now->along && now->along <= length)) {
        turn_corner(self, now->sign > 0 ? now->along - length : -now->along);
    }
    const leg_t *const leg = &self->legs[now->leg];
    const double part = now->along / leg->length;
    now->x = leg->x1 + (leg->x2 - leg->x1) * part;
    now->y = leg->y1 + (leg->y2 - leg->y1) * part;
}

static bool step_person(const movers_t *const movers, actor_t *const self, const pose_t robot) {
    moved_t *const now = &self->now;
    now->unwatched--;
    if (now->rest_ms > 0) {
        now->rest_ms -= step_ms;
        return false;
    }
    if (now->held > 0 || (now->unwatched <= 0 && self->yields && is_in_the_way(movers, self, robot))) {
        wait_for_robot(self);
        return false;
    }
    now->waited_ms = 0.0;
    walk(self);
    return true;
}

// ---- doors ------------------------------------------------------------------------------------------------

typedef struct {
    double c, s;
} direction_t;

static direction_t direction(const actor_t *const self, const double at_ms) {
    const double t_ms = fmod(at_ms, self->period_ms);
    const double closing_ms = t_ms - self->swing_ms - self->still_ms;
    const double part =
        closing_ms < 0 ? fmin(t_ms / self->swing_ms, 1.0) : fmax(0.0, 1.0 - closing_ms / self->swing_ms);
    const double angle = (self->closed + (self->open - self->closed) * part) * DEGREE;
    return (direction_t){cos(angle), sin(angle)};
}

static bool is_resting(const actor_t *const self) {
    const double t_ms = fmod(self->now.t_ms, self->period_ms);
    const double shut_ms = self->swing_ms + self->still_ms + self->swing_ms;
    return (self->swing_ms <= t_ms && t_ms <= self->swing_ms + self->still_ms - step_ms) || shut_ms <= t_ms;
}

static bool is_at_leaf(const movers_t *const movers, const actor_t *const self, const pose_t robot,
                       const direction_t way) {
    const moved_t *const now = &self->now;
    const segment_t leaf = {now->x, now->y, now->x + way.c * self->width, now->y + way.s * self->width};
    return argus_sim_body_distance(&movers->body, robot, leaf) <= leaf_mm;
}

static bool is_blocked(const movers_t *const movers, const actor_t *const self, const pose_t robot) {
    const moved_t *const now = &self->now;
    if (argus_sim_length(robot.x - now->x, robot.y - now->y) >
        movers->body.reach_mm + self->width + leaf_mm) {
        return false;
    }
    return is_at_leaf(movers, self, robot, (direction_t){now->c, now->s}) ||
           is_at_leaf(movers, self, robot, direction(self, now->t_ms + self->ahead_ms));
}

static bool step_door(const movers_t *const movers, actor_t *const self, const pose_t robot) {
    moved_t *const now = &self->now;
    if (now->delay_ms > 0) {
        now->delay_ms -= step_ms;
        return false;
    }
    const bool rests = is_resting(self);
    const direction_t then = rests ? (direction_t){now->c, now->s} : direction(self, now->t_ms + step_ms);
    if (then.c == now->c && then.s == now->s) {
        now->t_ms += step_ms;
        return false;
    }
    if (self->yields && is_blocked(movers, self, robot)) {
        return false;
    }
    now->t_ms += step_ms;
    now->c = then.c;
    now->s = then.s;
    return true;
}

// ---- all --------------------------------------------------------------------------------------------------

void argus_sim_movers_step(movers_t *const movers, const pose_t robot) {
    bool moved = false;
    for (int32_t k = 0; k < movers->count; k++) {
        actor_t *const actor = movers->actors[k];
        moved |= actor->kind == PERSON ? step_person(movers, actor, robot) : step_door(movers, actor, robot);
    }
    movers->moment += moved;
}

void argus_sim_movers_keep(const movers_t *const movers, moment_t *const kept) {
    kept->moment = movers->moment;
    for (int32_t k = 0; k < movers->count; k++) {
        kept->actor[k] = movers->actors[k]->now;
    }
}

void argus_sim_movers_restore(movers_t *const movers, const moment_t *const kept) {
    movers->moment = kept->moment;
    for (int32_t k = 0; k < movers->count; k++) {
        movers->actors[k]->now = kept->actor[k];
    }
}
