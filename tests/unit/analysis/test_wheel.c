// SPDX-License-Identifier: MIT
// Rule under attack: a wheel is named with its side and size after two pieces of way that bend alike, and
// cleared after two that do not; whichever end leads, it is the same wheel.
#include <math.h>
#include <string.h>

#include "analysis/wheel.h"
#include "unity.h"

#define CDEG_PER_RADIAN 5729.578

static argus_wheel_t wheel;
static argus_knowledge_t k;

void setUp(void) {
    memset(&wheel, 0, sizeof wheel);
    argus_knowledge_init(&k);
}

// What wheels that are told the same make of a way when one turns but a part: positive the left one.
static argus_way_turn_t bent(int32_t way_mm, double short_pm) {
    const double part = fabs(short_pm) / 1000;
    const double apart_mm = way_mm * part / (1 - part / 2);
    const double turn = (short_pm > 0 ? apart_mm : -apart_mm) / k.robot->track_mm;
    const argus_way_turn_t piece = {way_mm, (int32_t)lround(turn * CDEG_PER_RADIAN)};
    return piece;
}

static argus_wheel_news_t take(int32_t way_mm, double short_pm) {
    k.odometer_mm += (uint32_t)way_mm;
    const argus_way_turn_t piece = bent(way_mm, short_pm);
    return argus_wheel_judge(&wheel, &k, &piece);
}

void test_each_size_and_side_is_named(void) {
    for (int pm = 10; pm <= 140; pm += 10) {
        for (int side = -1; side <= 1; side += 2) {
            setUp();
            TEST_ASSERT_EQUAL_INT(ARGUS_WHEEL_SAME, take(400, side * pm));
            TEST_ASSERT_EQUAL_INT(ARGUS_SUSPECT, wheel.health);
            TEST_ASSERT_EQUAL_INT16(0, wheel.short_pm);
            TEST_ASSERT_EQUAL_INT(ARGUS_WHEEL_NAMED, take(400, side * pm));
            TEST_ASSERT_INT16_WITHIN(2, side * pm, wheel.short_pm);
            TEST_ASSERT_EQUAL_INT(ARGUS_KIND_WRONG, wheel.kind);
        }
    }
}

void test_one_piece_or_two_that_differ_name_nobody(void) {
    TEST_ASSERT_EQUAL_INT(ARGUS_WHEEL_SAME, take(300, 50));
    TEST_ASSERT_EQUAL_INT(ARGUS_WHEEL_SAME, take(1000, 0));
    TEST_ASSERT_EQUAL_INT(ARGUS_HEALTHY, wheel.health);
    TEST_ASSERT_EQUAL_INT(ARGUS_WHEEL_SAME, take(300, 50));
    TEST_ASSERT_EQUAL_INT(ARGUS_WHEEL_SAME, take(300, -50));
    TEST_ASSERT_EQUAL_INT(ARGUS_WHEEL_SAME, take(300, 140));
    TEST_ASSERT_EQUAL_INT(ARGUS_WHEEL_SAME, take(300, 400));
    TEST_ASSERT_EQUAL_INT(ARGUS_WHEEL_SAME, take(300, 400));
    TEST_ASSERT_EQUAL_INT16(0, wheel.short_pm);
}

void test_straight_ways_name_nobody(void) {
    for (int i = 0; i < 50; i++) {
        TEST_ASSERT_EQUAL_INT(ARGUS_WHEEL_SAME, take(1000, i % 2 == 0 ? 4 : -4));
    }
    TEST_ASSERT_EQUAL_INT(ARGUS_HEALTHY, wheel.health);
}

void test_the_size_follows_and_two_straight_pieces_clear_it(void) {
    take(300, 50);
    take(300, 50);
    for (int i = 0; i < 12; i++) {
        TEST_ASSERT_EQUAL_INT(ARGUS_WHEEL_SAME, take(300, 60));
    }
    TEST_ASSERT_INT16_WITHIN(3, 60, wheel.short_pm);
    TEST_ASSERT_EQUAL_INT(ARGUS_WHEEL_SAME, take(1000, 0));
    TEST_ASSERT_INT16_WITHIN(3, 60, wheel.short_pm);
    TEST_ASSERT_EQUAL_INT(ARGUS_WHEEL_CLEARED, take(1000, 0));
    TEST_ASSERT_EQUAL_INT16(0, wheel.short_pm);
    TEST_ASSERT_EQUAL_INT(ARGUS_KIND_NONE, wheel.kind);
}

void test_with_the_rear_ahead_it_is_the_same_wheel(void) {
    k.robot = argus_robot_other_end(k.robot);
    take(300, -50); // in the frame of the leading rear, which is turned about, the right one is short
    take(300, -50);
    TEST_ASSERT_INT16_WITHIN(2, 50, wheel.short_pm);
}

void test_no_piece_is_too_odd(void) {
    const argus_way_turn_t odd[] = {{40, INT32_MAX}, {40, INT32_MIN + 1}, {1000000, 60}, {1, 9000}};
    for (size_t i = 0; i < sizeof odd / sizeof odd[0]; i++) {
        TEST_ASSERT_EQUAL_INT(ARGUS_WHEEL_SAME, argus_wheel_judge(&wheel, &k, &odd[i]));
    }
    TEST_ASSERT_EQUAL_INT16(0, wheel.short_pm);
}

// Two pieces that differ by little, to either side, are no wheel: neither of them is named.
void test_pieces_that_bend_to_either_side_name_no_wheel(void) {
    TEST_ASSERT_EQUAL_INT(ARGUS_WHEEL_SAME, take(1000, 5));
    TEST_ASSERT_EQUAL_INT(ARGUS_WHEEL_SAME, take(1000, -5));
    TEST_ASSERT_EQUAL_INT(ARGUS_KIND_NONE, wheel.kind);
}
