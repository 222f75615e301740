// SPDX-License-Identifier: MIT
// Rule: a robot that is faster than it was set is found within three SIPs, and one that brakes, or whose
// speed scatters as that of any wheels, never.
#include "adjustment/pace.h"

#include "robot/robot.h"
#include "unity.h"

static argus_pace_t pace;
static argus_knowledge_t knowledge;

void setUp(void) {
    argus_knowledge_init(&knowledge);
    knowledge.robot = argus_robot_default();
    argus_pace_init(&pace);
}

static bool sip(int speed_mm_s, int set_mm_s) {
    knowledge.vel_left_mm_s = knowledge.vel_right_mm_s = (int16_t)speed_mm_s;
    return argus_pace_sip(&pace, &knowledge, set_mm_s);
}

void test_twice_the_speed_is_found_once(void) {
    int found = 0;
    for (int k = 0; k < 50; k++) {
        const bool now = sip(1000, 500);
        TEST_ASSERT_TRUE(!now || k == 2);
        found += now;
    }
    TEST_ASSERT_EQUAL_INT(1, found);
    TEST_ASSERT_EQUAL_INT32(1000, pace.seen_mm_s);
}

void test_backwards_counts_likewise(void) {
    TEST_ASSERT_FALSE(sip(-1000, 500));
    TEST_ASSERT_FALSE(sip(-1000, 500));
    TEST_ASSERT_TRUE(sip(-1000, 500));
}

void test_two_sips_alone_are_none(void) {
    for (int k = 0; k < 60; k++) {
        TEST_ASSERT_FALSE(sip(k % 3 == 2 ? 500 : 1000, 500));
    }
    TEST_ASSERT_EQUAL_INT32(0, pace.seen_mm_s);
}

// From 750 to 200 mm/s with its own brake and a cycle late.
void test_a_robot_that_brakes_obeys(void) {
    const int brakes_mm_s = (int)knowledge.robot->decel_mm_s2 / 10;
    int speed_mm_s = 750;
    for (int k = 0; k < 20; k++) {
        TEST_ASSERT_FALSE(sip(speed_mm_s, 750));
    }
    for (int k = 0; k < 60; k++) {
        speed_mm_s = k > 0 && speed_mm_s > 200 ? speed_mm_s - brakes_mm_s : speed_mm_s;
        TEST_ASSERT_FALSE(sip(speed_mm_s, 200));
    }
}

void test_an_eighth_more_is_how_wheels_keep_a_speed(void) {
    for (int k = 0; k < 40; k++) {
        TEST_ASSERT_FALSE(sip(k % 2 == 0 ? 440 : 360, 400));
    }
}

// A client, or a person who pushes, is as fast as may be.
void test_outside_of_a_move_of_ours_nothing_is_found(void) {
    for (int k = 0; k < 40; k++) {
        TEST_ASSERT_FALSE(sip(1500, 0));
    }
    TEST_ASSERT_EQUAL_INT32(0, pace.seen_mm_s);
}
