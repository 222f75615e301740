// SPDX-License-Identifier: MIT
// Rule under attack: an operator's order is carried out as it was meant, whichever end leads, and one that
// would change nothing changes nothing.
#include "supervisor/orders.h"

#include "behaviour/state.h"
#include "health.h"
#include "robot.h"
#include "supervisor/journey.h"
#include "unity.h"

static robot_t robot;
static argus_t *core;
static int from; // commands so far
static int said; // events

void setUp(void) {
    robot_in_box(&robot, ARGUS_PROFILE_ARGUS, -3000, -3000, 3000, 3000);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    robot_run(&robot, 2000);
    core = &robot.argus;
    robot_drain(&robot);
    from = robot.commands;
    said = robot.events;
}

static int events(int id) {
    robot_drain(&robot);
    return robot_count_events(&robot, id, said);
}

static int32_t moved_mm(int32_t asked_mm) {
    argus_obey(core, ARGUS_OP_MOVE, asked_mm);
    robot_run(&robot, 500);
    return robot_count_commands(&robot, ARCOS_CMD_MOVE, from) > 0
               ? robot_last_command(&robot, ARCOS_CMD_MOVE)->argument
               : 0;
}

// Ahead is where the robot is built to drive.
void test_an_operators_step_goes_the_way_that_he_sees(void) {
    TEST_ASSERT_EQUAL_INT32(100, moved_mm(100));
    setUp();
    TEST_ASSERT_EQUAL_INT32(-100, moved_mm(-100));
    setUp();
    core->knowledge.robot = argus_robot_other_end(core->knowledge.robot);
    TEST_ASSERT_EQUAL_INT32(100, moved_mm(100)); // back, for the end that leads
    TEST_ASSERT_EQUAL(1, events(ARGUS_EV_BACKING));
}

void test_a_step_of_nothing_or_without_motors_is_none(void) {
    TEST_ASSERT_EQUAL_INT32(0, moved_mm(0));
    core->knowledge.flags = (uint16_t)(core->knowledge.flags & ~(unsigned)ARCOS_FLAG_MOTORS);
    argus_obey(core, ARGUS_OP_MOVE, 100);
    TEST_ASSERT_EQUAL_INT32(0, core->travel.jog_mm);
    TEST_ASSERT_EQUAL(ARGUS_MODE_IDLE, core->mode);
}

void test_s6_a_step_waits_until_a_suspect_is_verified(void) {
    put_health(&core->knowledge.sonar[3], ARGUS_SUSPECT, ARGUS_KIND_WRONG, core->now_ms);
    argus_obey(core, ARGUS_OP_MOVE, 5000);
    TEST_ASSERT_EQUAL(ARGUS_MODE_CHECKING, core->mode);
    TEST_ASSERT_EQUAL_INT32(core->config.step_mm, core->travel.jog_mm);
}

void test_what_is_out_is_not_taken_out_again(void) {
    TEST_ASSERT_TRUE(argus_obey(core, ARGUS_OP_DISABLE, 3));
    TEST_ASSERT_EQUAL(1, events(ARGUS_EV_SONAR_DISABLED));
    TEST_ASSERT_EQUAL(1, core->knowledge.sonar[3].disabled_times);
    TEST_ASSERT_TRUE(argus_obey(core, ARGUS_OP_UNPIN, 3));
    TEST_ASSERT_TRUE(argus_obey(core, ARGUS_OP_DISABLE, 3));
    TEST_ASSERT_EQUAL(1, events(ARGUS_EV_SONAR_DISABLED));
    TEST_ASSERT_EQUAL(1, core->knowledge.sonar[3].disabled_times);
    TEST_ASSERT_EQUAL_HEX32(1u << 3, core->orders.pinned);
}

void test_no_order_is_of_a_sonar_that_there_is_not(void) {
    static const int32_t none[] = {-1, INT32_MIN, INT32_MAX};
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        for (int op = ARGUS_OP_RETEST; op <= ARGUS_OP_DISABLE; op++) {
            TEST_ASSERT_FALSE(argus_obey(core, (argus_op_t)op, none[i]));
        }
    }
    TEST_ASSERT_FALSE(argus_obey(core, ARGUS_OP_DISABLE, core->knowledge.sonars));
    TEST_ASSERT_FALSE(argus_obey(core, (argus_op_t)(ARGUS_OP_DISABLE + 1), 3)); // no such order
    TEST_ASSERT_EQUAL(0, events(ARGUS_EV_OPERATOR));
}

// A course that failed because this robot may not be driven begins once it may; one that failed by itself
// does not.
void test_active_takes_up_only_a_course_that_could_not_begin(void) {
    for (int unbegun = 0; unbegun < 2; unbegun++) {
        setUp();
        core->mission = ARGUS_MISSION_FAILED;
        core->orders.unbegun = unbegun != 0;
        TEST_ASSERT_TRUE(argus_obey(core, ARGUS_OP_ACTIVE, 0));
        TEST_ASSERT_EQUAL(unbegun != 0 ? ARGUS_MISSION_RUNNING : ARGUS_MISSION_FAILED, core->mission);
        TEST_ASSERT_FALSE(core->orders.unbegun);
    }
    setUp();
    core->mission = ARGUS_MISSION_REACHED;
    core->orders.unbegun = true;
    argus_obey(core, ARGUS_OP_ACTIVE, 0);
    TEST_ASSERT_EQUAL(ARGUS_MISSION_REACHED, core->mission);
}

// The plan of sonars that look ahead changes while it drives: what can cover no more is checked at rest.
static argus_mode_t after_loss_in(argus_mode_t mode) {
    setUp();
    TEST_ASSERT_TRUE(robot_goal(&robot, 2500, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 8000));
    robot_run(&robot, 1000);
    for (int i = 0; i < core->knowledge.sonars; i++) {
        if (i != 3) {
            core->knowledge.sonar[i].health = ARGUS_DISABLED;
            core->knowledge.sonar[i].kind = ARGUS_KIND_OFF;
        }
    }
    core->plan.disabled = 0x7E & ~(1u << 3);
    core->plan.looks = 1u << 3;
    core->mode = mode;
    core->motion.settled = false;
    robot_next_sip(&robot);
    return core->mode;
}

void test_s1_a_plan_that_covers_no_more_breaks_the_way_off(void) {
    static const argus_mode_t ways[] = {ARGUS_MODE_DRIVING, ARGUS_MODE_SWEEPING, ARGUS_MODE_STEPPING};
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        TEST_ASSERT_NOT_EQUAL(ways[i], after_loss_in(ways[i]));
    }
}

// Nobody knows what happened while it was only watched: the check is a full one, whatever was checked before.
void test_active_begins_with_a_full_check(void) {
    argus_obey(core, ARGUS_OP_PASSIVE, 0);
    robot_run(&robot, 1000);
    core->checked = true;
    argus_obey(core, ARGUS_OP_ACTIVE, 0);
    TEST_ASSERT_EQUAL(ARGUS_MODE_CHECKING, core->mode);
    TEST_ASSERT_EQUAL(core->config.suspect_readings, core->checking.rounds);
}

// A new course has not arrived.
void test_a_new_course_is_on_its_way(void) {
    static const argus_point_t to = {2000, 0};
    core->travel.arriving = true;
    core->orders.paused = true;
    TEST_ASSERT_TRUE(argus_journey_set(&core->travel, &to, 1));
    TEST_ASSERT_FALSE(core->travel.arriving);
    core->travel.arriving = true;
    TEST_ASSERT_FALSE(argus_journey_set(&core->travel, &to, 0));
    TEST_ASSERT_TRUE(core->travel.arriving);
}
