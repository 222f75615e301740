// SPDX-License-Identifier: MIT
// Integer trigonometry in hundredths of a degree and millimetres.
#ifndef ARGUS_ANGLE_H
#define ARGUS_ANGLE_H

#include <stdint.h>

#include "arcos/arithmetic.h"
#include "argus/argus.h"

#define ARGUS_TRIG_ONE 16384 // argus_sin() and argus_cos() are scaled by this
#define ARGUS_HALF_TURN_CDEG 18000
#define ARGUS_TURN_CDEG 36000

static inline int argus_count_bits(const uint32_t mask) {
    int count = 0;
    for (uint32_t rest = mask; rest != 0; rest &= rest - 1) {
        count++;
    }
    return count;
}

// Of a mask that is not 0: how many bits above its highest one are 0.
static inline int argus_leading_zeros(const uint32_t mask) {
    ARGUS_ASSERT(mask != 0);
#ifdef __GNUC__
    return __builtin_clz(mask);
#else
    int zeros = 0;
    for (uint32_t rest = mask; (rest & 0x80000000u) == 0; rest <<= 1) {
        zeros++;
    }
    return zeros;
#endif
}

// The highest bit of a mask that is not 0, which is taken out of it: 0 to 31.
static inline int argus_take_highest(uint32_t *const mask) {
    const int bit = 31 - argus_leading_zeros(*mask);
    *mask &= ~((uint32_t)1 << bit);
    return bit;
}

// A count of one more, up to 255.
static inline uint8_t argus_one_more(const uint8_t count) {
    return (uint8_t)argus_min(count + 1, UINT8_MAX);
}

// Any angle reduced to -18000 < a <= 18000.
static inline int32_t argus_angle_wrap(const int32_t cdeg) {
    const int32_t rest = cdeg % ARGUS_TURN_CDEG;
    if (rest > ARGUS_HALF_TURN_CDEG) {
        return rest - ARGUS_TURN_CDEG;
    }
    const int32_t wrapped = rest <= -ARGUS_HALF_TURN_CDEG ? rest + ARGUS_TURN_CDEG : rest;
    ARGUS_ASSERT(wrapped > -ARGUS_HALF_TURN_CDEG && wrapped <= ARGUS_HALF_TURN_CDEG);
    return wrapped;
}

static inline int32_t argus_angle_abs_diff(const int32_t a_cdeg, const int32_t b_cdeg) {
    return argus_abs(argus_angle_wrap(argus_angle_wrap(a_cdeg) - argus_angle_wrap(b_cdeg)));
}

// Error at most 4 / 16384. Any angle.
int32_t argus_sin(int32_t cdeg);
int32_t argus_cos(int32_t cdeg);

// A point, as a frame sees it that is turned by this, counter-clockwise. |x|, |y| <= 60,000; any angle.
argus_point_t argus_in_frame(argus_point_t at, int32_t cdeg);

// Direction of (x, y), |x|, |y| <= 1,000,000; error at most 6 cdeg; 0 for the origin.
int32_t argus_atan2(int32_t y, int32_t x);

// Floor of the square root.
uint32_t argus_sqrt(uint32_t value);

// Length of (x, y), |x|, |y| <= 40,000; and its square, of which the root is that.
int32_t argus_hypot(int32_t x, int32_t y);
uint32_t argus_square_of(int32_t x, int32_t y);

#endif
