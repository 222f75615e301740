// SPDX-License-Identifier: MIT
// Rule under attack: the pose survives the robot's wraps, units and resets; a reading is fresh only if listed
// after the mark.
#include "knowledge/body.h"
#include "knowledge/knowledge.h"

#include <math.h>
#include <string.h>

#include "health.h"
#include "knowledge/angle.h"
#include "unity.h"

static argus_knowledge_t k;
static argus_sip_t sip;
static uint32_t now_ms;

void setUp(void) {
    argus_knowledge_init(&k);
    memset(&sip, 0, sizeof sip);
    now_ms = 0xFFFFFF00u;
}

static void take(int32_t distance_um) {
    now_ms += 100;
    argus_knowledge_sip(&k, &sip, distance_um, now_ms);
}

static void wheels(int left_mm_s, int right_mm_s) {
    sip.vel_left_mm_s = (int16_t)left_mm_s;
    sip.vel_right_mm_s = (int16_t)right_mm_s;
}

static void list(int sonar, int mm) {
    sip.sonar[sip.sonar_count].number = (uint8_t)sonar;
    sip.sonar[sip.sonar_count].range_mm = (uint16_t)mm;
    sip.sonar_count++;
}

static void drive_through_wraps(uint16_t mask, int32_t distance_um, int direction) {
    setUp();
    const double unit_mm = distance_um / 1000.0;
    const int speed = (int)lround(hypot(600, 200) * unit_mm * direction);
    take(distance_um);
    wheels(150, -150);
    for (int i = 1; i <= 10; i++) { // to where the way goes
        sip.heading_raw = (int16_t)(-21 * i);
        take(distance_um);
    }
    wheels(speed, speed);
    for (int i = 0; i <= 3000; i++) { // 3000 x 60 units: more than two turns of 16 bits
        sip.x_raw = (uint16_t)(i * 60 * direction) & mask;
        sip.y_raw = (uint16_t)(-i * 20 * direction) & mask;
        take(distance_um);
    }
    TEST_ASSERT_INT32_WITHIN(5, (int32_t)lround(180000 * unit_mm * direction), k.pose.x_mm);
    TEST_ASSERT_INT32_WITHIN(5, (int32_t)lround(-60000 * unit_mm * direction), k.pose.y_mm);
    const double way = hypot(180000, 60000) * unit_mm;
    TEST_ASSERT_INT32_WITHIN((int32_t)(way * 0.02), (int32_t)way, (int32_t)k.odometer_mm);
}

void test_pose_through_15_and_16_bit_wraps_in_both_units(void) {
    for (int direction = -1; direction <= 1; direction += 2) {
        drive_through_wraps(0xFFFF, 1000, direction);
        drive_through_wraps(0x7FFF, 1000, direction);
        drive_through_wraps(0xFFFF, 485, direction);
        drive_through_wraps(0x7FFF, 485, direction);
    }
}

void test_a_first_position_other_than_zero_is_no_way_driven(void) {
    sip.x_raw = 12345;
    sip.y_raw = 23456;
    sip.heading_raw = 1024;
    take(1000);
    TEST_ASSERT_EQUAL(0, k.pose.x_mm);
    TEST_ASSERT_EQUAL(0, k.pose.y_mm);
    TEST_ASSERT_EQUAL(0, k.pose.heading_cdeg);
    TEST_ASSERT_EQUAL(0, k.odometer_mm);
}

void test_headings(void) {
    for (int raw = 0; raw <= 2048 + 4095; raw++) {
        sip.heading_raw = (int16_t)((raw + 2047) % 4096 - 2047);
        take(1000);
        TEST_ASSERT_INT32_WITHIN(1, argus_angle_wrap((int32_t)lround(raw % 4096 * 36000.0 / 4096)),
                                 k.pose.heading_cdeg);
    }
}

void test_odometry_set_to_zero_leaves_the_pose_alone(void) {
    take(1000);
    wheels(500, 500);
    for (int i = 1; i <= 100; i++) {
        sip.x_raw = (uint16_t)(i * 50);
        take(1000);
    }
    wheels(-200, 200);
    for (int i = 1; i <= 16; i++) {
        sip.heading_raw = (int16_t)(i * 64); // to 90 degrees
        take(1000);
    }
    TEST_ASSERT_EQUAL(5000, k.pose.x_mm);
    wheels(0, 0);
    take(1000);
    TEST_ASSERT_FALSE(k.leapt);
    sip.x_raw = sip.y_raw = 0;
    sip.heading_raw = 0;
    take(1000);
    TEST_ASSERT_INT32_WITHIN(2, 5000, k.pose.x_mm);
    TEST_ASSERT_INT32_WITHIN(10, 9000, k.pose.heading_cdeg);
    TEST_ASSERT_TRUE(k.leapt);
    TEST_ASSERT_INT32_WITHIN(2, 5000, k.leap_mm);
    TEST_ASSERT_INT32_WITHIN(10, 9000, k.leap_cdeg);
    wheels(500, 500);
    sip.x_raw = 50; // ahead in the new frame is left in the course's
    take(1000);
    sip.x_raw = 100;
    take(1000);
    TEST_ASSERT_INT32_WITHIN(1, 5000, k.pose.x_mm);
    TEST_ASSERT_INT32_WITHIN(1, 100, k.pose.y_mm);
}

void test_a_new_session_goes_on_from_where_the_robot_was(void) {
    take(1000);
    wheels(100, -100);
    for (int i = 1; i <= 5; i++) {
        sip.heading_raw = (int16_t)(-20 * i);
        take(1000);
    }
    wheels(700, 700);
    sip.x_raw = 70;
    take(1000);
    sip.x_raw = 140;
    take(1000);
    argus_knowledge_reopen(&k, now_ms);
    sip.x_raw = 0; // nearer than a leap: only the reopening tells
    sip.heading_raw = 0;
    take(1000);
    TEST_ASSERT_EQUAL(140, k.pose.x_mm);
    TEST_ASSERT_INT32_WITHIN(1, -879, k.pose.heading_cdeg);
}

void test_reopening_makes_every_sonar_report_anew(void) {
    list(3, 1000);
    take(1000);
    TEST_ASSERT_TRUE(k.sonar[3].reported);
    argus_knowledge_reopen(&k, now_ms);
    TEST_ASSERT_FALSE(k.sonar[3].reported);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, argus_age_ms(&k, 3, now_ms));
}

void test_fresh_only_when_listed_after_the_mark(void) {
    list(3, 1000);
    take(1000);
    const argus_mark_t mark = argus_mark_now(&k);
    TEST_ASSERT_FALSE(argus_fresh_since(&k, 3, &mark)); // in the SIP of the mark itself
    sip.sonar_count = 0;
    take(1000);
    TEST_ASSERT_FALSE(argus_fresh_since(&k, 3, &mark));
    list(3, 1000);
    take(1000);
    TEST_ASSERT_TRUE(argus_fresh_since(&k, 3, &mark));
    TEST_ASSERT_FALSE(argus_all_fresh_since(&k, 0x18, &mark));
    list(4, 1000);
    take(1000);
    TEST_ASSERT_TRUE(argus_all_fresh_since(&k, 0x18, &mark));
}

// A SIP of such a server may list pings up to 140 ms old; all have fired anew after another 320 ms.
void test_servers_that_list_every_sonar_get_460_ms_more(void) {
    for (int i = 0; i < 16; i++) {
        list(i, 1000);
    }
    take(1000);
    TEST_ASSERT_TRUE(k.lists_all);
    const argus_mark_t mark = argus_mark_now(&k);
    const uint32_t from = now_ms;
    for (int i = 0; i < 10; i++) {
        take(1000);
        TEST_ASSERT_EQUAL(now_ms - from >= 460, argus_fresh_since(&k, 3, &mark));
    }
}

void test_the_firing_schedule_is_no_listing_of_all(void) {
    list(0, 1), list(3, 1), list(5, 1), list(8, 1), list(9, 1), list(10, 1);
    take(1000);
    TEST_ASSERT_FALSE(k.lists_all);
}

void test_rest_takes_two_sips_within_5_mm_s(void) {
    sip.vel_left_mm_s = 5;
    sip.vel_right_mm_s = -5;
    take(1000);
    TEST_ASSERT_FALSE(argus_at_rest(&k));
    take(1000);
    TEST_ASSERT_TRUE(argus_at_rest(&k));
    sip.vel_right_mm_s = -6;
    take(1000);
    TEST_ASSERT_FALSE(argus_at_rest(&k));
}

void test_usable_readings(void) {
    TEST_ASSERT_FALSE(argus_usable(&k, 2));
    list(2, 4999);
    take(1000);
    TEST_ASSERT_TRUE(argus_usable(&k, 2));
    sip.sonar[0].range_mm = 5000;
    take(1000);
    TEST_ASSERT_FALSE(argus_usable(&k, 2));
    sip.sonar[0].range_mm = 800;
    take(1000);
    put_health(&k.sonar[2], ARGUS_DISABLED, ARGUS_KIND_WRONG, now_ms);
    TEST_ASSERT_FALSE(argus_usable(&k, 2));
    TEST_ASSERT_EQUAL_HEX16(4, argus_disabled(&k));
    TEST_ASSERT_EQUAL(1, k.sonar[2].disabled_times);
}

void test_sonar_numbers_beyond_the_ring_are_passed_over(void) {
    list(16, 1), list(31, 1), list(255, 1), list(7, 321);
    take(1000);
    TEST_ASSERT_EQUAL_HEX16(0x80, k.fresh);
    TEST_ASSERT_EQUAL(321, k.sonar[7].reading_mm);
}

void test_where_an_echo_lies(void) {
    for (int i = 0; i < 16; i++) {
        list(i, 1000);
    }
    take(1000);
    for (int i = 0; i < 16; i++) {
        const double a = argus_robot_table.poses[i].heading_deg * 3.14159265358979 / 180;
        const argus_point_t echo = argus_echo_robot(&k, i);
        TEST_ASSERT_INT32_WITHIN(2, (int32_t)lround(argus_robot_table.poses[i].x_mm + 1000 * cos(a)),
                                 echo.x_mm);
        TEST_ASSERT_INT32_WITHIN(2, (int32_t)lround(argus_robot_table.poses[i].y_mm + 1000 * sin(a)),
                                 echo.y_mm);
    }
    const argus_pose_t pose = {100, 200, 9000};
    const argus_point_t ahead = {1000, 10};
    TEST_ASSERT_EQUAL(90, argus_to_course(&pose, ahead).x_mm);
    TEST_ASSERT_EQUAL(1200, argus_to_course(&pose, ahead).y_mm);
}

// 3 and 4 look 10 degrees aside, so that 100 mm farther back is 99 mm farther off.
void test_nearest_echo_leaves_out_the_disabled_and_may_be_of_a_place_farther_back(void) {
    list(3, 300), list(4, 400), list(5, 500);
    take(1000);
    TEST_ASSERT_INT32_WITHIN(3, 468, argus_nearest_to_centre_mm(&k, 0));
    TEST_ASSERT_INT32_WITHIN(3, 567, argus_nearest_to_centre_mm(&k, 100));
    TEST_ASSERT_INT32_WITHIN(3, 468, argus_echo_to_centre_mm(&k, 3, 0));
    TEST_ASSERT_INT32_WITHIN(3, 568, argus_echo_to_centre_mm(&k, 4, 0));
    TEST_ASSERT_EQUAL(INT32_MAX, argus_echo_to_centre_mm(&k, 2, 0)); // not read
    put_health(&k.sonar[3], ARGUS_DISABLED, ARGUS_KIND_OFF, now_ms);
    TEST_ASSERT_INT32_WITHIN(3, 568, argus_nearest_to_centre_mm(&k, 0));
    TEST_ASSERT_EQUAL(INT32_MAX, argus_echo_to_centre_mm(&k, 3, 0));
    argus_knowledge_init(&k);
    TEST_ASSERT_EQUAL(INT32_MAX, argus_nearest_to_centre_mm(&k, 0));
}

void test_sonars_beyond_the_robots_are_absent_and_not_heard(void) {
    argus_body_is(&k, argus_robot_find("amigo-sh"), now_ms);
    for (int i = 0; i < 16; i++) {
        list(i, 300);
    }
    take(1000);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        TEST_ASSERT_EQUAL(i < 8 ? ARGUS_UNKNOWN : ARGUS_ABSENT, k.sonar[i].health);
        TEST_ASSERT_EQUAL(i < 8, k.sonar[i].reported);
        TEST_ASSERT_EQUAL(i < 8, argus_usable(&k, i));
    }
    TEST_ASSERT_EQUAL_HEX16(0xFF, k.fresh);
    TEST_ASSERT_EQUAL_HEX16(0, argus_out(&k));
    TEST_ASSERT_EQUAL(300, argus_flank_mm(&k, 0));
    TEST_ASSERT_EQUAL(INT32_MAX, argus_flank_mm(&k, 0xFF));
    argus_body_is(&k, argus_robot_default(), now_ms);
    TEST_ASSERT_EQUAL_HEX16(0xFFFF, argus_with_health(&k, ARGUS_UNKNOWN));
    argus_body_is(&k, argus_robot_unknown(), now_ms);
    TEST_ASSERT_EQUAL(0, k.sonars);
    TEST_ASSERT_EQUAL(ARGUS_ABSENT, k.sonar[0].health);
    TEST_ASSERT_EQUAL(INT32_MAX, argus_nearest_to_centre_mm(&k, 0));
}

// The order that turns them on may come late; one that never comes does not excuse them for ever.
void test_sonars_are_not_silent_before_their_array_is_on(void) {
    argus_knowledge_reopen(&k, now_ms);
    for (int i = 0; i < 50; i++) {
        take(1000);
    }
    TEST_ASSERT_EQUAL_UINT32(0, argus_silent_ms(&k, 3));
    sip.flags = ARCOS_FLAG_SONAR1;
    for (int i = 0; i < 20; i++) {
        take(1000);
    }
    TEST_ASSERT_EQUAL_UINT32(2000, argus_silent_ms(&k, 3));
    setUp();
    argus_knowledge_reopen(&k, now_ms);
    for (int i = 0; i < 80; i++) {
        take(1000);
    }
    TEST_ASSERT_UINT32_WITHIN(200, 2000, argus_silent_ms(&k, 3));
    setUp();
    argus_knowledge_reopen(&k, now_ms);
    list(0, 1000);
    take(1000);
    sip.sonar_count = 0;
    for (int i = 0; i < 20; i++) { // one of them was heard: on, whatever FLAGS says
        take(1000);
    }
    TEST_ASSERT_EQUAL_UINT32(2100, argus_silent_ms(&k, 3));
}

// A SIP may state any speed of a wheel. What is worked out of it counts on one that robots drive: the guard
// port's way to the side overflowed, and the least of 16 bits has no opposite for the end that leads.
void test_a_wheel_that_no_robot_has_is_as_fast_as_the_fastest(void) {
    static const int16_t stated[] = {INT16_MIN, -2001, -2000, 2000, 2001, INT16_MAX};
    static const int16_t kept[] = {-2000, -2000, -2000, 2000, 2000, 2000};
    for (int reversed = 0; reversed <= 1; reversed++) {
        setUp();
        take(1000);
        if (reversed != 0) {
            argus_knowledge_turn_about(&k, argus_robot_other_end(k.robot));
        }
        for (int i = 0; i < 6; i++) {
            wheels(stated[i], stated[5 - i]);
            take(1000);
            TEST_ASSERT_EQUAL(kept[i], argus_built_wheels(&k).left_mm_s);
            TEST_ASSERT_EQUAL(kept[5 - i], argus_built_wheels(&k).right_mm_s);
        }
    }
}

void test_the_count_of_sips_at_rest_stops_at_its_end(void) {
    for (int i = 0; i < UINT16_MAX + 5; i++) {
        take(1000);
    }
    TEST_ASSERT_TRUE(argus_at_rest(&k));
    TEST_ASSERT_EQUAL_UINT(UINT16_MAX, k.still_sips);
}

void test_a_place_is_set_back_and_its_fractions_with_it(void) {
    take(1000);
    k.x_um = 400;
    k.y_um = -300;
    k.pose.heading_cdeg = 4500;
    const argus_pose_t to = {.x_mm = 12, .y_mm = -34, .heading_cdeg = 0};
    argus_knowledge_set_back(&k, &to);
    TEST_ASSERT_EQUAL(12, k.pose.x_mm);
    TEST_ASSERT_EQUAL(-34, k.pose.y_mm);
    TEST_ASSERT_EQUAL(0, k.x_um);
    TEST_ASSERT_EQUAL(0, k.y_um);
    TEST_ASSERT_EQUAL(4500, k.pose.heading_cdeg); // slip says nothing of it
}

// Silence has no distance that a deck could be taken off. A build for 16 sonars has none of the other deck.
void test_silence_of_another_deck_is_silence(void) {
    argus_body_is(&k, argus_robot_chosen(4), 0); // peoplebot-sh
    int others = 0;
    for (int i = 0; i < k.sonars; i++) {
        k.sonar[i].reading_mm = (uint16_t)k.robot->no_echo_mm;
        TEST_ASSERT_EQUAL(k.robot->no_echo_mm, argus_reading_ahead_mm(&k, i));
        k.sonar[i].reading_mm = 1500;
        others += argus_reading_ahead_mm(&k, i) < 1500 ? 1 : 0;
    }
    TEST_ASSERT_EQUAL(ARGUS_SONARS > 16, others > 0);
}

// The trusted count; where there are none, those that are named. One that went stale is neither, though its
// last reading is of now.
void test_who_is_living(void) {
    for (int i = 0; i < k.sonars; i++) {
        put_health(&k.sonar[i], ARGUS_HEALTHY, ARGUS_KIND_NONE, 0);
        k.sonar[i].reported = true;
        k.sonar[i].heard_ms = now_ms;
    }
    const argus_mask_t all = argus_living(&k, 2000, now_ms);
    TEST_ASSERT_EQUAL_HEX32(argus_robot_all(k.robot), all);
    put_health(&k.sonar[3], ARGUS_STALE, ARGUS_KIND_NONE, now_ms);
    put_health(&k.sonar[4], ARGUS_DISABLED, ARGUS_KIND_OFF, now_ms);
    put_health(&k.sonar[5], ARGUS_SUSPECT, ARGUS_KIND_WRONG, now_ms);
    TEST_ASSERT_EQUAL_HEX32(all & ~(7u << 3), argus_living(&k, 2000, now_ms));
    for (int i = 0; i < k.sonars; i++) {
        if (i != 5) {
            put_health(&k.sonar[i], ARGUS_DISABLED, ARGUS_KIND_OFF, now_ms);
        }
    }
    TEST_ASSERT_EQUAL_HEX32(1u << 5, argus_living(&k, 2000, now_ms));
}

// Each of the three by itself: a heading beyond a turn, and either wheel.
void test_what_no_robot_states_is_no_motion(void) {
    static const int16_t stated[][3] = {
        {4097, 0, 0}, {-4097, 0, 0}, {0, 2001, 0}, {0, 0, 2001}, {0, 0, -2001}};
    for (size_t i = 0; i < sizeof stated / sizeof stated[0]; i++) {
        setUp();
        take(1000);
        take(1000);
        TEST_ASSERT_FALSE(k.leapt);
        sip.heading_raw = stated[i][0];
        wheels(stated[i][1], stated[i][2]);
        take(1000);
        TEST_ASSERT_TRUE(k.leapt);
    }
}

// An origin that was asked for is taken in any SIP; after a silence in motion how far the robot got until
// then is not known.
void test_an_origin_taken_in_a_silence_in_motion_loses_the_way(void) {
    for (int silent = 0; silent < 2; silent++) {
        setUp();
        sip.x_raw = 3000;
        wheels(400, 400);
        take(1000);
        argus_knowledge_origin_due(&k);
        now_ms += silent != 0 ? 3000 : 0;
        sip.x_raw = 20;
        take(1000);
        TEST_ASSERT_EQUAL(silent, k.leapt);
        TEST_ASSERT_EQUAL(silent, k.leaps_unseen);
    }
}

// A turn weighs as a way does, in units of the odometry: one that turns where it stands has not restarted.
void test_a_turn_where_it_stands_is_no_origin(void) {
    sip.x_raw = 1000;
    take(1000);
    wheels(-200, 200);
    for (int i = 1; i <= 10; i++) {
        sip.heading_raw = (int16_t)(8 * i);
        take(1000);
    }
    const int32_t before_cdeg = k.pose.heading_cdeg;
    argus_knowledge_origin_due(&k);
    wheels(200, -200);
    sip.heading_raw = 0;
    take(1000);
    TEST_ASSERT_FALSE(k.leapt);
    TEST_ASSERT_INT32_WITHIN(20, before_cdeg - 703, k.pose.heading_cdeg);
}

// The finer value counts where the SIP has one and the server fills it in.
void test_the_battery_is_the_finer_value_where_there_is_one(void) {
    for (int has = 0; has < 2; has++) {
        for (int value = 0; value <= 125; value += 125) {
            sip.battery_dv = 120;
            sip.has_battery_x10 = has != 0;
            sip.battery_x10_dv = (uint16_t)value;
            take(1000);
            TEST_ASSERT_EQUAL(has != 0 && value != 0 ? 125 : 120, k.battery_dv);
        }
    }
}
