// SPDX-License-Identifier: MIT
// Integer trigonometry: a quarter-wave table with linear interpolation, and CORDIC for directions.
#include "knowledge/angle.h"

#include "argus/argus.h"

#define QUARTER 9000

static const int16_t sine[91] = {
    0,     286,   572,   857,   1143,  1428,  1713,  1997,  2280,  2563,  2845,  3126,  3406,
    3686,  3964,  4240,  4516,  4790,  5063,  5334,  5604,  5872,  6138,  6402,  6664,  6924,
    7182,  7438,  7692,  7943,  8192,  8438,  8682,  8923,  9162,  9397,  9630,  9860,  10087,
    10311, 10531, 10749, 10963, 11174, 11381, 11585, 11786, 11982, 12176, 12365, 12551, 12733,
    12911, 13085, 13255, 13421, 13583, 13741, 13894, 14044, 14189, 14330, 14466, 14598, 14726,
    14849, 14968, 15082, 15191, 15296, 15396, 15491, 15582, 15668, 15749, 15826, 15897, 15964,
    16026, 16083, 16135, 16182, 16225, 16262, 16294, 16322, 16344, 16362, 16374, 16382, 16384};

// 0 <= cdeg <= 9000
static int32_t quarter_sine(const int32_t cdeg) {
    ARGUS_ASSERT(cdeg >= 0 && cdeg <= QUARTER);
    const int32_t degree = cdeg / 100;
    const int32_t part = cdeg % 100;
    const int32_t low = sine[degree];
    return part == 0 ? low : low + ((sine[degree + 1] - low) * part + 50) / 100;
}

int32_t argus_sin(const int32_t cdeg) {
    const int32_t a = argus_angle_wrap(cdeg);
    const int32_t size = argus_abs(a);
    const int32_t value = quarter_sine(size > QUARTER ? ARGUS_HALF_TURN_CDEG - size : size);
    ARGUS_ASSERT(value >= 0 && value <= ARGUS_TRIG_ONE);
    return a < 0 ? -value : value;
}

int32_t argus_cos(const int32_t cdeg) {
    const int32_t size = argus_abs(argus_angle_wrap(cdeg));
    return size > QUARTER ? -quarter_sine(size - QUARTER) : quarter_sine(QUARTER - size);
}

argus_point_t argus_in_frame(const argus_point_t at, const int32_t cdeg) {
    const int32_t c = argus_cos(cdeg);
    const int32_t s = argus_sin(cdeg);
    return (argus_point_t){(at.x_mm * c + at.y_mm * s) / ARGUS_TRIG_ONE,
                           (at.y_mm * c - at.x_mm * s) / ARGUS_TRIG_ONE};
}

// Direction in thousandths of a degree for x > 0, by CORDIC; the vector is scaled up so that small ones keep
// their angle.
static int32_t cordic_mdeg(int32_t x, int32_t y) {
    ARGUS_ASSERT(x > 0 || y != 0);
    static const int32_t step_mdeg[] = {45000, 26565, 14036, 7125, 3576, 1790, 895,
                                        448,   224,   112,   56,   28,   14,   7};
    int32_t angle = 0;
    for (unsigned i = 0; i < sizeof step_mdeg / sizeof step_mdeg[0]; i++) {
        const int32_t part = 1 << i;
        const int32_t sign = y > 0 ? 1 : -1;
        const int32_t next = x + sign * (y / part);
        y -= sign * (x / part);
        x = next;
        angle += sign * step_mdeg[i];
    }
    return angle;
}

int32_t argus_atan2(const int32_t y, const int32_t x) {
    if (x == 0 && y == 0) {
        return 0;
    }
    const int32_t ax = argus_abs(x);
    const int32_t ay = argus_abs(y);
    const int32_t scale = 500000000 / argus_max(argus_max(ax, ay), 1);
    const int32_t first = y == 0 ? 0 : (cordic_mdeg(ax * scale, ay * scale) + 5) / 10;
    const int32_t upper = x < 0 ? ARGUS_HALF_TURN_CDEG - first : first;
    return argus_angle_wrap(y < 0 ? -upper : upper);
}

uint32_t argus_sqrt(const uint32_t value) {
    uint32_t rest = value;
    uint32_t root = 0;
    for (uint32_t bit = 1u << 30; bit != 0; bit >>= 2) {
        if (rest >= root + bit) {
            rest -= root + bit;
            root = (root >> 1) + bit;
        } else {
            root >>= 1;
        }
    }
    ARGUS_ASSERT(root <= UINT16_MAX && root * root <= value);
    return root;
}

uint32_t argus_square_of(const int32_t x, const int32_t y) {
    const uint32_t ax = (uint32_t)argus_min(argus_abs(x), 46000);
    const uint32_t ay = (uint32_t)argus_min(argus_abs(y), 46000);
    return ax * ax + ay * ay;
}

int32_t argus_hypot(const int32_t x, const int32_t y) {
    return (int32_t)argus_sqrt(argus_square_of(x, y));
}
