// SPDX-License-Identifier: MIT
// What SIPs say, and the truth (sightings.py), in C.
#include "sightings.h"

#include "../robot/ring.h"

#include <string.h>

size_t argus_sim_sightings_size(void);

size_t argus_sim_sightings_size(void) {
    return sizeof(sightings_t);
}

// Of a turn of the loop: one SIP is made, and what is on the line is taken.
bool argus_sim_sightings_have_room(const sightings_t *const seen) {
    return seen->rows_count < SIGHTINGS - ON_THE_LINE && seen->readings_count < SEEN_READINGS - KEPT;
}

sighting_t argus_sim_sighting(sightings_t *const seen, const parts_t *const parts) {
    const chassis_t *const chassis = parts->chassis;
    const rows_t *const heard = &parts->ring->heard;
    const sighting_t made = {
        .t_ms = (double)parts->robot->now_ms,
        .x = chassis->x,
        .y = chassis->y,
        .heading = argus_sim_wrapped(chassis->th),
        .first = seen->base + seen->readings_count,
        .count = (int32_t)heard->count,
    };
    memcpy(&seen->readings[seen->readings_count], heard->rows, (size_t)heard->count * sizeof heard->rows[0]);
    seen->readings_count += heard->count;
    return made;
}

static sent_t *sent(sightings_t *const seen, const int64_t k) {
    return &seen->sent[(seen->first + k) % ON_THE_LINE];
}

static void forget(sightings_t *const seen, const int64_t count) {
    seen->first = (seen->first + count) % ON_THE_LINE;
    seen->count -= count;
}

void argus_sim_sighting_sent(sightings_t *const seen, const sighting_t *const made,
                             const uint8_t *const packet, const int32_t length) {
    if (seen->count == ON_THE_LINE) {
        forget(seen, 1);
    }
    sent_t *const last = sent(seen, seen->count++);
    last->row = *made;
    last->length = length;
    memcpy(last->packet, packet, (size_t)length);
}

static bool is_same(const sent_t *const one, const uint8_t *const packet, const int32_t length) {
    return one->length == length && memcmp(one->packet, packet, (size_t)length) == 0;
}

bool argus_sim_sighting_taken(sightings_t *const seen, const parts_t *const parts, const int32_t mode,
                              const uint8_t *const packet, const int32_t length) {
    int64_t k = 0;
    while (k < seen->count && !is_same(sent(seen, k), packet, length)) {
        k++;
    }
    if (k == seen->count) {
        return false;
    }
    const chassis_t *const chassis = parts->chassis;
    sighting_t *const row = &seen->rows[seen->rows_count++];
    *row = sent(seen, k)->row;
    row->mode = mode;
    row->true_x = chassis->x;
    row->true_y = chassis->y;
    row->th = chassis->th;
    row->travelled_mm = chassis->travelled_mm;
    row->v = parts->drive->v;
    row->w = parts->drive->w;
    forget(seen, k + 1);
    return true;
}
