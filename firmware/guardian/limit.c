// SPDX-License-Identifier: MIT
// Counts what a client says.
#include "guardian/limit.h"

#define ORDERS_PER_SIP 10 // 90 bytes: what a line of 9600 baud carries in that time
#define BYTES_MOST 400    // what a client says at its start
#define BYTES_PER_S 300   // a third of such a line
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

// Time that has not brought a whole byte yet is kept.
static void drain(argus_limit_t *const self, const uint32_t now_ms) {
    const uint32_t passed_ms = now_ms - self->filled_ms;
    const uint32_t gone = passed_ms < 10 * SECOND_MS ? passed_ms * BYTES_PER_S / SECOND_MS : BYTES_MOST;
    if (gone >= self->bytes) {
        self->bytes = 0;
        self->filled_ms = now_ms;
    } else if (gone > 0) {
        self->bytes = (uint16_t)(self->bytes - gone);
        self->filled_ms += gone * SECOND_MS / BYTES_PER_S;
    }
}

bool argus_limit_pass(argus_limit_t *const self, const uint32_t now_ms, const uint16_t bytes) {
    drain(self, now_ms);
    if (self->bytes + bytes > BYTES_MOST) {
        self->dropped++;
        return false;
    }
    self->bytes = (uint16_t)(self->bytes + bytes);
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
