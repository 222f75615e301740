// SPDX-License-Identifier: MIT
// The time since argusd began, which does not wrap as the clock does.
#ifndef ARGUSD_MOMENT_H
#define ARGUSD_MOMENT_H

#include <stdint.h>

typedef struct {
    uint32_t now_ms; // the clock
    uint64_t t_ms;   // since the start
} moment_t;

static inline void moment_take(moment_t *self, uint32_t now_ms) {
    self->t_ms += now_ms - self->now_ms;
    self->now_ms = now_ms;
}

// Of an event, which may lie a little before or after `now`.
static inline uint64_t moment_of(const moment_t *self, uint32_t ms) {
    const int64_t t_ms = (int64_t)self->t_ms + (int32_t)(ms - self->now_ms);
    return t_ms < 0 ? 0 : (uint64_t)t_ms;
}

#endif
