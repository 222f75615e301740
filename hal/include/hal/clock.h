// SPDX-License-Identifier: MIT
// The clock: milliseconds that only go forward.
#ifndef HAL_CLOCK_H
#define HAL_CLOCK_H

#include <stdint.h>

typedef struct {
    uint32_t (*now_ms)(void *context); // wraps after 49.7 days: compare by unsigned difference
    void *context;
} hal_clock_t;

static inline uint32_t hal_clock_now_ms(const hal_clock_t *clock) {
    return clock->now_ms(clock->context);
}

// CLOCK_MONOTONIC.
hal_clock_t hal_clock_monotonic(void);

#endif
