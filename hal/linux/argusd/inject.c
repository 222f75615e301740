// SPDX-License-Identifier: MIT
// Rewrites the sonar readings in SIPs; all other bytes pass as they came.
#include "inject.h"

#include <string.h>

#include "arcos/frame.h"

#define HOLD_MS 150u // a packet that stays incomplete so long passes as it is
#define LEAST_MM 100u
#define NO_ECHO_MM ((uint32_t)ARGUS_NO_ECHO_MM)
#define HEADER 3 // FA FB COUNT
#define TAIL_MAX 40

void inject_init(inject_t *self, bool armed, uint32_t seed) {
    memset(self, 0, sizeof *self);
    self->armed = armed;
    self->random = seed | 1u;
}

bool inject_kind(const char *word, argus_fault_kind_t *kind) {
    static const struct {
        const char *word;
        argus_fault_kind_t kind;
    } words[] = {{"ok", ARGUS_KIND_NONE},
                 {"delayed", ARGUS_KIND_SLOW}, // PX4's word
#define ROW(name, number, text, meaning) {text, ARGUS_KIND_##name},
                 ARGUS_FAULT_KIND_TABLE(ROW)
#undef ROW
    };
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (strcmp(words[i].word, word) == 0) {
            *kind = words[i].kind;
            return true;
        }
    }
    return false;
}

static void note(inject_t *self, int sonar) {
    if (self->changes < sizeof self->change / sizeof self->change[0]) {
        const inject_sonar_t *const of = &self->of[sonar];
        self->change[self->changes++] =
            (inject_change_t){.sonar = sonar, .kind = of->kind, .for_ms = of->for_ms};
    }
}

void inject_set(inject_t *self, int sonar, argus_fault_kind_t kind, uint32_t for_ms, uint32_t now_ms) {
    inject_sonar_t *const of = &self->of[sonar];
    if (kind == ARGUS_KIND_NONE && of->kind == ARGUS_KIND_NONE) {
        return;
    }
    of->kind = kind;
    of->mark = kind != ARGUS_KIND_NONE ? kind : of->mark;
    of->since_ms = now_ms;
    of->for_ms = kind == ARGUS_KIND_NONE ? 0 : for_ms;
    of->has_stuck = false;
    note(self, sonar);
}

void inject_expire(inject_t *self, bool all, uint32_t now_ms) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const inject_sonar_t *const of = &self->of[i];
        if (of->kind != ARGUS_KIND_NONE && (all || now_ms - of->since_ms >= of->for_ms)) {
            inject_set(self, i, ARGUS_KIND_NONE, 0, now_ms);
        }
    }
}

bool inject_change(inject_t *self, inject_change_t *change) {
    if (self->changes == 0) {
        return false;
    }
    *change = self->change[0];
    self->changes--;
    memmove(self->change, self->change + 1, self->changes * sizeof self->change[0]);
    return true;
}

void inject_settle(inject_t *self, const argus_status_t *status, uint32_t now_ms) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        inject_sonar_t *const of = &self->of[i];
        if (of->kind == ARGUS_KIND_NONE && status->kind[i] == ARGUS_KIND_NONE &&
            now_ms - of->since_ms >= INJECT_SETTLE_MS) {
            of->mark = ARGUS_KIND_NONE;
        }
    }
}

uint32_t inject_marked(const inject_t *self) {
    uint32_t mask = 0;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        mask |= self->of[i].mark != ARGUS_KIND_NONE ? 1u << i : 0u;
    }
    return mask;
}

bool inject_is_on(const inject_t *self) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if (self->of[i].kind != ARGUS_KIND_NONE) {
            return true;
        }
    }
    return false;
}

// xorshift32: chance enough for a fault.
static uint32_t chance(inject_t *self) {
    self->random ^= self->random << 13;
    self->random ^= self->random >> 17;
    self->random ^= self->random << 5;
    return self->random;
}

// Notes a reading and returns the one of INJECT_FIRINGS ago, or the oldest that is known.
static uint16_t earlier(inject_sonar_t *of, uint16_t now_mm) {
    const uint8_t oldest = of->known < INJECT_FIRINGS ? 0 : of->next;
    const uint16_t then_mm = of->known == 0 ? now_mm : of->before_mm[oldest];
    of->before_mm[of->next] = now_mm;
    of->next = (uint8_t)((of->next + 1) % INJECT_FIRINGS);
    of->known = (uint8_t)(of->known < INJECT_FIRINGS ? of->known + 1 : of->known);
    return then_mm;
}

static uint16_t stuck(inject_sonar_t *of, uint16_t now_mm) {
    of->stuck_mm = of->has_stuck ? of->stuck_mm : now_mm;
    of->has_stuck = true;
    return of->stuck_mm;
}

static uint16_t altered(inject_t *self, inject_sonar_t *of, uint16_t now_mm) {
    const uint16_t then_mm = earlier(of, now_mm);
    switch (of->kind) {
    case ARGUS_KIND_OFF:
        return NO_ECHO_MM;
    case ARGUS_KIND_STUCK:
        return stuck(of, now_mm);
    case ARGUS_KIND_WRONG:
        return (uint16_t)(now_mm / 2u < LEAST_MM ? LEAST_MM : now_mm / 2u);
    case ARGUS_KIND_GARBAGE:
        return (uint16_t)(LEAST_MM + chance(self) % (NO_ECHO_MM - LEAST_MM + 1));
    case ARGUS_KIND_SLOW:
        return then_mm;
    case ARGUS_KIND_INTERMITTENT:
        return (chance(self) & 0x100u) != 0 ? (uint16_t)NO_ECHO_MM : now_mm;
    default:
        return now_mm;
    }
}

// One reading of the list at `from`, written at `to`; returns its bytes, 0 when it is left out.
static size_t alter_reading(inject_t *self, const uint8_t *from, uint8_t *to) {
    const uint8_t number = from[0];
    uint16_t mm = (uint16_t)(from[1] | from[2] << 8);
    if (number < ARGUS_SONARS) {
        inject_sonar_t *const of = &self->of[number];
        if (of->kind == ARGUS_KIND_SILENT) {
            return 0;
        }
        mm = altered(self, of, mm);
    }
    to[0] = number;
    to[1] = (uint8_t)(mm & 0xFFu);
    to[2] = (uint8_t)(mm >> 8);
    return ARCOS_SIP_SONAR_BYTES;
}

static bool is_whole(const uint8_t *packet, size_t length) {
    const uint16_t sum = argus_frame_checksum(packet + HEADER, length - HEADER - 2);
    return packet[length - 2] == sum >> 8 && packet[length - 1] == (sum & 0xFFu);
}

// The bytes of a packet from its list of readings on: where its tail begins.
static size_t tail_of(const uint8_t *packet) {
    return ARCOS_SIP_OFFSET_SONAR + (size_t)packet[ARCOS_SIP_OFFSET_SONAR_COUNT] * ARCOS_SIP_SONAR_BYTES;
}

// A SIP with a right checksum, at `out`; returns its length.
static size_t alter_sip(inject_t *self, const uint8_t *packet, size_t length, uint8_t *out) {
    const size_t tail = tail_of(packet);
    memcpy(out, packet, ARCOS_SIP_OFFSET_SONAR);
    size_t at = ARCOS_SIP_OFFSET_SONAR;
    for (size_t from = at; from < tail; from += ARCOS_SIP_SONAR_BYTES) {
        at += alter_reading(self, packet + from, out + at);
    }
    out[ARCOS_SIP_OFFSET_SONAR_COUNT] = (uint8_t)((at - ARCOS_SIP_OFFSET_SONAR) / ARCOS_SIP_SONAR_BYTES);
    memcpy(out + at, packet + tail, length - 2 - tail);
    at += length - 2 - tail;
    out[2] = (uint8_t)(at + 2 - HEADER);
    const uint16_t sum = argus_frame_checksum(out + HEADER, at - HEADER);
    out[at] = (uint8_t)(sum >> 8);
    out[at + 1] = (uint8_t)(sum & 0xFFu);
    return at + 2;
}

static void drop(inject_t *self, size_t count) {
    self->used -= count;
    memmove(self->held, self->held + count, self->used);
}

// Passes the first byte held, which begins no packet.
static size_t pass_byte(inject_t *self, uint8_t *out) {
    out[0] = self->held[0];
    drop(self, 1);
    return 1;
}

// Whether the bytes held may still begin a SIP.
static bool has_head(const uint8_t *h, size_t used) {
    return h[0] == ARCOS_FRAME_HEADER0 && (used < 2 || h[1] == ARCOS_FRAME_HEADER1) &&
           (used < 3 || h[2] >= ARCOS_SIP_OFFSET_SONAR + 2 - HEADER) &&
           (used < 4 || h[HEADER] == ARCOS_TYPE_SIP_STATIONARY || h[HEADER] == ARCOS_TYPE_SIP_MOVING);
}

// ... with two counts that agree; what cannot become one is not waited for.
static bool may_be_sip(const inject_t *self) {
    const uint8_t *const h = self->held;
    if (!has_head(h, self->used)) {
        return false;
    }
    const size_t end = (size_t)h[2] + HEADER - 2;
    return self->used <= ARCOS_SIP_OFFSET_SONAR_COUNT || (tail_of(h) <= end && end - tail_of(h) <= TAIL_MAX);
}

// Passes on what can be decided of the bytes held; 0: more are needed.
static size_t pass(inject_t *self, uint8_t *out) {
    if (self->used == 0) {
        return 0;
    }
    if (!may_be_sip(self)) {
        return pass_byte(self, out);
    }
    const size_t length = self->used > 2 ? (size_t)self->held[2] + HEADER : sizeof self->held + 1;
    if (self->used < length) {
        return 0;
    }
    if (!is_whole(self->held, length)) {
        return pass_byte(self, out);
    }
    const size_t written = alter_sip(self, self->held, length, out);
    drop(self, length);
    return written;
}

static size_t pass_all(inject_t *self, uint8_t *out) {
    const size_t count = self->used;
    memcpy(out, self->held, count);
    self->used = 0;
    return count;
}

// Without a fault bytes pass at once. What is held is less than a packet, so `out` has room for that besides
// `count`.
static size_t alter(void *context, uint32_t now_ms, const uint8_t *bytes, size_t count, uint8_t *out) {
    inject_t *const self = context;
    const bool on = inject_is_on(self);
    size_t written = 0;
    if (!on || (count == 0 && now_ms - self->held_ms >= HOLD_MS)) {
        written = pass_all(self, out);
    }
    if (!on) {
        if (count > 0) {
            memcpy(out + written, bytes, count);
        }
        return written + count;
    }
    for (size_t i = 0; i < count; i++) {
        self->held[self->used++] = bytes[i];
        self->held_ms = now_ms;
        for (size_t got = pass(self, out + written); got > 0; got = pass(self, out + written)) {
            written += got;
        }
    }
    return written;
}

driver_filter_t inject_filter(inject_t *self) {
    return self->armed ? (driver_filter_t){.alter = alter, .context = self} : (driver_filter_t){0};
}
