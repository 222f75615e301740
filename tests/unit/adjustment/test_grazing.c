// SPDX-License-Identifier: MIT
// Rule under attack (S2): a wall that the robot slants into, and that only the sonar abeam hears, is told
// before the body can touch it; one that it drives along, or away from, is not, nor is a single odd reading.
#include <math.h>
#include <stdio.h>

#include "adjustment/grazing.h"
#include "knowledge/config.h"
#include "scene.h"
#include "unity.h"

#define RAD (3.14159265358979323846 / 180)
#define STEP_MM 64 // at 200 mm/s from one reading to the next
#define STOP_MM 163
#define HALF_WIDTH_MM 212.5
#define FRONT_MM 210
#define FAR_MM 2000

static argus_knowledge_t k;
static argus_evidence_t e;
static double way_mm;
static char text[160];

void setUp(void) {
    scene_blank(&k, &e);
    way_mm = 0;
}

static void read_at(int sonar, double range_mm) {
    const argus_pose_t pose = {.x_mm = (int32_t)lround(way_mm)};
    argus_ping_t now = argus_ping_from(k.robot, sonar, &pose);
    now.reading_mm = (uint16_t)lround(fmax(100, range_mm));
    now.steady = 1;
    argus_pings_note(&e.pings[sonar], now);
}

// How far beyond the sonar's face a wall at `slant` degrees is when the front corner touches it, on the
// sonar's axis.
static double touches_at(double slant_deg) {
    const double x = argus_robot_table.poses[0].x_mm, y = argus_robot_table.poses[0].y_mm;
    return HALF_WIDTH_MM - y + (FRONT_MM - x) * tan(slant_deg * RAD);
}

void test_the_stopping_way_is_that_of_the_default_configuration(void) {
    argus_config_t config;
    argus_config_default(&config);
    argus_config_follow(&config, argus_config_follows(&config), argus_robot_default());
    const argus_config_report_t report = argus_config_check(&config);
    TEST_ASSERT_EQUAL_INT32(STOP_MM, argus_config_stop_mm(&config, argus_robot_default(), 0));
    TEST_ASSERT_EQUAL_INT32(report.driving_mm - report.overhang_mm,
                            argus_config_stop_mm(&config, argus_robot_default(), 0));
}

static int lost_each; // no echo in so many readings once

// Drives on until it is told; what is left then of the way to the touch, in mm. Below 0: too late.
static double left_when_told(int sonar, double slant_deg, double from_mm, double odd_mm) {
    int readings = 0;
    const double slope = tan(slant_deg * RAD);
    for (double range = from_mm; range > touches_at(slant_deg); range -= slope * STEP_MM) {
        const bool lost = lost_each > 0 && ++readings % lost_each == 0;
        read_at(sonar, lost ? 5000 : range + (way_mm > 0 ? odd_mm : 0));
        odd_mm = -odd_mm;
        if (argus_grazing_wall(&e.pings[sonar], k.robot, sonar, STOP_MM)) {
            return (range - touches_at(slant_deg)) / slope;
        }
        way_mm += STEP_MM;
    }
    return -1;
}

void test_a_slant_is_told_in_time_to_stop(void) {
    for (int side = 0; side < 2; side++) {
        for (int slant = 2; slant <= 30; slant++) {
            for (int odd = 0; odd <= 4; odd += 2) {
                setUp();
                const double left = left_when_told(7 * side, slant, touches_at(slant) + 180, odd);
                snprintf(text, sizeof text, "slant %d degrees, odd by %d mm: %.0f mm left", slant, odd, left);
                TEST_ASSERT_TRUE_MESSAGE(left >= STOP_MM - STEP_MM,
                                         text); // the way holds one between readings
            }
        }
    }
}

// A reading later.
void test_a_lost_echo_hides_it_for_one_reading(void) {
    for (int slant = 2; slant <= 25; slant++) {
        for (lost_each = 3; lost_each <= 6; lost_each++) {
            setUp();
            const double left = left_when_told(7, slant, touches_at(slant) + 180, 0);
            snprintf(text, sizeof text, "slant %d degrees, one in %d lost: %.0f mm left", slant, lost_each,
                     left);
            TEST_ASSERT_TRUE_MESSAGE(left >= STOP_MM - 2 * STEP_MM, text);
        }
    }
    lost_each = 0;
}

void test_it_is_not_told_long_before(void) {
    for (int slant = 6; slant <= 20; slant++) {
        setUp();
        const double left = left_when_told(0, slant, 340, 0);
        snprintf(text, sizeof text, "slant %d degrees: %.0f mm left", slant, left);
        TEST_ASSERT_TRUE_MESSAGE(left <= STOP_MM + STEP_MM + 20 / tan(slant * RAD) + 1, text);
    }
}

void test_along_a_wall_or_away_from_it_nothing_is_told(void) {
    for (int range = 100; range < 250; range += 7) {
        for (int slant = -20; slant <= 0; slant += 5) {
            setUp();
            for (int i = 0; i < 14; i++) {
                read_at(0, range - tan(slant * RAD) * way_mm + (i % 2 == 0 ? 5 : -5));
                TEST_ASSERT_FALSE(argus_grazing_wall(&e.pings[0], k.robot, 0, STOP_MM));
                way_mm += STEP_MM;
            }
        }
    }
}

// Crosstalk, or a thing that the robot passes by: one reading is no line.
void test_one_odd_reading_is_no_slant(void) {
    for (int odd = 100; odd < 240; odd += 10) {
        setUp();
        for (int i = 0; i < 20; i++) {
            read_at(7, i % 5 == 4 ? odd : 240);
            TEST_ASSERT_FALSE(argus_grazing_wall(&e.pings[7], k.robot, 7, STOP_MM));
            way_mm += STEP_MM;
        }
    }
}

void test_no_slant_without_way_and_none_over_a_turn(void) {
    for (int i = 0; i < 14; i++) { // somebody comes near while the robot stands
        read_at(0, 230 - 10 * i);
        TEST_ASSERT_FALSE(argus_grazing_wall(&e.pings[0], k.robot, 0, STOP_MM));
    }
    setUp();
    for (int i = 0; i < 14; i++) {
        read_at(0, 230 - 10 * i);
        argus_pings_mark(&e.pings[0], 1)->bearing_cdeg = (int16_t)(9000 + 400 * i);
        TEST_ASSERT_FALSE(argus_grazing_wall(&e.pings[0], k.robot, 0, STOP_MM));
        way_mm += STEP_MM;
    }
}

// It stopped, looked and goes on: the readings from before are not forgotten.
void test_a_stop_in_between_does_not_hide_it(void) {
    left_when_told(0, 10, 160, 0);
    for (int i = 0; i < 6; i++) {
        read_at(0, 140);
    }
    way_mm += 20;
    read_at(0, 136);
    TEST_ASSERT_TRUE(argus_grazing_wall(&e.pings[0], k.robot, 0, STOP_MM));
}

void test_no_readings_no_slant(void) {
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_FALSE(argus_grazing_wall(&e.pings[0], k.robot, 0, STOP_MM));
        read_at(0, 120 - 20 * i);
    }
    setUp();
    for (int i = 0; i < 14; i++) {
        read_at(0, FAR_MM - 20 * i);
        TEST_ASSERT_FALSE(argus_grazing_wall(&e.pings[0], k.robot, 0, STOP_MM));
        way_mm += STEP_MM;
    }
}

// Two readings show a slant from a way of 80 mm on.
void test_a_slant_takes_a_way(void) {
    for (int way = 70; way <= 90; way += 2) {
        setUp();
        for (int part = 0; part <= 2; part++) {
            way_mm = way * part / 2.0;
            read_at(0, 200 - 15 * part);
        }
        TEST_ASSERT_EQUAL(way >= 80, argus_grazing_wall(&e.pings[0], k.robot, 0, STOP_MM));
    }
}
