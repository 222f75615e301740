// SPDX-License-Identifier: MIT
// What each sonar saw lately, from where and on which bearing.
#include <stddef.h>

#include "awareness/evidence_said.h"
#include "knowledge/angle.h"

#define SAME_LATERAL_MM 60
#define SAME_ALONG_MM 200
#define ALIKE_PLACE_MM 5
#define ALIKE_CDEG 30
#define ALIKE_MM 30

_Static_assert(ARGUS_GLIMPSES <= 64, "weighed has a bit for each");

static int32_t bearing_between(const argus_glimpse_t *const a, const argus_glimpse_t *const b) {
    const int32_t diff = a->bearing_cdeg - b->bearing_cdeg;
    const int32_t size = diff < 0 ? -diff : diff;
    return size > 18000 ? 36000 - size : size;
}

int32_t argus_seen_bearing_cdeg(const argus_glimpse_t *const a, const argus_glimpse_t *const b) {
    return bearing_between(a, b);
}

bool argus_seen_from(const argus_glimpse_t *const now, const argus_glimpse_t *const then,
                     int32_t *const along_mm) {
    const int32_t dx = argus_trail_offset_mm(now->x_mm, then->x_mm);
    const int32_t dy = argus_trail_offset_mm(now->y_mm, then->y_mm);
    if (argus_abs(dx) > SAME_ALONG_MM || argus_abs(dy) > SAME_ALONG_MM) {
        return false;
    }
    const argus_shift_t shift = argus_pair_shift(dx, dy, now->bearing_cdeg);
    *along_mm = shift.along_mm;
    return shift.lateral_mm <= SAME_LATERAL_MM;
}

static unsigned slot_of(const argus_peer_t *const self, const int back) {
    return (self->next + ARGUS_GLIMPSES - (unsigned)back) % ARGUS_GLIMPSES;
}

const argus_glimpse_t *argus_seen_at(const argus_peer_t *const self, const int back) {
    return back <= self->count ? &self->seen[slot_of(self, back)] : NULL;
}

const argus_glimpse_t *argus_seen_before(const argus_peer_t *const self, const int back, const int firings) {
    int left = firings;
    for (int i = back; i <= self->count; i++) {
        const argus_glimpse_t *const at = argus_seen_at(self, i);
        if (left <= at->repeats) {
            return at;
        }
        left -= at->repeats + 1;
    }
    return NULL;
}

int argus_seen_find(const argus_peer_t *const self, const argus_gaze_t *const gaze, const int after,
                    int32_t *const along_mm) {
    for (int i = after + 1; i <= self->count; i++) {
        const argus_glimpse_t *const then = &self->seen[slot_of(self, i)];
        if (gaze->now_ms - then->t_ms > gaze->age_ms) {
            return 0; // those before it are older still
        }
        if (bearing_between(gaze->at, then) <= gaze->span_cdeg && argus_seen_from(gaze->at, then, along_mm)) {
            return i;
        }
    }
    return 0;
}

bool argus_seen_is_weighed(const argus_peer_t *const self, const int back) {
    return (self->weighed >> slot_of(self, back) & 1u) != 0;
}

void argus_seen_weigh(argus_peer_t *const self, const int back) {
    self->weighed |= (uint64_t)1 << slot_of(self, back);
}

static bool is_alike(const argus_glimpse_t *const a, const argus_glimpse_t *const b) {
    const bool as_loud = (a->reading_mm >= ARGUS_NO_ECHO_MM) == (b->reading_mm >= ARGUS_NO_ECHO_MM);
    return as_loud && argus_abs(a->reading_mm - b->reading_mm) <= ALIKE_MM &&
           argus_seen_bearing_cdeg(a, b) <= ALIKE_CDEG &&
           argus_abs(argus_trail_offset_mm(a->x_mm, b->x_mm)) <= ALIKE_PLACE_MM &&
           argus_abs(argus_trail_offset_mm(a->y_mm, b->y_mm)) <= ALIKE_PLACE_MM;
}

// Nobody asks for them any more, and after 49 days they would look new.
static void drop_old(argus_peer_t *const self, const uint32_t now_ms) {
    while (self->count > 0 && now_ms - self->seen[slot_of(self, self->count)].t_ms > ARGUS_REMEMBERED_MS) {
        self->count--;
    }
}

// A robot at rest would fill the memory with one view. The first of those that are alike stays, since each
// could be a little aside of the one before.
void argus_seen_note(argus_peer_t *const self, const argus_glimpse_t now) {
    drop_old(self, now.t_ms);
    argus_glimpse_t *const last = &self->seen[slot_of(self, 1)];
    if (self->count > 0 && is_alike(&now, last)) {
        last->t_ms = now.t_ms;
        last->repeats = (uint16_t)argus_min(last->repeats + 1, UINT16_MAX);
    } else {
        self->seen[self->next] = now;
        self->next = (uint8_t)((self->next + 1) % ARGUS_GLIMPSES);
        self->count = (uint8_t)argus_min(self->count + 1, ARGUS_GLIMPSES);
    }
    self->weighed &= ~((uint64_t)1 << slot_of(self, 1));
}

void argus_seen_forget(argus_peer_t *const self) {
    self->count = 0;
    self->weighed = 0;
}
