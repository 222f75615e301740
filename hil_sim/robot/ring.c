// SPDX-License-Identifier: MIT
// The sonar ring (hil_sim/sonar/ring.py) in C: schedule, draws, noise and crosstalk in the same order.
#include "ring.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

static const double sound_mm_ms = 343.0, step_ms = STEP_MS;

static bool is_afflicted(const parts_t *const parts, const array_t *const array, const double now_ms) {
    const int32_t number = array->numbers[array->place];
    return !(array->next_ms > now_ms) && (number >= 64 || (parts->afflicted >> number & 1) != 0);
}

bool argus_sim_can_fire(const parts_t *const parts, const double now_ms) {
    const ring_t *const ring = parts->ring;
    if (now_ms - ring->last_ms > (double)parts->resume_ms || ring->heard.count > KEPT / 2 ||
        ring->under_way.count > KEPT / 2) {
        return false;
    }
    if (now_ms < ring->fire_ms) {
        return true;
    }
    for (int32_t k = 0; k < ring->lives; k++) {
        if (is_afflicted(parts, &ring->arrays[ring->live_at[k]], now_ms)) {
            return false;
        }
    }
    return (double)ring->cycle_ms >= step_ms; // else a sonar not looked at might fire as well
}

// Python's remainder has the sign of the divisor.
double argus_sim_wrapped(const double degrees) {
    if (-180 < degrees && degrees <= 180) {
        return degrees;
    }
    double rest = fmod(180 - degrees, 360);
    if (rest < 0) {
        rest += 360;
    }
    return 180 - rest;
}

static pose_t kept(const chassis_t *const chassis, const int32_t back) {
    const int32_t at = 3 * ((chassis->kept_at - back + HISTORY) % HISTORY);
    return (pose_t){chassis->kept[at], chassis->kept[at + 1], chassis->kept[at + 2]};
}

static pose_t pose_at(const chassis_t *const chassis, const double back_ms) {
    if (back_ms == 0) {
        return (pose_t){chassis->x, chassis->y, argus_sim_wrapped(chassis->th)};
    }
    const double back = fmin(fmax(back_ms, 0.0) / step_ms, chassis->kept_count - 1.0);
    const int32_t k = (int32_t)back;
    const double part = back - k;
    pose_t here = kept(chassis, k);
    if (part > 0) {
        const pose_t before = kept(chassis, k + 1);
        here.x += (before.x - here.x) * part;
        here.y += (before.y - here.y) * part;
        here.th += (before.th - here.th) * part;
    }
    here.th = argus_sim_wrapped(here.th);
    return here;
}

// What moves, where it is now.
static const patch_t *others_now(const parts_t *const parts) {
    const movers_t *const movers = parts->movers;
    others_t *const others = parts->others;
    if (movers == NULL) {
        return NULL;
    }
    if (others->moment != movers->moment) {
        others->moment = movers->moment;
        for (int32_t k = 0; k < movers->count; k++) {
            const moved_t *const now = &movers->actors[k]->now;
            double *const place = &others->places[4 * k];
            place[0] = now->x, place[1] = now->y, place[2] = now->c, place[3] = now->s;
        }
        argus_sim_place(others->here, others->shape, others->owner, others->corner_owner, others->places);
    }
    return others->here;
}

static int32_t true_range(const parts_t *const parts, const int32_t number, const pose_t at) {
    const patch_t *const others = others_now(parts);
    int32_t range = argus_sim_echo_ping(parts->echo, number, at.x, at.y, at.th, 0.0, 0.0, others);
    if (range == UNKNOWN_CELL) {
        const double heading = at.th * DEGREE;
        const double *const mount = &parts->mount[3 * number];
        const double c = cos(heading), s = sin(heading);
        parts->learn(at.x + mount[0] * c - mount[1] * s, at.y + mount[0] * s + mount[1] * c);
        range = argus_sim_echo_ping(parts->echo, number, at.x, at.y, at.th, 0.0, 0.0, others);
    }
    if (range < 0) {
        abort(); // no memory
    }
    return range;
}

static int32_t heard(const parts_t *const parts, const int32_t true_mm) {
    const double noise = parts->normal(parts->bitgen);
    const double chance = parts->bitgen->next_double(parts->bitgen->state);
    const double where = parts->bitgen->next_double(parts->bitgen->state);
    double value = (double)true_mm;
    if (value < parts->no_echo_mm) {
        value += noise * (parts->noise_mm + parts->noise_part * value);
    }
    if (chance < parts->crosstalk) {
        value = parts->min_mm + where * (value - parts->min_mm);
    }
    if (2 * value / sound_mm_ms > (double)parts->ring->cycle_ms) {
        value = parts->no_echo_mm;
    }
    return (int32_t)fmin(fmax(rint(value), parts->min_mm), parts->no_echo_mm);
}

static void fire(const parts_t *const parts, array_t *const array, const double t_ms, const double now_ms) {
    ring_t *const ring = parts->ring;
    array->next_ms = t_ms + (double)ring->cycle_ms;
    if (ring->quiet) {
        return;
    }
    const int32_t number = array->numbers[array->place];
    array->place = (array->place + 1) % array->count;
    array->last_ms = t_ms;
    array->last_number = number;
    const int32_t true_mm = true_range(parts, number, pose_at(parts->chassis, now_ms - t_ms));
    const int32_t value = heard(parts, true_mm);
    const double ready_ms = t_ms + fmin(2 * value / sound_mm_ms, (double)ring->cycle_ms);
    ring->under_way.rows[ring->under_way.count++] = (reading_t){ready_ms, number, value, true_mm, 0};
    ring->ready_ms = fmin(ready_ms, ring->ready_ms);
}

static void fire_due(const parts_t *const parts, const double now_ms) {
    ring_t *const ring = parts->ring;
    for (int32_t k = 0; k < ring->lives; k++) {
        array_t *const array = &ring->arrays[ring->live_at[k]];
        array->next_ms = isnan(array->next_ms) ? now_ms : array->next_ms;
    }
    ring->fire_ms = INFINITY;
    while (ring->lives > 0) {
        array_t *first = &ring->arrays[ring->live_at[0]];
        for (int32_t k = 1; k < ring->lives; k++) {
            array_t *const other = &ring->arrays[ring->live_at[k]];
            first = other->next_ms < first->next_ms ? other : first;
        }
        ring->fire_ms = first->next_ms;
        if (ring->fire_ms > now_ms) {
            return;
        }
        fire(parts, first, ring->fire_ms, now_ms);
    }
}

// Behind those that are as early or earlier.
static void insert(rows_t *const rows, const int64_t first, const reading_t reading) {
    int64_t at = rows->count++;
    for (; at > first && rows->rows[at - 1].t_ms > reading.t_ms; at--) {
        rows->rows[at] = rows->rows[at - 1];
    }
    rows->rows[at] = reading;
}

void argus_sim_ring_advance(const parts_t *const parts, const double now_ms) {
    ring_t *const ring = parts->ring;
    ring->last_ms = now_ms;
    if (now_ms >= ring->fire_ms) {
        fire_due(parts, now_ms);
    }
    if (now_ms < ring->ready_ms) {
        return;
    }
    const int64_t first = ring->heard.count;
    rows_t *const under_way = &ring->under_way;
    int64_t left = 0;
    ring->ready_ms = INFINITY;
    for (int64_t k = 0; k < under_way->count; k++) {
        const reading_t reading = under_way->rows[k];
        if (reading.t_ms <= now_ms) {
            insert(&ring->heard, first, reading);
        } else {
            under_way->rows[left++] = reading;
            ring->ready_ms = fmin(ring->ready_ms, reading.t_ms);
        }
    }
    under_way->count = left;
}
