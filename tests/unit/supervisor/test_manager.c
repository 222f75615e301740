// SPDX-License-Identifier: MIT
// Rule under attack: the life of a session: cold start, the course, shutdown, and what an operator may ask.
#include "analysis/record.h"
#include "supervisor/manager.h"

#include <math.h>
#include <string.h>

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

static uint32_t now(void) {
    return robot.start_ms + robot.t_ms;
}

static void ask(argus_op_t op, int32_t argument) {
    argus_operator(&robot.argus, now(), op, argument);
    robot_drain(&robot);
}

void test_cold_start_reaches_idle(void) {
    start_idle();
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_HEALTH_CHECK, 0));
    TEST_ASSERT_EQUAL(ARGUS_IS_NORMAL, robot.argus.events.state);
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
    TEST_ASSERT_TRUE(hypot(robot.x - 1500, robot.y) <= 150);
    TEST_ASSERT_TRUE(robot.v == 0);
    finish();
}

void test_drives_a_course_of_waypoints_in_order(void) {
    const argus_point_t course[] = {{800, 0}, {800, 800}, {0, 800}, {0, 0}};
    start_idle();
    TEST_ASSERT_TRUE(argus_set_course(&robot.argus, course, 4));
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_WAYPOINT, 30000));
        TEST_ASSERT_EQUAL(i + 1, robot_last_event(&robot, ARGUS_EV_WAYPOINT)->value);
        TEST_ASSERT_TRUE(hypot(robot.x - course[i].x_mm, robot.y - course[i].y_mm) <= 150);
    }
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 5000));
    TEST_ASSERT_EQUAL(ARGUS_MISSION_REACHED, robot.argus.mission);
    finish();
}

void test_a_course_given_before_the_robot_is_there_starts_by_itself(void) {
    start();
    robot.mute = true;
    TEST_ASSERT_TRUE(robot_goal(&robot, 700, 0));
    robot_run(&robot, 5000);
    TEST_ASSERT_EQUAL(ARGUS_MODE_OFFLINE, robot.argus.mode);
    robot.mute = false;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 40000));
    finish();
}

void test_the_older_position_unit(void) {
    start();
    robot.subclass = "p3dx";
    robot.unit_mm = 0.485;
    robot.position_mask = 0x7FFF;
    TEST_ASSERT_TRUE(robot_goal(&robot, 2000, -500));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000));
    TEST_ASSERT_TRUE(hypot(robot.x - 2000, robot.y + 500) <= 150);
    finish();
}

void test_a_server_that_lists_every_sonar_in_every_sip(void) {
    start();
    robot.lists_all = true;
    robot.fault[4] = ROBOT_SCALE;
    robot.fault_value[4] = 50;
    TEST_ASSERT_TRUE(robot_goal(&robot, 500, 0));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 120000));
    TEST_ASSERT_EQUAL_HEX16(1u << 4, argus_disabled(&robot.argus.knowledge));
    finish();
}

void test_bad_courses_change_nothing(void) {
    start_idle();
    const argus_point_t far = {30001, 0};
    TEST_ASSERT_FALSE(argus_set_course(&robot.argus, &far, 1));
    TEST_ASSERT_FALSE(argus_set_course(&robot.argus, &far, 0));
    TEST_ASSERT_EQUAL(ARGUS_MISSION_NONE, robot.argus.mission);
    robot_run(&robot, 2000);
    TEST_ASSERT_EQUAL(ARGUS_MODE_IDLE, robot.argus.mode);
    finish();
}

// The last four commands are SONAR 0, STOP, ENABLE 0, CLOSE, after the robot has come to rest.
static int motions(int from) {
    static const uint8_t all[] = {ARCOS_CMD_MOVE, ARCOS_CMD_HEAD, ARCOS_CMD_DHEAD, ARCOS_CMD_ROTATE,
                                  ARCOS_CMD_VEL2};
    int count = 0;
    for (size_t i = 0; i < sizeof all; i++) {
        count += robot_count_commands(&robot, all[i], from);
    }
    for (int i = from; i < robot.commands; i++) {
        count += robot.command[i].command == ARCOS_CMD_ENABLE && robot.command[i].argument != 0;
    }
    return count;
}

static void expect_orderly_end(void) {
    static const uint8_t last[] = {ARCOS_CMD_SONAR, ARCOS_CMD_STOP, ARCOS_CMD_ENABLE, ARCOS_CMD_CLOSE};
    TEST_ASSERT_TRUE(argus_closed(&robot.argus));
    TEST_ASSERT_TRUE(robot.commands >= 4);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL(last[i], robot.command[robot.commands - 4 + i].command);
    }
    TEST_ASSERT_EQUAL(0, robot.command[robot.commands - 4].argument);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_SESSION_CLOSED, 0));
}

void test_shutdown_at_rest(void) {
    start_idle();
    argus_shutdown(&robot.argus, now());
    robot_run(&robot, 3000);
    expect_orderly_end();
    finish();
}

void test_shutdown_in_motion_stops_first_and_closes_at_rest(void) {
    start_idle();
    TEST_ASSERT_TRUE(robot_goal(&robot, 5000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 5000));
    robot_run(&robot, 2000);
    const int from = robot.commands;
    argus_shutdown(&robot.argus, now());
    robot_drain(&robot);
    TEST_ASSERT_EQUAL(ARCOS_CMD_STOP, robot.command[from].command);
    for (int i = 0; i < 300 && robot_count_commands(&robot, ARCOS_CMD_SONAR, from) == 0; i++) {
        robot_tick(&robot);
    }
    TEST_ASSERT_TRUE(robot.v == 0);
    robot_run(&robot, 2000);
    expect_orderly_end();
    finish();
}

void test_shutdown_with_a_robot_that_says_nothing_ends_within_3_s(void) {
    start_idle();
    robot.mute = true;
    argus_shutdown(&robot.argus, now());
    robot_run(&robot, 3000);
    TEST_ASSERT_TRUE(argus_closed(&robot.argus));
    finish();
}

void test_shutdown_at_every_moment_of_the_opening_leaves_no_session_behind(void) {
    for (uint32_t at = 0; at < 3000; at += 50) {
        start();
        robot_run(&robot, at);
        argus_shutdown(&robot.argus, now());
        robot_run(&robot, 3000);
        TEST_ASSERT_TRUE(argus_closed(&robot.argus));
        const bool opened = robot_count_commands(&robot, ARCOS_CMD_OPEN, 0) > 0;
        TEST_ASSERT_TRUE(!opened || robot_count_commands(&robot, ARCOS_CMD_CLOSE, 0) > 0);
        const int from = robot.commands;
        robot_run(&robot, 3000);
        TEST_ASSERT_EQUAL(from, robot.commands);
        finish();
    }
}

// What comes back after the end is not taken up again.
void test_a_link_that_comes_back_after_the_end_moves_nothing(void) {
    start_idle();
    TEST_ASSERT_TRUE(robot_goal(&robot, 5000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 5000));
    argus_shutdown(&robot.argus, now());
    argus_link_lost(&robot.argus, now());
    TEST_ASSERT_TRUE(argus_closed(&robot.argus));
    argus_link_up(&robot.argus, now());
    const int from = robot.commands;
    robot_run(&robot, 6000);
    TEST_ASSERT_TRUE(argus_closed(&robot.argus));
    TEST_ASSERT_EQUAL(0, motions(from));
    finish();
}

// A link that was lost before the first SIP was never silent.
void test_a_link_lost_before_the_first_sip_has_no_silence(void) {
    start();
    argus_link_lost(&robot.argus, now());
    robot_drain(&robot);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_LINK_LOST, 0));
    TEST_ASSERT_EQUAL_INT32(0, robot_last_event(&robot, ARGUS_EV_LINK_LOST)->value);
}

void test_stop_and_go(void) {
    start_idle();
    TEST_ASSERT_TRUE(robot_goal(&robot, 2000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 5000));
    robot_run(&robot, 2000);
    ask(ARGUS_OP_STOP, 0);
    TEST_ASSERT_EQUAL(ARCOS_CMD_STOP, robot.command[robot.commands - 1].command);
    robot_run(&robot, 10000);
    TEST_ASSERT_EQUAL(ARGUS_MODE_IDLE, robot.argus.mode);
    TEST_ASSERT_TRUE(robot.x < 700);
    ask(ARGUS_OP_GO, 0);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 30000));
    finish();
}

// Stop and stay: neither the verification goes on nor the robot turns home, until another order comes.
void test_stop_while_verifying_ends_every_motion(void) {
    start_idle();
    robot.fault[3] = ROBOT_SCALE;
    robot.fault_value[3] = 50;
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_VERIFYING, 5000));
    for (int i = 0; i < 500 && fabs(robot_heading_deg(&robot)) < 10; i++) {
        robot_tick(&robot);
    }
    ask(ARGUS_OP_STOP, 0);
    const int from = robot.commands;
    robot_run(&robot, 15000);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_HEAD, from));
    TEST_ASSERT_EQUAL(ARGUS_MODE_IDLE, robot.argus.mode);
    ask(ARGUS_OP_GO, 0);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_DISABLED, 20000));
    finish();
}

void test_jogs_are_bounded(void) {
    start_idle();
    ask(ARGUS_OP_MOVE, 5000);
    robot_run(&robot, 8000);
    TEST_ASSERT_TRUE(robot.x > 150 && robot.x <= 205);
    ask(ARGUS_OP_MOVE, -5000);
    robot_run(&robot, 8000);
    TEST_ASSERT_TRUE(robot.x > 0 && robot.x <= 60);
    ask(ARGUS_OP_TURN, -90);
    robot_run(&robot, 8000);
    TEST_ASSERT_TRUE(fabs(robot_heading_deg(&robot) + 90) < 2);
    TEST_ASSERT_EQUAL(ARGUS_MODE_IDLE, robot.argus.mode);
    finish();
}

void test_jog_ahead_with_a_sonar_out_sweeps_first(void) {
    start_idle();
    robot.fault[3] = ROBOT_OFF;
    robot_run(&robot, 3000);
    const int from = robot.commands;
    ask(ARGUS_OP_MOVE, 100);
    robot_run(&robot, 15000);
    TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_HEAD, from) >= 2);
    TEST_ASSERT_TRUE(robot.x > 80 && robot.x < 120);
    TEST_ASSERT_EQUAL(ARGUS_MODE_IDLE, robot.argus.mode);
    finish();
}

// What an operator asked for before the trouble is not taken up by itself after it.
void test_a_jog_does_not_outlive_a_bumper_or_a_lost_link(void) {
    for (int trouble = 0; trouble < 3; trouble++) {
        start_idle();
        robot.fault[3] = ROBOT_OFF;
        robot_run(&robot, 3000);
        ask(ARGUS_OP_MOVE, 200);
        robot_run(&robot, 1000);
        const int from = robot.commands;
        if (trouble == 0) {
            robot.bumpers_front = 4;
            robot_run(&robot, 500);
            robot.bumpers_front = 0;
        } else if (trouble == 1) {
            argus_link_lost(&robot.argus, now());
            argus_link_up(&robot.argus, now());
        } else {
            robot.mute = true;
            robot_run(&robot, 1500);
            robot.mute = false;
        }
        robot_run(&robot, 30000);
        for (int i = from; i < robot.commands; i++) {
            TEST_ASSERT_FALSE(robot.command[i].command == ARCOS_CMD_MOVE && robot.command[i].argument > 0);
        }
        finish();
    }
}

void test_recheck_runs_a_full_check(void) {
    start_idle();
    ask(ARGUS_OP_RECHECK, 0);
    TEST_ASSERT_EQUAL(ARGUS_MODE_CHECKING, robot.argus.mode);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_HEALTH_CHECK, 5000));
    finish();
}

void test_passive_reports_and_never_moves(void) {
    argus_config_t config = robot_config();
    config.active = 0;
    robot_init(&robot, &config, 777);
    robot_goal(&robot, 2000, 0);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    TEST_ASSERT_FALSE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_MOVE, 100));
    TEST_ASSERT_FALSE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_TURN, 20));
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_OPERATOR, 0));
    robot.fault[2] = ROBOT_OFF;
    robot.fault[5] = ROBOT_SCALE;
    robot.fault_value[5] = 50;
    robot_run(&robot, 5000);
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, robot.argus.knowledge.sonar[2].health);
    TEST_ASSERT_EQUAL(ARGUS_SUSPECT,
                      robot.argus.knowledge.sonar[5].health); // a robot that may not turn cannot prove it
    robot.bumpers_front = 8;
    robot_run(&robot, 3000);
    robot.bumpers_front = 0;
    robot.stall = true;
    robot_run(&robot, 3000);
    robot.stall = false;
    robot.mute = true;
    robot_run(&robot, 2000);
    robot.mute = false;
    for (int op = 1; op <= 6; op++) {
        ask((argus_op_t)op, 100);
        robot_run(&robot, 2000);
    }
    TEST_ASSERT_EQUAL(0, motions(0));
    TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_BUMPER, 0) == 1);
    finish();
}

void test_going_passive_stops_and_going_active_checks(void) {
    start_idle();
    TEST_ASSERT_TRUE(robot_goal(&robot, 3000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 5000));
    robot_run(&robot, 2000);
    ask(ARGUS_OP_PASSIVE, 0);
    TEST_ASSERT_EQUAL(ARCOS_CMD_STOP, robot.command[robot.commands - 1].command);
    const int from = robot.commands;
    robot_run(&robot, 10000);
    TEST_ASSERT_EQUAL(0, motions(from));
    TEST_ASSERT_TRUE(robot.v == 0);
    ask(ARGUS_OP_ACTIVE, 0);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000));
    finish();
}

void test_record_survives_a_restart_as_history(void) {
    static uint8_t record[ARGUS_RECORD_BYTES];
    start_idle();
    robot.fault[4] = ROBOT_OFF;
    robot_run(&robot, 2000);
    const size_t length = argus_record_save(&robot.argus, record, sizeof record);
    TEST_ASSERT_TRUE(length > 0);
    start();
    TEST_ASSERT_TRUE(argus_record_load(&robot.argus, record, length));
    TEST_ASSERT_EQUAL(1, robot.argus.knowledge.sonar[4].disabled_before);
    TEST_ASSERT_EQUAL(ARGUS_UNKNOWN, robot.argus.knowledge.sonar[4].health);
    record[9] ^= 1;
    TEST_ASSERT_FALSE(argus_record_load(&robot.argus, record, length));
    robot_drain(&robot);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_RECORD_IGNORED, 0));
    finish();
}

void test_status_is_a_picture_of_what_is_known(void) {
    start_idle();
    robot.fault[6] = ROBOT_OFF;
    robot_run(&robot, 3000);
    argus_status_t status;
    argus_status(&robot.argus, &status);
    TEST_ASSERT_EQUAL(ARGUS_MODE_IDLE, status.mode);
    TEST_ASSERT_EQUAL(ARGUS_IS_MINOR, status.failure);
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, status.health[6]);
    TEST_ASSERT_EQUAL(5000, status.reading_mm[6]);
    TEST_ASSERT_EQUAL(2600, status.reading_mm[3]);
    TEST_ASSERT_TRUE(status.age_ms[3] <= 420);
    TEST_ASSERT_TRUE(status.active && status.online);
    TEST_ASSERT_EQUAL_STRING("p3dx-sh", status.robot_subclass);
    finish();
}

void test_garbage_between_sips_is_survived(void) {
    start_idle();
    uint8_t junk[300];
    for (size_t i = 0; i < sizeof junk; i++) {
        junk[i] = (uint8_t)(i * 73);
    }
    for (int i = 0; i < 50; i++) {
        robot_deliver(&robot, junk, (size_t)(i * 6));
        robot_drain(&robot);
        robot_run(&robot, 100);
    }
    TEST_ASSERT_TRUE(robot_goal(&robot, 600, 0));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 30000));
    finish();
}
