// SPDX-License-Identifier: MIT
// The ping log: what each sonar lately heard, from where and on which bearing.
#include "awareness/pings.h"

#include <stddef.h>

#include "awareness/numbers.h"
#include "knowledge/angle.h"

#define SECTOR_CDEG (ARGUS_TURN_CDEG / ARGUS_PING_SECTORS)

static int32_t offset_mm(const uint16_t now_mm, const uint16_t then_mm) {
    const int32_t delta = (int32_t)((uint32_t)(now_mm - then_mm) & 0xFFFFu);
    return delta > INT16_MAX ? delta - 0x10000 : delta;
}

static unsigned slot_of(const argus_pings_t *const self, const int back) {
    ARGUS_ASSERT(back >= 1);
    ARGUS_ASSERT(self->count <= ARGUS_PINGS && self->next < ARGUS_PINGS);
    return (self->next + ARGUS_PINGS - (unsigned)back) % ARGUS_PINGS;
}

const argus_ping_t *argus_pings_at(const argus_pings_t *const self, const int back) {
    return back >= 1 && back <= self->count ? &self->ping[slot_of(self, back)] : NULL;
}

argus_ping_t *argus_pings_mark(argus_pings_t *const self, const int back) {
    ARGUS_ASSERT(back >= 1);
    return &self->ping[slot_of(self, back)];
}

const argus_ping_t *argus_pings_before(const argus_pings_t *const self, const int back, const int firings) {
    ARGUS_ASSERT(back >= 1);
    ARGUS_ASSERT(self->count <= ARGUS_PINGS && self->next < ARGUS_PINGS);
    int left = firings;
    for (int i = back; i <= self->count; i++) {
        const argus_ping_t *const at = &self->ping[slot_of(self, i)];
        if (left <= at->repeats) {
            return at;
        }
        left -= at->repeats + 1;
    }
    return NULL;
}

int32_t argus_ping_age_ms(const argus_ping_t *const self, const uint32_t now_ms) {
    return (int32_t)((now_ms - self->t_ms) & 0xFFFFu);
}

int32_t argus_ping_moved_mm(const argus_ping_t *const a, const argus_ping_t *const b) {
    return argus_hypot(offset_mm(a->x_mm, b->x_mm), offset_mm(a->y_mm, b->y_mm));
}

int32_t argus_ping_turned_cdeg(const argus_ping_t *const a, const argus_ping_t *const b) {
    const int32_t size = argus_abs(a->bearing_cdeg - b->bearing_cdeg);
    ARGUS_ASSERT(size < ARGUS_TURN_CDEG);
    return size > 18000 ? 36000 - size : size;
}

argus_shift_t argus_line_shift(const argus_line_t *const line, const argus_ping_t *const then) {
    const int32_t dx = offset_mm(line->ping->x_mm, then->x_mm);
    const int32_t dy = offset_mm(line->ping->y_mm, then->y_mm);
    return (argus_shift_t){.along_mm = (dx * line->cos + dy * line->sin) / ARGUS_TRIG_ONE,
                           .lateral_mm = argus_abs(dy * line->cos - dx * line->sin) / ARGUS_TRIG_ONE};
}

argus_shift_t argus_ping_shift(const argus_ping_t *const now, const argus_ping_t *const then) {
    const argus_line_t line = argus_ping_line(now);
    return argus_line_shift(&line, then);
}

int32_t argus_ping_predict_mm(const argus_ping_t *const now, const argus_ping_t *const then) {
    return then->reading_mm - argus_ping_shift(now, then).along_mm;
}

bool argus_ping_is_within(const argus_ping_t *const a, const argus_ping_t *const b, const int32_t mm) {
    return argus_is_close(a->x_mm, b->x_mm, mm) && argus_is_close(a->y_mm, b->y_mm, mm);
}

static unsigned sector_of(const int32_t bearing_cdeg) {
    return (unsigned)(bearing_cdeg + 2 * ARGUS_TURN_CDEG) / SECTOR_CDEG % ARGUS_PING_SECTORS;
}

argus_line_t argus_ping_line(const argus_ping_t *const self) {
    _Static_assert(2 * ARGUS_BESIDE_CDEG < SECTOR_CDEG, "what is beside a bearing lies in two sectors");
    return (argus_line_t){.ping = self,
                          .cos = argus_cos(self->bearing_cdeg),
                          .sin = argus_sin(self->bearing_cdeg),
                          .sector = {(uint8_t)sector_of(self->bearing_cdeg - ARGUS_BESIDE_CDEG),
                                     (uint8_t)sector_of(self->bearing_cdeg + ARGUS_BESIDE_CDEG)}};
}

static bool is_near(const argus_ping_t *const a, const argus_ping_t *const b) {
    const int32_t turned = argus_abs(a->bearing_cdeg - b->bearing_cdeg);
    return (turned <= ARGUS_BESIDE_CDEG || turned >= ARGUS_TURN_CDEG - ARGUS_BESIDE_CDEG) &&
           argus_ping_is_within(a, b, ARGUS_SAME_ALONG_MM);
}

// Thousands of pings are asked for in one SIP, and few of them looked that way.
int argus_pings_near(const argus_pings_t *const self, uint32_t *const left, const argus_line_t *const line) {
    ARGUS_ASSERT(self->count <= ARGUS_PINGS && self->next < ARGUS_PINGS);
    while (*left != 0) {
        const int back = ARGUS_PINGS - argus_take_highest(left);
        if (is_near(line->ping, &self->ping[slot_of(self, back)])) {
            return back;
        }
    }
    return 0;
}

bool argus_ping_goes_on(const argus_ping_t *const now, const argus_ping_t *const then) {
    if (!then->steady || argus_ping_turned_cdeg(now, then) > ARGUS_SAME_CDEG) {
        return false;
    }
    if (!argus_ping_is_echo(now) || !argus_ping_is_echo(then)) {
        return argus_ping_is_echo(now) == argus_ping_is_echo(then);
    }
    const int32_t limit =
        ARGUS_SAME_LATERAL_MM + now->reading_mm * 3 / 100 + argus_ping_moved_mm(now, then) / 4;
    return argus_abs(now->reading_mm - argus_ping_predict_mm(now, then)) <= limit;
}

static bool is_alike(const argus_ping_t *const a, const argus_ping_t *const b) {
    return argus_ping_is_echo(a) == argus_ping_is_echo(b) &&
           argus_abs(a->reading_mm - b->reading_mm) <= ARGUS_ONE_PING_MM &&
           argus_ping_turned_cdeg(a, b) <= ARGUS_ONE_PING_CDEG &&
           argus_ping_is_within(a, b, ARGUS_ONE_PING_PLACE_MM);
}

void argus_pings_age(argus_pings_t *const self, const uint32_t now_ms) {
    ARGUS_ASSERT(self->count <= ARGUS_PINGS && self->next < ARGUS_PINGS);
    while (self->count > 0 &&
           argus_ping_age_ms(&self->ping[slot_of(self, self->count)], now_ms) > (int32_t)ARGUS_PINGS_AGE_MS) {
        self->count--;
    }
}

static void note_sector(argus_pings_t *const self, const unsigned slot, const int32_t bearing_cdeg) {
    ARGUS_ASSERT(slot < ARGUS_PINGS);
    for (int i = 0; i < ARGUS_PING_SECTORS; i++) {
        self->looked[i] &= ~((uint32_t)1 << slot);
    }
    self->looked[sector_of(bearing_cdeg)] |= (uint32_t)1 << slot;
}

void argus_pings_note(argus_pings_t *const self, const argus_ping_t now) {
    ARGUS_ASSERT(self->count <= ARGUS_PINGS && self->next < ARGUS_PINGS);
    argus_ping_t *const last = &self->ping[slot_of(self, 1)];
    if (self->count > 0 && is_alike(&now, last)) {
        last->t_ms = now.t_ms;
        last->reading_mm = now.reading_mm;
        last->repeats = argus_one_more(last->repeats);
        last->steady = now.steady;
        last->rest = now.rest;
        last->weighed = 0;
        return;
    }
    note_sector(self, self->next, now.bearing_cdeg);
    self->ping[self->next] = now;
    self->next = (uint8_t)((self->next + 1) % ARGUS_PINGS);
    self->count = (uint8_t)argus_min(self->count + 1, ARGUS_PINGS);
}

argus_ping_t argus_ping_from(const argus_robot_t *const robot, const int sonar,
                             const argus_pose_t *const pose) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_sonar_pose_t mount = argus_robot_pose(robot, sonar);
    const argus_point_t at = argus_to_course(pose, (argus_point_t){mount.x_mm, mount.y_mm});
    const int32_t bearing_cdeg = argus_angle_wrap(pose->heading_cdeg + mount.heading_deg * 100);
    const argus_ping_t ping = {.x_mm = (uint16_t)((uint32_t)at.x_mm & 0xFFFFu),
                               .y_mm = (uint16_t)((uint32_t)at.y_mm & 0xFFFFu),
                               .bearing_cdeg = (int16_t)bearing_cdeg};
    return ping;
}
