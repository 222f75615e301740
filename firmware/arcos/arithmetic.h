// SPDX-License-Identifier: MIT
// Integer arithmetic that all rooms use: magnitudes, bounds, times that wrap, words of two bytes.
#ifndef ARGUS_ARITHMETIC_H
#define ARGUS_ARITHMETIC_H

#include <stdbool.h>
#include <stdint.h>

#include "argus/argus.h"

static inline int32_t argus_abs(const int32_t value) {
    return value < 0 ? -value : value;
}

static inline int32_t argus_min(const int32_t a, const int32_t b) {
    return a < b ? a : b;
}

static inline int32_t argus_max(const int32_t a, const int32_t b) {
    return a > b ? a : b;
}

// The value, from `least` to `most`.
static inline int32_t argus_between(const int32_t least, const int32_t most, const int32_t value) {
    return argus_max(least, argus_min(most, value));
}

// ... of at most so much to either side; `most` >= 0.
static inline int32_t argus_within(const int32_t most, const int32_t value) {
    ARGUS_ASSERT(most >= 0);
    return argus_between(-most, most, value);
}

// Since then; 0 where the clock steps back, which must not look like a long silence.
static inline uint32_t argus_elapsed_ms(const uint32_t now_ms, const uint32_t then_ms) {
    const uint32_t elapsed = now_ms - then_ms;
    return elapsed < UINT32_C(0x80000000) ? elapsed : 0;
}

// At most so far apart, modulo 65,536: one unsigned comparison. 0 <= `most` < 32,768.
static inline bool argus_is_close(const uint16_t a, const uint16_t b, const int32_t most) {
    return (uint16_t)((uint32_t)a - b + (uint32_t)most) <= (uint32_t)(2 * most);
}

// Two bytes, the low one first.
static inline uint16_t argus_u16_at(const uint8_t *const at) {
    return (uint16_t)(at[0] | (unsigned)at[1] << 8);
}

#endif
