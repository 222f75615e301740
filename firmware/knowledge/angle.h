// SPDX-License-Identifier: MIT
// Integer trigonometry in hundredths of a degree and millimetres.
#ifndef ARGUS_ANGLE_H
#define ARGUS_ANGLE_H

#include <stdint.h>

#include "arcos/apart.h"
#include "argus/argus.h"

#define ARGUS_TRIG_ONE 16384 // argus_sin() and argus_cos() are scaled by this

// Any angle reduced to -18000 < a <= 18000.
int32_t argus_angle_wrap(int32_t cdeg);
int32_t argus_angle_abs_diff(int32_t a_cdeg, int32_t b_cdeg);

// Error at most 4 / 16384. Any angle.
int32_t argus_sin(int32_t cdeg);
int32_t argus_cos(int32_t cdeg);

// A point, as a frame sees it that is turned by this, counter-clockwise. |x|, |y| <= 60,000; any angle.
argus_point_t argus_in_frame(argus_point_t at, int32_t cdeg);

// Direction of (x, y), |x|, |y| <= 1,000,000; error at most 6 cdeg; 0 for the origin.
int32_t argus_atan2(int32_t y, int32_t x);

// Floor of the square root.
uint32_t argus_sqrt(uint32_t value);

// Length of (x, y), |x|, |y| <= 40,000.
int32_t argus_hypot(int32_t x, int32_t y);

ARGUS_APART int32_t argus_abs(int32_t value);
int32_t argus_min(int32_t a, int32_t b);
int32_t argus_max(int32_t a, int32_t b);
// The value, from `least` to `most`.
ARGUS_APART int32_t argus_between(int32_t least, int32_t most, int32_t value);
// ... of at most so much to either side; `most` >= 0.
ARGUS_APART int32_t argus_within(int32_t most, int32_t value);
int argus_count_bits(uint32_t mask);

// A count of one more, up to 255.
ARGUS_APART uint8_t argus_one_more(uint8_t count);

#endif
