// SPDX-License-Identifier: MIT
// Rule under attack: a named wheel is countered by turning against its drift, more the faster it drives; a
// healthy robot is not, and now and then nothing is, so that the wheel can be measured again.
#include "adjustment/trim.h"

#include "unity.h"
#include <string.h>

static argus_wheel_t wheel;
static argus_knowledge_t k;

void setUp(void) {
    memset(&wheel, 0, sizeof wheel);
    argus_knowledge_init(&k);
    k.vel_left_mm_s = k.vel_right_mm_s = 400;
}

void test_a_healthy_robot_is_not_countered(void) {
    TEST_ASSERT_FALSE(argus_trim_is_due(&wheel, &k));
    TEST_ASSERT_EQUAL_INT32(0, argus_trim_cdeg(&wheel, &k));
}

void test_a_short_left_wheel_turns_the_robot_left_so_it_is_turned_right(void) {
    wheel.short_pm = 100;
    const int32_t left_cdeg = argus_trim_cdeg(&wheel, &k);
    // 40 mm/s apart, for 150 ms, over the track
    TEST_ASSERT_INT32_WITHIN(3, -6 * 5730 / k.robot->track_mm, left_cdeg);
    wheel.short_pm = -100;
    TEST_ASSERT_EQUAL_INT32(-left_cdeg, argus_trim_cdeg(&wheel, &k));
    k.vel_left_mm_s = k.vel_right_mm_s = 200;
    TEST_ASSERT_INT32_WITHIN(2, -left_cdeg / 2, argus_trim_cdeg(&wheel, &k));
    k.vel_left_mm_s = k.vel_right_mm_s = -200;
    TEST_ASSERT_EQUAL_INT32(0, argus_trim_cdeg(&wheel, &k));
    k.vel_left_mm_s = k.vel_right_mm_s = 200;
    k.robot = argus_robot_other_end(k.robot);
    TEST_ASSERT_INT32_WITHIN(2, left_cdeg / 2, argus_trim_cdeg(&wheel, &k));
}

void test_it_is_measured_again_after_three_metres(void) {
    wheel.short_pm = 50;
    wheel.odometer_mm = UINT32_MAX - 500; // the counter may wrap
    k.odometer_mm = wheel.odometer_mm + 2999;
    TEST_ASSERT_TRUE(argus_trim_is_due(&wheel, &k));
    k.odometer_mm++;
    TEST_ASSERT_FALSE(argus_trim_is_due(&wheel, &k));
    k.odometer_mm += 2499;
    TEST_ASSERT_FALSE(argus_trim_is_due(&wheel, &k));
    k.odometer_mm++;
    TEST_ASSERT_TRUE(argus_trim_is_due(&wheel, &k));
}

// Exactly what comes apart in 150 ms, in radians of the track.
void test_how_much_it_is_countered(void) {
    k.vel_left_mm_s = k.vel_right_mm_s = 1000;
    wheel.short_pm = 1000;
    TEST_ASSERT_EQUAL_INT32(-(1000 * 150 * 573 / k.robot->track_mm / 100), argus_trim_cdeg(&wheel, &k));
}
