// SPDX-License-Identifier: MIT
// Rule under attack: while the rear leads all of the robot is told as if its rear were its front, about the
// same place; what is said outside is as before.
#include "knowledge/knowledge.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "knowledge/angle.h"
#include "unity.h"

static argus_knowledge_t front; // the same SIPs, the front leading
static argus_knowledge_t rear;
static argus_sip_t sip;
static uint32_t now_ms;

static void take(void) {
    now_ms += 100;
    argus_knowledge_sip(&front, &sip, 1000, now_ms);
    argus_knowledge_sip(&rear, &sip, 1000, now_ms);
}

void setUp(void) {
    argus_knowledge_init(&front);
    argus_knowledge_init(&rear);
    memset(&sip, 0, sizeof sip);
    now_ms = 1000;
    sip.heading_raw = 700;
    take();
    argus_knowledge_turn_about(&rear, argus_robot_other_end(rear.robot));
}

static void is_turned(void) {
    TEST_ASSERT_INT32_WITHIN(1, front.pose.x_mm, rear.pose.x_mm);
    TEST_ASSERT_INT32_WITHIN(1, front.pose.y_mm, rear.pose.y_mm);
    TEST_ASSERT_EQUAL(front.odometer_mm, rear.odometer_mm);
    TEST_ASSERT_EQUAL(18000, argus_angle_abs_diff(front.pose.heading_cdeg, rear.pose.heading_cdeg));
    TEST_ASSERT_EQUAL(front.pose.heading_cdeg, argus_built_heading_cdeg(&rear));
    TEST_ASSERT_EQUAL(-front.vel_right_mm_s, rear.vel_left_mm_s);
    TEST_ASSERT_EQUAL(-front.vel_left_mm_s, rear.vel_right_mm_s);
    TEST_ASSERT_EQUAL(front.leaps, rear.leaps);
}

void test_a_way_on_wheels_is_the_same_way_seen_from_the_other_end(void) {
    srand(28);
    int x = 0;
    for (int i = 0; i < 300; i++) {
        const int left = rand() % 300 - 150, right = left + rand() % 20 - 10;
        x += (left + right) / 20;
        sip.x_raw = (uint16_t)x;
        sip.vel_left_mm_s = (int16_t)left;
        sip.vel_right_mm_s = (int16_t)right;
        sip.heading_raw = (int16_t)((700 + i) % 4096);
        take();
        is_turned();
    }
    TEST_ASSERT_TRUE(front.odometer_mm > 1000);
}

// So far along the heading of the start, 61.5 degrees.
static void place(double mm) {
    sip.x_raw = (uint16_t)lround(mm * 0.4769);
    sip.y_raw = (uint16_t)lround(mm * 0.8790);
}

void test_a_leap_of_the_odometry_is_left_out_alike(void) {
    sip.vel_left_mm_s = sip.vel_right_mm_s = 200;
    for (int i = 1; i <= 10; i++) {
        place(20 * i);
        take();
    }
    place(5000);
    take();
    TEST_ASSERT_EQUAL(1, front.leaps);
    is_turned();
    place(5020);
    take();
    TEST_ASSERT_EQUAL(1, front.leaps);
    is_turned();
}

void test_a_new_session_keeps_the_heading_of_the_end_that_leads(void) {
    const int32_t heading_cdeg = rear.pose.heading_cdeg;
    argus_knowledge_reopen(&rear, now_ms);
    sip.heading_raw = 0;
    argus_knowledge_sip(&rear, &sip, 1000, now_ms += 100);
    TEST_ASSERT_EQUAL(heading_cdeg, rear.pose.heading_cdeg);
}

void test_bumpers_and_stalls_change_ends_and_are_told_as_they_are(void) {
    sip.bumpers_front = 0x02;
    sip.bumpers_rear = 0x20;
    sip.stall_left = true;
    take();
    TEST_ASSERT_EQUAL(0x20, rear.bumpers_front);
    TEST_ASSERT_EQUAL(0x02, rear.bumpers_rear);
    TEST_ASSERT_TRUE(rear.stall_right && !rear.stall_left);
    TEST_ASSERT_EQUAL(argus_built_bumpers(&front), argus_built_bumpers(&rear));
    TEST_ASSERT_EQUAL(0x0220, argus_built_bumpers(&rear));
    TEST_ASSERT_EQUAL(1, argus_built_stalls(&rear));
    TEST_ASSERT_EQUAL(1, argus_built_stalls(&front));
}

void test_echoes_lie_where_they_lie(void) {
    for (int i = 0; i < rear.sonars; i++) {
        sip.sonar[0].number = (uint8_t)i;
        sip.sonar[0].range_mm = (uint16_t)(500 + 100 * i);
        sip.sonar_count = 1;
        take();
        const argus_point_t a = argus_to_course(&front.pose, argus_echo_robot(&front, i));
        const argus_point_t b = argus_to_course(&rear.pose, argus_echo_robot(&rear, i));
        TEST_ASSERT_INT32_WITHIN(3, a.x_mm, b.x_mm);
        TEST_ASSERT_INT32_WITHIN(3, a.y_mm, b.y_mm);
    }
}

void test_turned_about_twice_nothing_has_changed(void) {
    take();
    argus_knowledge_turn_about(&rear, argus_robot_other_end(rear.robot));
    TEST_ASSERT_EQUAL_PTR(front.robot, rear.robot);
    TEST_ASSERT_EQUAL_MEMORY(&front, &rear, sizeof front);
}
