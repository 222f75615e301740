// SPDX-License-Identifier: MIT
// Rule under attack: the life of a session: cold start, the course, shutdown, and what an operator may ask.
#include "argus/manager.h"

#include <math.h>
#include <stdio.h>

#include "robot.h"
#include "unity.h"

static robot_t robot;

static void start(void) {
    const argus_config_t config = robot_config();
    robot_init(&robot, &config, 0xFFFFF000u); // the clock wraps after 4 s
}

static void finish(void) {
    TEST_ASSERT_EQUAL_STRING("", robot.violation);
}

static void start_idle(void) {
    start();
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
}

static void dump(void) {
    for (int i = 0; i < robot.events; i++) {
        printf("%u %s %d %d\n", (unsigned)(robot.event[i].t_ms - robot.start_ms), argus_event_name(robot.event[i].id),
               robot.event[i].sonar, (int)robot.event[i].value);
    }
}

void test_cold_start_reaches_idle(void) {
    start_idle();
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_HEALTH_CHECK, 0));
    TEST_ASSERT_EQUAL(ARGUS_IS_NORMAL, robot.argus.failure);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, 0));
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_HEAD, 0));
    for (int i = 1; i <= 6; i++) {
        TEST_ASSERT_EQUAL(ARGUS_HEALTHY, robot.argus.knowledge.sonar[i].health);
    }
    finish();
}

void test_drives_to_the_goal(void) {
    start_idle();
    TEST_ASSERT_TRUE(robot_goal(&robot, 1500, 0));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 30000));
    TEST_ASSERT_EQUAL(ARGUS_MISSION_REACHED, robot.argus.mission);
    if (hypot(robot.x - 1500, robot.y) > 150) dump();
    TEST_ASSERT_TRUE(hypot(robot.x - 1500, robot.y) <= 150);
    TEST_ASSERT_TRUE(robot.v == 0);
    finish();
}
