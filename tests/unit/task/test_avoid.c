// SPDX-License-Identifier: MIT
// Rule under attack: the way round: which heading is free, which side is kept, when there is none.
#include "task/task.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "echo.h"
#include "health.h"
#include "knowledge/angle.h"
#include "unity.h"

static argus_task_t t;
static argus_echoes_t e;
static argus_knowledge_t k;

void setUp(void) {
    argus_task_init(&t);
    argus_echoes_init(&e);
    argus_knowledge_init(&k);
    k.sip_ms = 100000;
    const argus_point_t goal = {5000, 0};
    TEST_ASSERT_TRUE(argus_task_set(&t, &goal, 1));
}

static int32_t heading_chosen(void) {
    return argus_task_bearing_cdeg(&t, &k);
}

void test_far_from_the_start_nothing_overflows(void) {
    k.pose.x_mm = 2000000;
    k.pose.y_mm = -2000000;
    see_echo(&e, &k, 3, 500);
    TEST_ASSERT_EQUAL(0, e.count);
    argus_echoes_clear_mm(&e, &k, 0, 305);
    argus_task_choose(&t, &k, &e);
}

void test_the_straight_way_until_something_stops_it(void) {
    place_echo(&e, &k, 600, 0);
    TEST_ASSERT_TRUE(argus_task_choose(&t, &k, &e));
    TEST_ASSERT_EQUAL(0, heading_chosen());
}

void test_a_refused_heading_is_not_taken_again_here(void) {
    argus_task_refuse(&t, &k);
    TEST_ASSERT_TRUE(argus_task_choose(&t, &k, &e));
    TEST_ASSERT_TRUE(argus_angle_abs_diff(heading_chosen(), 0) >= 1500);
    k.pose.x_mm += 200; // moved on
    argus_task_restart(&t);
    TEST_ASSERT_TRUE(argus_task_choose(&t, &k, &e));
    TEST_ASSERT_TRUE(argus_angle_abs_diff(heading_chosen(), 0) < 100);
}

static void flank_reads(int sonar, int mm) {
    k.sonar[sonar].reported = true;
    k.sonar[sonar].health = ARGUS_HEALTHY;
    k.sonar[sonar].reading_mm = (uint16_t)mm;
}

static bool goes_straight_on(void) {
    return argus_task_choose(&t, &k, &e) && argus_angle_abs_diff(heading_chosen(), 0) < 1500;
}

// Neither waiting nor a sonar that is given up takes a wall beside the way out of it.
void test_a_slant_stays_refused_while_the_flank_reads_near(void) {
    for (int sonar = 0; sonar <= 7; sonar += 7) {
        setUp();
        flank_reads(0, 5000);
        flank_reads(7, 5000);
        flank_reads(sonar, 150);
        argus_task_refuse_slant(&t, &k);
        argus_task_forgive(&t, &k);
        TEST_ASSERT_FALSE(goes_straight_on());
        argus_task_restart(&t);
        TEST_ASSERT_FALSE(goes_straight_on());
        TEST_ASSERT_TRUE(t.avoiding); // so that the detour ends, and the bearing is tried again
        flank_reads(sonar, 351);
        argus_task_forgive(&t, &k);
        TEST_ASSERT_TRUE(goes_straight_on());
    }
}

void test_a_slant_is_forgotten_when_the_robot_has_moved_on(void) {
    flank_reads(7, 150);
    argus_task_refuse_slant(&t, &k);
    k.pose.x_mm -= 149;
    TEST_ASSERT_FALSE(goes_straight_on());
    k.pose.x_mm -= 1;
    TEST_ASSERT_TRUE(goes_straight_on());
}

void test_the_detour_leads_past_the_obstacle(void) {
    for (int y = -300; y <= 100; y += 100) {
        place_echo(&e, &k, 450, y);
    }
    argus_task_refuse(&t, &k);
    TEST_ASSERT_TRUE(argus_task_choose(&t, &k, &e));
    TEST_ASSERT_TRUE(t.avoiding);
    TEST_ASSERT_TRUE(heading_chosen() > 0); // the left side is nearer
    TEST_ASSERT_TRUE(argus_echoes_clear_mm(&e, &k, heading_chosen(), 305) >= 600);
}

void test_no_way_when_every_heading_is_blocked(void) {
    for (int a = 0; a < 36000; a += 1000) {
        place_echo(&e, &k, 450 * argus_cos(a) / ARGUS_TRIG_ONE, 450 * argus_sin(a) / ARGUS_TRIG_ONE);
    }
    argus_task_refuse(&t, &k);
    TEST_ASSERT_FALSE(argus_task_choose(&t, &k, &e));
    TEST_ASSERT_FALSE(t.has_leg);
}

void test_many_refusals_are_survived(void) {
    for (int i = 0; i < 100; i++) {
        k.pose.heading_cdeg = argus_angle_wrap(i * 997);
        argus_task_refuse(&t, &k);
        argus_task_choose(&t, &k, &e);
    }
}
