// SPDX-License-Identifier: MIT
// Rule under attack: the integer maps stay within the errors that angle.h promises, over dense samples.
#include "knowledge/angle.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "unity.h"

#define PI 3.14159265358979323846

static char text[120];

void test_wrap_keeps_the_direction_and_the_range(void) {
    for (int32_t a = -200000; a <= 200000; a += 7) {
        const int32_t w = argus_angle_wrap(a);
        TEST_ASSERT_TRUE(w > -18000 && w <= 18000);
        TEST_ASSERT_EQUAL(0, (a - w) % 36000);
    }
    TEST_ASSERT_EQUAL(18000, argus_angle_wrap(18000));
    TEST_ASSERT_EQUAL(18000, argus_angle_wrap(-18000));
    TEST_ASSERT_EQUAL(-17999, argus_angle_wrap(18001));
    TEST_ASSERT_EQUAL(18000, argus_angle_wrap(54000));
    argus_angle_wrap(INT32_MAX);
    argus_angle_wrap(INT32_MIN);
}

// The next angle is one hundredth on, but for the one behind half a turn.
static void walk_all(const int64_t from, const int64_t to) {
    int32_t expected = argus_angle_wrap((int32_t)from);
    for (int64_t a = from; a <= to; a++) {
        const int32_t wrapped = argus_angle_wrap((int32_t)a);
        if (wrapped != expected) {
            TEST_ASSERT_EQUAL(expected, wrapped);
        }
        expected = expected == 18000 ? -17999 : expected + 1;
    }
}

void test_each_angle_of_a_thousand_turns(void) {
    walk_all(-3600000, 3600000);
    TEST_ASSERT_EQUAL(0, argus_angle_wrap(0));
}

void test_each_angle_that_there_is(void) { // wide
    walk_all(INT32_MIN, INT32_MAX);
}

void test_difference_is_the_shorter_way(void) {
    TEST_ASSERT_EQUAL(200, argus_angle_abs_diff(17900, -17900));
    TEST_ASSERT_EQUAL(18000, argus_angle_abs_diff(0, 18000));
    TEST_ASSERT_EQUAL(100, argus_angle_abs_diff(36050, -50));
    TEST_ASSERT_EQUAL(2000, argus_angle_abs_diff(INT32_MAX, INT32_MAX - 2000));
}

void test_sine_and_cosine(void) {
    for (int32_t a = -40000; a <= 40000; a++) {
        const double radians = a / 100.0 * PI / 180;
        snprintf(text, sizeof text, "%d", (int)a);
        TEST_ASSERT_TRUE_MESSAGE(fabs(argus_sin(a) - 16384 * sin(radians)) <= 4, text);
        TEST_ASSERT_TRUE_MESSAGE(fabs(argus_cos(a) - 16384 * cos(radians)) <= 4, text);
    }
    TEST_ASSERT_EQUAL(ARGUS_TRIG_ONE, argus_cos(0));
    TEST_ASSERT_EQUAL(-ARGUS_TRIG_ONE, argus_cos(18000));
    TEST_ASSERT_EQUAL(0, argus_sin(18000));
}

static void check_atan2(int32_t y, int32_t x) {
    const double exact = atan2(y, x) * 18000 / PI;
    const double error = remainder(argus_atan2(y, x) - exact, 36000);
    snprintf(text, sizeof text, "atan2(%d, %d) = %d, exact %.2f", (int)y, (int)x, (int)argus_atan2(y, x),
             exact);
    TEST_ASSERT_TRUE_MESSAGE(fabs(error) <= 6, text);
    TEST_ASSERT_TRUE_MESSAGE(argus_atan2(y, x) > -18000 && argus_atan2(y, x) <= 18000, text);
}

void test_direction_of_small_and_large_vectors(void) {
    for (int32_t x = -60; x <= 60; x++) {
        for (int32_t y = -60; y <= 60; y++) {
            if (x != 0 || y != 0) {
                check_atan2(y, x);
                check_atan2(y * 16666, x * 16666);
                check_atan2(y * 517 + 3, x * 517 - 5);
            }
        }
    }
    for (int degree = 0; degree < 3600; degree++) {
        const double a = degree / 10.0 * PI / 180;
        check_atan2((int32_t)lround(1000000 * sin(a)), (int32_t)lround(1000000 * cos(a)));
        check_atan2((int32_t)lround(30000 * sin(a)), (int32_t)lround(30000 * cos(a)));
    }
    TEST_ASSERT_EQUAL(0, argus_atan2(0, 0));
    TEST_ASSERT_EQUAL(18000, argus_atan2(0, -5));
    TEST_ASSERT_EQUAL(9000, argus_atan2(7, 0));
    TEST_ASSERT_EQUAL(-9000, argus_atan2(-7, 0));
}

void test_square_root_is_the_floor(void) {
    for (uint32_t root = 0; root < 65536; root++) {
        TEST_ASSERT_EQUAL_UINT32(root, argus_sqrt(root * root));
        if (root > 0) {
            TEST_ASSERT_EQUAL_UINT32(root - 1, argus_sqrt(root * root - 1));
        }
    }
    TEST_ASSERT_EQUAL_UINT32(65535, argus_sqrt(UINT32_MAX));
}

void test_length_of_a_vector(void) {
    for (int32_t x = -40000; x <= 40000; x += 797) {
        for (int32_t y = -40000; y <= 40000; y += 811) {
            TEST_ASSERT_EQUAL((int32_t)floor(sqrt((double)x * x + (double)y * y)), argus_hypot(x, y));
        }
    }
}

static uint32_t digest(uint32_t hash, int32_t value) {
    for (int i = 0; i < 4; i++) {
        hash = (hash ^ ((uint32_t)value >> 8 * i & 0xFFu)) * 16777619u;
    }
    return hash;
}

// Records of a mission are replayed elsewhere: each value is the same everywhere, to the last bit.
void test_each_value_is_what_it_was(void) {
    uint32_t sines = 2166136261u;
    uint32_t directions = 2166136261u;
    for (int32_t cdeg = 0; cdeg <= 9000; cdeg++) {
        sines = digest(sines, argus_sin(cdeg));
    }
    for (int32_t x = -3000; x <= 3000; x += 31) {
        for (int32_t y = -3000; y <= 3000; y += 29) {
            directions = digest(directions, argus_atan2(y, x));
        }
    }
    TEST_ASSERT_EQUAL_HEX32(0xE6372921u, sines);
    TEST_ASSERT_EQUAL_HEX32(0xF76D1024u, directions);
}
