// SPDX-License-Identifier: MIT
// Rule under attack: what a robot without ARCOS says becomes the SIP that an ARCOS robot would send: wheels
// by its track, positions that wrap, no old range, none beyond what is counted or fits.
#include "knowledge/observe.h"

#include <string.h>

#include "unity.h"

static argus_range_t ranges[ARGUS_SIP_SONARS_MAX + 2];
static argus_observation_t said;
static argus_sip_t sip;

void setUp(void) {
    for (unsigned i = 0; i < sizeof ranges / sizeof ranges[0]; i++) {
        ranges[i] = (argus_range_t){(uint8_t)(i % 16), (uint16_t)(1000 + i), 0};
    }
    said = (argus_observation_t){.ranges = ranges};
}

static void take(void) {
    argus_sip_of(&sip, &said, argus_robot_default());
}

static void expect_wheels(int left_mm_s, int right_mm_s) {
    take();
    TEST_ASSERT_EQUAL_INT(left_mm_s, sip.vel_left_mm_s);
    TEST_ASSERT_EQUAL_INT(right_mm_s, sip.vel_right_mm_s);
    TEST_ASSERT_EQUAL(left_mm_s != 0 || right_mm_s != 0, sip.moving);
}

void test_wheels_are_as_far_apart_as_the_track_says(void) {
    const int half_mm_s = 9000 * argus_robot_default()->track_mm / 5730 / 2; // at 90 degrees/s
    expect_wheels(0, 0);
    said.speed_mm_s = 200;
    expect_wheels(200, 200);
    said.turn_cdeg_s = 9000;
    expect_wheels(200 - half_mm_s, 200 + half_mm_s);
    said.speed_mm_s = half_mm_s; // round its left wheel
    expect_wheels(0, 2 * half_mm_s);
    said.turn_cdeg_s = -9000;
    expect_wheels(2 * half_mm_s, 0);
}

void test_speeds_that_no_robot_has_do_not_overflow(void) {
    said.speed_mm_s = INT32_MAX;
    said.turn_cdeg_s = INT32_MIN;
    take();
    TEST_ASSERT_TRUE(sip.vel_left_mm_s > sip.vel_right_mm_s);
}

void test_ranges_are_those_that_are_counted_and_of_now(void) {
    said.count = 3;
    ranges[1].age_ms = ARGUS_RANGE_OLD_MS + 1;
    ranges[2].age_ms = ARGUS_RANGE_OLD_MS;
    take();
    TEST_ASSERT_EQUAL_INT(2, sip.sonar_count);
    TEST_ASSERT_EQUAL_INT(0, sip.sonar[0].number);
    TEST_ASSERT_EQUAL_INT(1002, sip.sonar[1].range_mm);
    said.count = 0;
    take();
    TEST_ASSERT_EQUAL_INT(0, sip.sonar_count);
}

void test_no_more_ranges_than_a_sip_holds(void) {
    const uint8_t behind = 0xA5;
    struct {
        argus_sip_t sip;
        uint8_t behind;
    } held = {.behind = behind};
    said.count = ARGUS_SIP_SONARS_MAX + 2;
    argus_sip_of(&held.sip, &said, argus_robot_default());
    TEST_ASSERT_EQUAL_INT(ARGUS_SIP_SONARS_MAX, held.sip.sonar_count);
    TEST_ASSERT_EQUAL_HEX8(behind, held.behind);
}

void test_a_place_beyond_16_bits_wraps_as_on_the_wire(void) {
    const int32_t um = argus_robot_default()->dist_conv_um;
    said.pose = (argus_pose_t){.x_mm = 70000, .y_mm = -1, .heading_cdeg = 36000 + 9000};
    take();
    TEST_ASSERT_EQUAL_HEX16((uint16_t)((int64_t)70000 * 1000 / um), sip.x_raw);
    TEST_ASSERT_EQUAL_HEX16((uint16_t)(-1000 / um), sip.y_raw);
    TEST_ASSERT_EQUAL_INT(1024, sip.heading_raw);
    TEST_ASSERT_EQUAL_INT(125, sip.battery_dv);
}
