// SPDX-License-Identifier: MIT
// Rule under attack: S7 for the body itself: a turn is met by what its corner would sweep, on that side
// alone, wherever in a cone the echo lies; what is near already may stay so near.
#include "adjustment/swing.h"

#include <stdio.h>
#include <string.h>

#include "echo.h"
#include "knowledge/angle.h"
#include "unity.h"

static argus_knowledge_t k;
static argus_echoes_t e;
static char text[64];

void setUp(void) {
    argus_knowledge_init(&k);
    argus_echoes_init(&e);
    k.sip_ms = 100000;
}

static void put(int x_mm, int y_mm) {
    place_echo(&e, &k, x_mm, y_mm);
    e.at[e.count - 1].again = true;
}

static bool meets(int32_t by_cdeg) {
    return argus_swing_meets(&k, &e, by_cdeg);
}

void test_nothing_is_met_where_nothing_is(void) {
    TEST_ASSERT_FALSE(meets(9000));
    TEST_ASSERT_FALSE(argus_swing_meets(&k, NULL, -9000));
}

// 20 mm beside the left of the rear end: a turn to the right sweeps it, one to the left goes away from it.
void test_a_corner_sweeps_one_side(void) {
    put(-k.robot->rear_mm + 60, argus_robot_half_width_mm(k.robot) + 20);
    TEST_ASSERT_TRUE(meets(-500));
    TEST_ASSERT_TRUE(meets(-4500));
    TEST_ASSERT_FALSE(meets(500));
    TEST_ASSERT_FALSE(argus_swing_meets(&k, NULL, -500)); // where nothing is remembered
}

// Behind the rear end, where no sonar may be left to look: it stands there until one hears past it, or a
// minute is over.
void test_what_stands_does_not_go_with_the_sonar_that_heard_it(void) {
    put(-k.robot->rear_mm - 20, 100);
    e.at[0].stands = true;
    k.sip_ms += 30000;
    TEST_ASSERT_TRUE(meets(1800));
    TEST_ASSERT_FALSE(meets(-500));
    e.at[0].stands = false;
    TEST_ASSERT_FALSE(meets(1800));
    e.at[0].stands = true;
    k.sip_ms += ARGUS_FORGET_MS;
    TEST_ASSERT_FALSE(meets(1800));
}

// No second time: what was touched is asked of each turn, whoever orders it.
void test_what_was_touched_is_met(void) {
    const argus_point_t at = {-k.robot->rear_mm + 60, argus_robot_half_width_mm(k.robot) + 5};
    argus_touches_add(&e.touches, at);
    TEST_ASSERT_TRUE(meets(-500));
    TEST_ASSERT_FALSE(meets(500));
    TEST_ASSERT_FALSE(argus_swing_meets(&k, NULL, -500)); // where nothing is remembered
}

// A turn is asked all along: by 90 degrees the corner has passed the thing.
void test_what_lies_on_the_way_of_a_turn_is_met(void) {
    put(-k.robot->rear_mm + 60, argus_robot_half_width_mm(k.robot) + 20);
    TEST_ASSERT_TRUE(meets(-18000));
}

void test_beyond_the_circle_nothing_is_met(void) {
    put(0, k.robot->swing_radius_mm + 26);
    put(-k.robot->swing_radius_mm - 26, 0);
    for (int32_t by = -18000; by <= 18000; by += 500) {
        TEST_ASSERT_FALSE(meets(by));
    }
}

static bool meets_place(argus_point_t at, int32_t by_cdeg) {
    e.count = 0;
    put(at.x_mm, at.y_mm);
    const argus_knowledge_t blank = k;
    for (int i = 0; i < k.sonars; i++) {
        k.sonar[i].reported = false;
    }
    const bool met = meets(by_cdeg);
    k = blank;
    return met;
}

// An echo is met where one of its edges or its middle would be, and nowhere else.
static void check_cone(int sonar, int reading_mm, int32_t by_cdeg) {
    const argus_sonar_pose_t pose = argus_robot_pose(k.robot, sonar);
    bool any = false;
    for (int edge = -1; edge <= 1; edge++) {
        const int32_t cdeg = pose.heading_deg * 100 + edge * argus_robot_cone_deg(k.robot, sonar) * 50;
        const argus_point_t at = {pose.x_mm + reading_mm * argus_cos(cdeg) / ARGUS_TRIG_ONE,
                                  pose.y_mm + reading_mm * argus_sin(cdeg) / ARGUS_TRIG_ONE};
        any = any || meets_place(at, by_cdeg);
    }
    k.sonar[sonar].reading_mm = (uint16_t)reading_mm;
    k.sonar[sonar].reported = true;
    snprintf(text, sizeof text, "sonar %d, %d mm, by %d", sonar, reading_mm, (int)by_cdeg);
    TEST_ASSERT_EQUAL_MESSAGE(any, argus_swing_meets(&k, NULL, by_cdeg), text);
    k.sonar[sonar].reported = false;
}

void test_an_echo_is_anywhere_in_its_cone(void) {
    static const int32_t by[] = {500, -500, 2000, -2000, 9000, -9000};
    for (int sonar = 0; sonar < k.sonars; sonar++) {
        for (int mm = 10; mm < 400; mm += 13) {
            for (size_t i = 0; i < sizeof by / sizeof by[0]; i++) {
                check_cone(sonar, mm, by[i]);
            }
        }
    }
}
