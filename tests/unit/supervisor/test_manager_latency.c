// SPDX-License-Identifier: MIT
// Rule: a link that gets late stops the robot before it has driven on what was, and a link that is prompt
// again is believed soon: not before a time without delay, nor half a minute after it.
#include "knowledge/latency.h"

#include "robot.h"
#include "unity.h"

static robot_t robot;

void setUp(void) {
    const argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &config, UINT32_MAX - 9000); // the clock wraps
    robot.world = robot_world_segments;
    robot_box(&robot, -4000, -3000, 4000, 3000);
    robot_run(&robot, 4000);
}

// What is sent does not show for so long; at rest, since the robot obeys else.
static void delay(uint32_t ms) {
    robot.ignores[ARCOS_CMD_ADSEL] = true;
    robot_run(&robot, ms);
    robot.ignores[ARCOS_CMD_ADSEL] = false;
}

void test_a_prompt_link_is_not_late(void) {
    robot_run(&robot, 20000);
    TEST_ASSERT_EQUAL_INT32(0, robot.argus.latency.late_ms);
    TEST_ASSERT_TRUE(argus_latency_is_prompt(&robot.argus.latency));
    TEST_ASSERT_EQUAL_INT(0, robot_count_events(&robot, ARGUS_EV_LINK_SLOW, 0));
}

void test_a_delay_stops_what_drives(void) {
    TEST_ASSERT_TRUE(robot_goal(&robot, 3000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 5000));
    robot_run(&robot, 1500);
    const int from = robot.commands;
    delay(1200);
    TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_STOP, from) > 0);
    TEST_ASSERT_TRUE(robot.argus.latency.stands);
    const int stands = robot.commands;
    delay(1000);
    TEST_ASSERT_EQUAL_INT(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, stands));
    TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_LINK_SLOW, 0) > 0);
}

// LINK_PROMPT comes three to seven seconds after the delay has ended, whatever it was.
void test_a_delay_that_has_ended_is_over_soon(void) {
    static const uint32_t delays_ms[] = {600, 1000, 2000, 3500};
    for (unsigned i = 0; i < sizeof delays_ms / sizeof delays_ms[0]; i++) {
        setUp();
        delay(delays_ms[i]);
        TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_LINK_SLOW, 0) > 0);
        robot_run(&robot, 2900);
        TEST_ASSERT_EQUAL_INT(0, robot_count_events(&robot, ARGUS_EV_LINK_PROMPT, 0));
        robot_run(&robot, 4600);
        TEST_ASSERT_EQUAL_INT(1, robot_count_events(&robot, ARGUS_EV_LINK_PROMPT, 0));
        TEST_ASSERT_TRUE(argus_latency_is_prompt(&robot.argus.latency));
    }
}

// A delay that comes back each two seconds is never over.
void test_a_delay_that_pulses_stays(void) {
    delay(800);
    for (int k = 0; k < 15; k++) {
        robot_run(&robot, 1500);
        delay(500);
    }
    TEST_ASSERT_EQUAL_INT(0, robot_count_events(&robot, ARGUS_EV_LINK_PROMPT, 0));
    TEST_ASSERT_TRUE(robot.argus.latency.late_ms > 100);
}

// What stands for the link does not stand for ever, and the reason is the link.
void test_a_course_that_stands_for_the_link_is_given_up(void) {
    TEST_ASSERT_TRUE(robot_goal(&robot, 3000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 5000));
    robot_run(&robot, 1500);
    delay(80000);
    TEST_ASSERT_EQUAL_INT(ARGUS_MISSION_RUNNING, robot.argus.mission);
    const int before = robot.events;
    delay(20000);
    TEST_ASSERT_EQUAL_INT(ARGUS_MISSION_FAILED, robot.argus.mission);
    TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_LINK_SLOW, before) > 0);
    TEST_ASSERT_EQUAL_INT(0, robot_count_events(&robot, ARGUS_EV_NO_WAY, 0));
}
