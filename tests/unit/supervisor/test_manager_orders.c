// SPDX-License-Identifier: MIT
// Rule under attack: each order of the set-up is known to hold by what the robot reports, or is sent again,
// with a pause that grows, and an event when it stays away.
#include "supervisor/manager.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "knowledge/config.h"
#include "robot.h"
#include "unity.h"

#define DEG (3.14159265358979323846 / 180.0)

static robot_t robot;
static char text[400];

static void start(void) {
    const argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &config, 9000u);
    robot.tells_settings = true;
    robot_box(&robot, -2000, -2500, 5000, 2500);
    robot.world = robot_world_segments;
}

static void finish(void) {
    TEST_ASSERT_EQUAL_STRING("", robot.violation);
}

static bool holds(int command) {
    const argus_config_t *config = &robot.argus.config;
    switch (command) {
    case ARCOS_CMD_SETV:
        return fabs(robot.setv - (double)robot.argus.motion.speed_mm_s) < 1;
    case ARCOS_CMD_SETA:
        return fabs(robot.accel - config->accel_mm_s2) < 1 && fabs(robot.decel - config->decel_mm_s2) < 1;
    case ARCOS_CMD_SETRV:
        return fabs(robot.setrv / DEG - config->turn_speed_deg_s) < 1;
    case ARCOS_CMD_SETRA:
        return fabs(robot.setra / DEG - config->turn_accel_deg_s2) < 1;
    case ARCOS_CMD_SONAR_CYCLE:
        return robot.sonar_cycle_ms == config->sonar_cycle_ms;
    case ARCOS_CMD_SONAR:
        return robot.sonar_on;
    case ARCOS_CMD_ENABLE:
        return robot.motors;
    default:
        return false;
    }
}

static const int orders[] = {ARCOS_CMD_SETV,        ARCOS_CMD_SETA,  ARCOS_CMD_SETRV, ARCOS_CMD_SETRA,
                             ARCOS_CMD_SONAR_CYCLE, ARCOS_CMD_SONAR, ARCOS_CMD_ENABLE};
#define ORDERS (sizeof orders / sizeof orders[0])

static const char *told(const char *what, int command) {
    snprintf(text, sizeof text, "%s, command %d, t %u ms, %s", what, command, (unsigned)robot.t_ms,
             robot.violation);
    return text;
}

// The robot is deaf to one command for the first two seconds of the session.
void test_each_order_that_was_lost_is_sent_again(void) {
    for (size_t i = 0; i < ORDERS; i++) {
        start();
        robot.argus.config.sonar_cycle_ms = 45; // another one than the robot's
        robot.ignores[orders[i]] = true;
        robot_run(&robot, 2000);
        TEST_ASSERT_FALSE_MESSAGE(holds(orders[i]), told("is deaf to it", orders[i]));
        robot.ignores[orders[i]] = false;
        robot_run(&robot, 4000);
        TEST_ASSERT_TRUE_MESSAGE(holds(orders[i]), told("holds at last", orders[i]));
        const int sent = robot.commands;
        robot_run(&robot, 20000);
        TEST_ASSERT_EQUAL_MESSAGE(0, robot_count_commands(&robot, orders[i], sent),
                                  told("confirmed, it is let be", orders[i]));
        finish();
    }
}

void test_an_order_that_stays_away_is_told_once_and_paced(void) {
    for (size_t i = 0; i < ORDERS; i++) {
        start();
        robot.argus.config.sonar_cycle_ms = 45;
        robot.ignores[orders[i]] = true;
        robot_run(&robot, 60000);
        int said = 0;
        for (int k = 0; k < robot.events; k++) {
            said += robot.event[k].id == ARGUS_EV_ORDER_UNANSWERED && robot.event[k].value == orders[i];
        }
        const bool two = orders[i] == ARCOS_CMD_SETA || orders[i] == ARCOS_CMD_SETRA; // + and -
        const int least = orders[i] == ARCOS_CMD_SETV ? 0 : 1; // what the wheels do tells of SETV
        TEST_ASSERT_TRUE_MESSAGE(said >= least && said <= (two ? 2 : 1), told("said once", orders[i]));
        TEST_ASSERT_LESS_THAN_MESSAGE(two ? 40 : 20, robot_count_commands(&robot, orders[i], 0),
                                      told("paced", orders[i]));
        finish();
    }
}

// A person who pressed the button lets the motors go on, not an order that is sent again.
void test_a_button_ends_what_is_sent_again(void) {
    start();
    robot.stop_button = true;
    robot_run(&robot, 10000);
    const int sent = robot.commands;
    robot.stop_button = false;
    robot_run(&robot, 10000);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_ENABLE, sent));
    TEST_ASSERT_FALSE(robot.motors);
    finish();
}

void test_passive_nothing_enables_the_motors(void) {
    start();
    robot.ignores[ARCOS_CMD_ENABLE] = true;
    robot_run(&robot, 1500);
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_PASSIVE, 0);
    robot.ignores[ARCOS_CMD_ENABLE] = false;
    robot_run(&robot, 20000);
    TEST_ASSERT_FALSE(robot.motors);
    finish();
}

void test_a_robot_that_tells_no_settings_is_not_asked_for_ever(void) {
    start();
    robot.tells_settings = false;
    robot_run(&robot, 60000);
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_ORDER_UNANSWERED, 0));
    TEST_ASSERT_LESS_THAN(10, robot_count_commands(&robot, ARCOS_CMD_CONFIG, 0));
    TEST_ASSERT_LESS_THAN(8, robot_count_commands(&robot, ARCOS_CMD_SETA, 0));
    finish();
}

// What the settings were before the set-up is the robot's own; what it tells afterwards is ours.
void test_the_robots_own_settings_are_those_before_the_set_up(void) {
    start();
    robot_run(&robot, 5000);
    TEST_ASSERT_EQUAL(750, robot.argus.session.robot.vel_max_mm_s);
    TEST_ASSERT_EQUAL(300, robot.argus.session.robot.decel_mm_s2);
    TEST_ASSERT_GREATER_THAN(1, robot_count_commands(&robot, ARCOS_CMD_CONFIG, 0));
    finish();
}

// In failure mode the firing order is ours. Lost, it shows in what is listed.
void test_a_firing_order_that_was_lost_is_sent_again(void) {
    start();
    robot_run(&robot, 4000);
    robot.ignores[ARCOS_CMD_POLLING] = true;
    robot.fault[3] = ROBOT_SILENT;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_PLAN, 6000));
    robot_run(&robot, 1000);
    robot.ignores[ARCOS_CMD_POLLING] = false;
    TEST_ASSERT_EQUAL(8, robot.order_count[0]);
    robot_run(&robot, 8000);
    TEST_ASSERT_GREATER_THAN(8, robot.order_count[0]);
    const int sent = robot.commands;
    robot_run(&robot, 20000);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_POLLING, sent));
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_ORDER_UNANSWERED, 0));
    finish();
}

// ---- the speed that it is set, and the one that it drives

// Some robots do not heed SETV in a MOVE. What counts for S5 is the speed that is seen: told once, and from
// then on each MOVE is so short that the robot is no faster than what it sees allows.
void test_a_robot_that_races_is_told_of_once_and_held_by_short_ways(void) {
    start();
    robot.segments = 0;
    robot_box(&robot, -1500, -1500, 6000, 1500);
    robot.races_mm_s = 1000;
    robot_goal(&robot, 5000, 0);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SPEED_EXCEEDED, 15000));
    TEST_ASSERT_GREATER_THAN(240, robot_last_event(&robot, ARGUS_EV_SPEED_EXCEEDED)->value);
    robot_run(&robot, 2500); // it brakes
    double most = 0;
    for (int i = 0; i < 600; i++) {
        robot_run(&robot, 100);
        const argus_config_t *config = &robot.argus.config;
        const int range_mm = (int)fmax(6000 - robot.x - 300, config->object_range_mm);
        const double safe =
            argus_config_speed_mm_s(config, robot.argus.knowledge.robot, (int)fmin(range_mm, 5000), 0);
        most = fmax(most, robot.v);
        TEST_ASSERT_TRUE_MESSAGE(robot.v <= safe + 60, told("S5 by the speed seen", (int)robot.v));
    }
    TEST_ASSERT_TRUE(most > 30);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_SPEED_EXCEEDED, 0));
    TEST_ASSERT_EQUAL(ARGUS_MISSION_REACHED, robot.argus.mission);
    TEST_ASSERT_TRUE(robot.closest_mm > 100);
    finish();
}

// A lower SETV that got lost shows in the wheels: it is sent again at once, and nothing is told.
void test_a_lower_speed_that_got_lost_is_sent_again(void) {
    start();
    robot.segments = 0;
    robot_box(&robot, -1500, -1500, 9000, 1500);
    robot_goal(&robot, 8000, 0);
    for (int i = 0; i < 2000 && robot.v < 450; i++) {
        robot_tick(&robot);
    }
    TEST_ASSERT_TRUE(robot.v >= 450);
    robot.ignores[ARCOS_CMD_SETV] = true;
    for (int i = 0; i < 2000 && robot.argus.motion.speed_mm_s >= 450; i++) {
        robot_tick(&robot);
    }
    robot.ignores[ARCOS_CMD_SETV] = false; // one alone was lost
    robot_run(&robot, 20000);
    TEST_ASSERT_EQUAL(ARGUS_MISSION_REACHED, robot.argus.mission);
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_SPEED_EXCEEDED, 0));
    finish();
}

void test_a_robot_that_keeps_to_its_speed_is_never_said_to_race(void) {
    start();
    robot_goal(&robot, 3500, 600);
    robot_run(&robot, 40000);
    TEST_ASSERT_EQUAL(ARGUS_MISSION_REACHED, robot.argus.mission);
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_SPEED_EXCEEDED, 0));
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_ORDER_UNANSWERED, 0));
    finish();
}
