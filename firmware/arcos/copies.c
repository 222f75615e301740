// SPDX-License-Identifier: MIT
// Keeps what the last SIPs were.
#include "arcos/copies.h"

#include "arcos/arithmetic.h"
#include "arcos/sip.h"

#define PLACE_BYTES (ARGUS_SIP_AT(TH) + 2)
#define STEP_UNITS 40 // a robot that comes back to rest where it was makes smaller steps, of mm
#define STEP_TURN 57  // ... and turns by less, of 4096

static bool is_there(const argus_sip_mark_t *const a, const argus_sip_mark_t *const b) {
    return a->x == b->x && a->y == b->y && a->heading == b->heading;
}

// What a robot does in a cycle about where it comes to rest.
static bool is_step(const argus_sip_mark_t *const a, const argus_sip_mark_t *const b) {
    return argus_is_close(a->x, b->x, STEP_UNITS) && argus_is_close(a->y, b->y, STEP_UNITS) &&
           argus_is_close(a->heading, b->heading, STEP_TURN);
}

static bool is_kept(const argus_copies_t *const self, const argus_sip_mark_t *const mark) {
    bool kept = false;
    for (int i = 0; i < self->count; i++) {
        kept = kept || (self->kept[i].sum == mark->sum && is_there(&self->kept[i], mark));
    }
    return kept;
}

static void keep(argus_copies_t *const self, const argus_sip_mark_t *const mark) {
    self->last = (uint8_t)((self->last + 1) % ARGUS_COPIES_KEPT);
    self->kept[self->last] = *mark;
    self->count = (uint8_t)argus_min(self->count + 1, ARGUS_COPIES_KEPT);
}

bool argus_copies_has(argus_copies_t *const self, const argus_packet_t *const packet) {
    if (packet->count < PLACE_BYTES) {
        return false;
    }
    const argus_sip_mark_t mark = {
        argus_u16_at(packet->data + ARGUS_SIP_AT(X)), argus_u16_at(packet->data + ARGUS_SIP_AT(Y)),
        argus_u16_at(packet->data + ARGUS_SIP_AT(TH)), argus_frame_checksum(packet->data, packet->count)};
    const bool moved = self->count > 0 && !is_step(&self->kept[self->last], &mark);
    const bool again = self->passing && is_there(&self->passed, &mark); // it is there indeed
    if (moved && !again && is_kept(self, &mark)) {
        self->found++;
        self->passing = true;
        self->passed = mark;
        return true;
    }
    self->passing = false;
    keep(self, &mark);
    return false;
}
