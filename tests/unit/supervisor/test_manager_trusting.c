// SPDX-License-Identifier: MIT
// Rule under attack: with diagnosis = off nothing is suspected, named or disabled but a sonar that yields
// nothing, whatever the profile; what a sonar says is an object stops the robot as ever, and the drive is the
// same as that of profile argus with healthy sonars.
#include "supervisor/manager.h"

#include <math.h>
#include <stdio.h>

#include "robot.h"
#include "unity.h"

static robot_t robot;
static robot_t judged;
static char text[120];

static void start(robot_t *r, int32_t profile, int32_t diagnosis) {
    argus_config_t config = robot_config_of(profile);
    config.diagnosis = diagnosis;
    robot_init(r, &config, 0xFFFF8000u);
    r->noise_mm = 5;
    robot_box(r, -2500, -2300, 6000, 2500);
    r->world = robot_world_segments;
}

static int judgements(void) {
    static const int ids[] = {ARGUS_EV_SONAR_SUSPECT,  ARGUS_EV_SONAR_NAMED, ARGUS_EV_SONAR_VERIFYING,
                              ARGUS_EV_SONAR_DISABLED, ARGUS_EV_SONAR_DEAD,  ARGUS_EV_LOOK};
    int count = 0;
    for (int i = 0; i < (int)(sizeof ids / sizeof ids[0]); i++) {
        count += robot_count_events(&robot, ids[i], 0);
    }
    return count;
}

// To and fro with a fault.
static void drive_with(robot_fault_t fault, int sonar) {
    robot_run(&robot, 4000);
    robot.fault[sonar] = fault;
    robot.fault_value[sonar] = fault == ROBOT_SLOW ? 6 : 60;
    for (int leg = 0; leg < 6; leg++) {
        robot_goal(&robot, leg % 2 == 0 ? 1500 : 0, leg * 100);
        robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 20000);
    }
}

void test_nothing_is_judged(void) {
    static const robot_fault_t faults[] = {ROBOT_OFF,     ROBOT_SCALE, ROBOT_STUCK,
                                           ROBOT_GARBAGE, ROBOT_SLOW,  ROBOT_DROPOUT};
    for (int32_t profile = ARGUS_PROFILE_PAPER; profile <= ARGUS_PROFILE_ARGUS; profile++) {
        for (int i = 0; i < (int)(sizeof faults / sizeof faults[0]); i++) {
            start(&robot, profile, 0);
            drive_with(faults[i], i % 2 == 0 ? 3 : 5);
            snprintf(text, sizeof text, "profile %d, fault %d", (int)profile, (int)faults[i]);
            TEST_ASSERT_EQUAL_MESSAGE(0, judgements(), text);
            TEST_ASSERT_EQUAL_HEX16(0, argus_out(&robot.argus.knowledge));
            TEST_ASSERT_EQUAL_STRING("", robot.violation);
        }
    }
}

void test_whoever_yields_nothing_is_out(void) {
    for (int sonar = 3; sonar <= 5; sonar++) {
        start(&robot, ARGUS_PROFILE_ARGUS, 0);
        drive_with(ROBOT_SILENT, sonar);
        TEST_ASSERT_EQUAL(ARGUS_DISABLED, robot.argus.knowledge.sonar[sonar].health);
        TEST_ASSERT_EQUAL(ARGUS_KIND_SILENT, robot.argus.knowledge.sonar[sonar].kind);
        TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_SONAR_DISABLED, 0));
        TEST_ASSERT_EQUAL_STRING("", robot.violation);
    }
}

void test_a_retest_brings_no_look(void) {
    start(&robot, ARGUS_PROFILE_ARGUS, 0);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_RETEST, 3));
    robot_run(&robot, 10000);
    TEST_ASSERT_EQUAL(0, judgements());
    TEST_ASSERT_EQUAL(ARGUS_MODE_IDLE, robot.argus.mode);
    TEST_ASSERT_EQUAL_STRING("", robot.violation);
}

void test_an_object_stops_it_all_the_same(void) {
    start(&robot, ARGUS_PROFILE_ARGUS, 0);
    TEST_ASSERT_TRUE(robot_goal(&robot, 4000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
    robot_run(&robot, 2000);
    robot.fault[3] = ROBOT_VALUE;
    robot.fault_value[3] = 240;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_OBJECT, 1000));
    robot_run(&robot, 2000);
    TEST_ASSERT_TRUE(robot.v == 0);
}

// The same commands to the wheels at the same time, until somebody is doubted where that is on.
void test_the_drive_is_that_of_argus_with_healthy_sonars(void) {
    start(&robot, ARGUS_PROFILE_ARGUS, 0);
    start(&judged, ARGUS_PROFILE_ARGUS, 1);
    TEST_ASSERT_TRUE(robot_goal(&robot, 4000, 800) && robot_goal(&judged, 4000, 800));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 40000));
    TEST_ASSERT_TRUE(robot_until_event(&judged, ARGUS_EV_GOAL_REACHED, 40000));
    TEST_ASSERT_EQUAL(0, robot_count_events(&judged, ARGUS_EV_SONAR_NAMED, 0));
    TEST_ASSERT_EQUAL(judged.commands, robot.commands);
    for (int i = 0; i < robot.commands; i++) {
        snprintf(text, sizeof text, "command %d at %u ms", i, (unsigned)robot.command[i].t_ms);
        TEST_ASSERT_EQUAL_MESSAGE(judged.command[i].t_ms, robot.command[i].t_ms, text);
        TEST_ASSERT_EQUAL_MESSAGE(judged.command[i].command, robot.command[i].command, text);
        TEST_ASSERT_EQUAL_MESSAGE(judged.command[i].argument, robot.command[i].argument, text);
    }
}
