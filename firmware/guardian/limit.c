// SPDX-License-Identifier: MIT
// Counts what a client says.
#include "guardian/limit.h"

#define ORDERS_PER_SIP 10 // 90 bytes: what a line of 9600 baud carries in that time
#define BYTES_MOST 400u   // what a client says at its start
#define BYTES_PER_S 300u  // a third of such a line
#define PARTS 1000u       // of a byte: a ms brings less than one
#define LONG_MS 10000u    // all is gone
#define WORDS_PER_S 5
#define SECOND_MS 1000u

bool argus_limit_order(argus_limit_t *const self) {
    if (self->orders >= ORDERS_PER_SIP) {
        return false;
    }
    self->orders++;
    return true;
}

void argus_limit_sip(argus_limit_t *const self) {
    self->orders = 0;
}

static void drain(argus_limit_t *const self, const uint32_t now_ms) {
    const uint32_t passed_ms = now_ms - self->filled_ms;
    const uint32_t gone = passed_ms < LONG_MS ? passed_ms * BYTES_PER_S : self->used;
    self->used -= gone < self->used ? gone : self->used;
    self->filled_ms = now_ms;
}

bool argus_limit_pass(argus_limit_t *const self, const uint32_t now_ms, const uint16_t bytes) {
    drain(self, now_ms);
    if (self->used + bytes * PARTS > BYTES_MOST * PARTS) {
        self->dropped++;
        return false;
    }
    self->used += bytes * PARTS;
    return true;
}

bool argus_limit_word(argus_limit_t *const self) {
    if (self->words >= WORDS_PER_S) {
        self->dropped++;
        return false;
    }
    self->words++;
    return true;
}

uint32_t argus_limit_second(argus_limit_t *const self, const uint32_t now_ms) {
    if (now_ms - self->second_ms < SECOND_MS) {
        return 0;
    }
    const uint32_t dropped = self->dropped;
    self->second_ms = now_ms;
    self->dropped = 0;
    self->words = 0;
    return dropped;
}
