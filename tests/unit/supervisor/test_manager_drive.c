// SPDX-License-Identifier: MIT
// Rule under attack: the manager finds what is wrong with the drive and with a laser while the robot goes its
// way, says it once, and goes by what it has found: wheels that slip, a wheel that is short, a scan that
// stays.
#include <math.h>
#include <stdlib.h>

#include "behaviour/core.h"
#include "robot.h"
#include "unity.h"

#define TRACK_MM 330.0
#define SECTORS 24
#define STEP_MS 100

static robot_t robot;

static void start(void) {
    const argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &config, 0xFFFF8000u);
    robot.noise_mm = 3;
}

// ---- wheels that turn on the spot

static int stays_mm(const robot_t *r, int sonar) {
    (void)r;
    return sonar == 0 || sonar == 7 || sonar == 8 || sonar == 15 ? 2500 : 1500;
}

// Ahead and behind nothing changes while the wheels make a metre: it is where it was, and says so.
void test_wheels_that_slip_are_found_and_the_place_is_set_back(void) {
    start();
    robot.world = stays_mm;
    TEST_ASSERT_TRUE(robot_goal(&robot, 6000, 0));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SLIP, 60000));
    const int32_t slipped_mm = robot_last_event(&robot, ARGUS_EV_SLIP)->value;
    TEST_ASSERT_INT_WITHIN(400, 1000, slipped_mm);
    TEST_ASSERT_TRUE(robot.x > 800); // by its wheels
    TEST_ASSERT_INT_WITHIN(300, 0, robot.argus.knowledge.pose.x_mm);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_ODOMETRY_LOST, 120000)); // and again, and again
    TEST_ASSERT_EQUAL(ARGUS_MISSION_FAILED, robot.argus.mission);
}

// ---- a short wheel

// One wheel makes `short_pm` less than the robot says: it bends by that.
static void drive_bent(double short_pm, uint32_t ms) {
    for (uint32_t at = 0; at < ms; at += 10) {
        robot.pushed_w = robot.v > 20 ? robot.v * short_pm / 1000 / TRACK_MM : 0;
        robot_tick(&robot);
    }
}

void test_a_wheel_that_is_short_is_named_countered_and_cleared(void) {
    for (int side = -1; side <= 1; side += 2) {
        start();
        robot.world = robot_world_segments;
        robot_box(&robot, -4000, -4000, 60000, 4000);
        TEST_ASSERT_TRUE(robot_goal(&robot, 29000, 0));
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
        drive_bent(side * 40, 20000);
        TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_WHEEL_SHORT, 0));
        const int32_t short_pm = robot_last_event(&robot, ARGUS_EV_WHEEL_SHORT)->value;
        TEST_ASSERT_INT_WITHIN(20, side * 40, short_pm);
        TEST_ASSERT_TRUE(fabs(robot.y) < 250); // though it bends, it keeps to its way
        drive_bent(0, 40000);
        TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_WHEEL_EVEN, 0));
        TEST_ASSERT_EQUAL_STRING("", robot.violation);
    }
}

void test_without_diagnosis_no_wheel_is_named(void) {
    argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    config.diagnosis = 0;
    robot_init(&robot, &config, 1000);
    robot.world = robot_world_segments;
    robot_box(&robot, -4000, -4000, 60000, 4000);
    TEST_ASSERT_TRUE(robot_goal(&robot, 29000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
    drive_bent(40, 20000);
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_WHEEL_SHORT, 0));
}

// ---- a laser

static argus_storage_t storage;
static argus_robot_storage_t robot_storage;

static int laser_events(argus_t *argus, int32_t *value) {
    argus_event_t event;
    int count = 0;
    while (argus_next_event(argus, &event)) {
        if (event.id == ARGUS_EV_LASER_FAULT) {
            count++;
            *value = event.value;
        }
    }
    return count;
}

// The robot turns and its scan stays as it was: said once, and each sector is given up.
void test_a_laser_that_stays_as_it_was_is_said_once(void) {
    if (ARGUS_SONARS <= 16) {
        TEST_IGNORE_MESSAGE("this build takes no laser");
    }
    const argus_ring_t ring = {.name = "scanbot",
                               .front_mm = 150,
                               .rear_mm = 150,
                               .width_mm = 300,
                               .swing_radius_mm = 150,
                               .track_mm = 240,
                               .min_mm = 30,
                               .no_echo_mm = 4000,
                               .decel_mm_s2 = 300,
                               .dist_conv_um = 1000,
                               .cone_deg = 30,
                               .cycle_ms = 40,
                               .sectors = SECTORS,
                               .field_deg = 360,
                               .forward = {10, 11, 12, 13},
                               .forward_count = 4};
    argus_config_t config;
    argus_config_default(&config);
    uint32_t now_ms = UINT32_MAX - 2000;
    argus_t *const argus = argus_init(&storage, &config, now_ms);
    TEST_ASSERT_EQUAL(ARGUS_RING_OK, argus_set_ring(argus, &robot_storage, &ring).fault);
    argus_range_t ranges[SECTORS];
    int said = 0;
    int32_t value = 0;
    for (int n = 0; n < 150; n++) {
        for (int i = 0; i < SECTORS; i++) {
            ranges[i] = (argus_range_t){(uint8_t)i, (uint16_t)(1200 + 37 * i), 20};
        }
        const int32_t heading_cdeg = n * 400 % 36000 - 18000;
        const argus_observation_t observation = {
            .pose = {0, 0, heading_cdeg == -18000 ? 18000 : heading_cdeg},
            .turn_cdeg_s = 4000,
            .ranges = ranges,
            .count = SECTORS};
        now_ms += STEP_MS;
        TEST_ASSERT_TRUE(argus_observe(argus, now_ms, &observation));
        argus_process(argus, now_ms);
        said += laser_events(argus, &value);
    }
    TEST_ASSERT_EQUAL(1, said);
    TEST_ASSERT_EQUAL(1, value); // frozen
    for (int i = 0; i < SECTORS; i++) {
        TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, argus->knowledge.sonar[i].kind);
        TEST_ASSERT_EQUAL(ARGUS_DISABLED, argus->knowledge.sonar[i].health);
    }
}
