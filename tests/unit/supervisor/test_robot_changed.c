// SPDX-License-Identifier: MIT
// Attacks: behind a wire that was lost and comes back is another robot: no motors, no motion, one event,
// nothing of what was known of the first one, until an operator says so; the same robot is driven on.
#include <stdio.h>

#include "robot.h"
#include "supervisor/robot_changed.h"
#include "unity.h"

static const uint8_t config_1[] = "\x20"
                                  "Pioneer\0p3dx-sh\0SERIAL-1";
static const uint8_t config_2[] = "\x20"
                                  "Pioneer\0p3dx-sh\0SERIAL-2";
static robot_t robot;
static int from; // commands before the wire was lost

static uint32_t now(void) {
    return robot.start_ms + robot.t_ms;
}

void setUp(void) {
    const argus_config_t config = robot_config();
    robot_init(&robot, &config, UINT32_MAX - 9000); // the clock wraps
    robot.config = config_1;
    robot.config_count = sizeof config_1;
    TEST_ASSERT_TRUE(robot_goal(&robot, 20000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 12000));
    robot_run(&robot, 1000);
}

// The wire is lost and comes back, with a robot at rest behind it.
static void reopen(void) {
    argus_link_lost(&robot.argus, now());
    from = robot.commands;
    robot.phase = 0;
    robot.v = robot.w = 0;
    robot.moving = robot.turning = robot.motors = false;
    for (int i = 0; i < 16; i++) { // each session begins with the robot's own order
        robot.order[i / 8][i % 8] = (uint8_t)i;
        robot.order_count[i / 8] = 8;
    }
    robot_run(&robot, 500);
    argus_link_up(&robot.argus, now());
}

// The cable is pulled and plugged in again; the robot stays in its session and in motion.
static void replug(void) {
    argus_link_lost(&robot.argus, now());
    from = robot.commands;
    robot_run(&robot, 500);
    argus_link_up(&robot.argus, now());
}

static int motions(void) {
    int sum = 0;
    static const int moving[] = {ARCOS_CMD_ENABLE, ARCOS_CMD_MOVE, ARCOS_CMD_HEAD, ARCOS_CMD_VEL2};
    for (size_t i = 0; i < sizeof moving / sizeof moving[0]; i++) {
        sum += robot_count_commands(&robot, moving[i], from);
    }
    return sum;
}

static void expect_stranger(int32_t part) {
    reopen();
    robot_run(&robot, 30000);
    TEST_ASSERT_EQUAL_INT(0, motions());
    TEST_ASSERT_EQUAL_INT(1, robot_count_events(&robot, ARGUS_EV_OTHER_ROBOT, 0));
    TEST_ASSERT_EQUAL_INT32(part, robot_last_event(&robot, ARGUS_EV_OTHER_ROBOT)->value);
    TEST_ASSERT_TRUE(robot.argus.orders.passive);
    TEST_ASSERT_EQUAL_INT(ARGUS_MISSION_RUNNING, robot.argus.mission);
    TEST_ASSERT_EQUAL_STRING("", robot.violation);
}

void test_the_same_robot_is_driven_on(void) {
    replug();
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 12000));
    TEST_ASSERT_EQUAL_INT(0, robot_count_events(&robot, ARGUS_EV_OTHER_ROBOT, 0));
}

// How far it rolled before its counters restarted nobody saw: the pose is not known any more.
void test_one_that_restarted_in_motion_is_not_driven_on(void) {
    reopen();
    robot_run(&robot, 12000);
    TEST_ASSERT_EQUAL_INT(1, robot_count_events(&robot, ARGUS_EV_ODOMETRY_LOST, 0));
    TEST_ASSERT_EQUAL_INT(ARGUS_MISSION_FAILED, robot.argus.mission);
    TEST_ASSERT_EQUAL_INT(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, from));
}

// ... nor where it got to when the last SIP before the loss shows a robot at rest that was told to move.
void test_one_that_was_about_to_move_is_not_driven_on(void) {
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 12000));
    robot.argus.knowledge.vel_left_mm_s = robot.argus.knowledge.vel_right_mm_s = 0;
    TEST_ASSERT_FALSE(robot.argus.motion.settled);
    reopen();
    robot_run(&robot, 12000);
    TEST_ASSERT_EQUAL_INT(1, robot_count_events(&robot, ARGUS_EV_ODOMETRY_LOST, 0));
}

void test_one_that_restarted_at_rest_is_driven_on(void) {
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, now(), ARGUS_OP_STOP, 0));
    robot_run(&robot, 4000);
    reopen();
    robot_run(&robot, 4000);
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, now(), ARGUS_OP_GO, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 12000));
    TEST_ASSERT_EQUAL_INT(0, robot_count_events(&robot, ARGUS_EV_ODOMETRY_LOST, 0));
}

void test_another_subclass_is_not_driven(void) {
    robot.subclass = "p3at-sh";
    expect_stranger(3);
}

void test_another_serial_number_is_not_driven(void) {
    robot.config = config_2;
    robot.config_count = sizeof config_2;
    expect_stranger(4);
}

void test_without_configpac_the_rest_decides(void) {
    robot.config = NULL;
    replug();
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 12000));
}

void test_the_operator_takes_it_over_in_two_steps(void) {
    robot.subclass = "p3at-sh";
    expect_stranger(3);
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, now(), ARGUS_OP_ACTIVE, 0));
    robot_run(&robot, 12000);
    TEST_ASSERT_EQUAL_INT(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, from));
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, now(), ARGUS_OP_GO, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 12000));
    // It is the robot of before now.
    reopen();
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 12000));
    TEST_ASSERT_EQUAL_INT(1, robot_count_events(&robot, ARGUS_EV_OTHER_ROBOT, 0));
}

void test_what_was_known_of_the_first_one_is_forgotten(void) {
    robot.fault[3] = ROBOT_SILENT;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_DISABLED, 20000));
    robot.fault[3] = ROBOT_OK;
    robot.subclass = "p3at-sh";
    reopen();
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_OTHER_ROBOT, 12000));
    robot_run(&robot, 10000);
    TEST_ASSERT_EQUAL_INT(0, robot_count_commands(&robot, ARCOS_CMD_POLLING, from));
    TEST_ASSERT_EQUAL_INT(ARGUS_HEALTHY, robot.argus.knowledge.sonar[3].health);
    TEST_ASSERT_EQUAL_INT(ARGUS_IS_NORMAL, robot.argus.events.state);
    TEST_ASSERT_EQUAL_INT(0, robot.argus.plan.disabled);
    TEST_ASSERT_EQUAL_INT(0, motions());
}

// What the record said of the first one protects none of another's sonars.
void test_no_record_of_the_first_one_is_left(void) {
    robot.argus.history.recorded = 1u << 3 | 1u << 12;
    robot.subclass = "p3at-sh";
    reopen();
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_OTHER_ROBOT, 12000));
    TEST_ASSERT_EQUAL_HEX32(0, robot.argus.history.recorded);
}

// Nor is an array of another robot doubted because one of the first was.
void test_no_doubt_of_an_array_of_the_first_one_is_left(void) {
    robot.argus.common.of[0].sonars = 0xFF;
    robot.argus.common.of[0].doubted = robot.argus.common.of[0].proven = true;
    robot.argus.common.sure[3].reading_mm = 1234;
    argus_robot_changed(&robot.argus);
    TEST_ASSERT_FALSE(argus_common_doubts(&robot.argus.common, 3) ||
                      argus_common_convicts(&robot.argus.common, 3));
    TEST_ASSERT_EQUAL(0, robot.argus.common.sure[3].reading_mm);
}

static uint32_t seed;

static uint32_t draw(uint32_t below) {
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) % below;
}

// One that was cut off on its way may have lost its place: the course has ended then, and begins on order.
static void go_on(const int lost_before, const char *message) {
    if (robot.argus.mission == ARGUS_MISSION_FAILED) {
        const int lost = robot_count_events(&robot, ARGUS_EV_ODOMETRY_LOST, 0);
        TEST_ASSERT_EQUAL_INT_MESSAGE(lost_before + 1, lost, message);
        argus_operator(&robot.argus, now(), ARGUS_OP_GO, 0);
    }
    TEST_ASSERT_TRUE_MESSAGE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 12000), message);
}

// Any robot may be behind the wire each time, and any part of it may differ from the one before.
static bool change_robot(void) {
    static const char *const subclasses[] = {"p3dx-sh", "p3at-sh", "amigo-sh"};
    const char *const subclass = robot.subclass;
    const uint8_t *const config = robot.config;
    robot.subclass = subclasses[draw(3)];
    robot.config = draw(2) == 0 ? config_1 : config_2;
    return robot.subclass != subclass || robot.config != config;
}

void test_reopened_at_random_no_other_robot_is_ever_driven(void) {
    char message[64];
    int events = 0;
    seed = 20261125;
    for (int round = 0; round < 150; round++) {
        const bool was_passive = robot.argus.orders.passive;
        snprintf(message, sizeof message, "round %d of seed 20261125", round);
        const bool other = change_robot();
        const int lost = robot_count_events(&robot, ARGUS_EV_ODOMETRY_LOST, 0);
        events += other;
        reopen();
        robot_run(&robot, 500 + draw(8000));
        if (!argus_session_is_open(&robot.argus.session)) {
            TEST_ASSERT_TRUE_MESSAGE(robot_until_event(&robot, ARGUS_EV_SESSION_OPEN, 12000), message);
        }
        TEST_ASSERT_EQUAL_INT_MESSAGE(events, robot_count_events(&robot, ARGUS_EV_OTHER_ROBOT, 0), message);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, robot_count_events(&robot, ARGUS_EV_GOAL_REACHED, 0), message);
        if (other || was_passive) {
            TEST_ASSERT_EQUAL_INT_MESSAGE(0, motions(), message);
        } else {
            go_on(lost, message);
        }
        if (draw(3) == 0 && robot.argus.orders.passive) {
            argus_operator(&robot.argus, now(), ARGUS_OP_ACTIVE, 0);
            argus_operator(&robot.argus, now(), ARGUS_OP_GO, 0);
        }
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", robot.violation, message);
    }
    TEST_ASSERT_GREATER_THAN_INT(50, events);
}
