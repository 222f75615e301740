// SPDX-License-Identifier: MIT
// Rule under attack: diagnosis in closed loop: what is dead, silent, wrong or healthy is found to be so, and
// driven with.
#include "supervisor/manager.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "robot.h"
#include "unity.h"

static robot_t robot;

static void start(int policy) {
    argus_config_t config = robot_config();
    config.policy = policy;
    robot_init(&robot, &config, 12345);
}

static void start_idle(void) {
    start(ARGUS_POLICY_PAPER);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
}

static void finish(void) {
    TEST_ASSERT_EQUAL_STRING("", robot.violation);
}

static uint32_t now(void) {
    return robot.start_ms + robot.t_ms;
}

// Posts on two bearings of the world, 1000 mm away, before walls at 2000: a healthy sonar that looks at it is
// disparate.
static int world_with_post(const robot_t *r, int sonar) {
    const double bearing = remainder(robot_heading_deg(r) + argus_robot_table.poses[sonar].heading_deg, 360);
    return fabs(bearing - 10) < 5 || fabs(bearing - 100) < 5 ? 1000 : 2000;
}

static void expect_health(int sonar, argus_health_t health, argus_fault_kind_t kind) {
    char text[20];
    snprintf(text, sizeof text, "sonar %d", sonar);
    TEST_ASSERT_EQUAL_MESSAGE(health, robot.argus.knowledge.sonar[sonar].health, text);
    TEST_ASSERT_EQUAL_MESSAGE(kind, robot.argus.knowledge.sonar[sonar].kind, text);
}

static void expect_others_healthy(uint16_t disabled) {
    TEST_ASSERT_EQUAL_HEX16(disabled, argus_disabled(&robot.argus.knowledge));
    for (int i = 1; i <= 6; i++) {
        if ((disabled >> i & 1u) == 0) {
            expect_health(i, ARGUS_HEALTHY, ARGUS_KIND_NONE);
        }
    }
}

void test_dead_at_the_start(void) {
    for (int sonar = 1; sonar <= 6; sonar++) {
        start(ARGUS_POLICY_FEWEST);
        robot.fault[sonar] = ROBOT_OFF;
        TEST_ASSERT_TRUE(robot_goal(&robot, 500, 0));
        TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 90000));
        expect_health(sonar, ARGUS_DISABLED, ARGUS_KIND_OFF);
        expect_others_healthy((uint16_t)(1u << sonar));
        TEST_ASSERT_EQUAL(ARGUS_IS_MINOR, robot.argus.events.state);
        finish();
    }
}

void test_silent_at_the_start_and_later(void) {
    for (int later = 0; later < 2; later++) {
        start_idle();
        if (later == 0) {
            start(ARGUS_POLICY_PAPER);
        }
        robot.fault[5] = ROBOT_SILENT;
        TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_SILENT, 8000));
        robot_run(&robot, 3000);
        expect_health(5, ARGUS_DISABLED, ARGUS_KIND_SILENT);
        expect_others_healthy(1u << 5);
        TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_SONAR_DISABLED, 0));
        finish();
    }
}

void test_a_wrong_sonar_is_convicted_whichever_it_is(void) {
    for (int sonar = 1; sonar <= 6; sonar++) {
        start_idle();
        robot.fault[sonar] = ROBOT_SCALE;
        robot.fault_value[sonar] = 50;
        TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_DISABLED, 30000));
        robot_run(&robot, 5000);
        expect_health(sonar, ARGUS_DISABLED, ARGUS_KIND_WRONG);
        expect_others_healthy((uint16_t)(1u << sonar));
        TEST_ASSERT_EQUAL(sonar == 1 || sonar == 6 ? 1 : 2,
                          robot_count_events(&robot, ARGUS_EV_SONAR_WITNESS, 0));
        finish();
    }
}

void test_a_wrong_sonar_is_convicted_in_motion(void) {
    start_idle();
    TEST_ASSERT_TRUE(robot_goal(&robot, 4000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 5000));
    robot_run(&robot, 2000);
    robot.fault[6] = ROBOT_SCALE;
    robot.fault_value[6] = 50;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_DISABLED, 20000));
    TEST_ASSERT_TRUE(robot.v == 0);
    expect_others_healthy(1u << 6);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 300000));
    expect_others_healthy(1u << 6);
    TEST_ASSERT_TRUE(hypot(robot.x - 4000, robot.y) <= 150);
    finish();
}

void test_a_healthy_suspect_is_cleared_and_held_off(void) {
    start_idle();
    robot.world = world_with_post;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_CLEARED, 30000));
    TEST_ASSERT_EQUAL(3, robot_last_event(&robot, ARGUS_EV_SONAR_CLEARED)->sonar);
    const int from = robot.events;
    robot_run(&robot, 60000);
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_SONAR_VERIFYING, from));
    expect_others_healthy(0);
    finish();
}

void test_a_cleared_sonar_is_judged_anew_after_a_turn(void) {
    start_idle();
    robot.world = world_with_post;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_CLEARED, 30000));
    robot_run(&robot, 3000);
    argus_operator(&robot.argus, now(), ARGUS_OP_TURN, 90);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_VERIFYING, 20000));
    TEST_ASSERT_EQUAL(3, robot_last_event(&robot, ARGUS_EV_SONAR_VERIFYING)->sonar);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_CLEARED, 30000));
    expect_others_healthy(0);
    finish();
}

// suspect_readings 1, holdoff 0, 0: the paper without a hold-off verifies again wherever the robot has moved
// to.
void test_the_bare_paper_verifies_a_healthy_suspect_again_and_again(void) {
    argus_config_t config = robot_config();
    config.suspect_readings = 1;
    config.holdoff_mm = 0;
    config.holdoff_deg = 0;
    robot_init(&robot, &config, 1);
    robot.world = world_with_post;
    for (int i = 0; i < 3; i++) { // to one post, to the other one and back
        TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_CLEARED, 30000));
        robot_run(&robot, 3000);
        argus_operator(&robot.argus, now(), ARGUS_OP_TURN, i % 2 == 0 ? 90 : -90);
    }
    TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_SONAR_CLEARED, 0) >= 3);
    TEST_ASSERT_EQUAL_HEX16(0, argus_disabled(&robot.argus.knowledge));
    finish();
}

// Cleared once is no pass for ever: the same sonar, now lying, is found also where it was cleared.
void test_a_cleared_sonar_that_fails_later_is_found_in_the_same_place(void) {
    start_idle();
    robot.world = world_with_post;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_CLEARED, 30000));
    robot_run(&robot, 3000);
    robot.fault[3] = ROBOT_SCALE;
    robot.fault_value[3] = 50;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_DISABLED, 20000));
    expect_health(3, ARGUS_DISABLED, ARGUS_KIND_WRONG);
    finish();
}

void test_a_passing_disparity_is_dropped(void) {
    start_idle();
    robot.fault[4] = ROBOT_SCALE;
    robot.fault_value[4] = 50;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_SUSPECT, 5000));
    robot.fault[4] = ROBOT_OK;
    robot_run(&robot, 4000);
    expect_others_healthy(0);
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_SONAR_DISABLED, 0));
    finish();
}

void test_two_wrong_sonars_apart(void) {
    start_idle();
    robot.fault[1] = robot.fault[4] = ROBOT_SCALE;
    robot.fault_value[1] = robot.fault_value[4] = 50;
    robot_run(&robot, 60000);
    expect_others_healthy(1u << 1 | 1u << 4);
    finish();
}

void test_a_dead_sonar_does_not_convict_its_neighbours(void) {
    for (int sonar = 1; sonar <= 6; sonar++) {
        start_idle();
        robot.fault[sonar] = ROBOT_OFF;
        robot_run(&robot, 20000);
        expect_others_healthy((uint16_t)(1u << sonar));
        finish();
    }
}

void test_a_sonar_that_dies_during_a_verification(void) {
    for (int dying = 1; dying <= 6; dying++) {
        start_idle();
        robot.fault[3] = ROBOT_SCALE;
        robot.fault_value[3] = 50;
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_VERIFYING, 5000));
        robot_run(&robot, 1500);
        const int before = robot_count_commands(&robot, ARCOS_CMD_STOP, 0);
        robot.fault[dying] = ROBOT_OFF;
        robot_run(&robot, 40000);
        TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_STOP, 0) > before);
        expect_health(dying, ARGUS_DISABLED, ARGUS_KIND_OFF);
        expect_health(3, ARGUS_DISABLED, dying == 3 ? ARGUS_KIND_OFF : ARGUS_KIND_WRONG);
        expect_others_healthy((uint16_t)(1u << dying | 1u << 3));
        TEST_ASSERT_TRUE(fabs(robot_heading_deg(&robot)) < 2);
        finish();
    }
}

void test_a_sonar_that_dies_during_a_sweep(void) {
    for (int dying = 2; dying <= 6; dying++) {
        start_idle();
        robot.fault[1] = ROBOT_OFF;
        robot_run(&robot, 1000);
        TEST_ASSERT_TRUE(robot_goal(&robot, 3000, 0));
        for (int i = 0;
             i < 2000 && !(robot.argus.mode == ARGUS_MODE_SWEEPING && fabs(robot_heading_deg(&robot)) > 5);
             i++) {
            robot_tick(&robot);
        }
        const int from = robot.commands;
        robot.fault[dying] = ROBOT_OFF;
        TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_DEAD, 3000));
        TEST_ASSERT_EQUAL(1, robot_count_commands(&robot, ARCOS_CMD_STOP, from));
        TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_HEALTH_CHECK, 20000));
        TEST_ASSERT_TRUE(fabs(robot_heading_deg(&robot)) < 2); // S4
        TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_STEP, 60000));
        expect_others_healthy((uint16_t)(1u << 1 | 1u << dying));
        finish();
    }
}

void test_all_six_dead_is_catastrophic_and_ends_the_mission(void) {
    start_idle();
    TEST_ASSERT_TRUE(robot_goal(&robot, 5000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 5000));
    robot_run(&robot, 1000);
    for (int i = 1; i <= 6; i++) {
        robot.fault[i] = ROBOT_OFF;
    }
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_MISSION_FAILED, 10000));
    TEST_ASSERT_EQUAL(ARGUS_IS_CATASTROPHIC, robot.argus.events.state);
    TEST_ASSERT_EQUAL(ARGUS_MISSION_FAILED, robot.argus.mission);
    const int from = robot.commands;
    robot_run(&robot, 30000);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, from));
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_HEAD, from));
    const int events = robot.events;
    TEST_ASSERT_TRUE(robot_goal(&robot, 100, 0)); // a new course cannot be driven either, and says so
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_MISSION_FAILED, 10000));
    TEST_ASSERT_TRUE(robot.events > events);
    finish();
}

void test_disabled_latches_for_the_mission(void) {
    start_idle();
    robot.fault[2] = ROBOT_OFF;
    robot_run(&robot, 2000);
    robot.fault[2] = ROBOT_OK;
    argus_operator(&robot.argus, now(), ARGUS_OP_RECHECK, 0);
    robot_run(&robot, 10000);
    expect_health(2, ARGUS_DISABLED, ARGUS_KIND_OFF);
    finish();
}

void test_turned_aside_in_motion_it_stops_and_aims_anew(void) {
    start_idle();
    TEST_ASSERT_TRUE(robot_goal(&robot, 4000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 5000));
    robot_run(&robot, 2000);
    const int from = robot.commands;
    robot.pushed_w = 1;
    robot_run(&robot, 500);
    robot.pushed_w = 0;
    robot_run(&robot, 500);
    TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_STOP, from) > 0);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000));
    TEST_ASSERT_TRUE(hypot(robot.x - 4000, robot.y) <= 150);
    finish();
}

void test_motors_cut_by_the_button_and_back(void) {
    start_idle();
    TEST_ASSERT_TRUE(robot_goal(&robot, 4000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 5000));
    robot_run(&robot, 2000);
    robot.motors = false;
    const int from = robot.commands;
    robot_run(&robot, 15000);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_MOTORS_OFF, 0));
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, from));
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_ENABLE, from)); // the button's owner decides
    TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_WAITING, 0) >= 2);
    robot.motors = true;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000));
    finish();
}

// An order to go active switches the motors on, which takes the robot a SIP or more.
void test_motors_that_come_on_soon_after_it_went_active_are_no_error(void) {
    argus_config_t config = robot_config();
    config.active = 0;
    robot_init(&robot, &config, 0);
    robot_run(&robot, 6000);
    TEST_ASSERT_FALSE(robot.motors);
    robot.deny_motors = true;
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_ACTIVE, 0));
    robot_run(&robot, 800);
    robot.motors = true;
    robot_run(&robot, 5000);
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_MOTORS_OFF, 0));
    robot.motors = false;
    robot_run(&robot, 2000);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_MOTORS_OFF, 0));
    finish();
}

void test_motors_that_never_come_on_are_said(void) {
    const argus_config_t config = robot_config();
    robot_init(&robot, &config, 0);
    robot.deny_motors = true;
    TEST_ASSERT_TRUE(robot_goal(&robot, 1000, 0));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_MOTORS_OFF, 8000));
    robot_run(&robot, 5000);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, 0));
    finish();
}

void test_goes_round_a_box_and_touches_nothing(void) {
    start_idle();
    robot_box(&robot, -1500, -2000, 4500, 2000);
    robot_box(&robot, 1300, -200, 1700, 200);
    robot.world = robot_world_segments;
    robot.noise_mm = 4;
    TEST_ASSERT_TRUE(robot_goal(&robot, 3000, 0));
    const bool reached = robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 240000);
    char text[100];
    snprintf(text, sizeof text, "at %.0f %.0f, mode %s, closest %.0f", robot.x, robot.y,
             argus_name(ARGUS_NAME_MODE, robot.argus.mode), robot.closest_mm);
    TEST_ASSERT_TRUE_MESSAGE(reached, text);
    TEST_ASSERT_TRUE_MESSAGE(robot.closest_mm > 0, text);
    TEST_ASSERT_TRUE(hypot(robot.x - 3000, robot.y) <= 150);
    TEST_ASSERT_EQUAL_HEX16(0, argus_disabled(&robot.argus.knowledge));
    finish();
}

void test_round_a_box_with_a_sonar_that_dies_and_one_that_lies(void) {
    start(ARGUS_POLICY_FEWEST);
    robot_box(&robot, -1500, -2000, 4500, 2000);
    robot_box(&robot, 1300, -200, 1700, 200);
    robot.world = robot_world_segments;
    robot.noise_mm = 4;
    TEST_ASSERT_TRUE(robot_goal(&robot, 3000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
    robot_run(&robot, 2000);
    robot.fault[3] = ROBOT_OFF;
    for (int i = 0; i < 60000 && robot.x < 1400; i++) {
        robot_tick(&robot);
    }
    robot.fault[6] = ROBOT_SCALE;
    robot.fault_value[6] = 50;
    const bool reached = robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 900000);
    char text[140];
    snprintf(text, sizeof text, "at %.0f %.0f, mode %s, closest %.0f, disabled %x", robot.x, robot.y,
             argus_name(ARGUS_NAME_MODE, robot.argus.mode), robot.closest_mm,
             (unsigned)argus_disabled(&robot.argus.knowledge));
    TEST_ASSERT_TRUE_MESSAGE(reached, text);
    TEST_ASSERT_TRUE_MESSAGE(robot.closest_mm > 0, text);
    TEST_ASSERT_EQUAL_HEX16_MESSAGE(1u << 3 | 1u << 6, argus_disabled(&robot.argus.knowledge), text);
    finish();
}

void test_a_stall_is_backed_away_from(void) {
    start_idle();
    TEST_ASSERT_TRUE(robot_goal(&robot, 4000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 5000));
    robot_run(&robot, 2000);
    robot.stall = true;
    const int from = robot.commands;
    robot_run(&robot, 300);
    TEST_ASSERT_EQUAL(1, robot_count_commands(&robot, ARCOS_CMD_STOP, from));
    robot.stall = false;
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_BACKING, 5000));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_HEALTH_CHECK, 8000));
    finish();
}

// S2: the bumper at its front does not explain wheels that stall on the way back.
void test_a_stall_on_the_way_back_from_a_bumper_stops_it(void) {
    start_idle();
    TEST_ASSERT_TRUE(robot_goal(&robot, 4000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 5000));
    robot_run(&robot, 2000);
    robot.bumpers_front = 8;
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_BACKING, 5000));
    robot_run(&robot, 300);
    const int from = robot.commands;
    const int events = robot_count_events(&robot, ARGUS_EV_STALL, 0);
    robot.stall = true;
    robot_next_sip(&robot);
    robot_run(&robot, 20);
    TEST_ASSERT_EQUAL(1, robot_count_commands(&robot, ARCOS_CMD_STOP, from));
    TEST_ASSERT_EQUAL(events + 1, robot_count_events(&robot, ARGUS_EV_STALL, 0));
    robot.stall = false;
    robot.bumpers_front = 0;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_HEALTH_CHECK, 12000));
    finish();
}

// The stall that comes of what pressed the bumper is part of that contact: its E_STOP was the answer.
void test_a_stall_with_the_bumper_that_stopped_it_is_no_news(void) {
    start_idle();
    TEST_ASSERT_TRUE(robot_goal(&robot, 4000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 5000));
    robot_run(&robot, 2000);
    robot.bumpers_front = 8;
    robot_next_sip(&robot);
    robot.stall = true;
    robot_run(&robot, 300);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_BUMPER, 0));
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_STALL, 0));
    robot.stall = false;
    robot.bumpers_front = 0;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_HEALTH_CHECK, 12000));
    finish();
}

void test_polling_leaves_out_the_disabled_and_keeps_0_and_7(void) {
    start_idle();
    robot.fault[3] = ROBOT_OFF;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_PLAN, 3000));
    robot_run(&robot, 200);
    unsigned fires = 0;
    for (int i = 0; i < robot.order_count[0]; i++) {
        fires |= 1u << robot.order[0][i];
    }
    TEST_ASSERT_EQUAL_HEX16(0xFF & ~(1u << 3), fires);
    TEST_ASSERT_EQUAL(8, robot.order_count[1]); // the rear keeps its order
    finish();
}

// A new session begins with the robot's own firing order: the plan's must be sent again.
void test_polling_is_sent_again_after_reconnecting(void) {
    start_idle();
    robot.fault[3] = ROBOT_OFF;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_PLAN, 3000));
    robot_run(&robot, 500);
    argus_link_lost(&robot.argus, now());
    argus_link_up(&robot.argus, now());
    const int from = robot.commands;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_HEALTH_CHECK, 10000));
    robot_run(&robot, 300);
    TEST_ASSERT_EQUAL(1, robot_count_commands(&robot, ARCOS_CMD_POLLING, from));
    finish();
}

void test_polling_is_left_alone_where_no_order_was_given(void) {
    start_idle();
    argus_operator(&robot.argus, now(), ARGUS_OP_PASSIVE, 0);
    robot_run(&robot, 500);
    argus_operator(&robot.argus, now(), ARGUS_OP_ACTIVE, 0);
    robot_run(&robot, 2000);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_POLLING, 0));
    finish();
}
