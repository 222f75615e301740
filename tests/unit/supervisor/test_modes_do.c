// SPDX-License-Identifier: MIT
// Rule under attack: what an intent asks for is done, with what follows from it, and what may not be done now
// is not sent: nothing reaches the wheels but through the permit, and a robot that is being left checks
// nothing.
#include "supervisor/modes.h"

#include "behaviour/state.h"
#include "health.h"
#include "robot.h"
#include "unity.h"

#define AHEAD 3
#define BEHIND 12
#define ABEAM 7

static robot_t robot;
static argus_t *core;
static int from; // commands so far
static int said; // events

static void begin(void) {
    robot_in_box(&robot, ARGUS_PROFILE_ARGUS, -3000, -3000, 3000, 3000);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    robot_run(&robot, 3000);
    core = &robot.argus;
    robot_drain(&robot);
    from = robot.commands;
    said = robot.events;
}

void setUp(void) {
    begin();
}

static void drive_off(void) {
    TEST_ASSERT_TRUE(robot_goal(&robot, 2000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 8000));
    robot_run(&robot, 2000);
    TEST_ASSERT_TRUE(robot.v > 100);
    robot_drain(&robot);
    from = robot.commands;
    said = robot.events;
}

static void perform(argus_act_t act) {
    argus_stop_and_do(core, ARGUS_STOP_NONE, act, false);
}

static int sent(int command) {
    robot_drain(&robot);
    return robot_count_commands(&robot, command, from);
}

static int events(int id) {
    robot_drain(&robot);
    return robot_count_events(&robot, id, said);
}

void test_hold_waits_for_rest_and_sends_nothing(void) {
    core->motion.settled = true;
    perform(ARGUS_DO_HOLD);
    TEST_ASSERT_FALSE(core->motion.settled);
    TEST_ASSERT_EQUAL(0, sent(ARCOS_CMD_STOP) + sent(ARCOS_CMD_MOVE) + sent(ARCOS_CMD_HEAD));
    robot_run(&robot, 1000);
    TEST_ASSERT_TRUE(core->motion.settled);
}

// S3: an operator's stop bars the way; the order that was ahead of it is held, not sent.
void test_a_way_that_is_barred_is_not_sent(void) {
    drive_off();
    core->orders.stay = ARGUS_STAY_OPERATOR;
    const argus_intent_t drive = {.act = ARGUS_DO_DRIVE, .mm = 100, .speed_mm_s = 100, .moves_on = true};
    core->turning.backed = 2;
    argus_do(core, &drive);
    TEST_ASSERT_EQUAL(0, sent(ARCOS_CMD_MOVE));
    TEST_ASSERT_EQUAL(2, core->turning.backed); // it does not stand elsewhere for that
    TEST_ASSERT_FALSE(argus_motion_is_under_way(&core->motion));
}

static int backs(void) {
    const argus_intent_t back = {.act = ARGUS_DO_BACK, .mm = 150, .speed_mm_s = 100};
    core->mode = ARGUS_MODE_WAITING;
    argus_do(core, &back);
    return sent(ARCOS_CMD_MOVE);
}

void test_the_way_back_is_sent_only_where_it_may_be(void) {
    core->orders.stay = ARGUS_STAY_OPERATOR;
    TEST_ASSERT_EQUAL(0, backs());
    TEST_ASSERT_EQUAL(ARGUS_MODE_WAITING, core->mode);
    begin();
    core->orders.passive = true;
    TEST_ASSERT_EQUAL(0, backs());
    begin();
    put_health(&core->knowledge.sonar[BEHIND], ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
    TEST_ASSERT_EQUAL(0, backs());
    begin();
    TEST_ASSERT_EQUAL(1, backs());
    TEST_ASSERT_EQUAL(ARGUS_MODE_BACKING, core->mode);
    TEST_ASSERT_EQUAL(1, events(ARGUS_EV_BACKING));
}

void test_what_is_left_open_is_unproven_and_checked(void) {
    put_health(&core->knowledge.sonar[BEHIND], ARGUS_SUSPECT, ARGUS_KIND_WRONG, core->now_ms);
    const argus_intent_t leave = {.act = ARGUS_DO_LEAVE_OPEN, .sonars = 1u << BEHIND};
    core->mode = ARGUS_MODE_VERIFYING;
    argus_do(core, &leave);
    TEST_ASSERT_EQUAL(ARGUS_MODE_CHECKING, core->mode);
    TEST_ASSERT_EQUAL(1, events(ARGUS_EV_SONAR_UNPROVEN));
    TEST_ASSERT_EQUAL(BEHIND, robot_last_event(&robot, ARGUS_EV_SONAR_UNPROVEN)->sonar);
    TEST_ASSERT_EQUAL_HEX32(0, argus_open_suspects(core)); // not looked at again in this place
    TEST_ASSERT_EQUAL(ARGUS_SUSPECT, core->knowledge.sonar[BEHIND].health);
}

void test_a_robot_that_is_being_left_checks_nothing(void) {
    for (int closed = 0; closed < 2; closed++) {
        begin();
        const argus_mode_t mode = closed != 0 ? ARGUS_MODE_CLOSED : ARGUS_MODE_CLOSING;
        core->mode = mode;
        perform(ARGUS_DO_CHECK);
        TEST_ASSERT_EQUAL(mode, core->mode);
    }
}

// A sonar that dies while the robot is being left, or waits, is lost all the same and changes no mode.
void test_a_loss_is_noted_where_the_mode_stays(void) {
    static const struct {
        argus_mode_t in, then;
    } by[] = {{ARGUS_MODE_CLOSING, ARGUS_MODE_CLOSING},
              {ARGUS_MODE_WAITING, ARGUS_MODE_WAITING},
              {ARGUS_MODE_IDLE, ARGUS_MODE_CHECKING}};
    for (size_t i = 0; i < sizeof by / sizeof by[0]; i++) {
        begin();
        core->mode = by[i].in;
        const argus_intent_t loss = {.act = ARGUS_DO_LOSE, .sonars = 1u << AHEAD, .silent = 1u << 4};
        argus_do(core, &loss);
        TEST_ASSERT_EQUAL(by[i].then, core->mode);
        TEST_ASSERT_EQUAL(ARGUS_DISABLED, core->knowledge.sonar[AHEAD].health);
        TEST_ASSERT_EQUAL(ARGUS_KIND_OFF, core->knowledge.sonar[AHEAD].kind);
        TEST_ASSERT_EQUAL(ARGUS_KIND_SILENT, core->knowledge.sonar[4].kind);
        TEST_ASSERT_EQUAL(1, events(ARGUS_EV_SONAR_DEAD));
        TEST_ASSERT_EQUAL(1, events(ARGUS_EV_SONAR_SILENT));
    }
}

// At a goal by the wheels alone the robot is still where they began to slip.
void test_a_goal_that_was_slipped_to_is_none(void) {
    drive_off();
    core->slip.doubted = 1;
    core->slip.first = (argus_pose_t){100, 0, 0};
    core->slip.first.x_mm = core->knowledge.pose.x_mm - 700;
    const int32_t there_mm = core->slip.first.x_mm;
    perform(ARGUS_DO_REACH);
    TEST_ASSERT_EQUAL(ARGUS_MISSION_RUNNING, core->mission);
    TEST_ASSERT_EQUAL(ARGUS_MODE_CHECKING, core->mode);
    TEST_ASSERT_EQUAL_INT32(there_mm, core->knowledge.pose.x_mm);
    TEST_ASSERT_EQUAL(0, events(ARGUS_EV_GOAL_REACHED));
    begin();
    drive_off();
    perform(ARGUS_DO_REACH);
    TEST_ASSERT_EQUAL(ARGUS_MISSION_REACHED, core->mission);
    TEST_ASSERT_EQUAL(1, events(ARGUS_EV_GOAL_REACHED));
}

// S5: no sonar ahead has heard an echo, others have: a check first, then a look by which they may.
void test_a_ring_that_is_deaf_ahead_is_checked_and_then_looked_with(void) {
    core->mission = ARGUS_MISSION_RUNNING;
    core->knowledge.heard = (argus_mask_t)(1u << ABEAM); // neither end would lead better
    perform(ARGUS_DO_DECIDE);
    TEST_ASSERT_EQUAL(ARGUS_MODE_CHECKING, core->mode);
    TEST_ASSERT_FALSE(core->looks.tried);
    perform(ARGUS_DO_DECIDE);
    TEST_ASSERT_EQUAL(ARGUS_MODE_VERIFYING, core->mode);
    TEST_ASSERT_TRUE(core->looks.tried);
}

// Verifying begins at rest: what is under way is stopped, and what has not settled is waited for.
void test_verifying_begins_at_rest(void) {
    const argus_intent_t verify = {.act = ARGUS_DO_VERIFY, .sonars = 1u << AHEAD};
    drive_off();
    argus_do(core, &verify);
    TEST_ASSERT_EQUAL(ARGUS_MODE_VERIFYING, core->mode);
    TEST_ASSERT_EQUAL(1, sent(ARCOS_CMD_STOP));
    begin();
    argus_motion_init(&core->motion); // at rest, and no motion has settled yet
    core->motion.settled = false;
    argus_do(core, &verify);
    TEST_ASSERT_EQUAL(0, sent(ARCOS_CMD_STOP));
    TEST_ASSERT_FALSE(core->motion.settled);
    robot_run(&robot, 500);
    TEST_ASSERT_TRUE(core->motion.settled || core->motion.kind == ARGUS_MOTION_TURN);
}

// A check waits for rest, also where a motion failed; a stop at work is waited for, not sent twice.
void test_a_check_sends_one_stop_at_most(void) {
    static const struct {
        argus_motion_kind_t kind;
        bool settled, failed;
        int stops;
    } by[] = {{ARGUS_MOTION_MOVE, false, false, 1}, {ARGUS_MOTION_TURN, false, true, 0},
              {ARGUS_MOTION_STOP, false, false, 0}, {ARGUS_MOTION_STOP, false, true, 0},
              {ARGUS_MOTION_MOVE, true, false, 0},  {ARGUS_MOTION_NONE, false, false, 0}};
    for (size_t i = 0; i < sizeof by / sizeof by[0]; i++) {
        begin();
        core->motion.kind = by[i].kind;
        core->motion.settled = by[i].settled;
        core->motion.failed = by[i].failed;
        perform(ARGUS_DO_CHECK);
        TEST_ASSERT_EQUAL(by[i].stops, sent(ARCOS_CMD_STOP));
        TEST_ASSERT_EQUAL(ARGUS_MODE_CHECKING, core->mode);
        TEST_ASSERT_FALSE(core->motion.failed); // nothing failed that is only waited for
    }
}

// S7: a turn that something is in the way of ends at once, and a full check follows.
void test_s7_a_turn_that_is_ended_is_followed_by_a_full_check(void) {
    core->motion.kind = ARGUS_MOTION_TURN;
    core->motion.settled = false;
    TEST_ASSERT_TRUE(core->checked);
    const argus_intent_t end = {.act = ARGUS_DO_END_TURN, .at = {300, 100}};
    argus_do(core, &end);
    TEST_ASSERT_EQUAL(1, sent(ARCOS_CMD_STOP));
    TEST_ASSERT_EQUAL(1, events(ARGUS_EV_TURN_BLOCKED));
    TEST_ASSERT_EQUAL(ARGUS_MODE_CHECKING, core->mode);
    TEST_ASSERT_EQUAL(core->config.suspect_readings, core->checking.rounds);
}
