// SPDX-License-Identifier: MIT
// Rule under attack: a robot that stands asks for what its mode is for and for nothing else: it reads again,
// looks, waits or backs away, says when the robot does not do it, and no look is begun where none can be had.
#include "behaviour/resting.h"

#include "behaviour/state.h"
#include "health.h"
#include "robot.h"
#include "unity.h"

#define AHEAD 3
#define BEHIND 12
#define HEMMED_IN_MS 10000u

static robot_t robot;
static argus_t *core;
static argus_intent_t intent;

static void begin_in(double half_x_mm, double half_y_mm) {
    robot_in_box(&robot, ARGUS_PROFILE_ARGUS, -half_x_mm, -half_y_mm, half_x_mm, half_y_mm);
    robot_run(&robot, 5000);
    core = &robot.argus;
    intent = (argus_intent_t){0};
}

void setUp(void) {
    begin_in(3000, 3000);
}

static void suspect(int sonar) {
    put_health(&core->knowledge.sonar[sonar], ARGUS_SUSPECT, ARGUS_KIND_WRONG, core->now_ms);
}

// It stands where it may neither turn nor back away, and has waited for either.
static void hem_in(void) {
    begin_in(330, 300);
    core->mission = ARGUS_MISSION_RUNNING;
    core->waiting.last = ARGUS_WAIT_TURN;
    core->waiting.since_ms = core->now_ms - HEMMED_IN_MS;
    TEST_ASSERT_TRUE(argus_is_hemmed_in(core));
}

static void look(void) {
    core->mode = ARGUS_MODE_VERIFYING;
    intent = (argus_intent_t){0};
    argus_run_verifying(core, &core->verifying, &intent);
}

void test_looks_end_where_the_robot_does_not_turn(void) {
    suspect(AHEAD);
    look();
    TEST_ASSERT_EQUAL(ARGUS_DO_LOOK, intent.act);
    TEST_ASSERT_TRUE(core->verifying.inquiry.active);
    core->motion.kind = ARGUS_MOTION_TURN;
    core->motion.failed = true;
    look();
    TEST_ASSERT_EQUAL(ARGUS_EV_TURN_FAILED, intent.event);
    TEST_ASSERT_EQUAL(ARGUS_DO_WAIT, intent.act);
    TEST_ASSERT_EQUAL(ARGUS_WAIT_MOTORS, intent.why);
    TEST_ASSERT_FALSE(core->verifying.inquiry.active);
}

void test_a_look_waits_until_the_robot_has_settled(void) {
    suspect(AHEAD);
    core->motion.settled = false;
    look();
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
    TEST_ASSERT_FALSE(core->verifying.inquiry.active);
}

// Hemmed in, one that does not look ahead is left open; one that does is asked for all the same, and where
// there is room both are.
void test_where_no_look_can_be_had_only_those_ahead_are_asked(void) {
    hem_in();
    suspect(BEHIND);
    look();
    TEST_ASSERT_EQUAL(ARGUS_DO_LEAVE_OPEN, intent.act);
    TEST_ASSERT_EQUAL_HEX32(1u << BEHIND, intent.sonars);
    TEST_ASSERT_FALSE(core->verifying.inquiry.active);
    suspect(AHEAD);
    look();
    TEST_ASSERT_EQUAL(ARGUS_DO_LOOK, intent.act);
    TEST_ASSERT_EQUAL_HEX32(1u << BEHIND | 1u << AHEAD, intent.sonars);
    setUp();
    suspect(BEHIND);
    look();
    TEST_ASSERT_EQUAL(ARGUS_DO_LOOK, intent.act);
}

// The first thing after a session begins is rest, whatever heading that is on.
void test_idle_waits_for_rest_first_and_then_checks_beside(void) {
    core->mode = ARGUS_MODE_IDLE;
    argus_motion_init(&core->motion);
    core->motion.settled = false;
    argus_run_idle(core, &intent);
    TEST_ASSERT_EQUAL(ARGUS_DO_HOLD, intent.act);
    TEST_ASSERT_TRUE(intent.more);
    for (int kind = ARGUS_MOTION_NONE; kind <= ARGUS_MOTION_STOP; kind++) {
        for (int settled = 0; settled < 2; settled++) {
            intent = (argus_intent_t){0};
            core->motion.kind = (argus_motion_kind_t)kind;
            core->motion.settled = settled != 0;
            argus_run_idle(core, &intent);
            const bool holds = kind == ARGUS_MOTION_NONE && settled == 0;
            TEST_ASSERT_EQUAL(holds ? ARGUS_DO_HOLD : ARGUS_DO_CHECK_BESIDE, intent.act);
            TEST_ASSERT_EQUAL(holds, intent.more);
        }
    }
}

// What a wait is for is tried again after its pause, and what nothing ends is not.
static void wait_for(argus_wait_t why) {
    core->mode = ARGUS_MODE_WAITING;
    core->waiting.why = why;
    core->waiting.tried_ms = core->now_ms - 3000u;
    intent = (argus_intent_t){0};
    argus_run_waiting(core, &core->waiting, &intent);
}

void test_a_wait_ends_by_what_it_is_for(void) {
    wait_for(ARGUS_WAIT_WAY);
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act);
    TEST_ASSERT_EQUAL(ARGUS_WAY_FORGIVE, intent.way);
    wait_for(ARGUS_WAIT_TURN);
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act);
    core->reflexes.motors_said = true;
    wait_for(ARGUS_WAIT_MOTORS);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
    core->reflexes.motors_said = false;
    wait_for(ARGUS_WAIT_MOTORS);
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act);
    wait_for(ARGUS_WAIT_ECHO);
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act); // one ahead has heard an echo
    core->knowledge.heard = 0;
    wait_for(ARGUS_WAIT_ECHO);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
    wait_for(ARGUS_WAIT_CATASTROPHIC);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
}

void test_before_its_pause_is_over_nothing_is_tried(void) {
    core->mode = ARGUS_MODE_WAITING;
    core->waiting.why = ARGUS_WAIT_WAY;
    core->waiting.tried_ms = core->now_ms - 2999u;
    argus_run_waiting(core, &core->waiting, &intent);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
    core->waiting.why = ARGUS_WAIT_BUMPER;
    core->waiting.tried_ms = core->now_ms - 499u;
    argus_run_waiting(core, &core->waiting, &intent);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
}

// S2: at a bumper the motors come first, then a way back that nothing presses; a button or an operator leaves
// it where it is.
void test_at_a_bumper_the_robot_frees_itself_only_where_it_may(void) {
    core->reflexes.bumpers = core->knowledge.bumpers_front = 8;
    wait_for(ARGUS_WAIT_BUMPER);
    TEST_ASSERT_EQUAL(ARGUS_DO_BACK, intent.act);
    TEST_ASSERT_EQUAL_INT32(core->config.backoff_mm, intent.mm);
    core->knowledge.bumpers_rear = 8;
    wait_for(ARGUS_WAIT_BUMPER);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
    core->knowledge.bumpers_rear = 0;
    core->knowledge.flags = (uint16_t)(core->knowledge.flags & ~(unsigned)ARCOS_FLAG_MOTORS);
    wait_for(ARGUS_WAIT_BUMPER);
    TEST_ASSERT_EQUAL(ARGUS_DO_ENABLE, intent.act);
    core->knowledge.flags = (uint16_t)(core->knowledge.flags | ARCOS_FLAG_ESTOP);
    wait_for(ARGUS_WAIT_BUMPER);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
    core->orders.paused = true;
    core->knowledge.flags = (uint16_t)(core->knowledge.flags & ~(unsigned)ARCOS_FLAG_ESTOP);
    wait_for(ARGUS_WAIT_BUMPER);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
}

void test_a_passive_robot_at_a_bumper_waits_for_others_to_free_it(void) {
    core->orders.passive = true;
    core->reflexes.bumpers = 8;
    wait_for(ARGUS_WAIT_BUMPER);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
    core->reflexes.bumpers = 0;
    wait_for(ARGUS_WAIT_BUMPER);
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act);
}

// Backing ends at rest by a check all round, and where something is still pressed by a wait.
void test_backing_ends_in_a_check_or_at_the_bumper(void) {
    core->mode = ARGUS_MODE_BACKING;
    core->motion.settled = true;
    argus_run_backing(core, &intent);
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act);
    TEST_ASSERT_TRUE(intent.all_round);
    TEST_ASSERT_FALSE(intent.full);
    TEST_ASSERT_EQUAL(ARGUS_BASE_DROP, intent.base);
    core->reflexes.bumpers = 8;
    intent = (argus_intent_t){0};
    argus_run_backing(core, &intent);
    TEST_ASSERT_EQUAL(ARGUS_DO_WAIT, intent.act);
    TEST_ASSERT_EQUAL(ARGUS_WAIT_BUMPER, intent.why);
}

void test_s2_backing_halts_where_the_rear_is_not_watched(void) {
    core->mode = ARGUS_MODE_BACKING;
    core->motion.settled = false;
    argus_run_backing(core, &intent);
    TEST_ASSERT_EQUAL(ARGUS_STOP_NONE, intent.stop);
    put_health(&core->knowledge.sonar[BEHIND], ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
    intent = (argus_intent_t){0};
    argus_run_backing(core, &intent);
    TEST_ASSERT_EQUAL(ARGUS_STOP_HALT, intent.stop);
}

// What counts is read since the motion ended; a robot that is only watched has none.
void test_a_check_counts_from_the_end_of_the_motion(void) {
    for (int passive = 0; passive < 2; passive++) {
        setUp();
        core->orders.passive = passive != 0;
        core->mode = ARGUS_MODE_CHECKING;
        core->checking = (argus_checking_t){.rounds = 2};
        core->motion.mark = argus_mark_now(&core->knowledge);
        core->motion.mark.sip -= 3;
        argus_run_checking(core, &core->checking, &intent);
        TEST_ASSERT_TRUE(core->checking.marked);
        TEST_ASSERT_EQUAL_UINT32(core->knowledge.sips - (passive != 0 ? 0 : 3), core->checking.mark.sip);
    }
}
