// SPDX-License-Identifier: MIT
// Rule under attack: each question on the state has one answer, and each of its reasons alone changes it.
#include "behaviour/state.h"

#include "health.h"
#include "robot.h"
#include "unity.h"

#define HEMMED_IN_MS 10000u
#define PEOPLEBOT 4 // of the setting `robot`: bumpers at both ends

static robot_t robot;
static argus_t *core;

static void begin_in(double half_x_mm, double half_y_mm) {
    robot_in_box(&robot, ARGUS_PROFILE_ARGUS, -half_x_mm, -half_y_mm, half_x_mm, half_y_mm);
    robot_run(&robot, 5000);
    core = &robot.argus;
}

static void hem_in(void) {
    begin_in(330, 300);
    core->mission = ARGUS_MISSION_RUNNING;
    core->waiting.last = ARGUS_WAIT_TURN;
    core->waiting.since_ms = core->now_ms - HEMMED_IN_MS;
}

void test_a_robot_is_hemmed_in_on_its_course_only_and_after_a_while(void) {
    hem_in();
    TEST_ASSERT_TRUE(argus_is_hemmed_in(core));
    core->waiting.since_ms++;
    TEST_ASSERT_FALSE(argus_is_hemmed_in(core));
    hem_in();
    core->waiting.last = ARGUS_WAIT_WAY;
    TEST_ASSERT_FALSE(argus_is_hemmed_in(core));
    hem_in();
    core->mission = ARGUS_MISSION_FAILED;
    TEST_ASSERT_FALSE(argus_is_hemmed_in(core));
    hem_in();
    core->orders.paused = true;
    TEST_ASSERT_FALSE(argus_is_hemmed_in(core));
    hem_in();
    core->reflexes.bumpers = 8;
    TEST_ASSERT_FALSE(argus_is_hemmed_in(core));
}

void test_one_that_may_turn_or_back_away_is_not_hemmed_in(void) {
    static const double halves_mm[][2] = {{3000, 3000}, {3000, 360}};
    for (int i = 0; i < 2; i++) { // room to turn; a passage in which it may back away
        begin_in(halves_mm[i][0], halves_mm[i][1]);
        core->mission = ARGUS_MISSION_RUNNING;
        core->waiting.last = ARGUS_WAIT_TURN;
        core->waiting.since_ms = core->now_ms - HEMMED_IN_MS;
        const argus_guard_t guard = argus_guard(core);
        TEST_ASSERT_EQUAL(i == 0, argus_guard_may_turn(&guard));
        TEST_ASSERT_EQUAL(i == 1, !argus_guard_may_turn(&guard) && argus_guard_may_back_off(&guard));
        TEST_ASSERT_FALSE(argus_is_hemmed_in(core));
    }
}

// It creeps by its bumpers, so by those of the end that leads; without any it does not.
void test_a_robot_creeps_only_where_the_leading_end_has_bumpers(void) {
    for (int reversed = 0; reversed < 2; reversed++) {
        for (int ends = 0; ends < 4; ends++) {
            begin_in(3000, 3000);
            core->config.creep_mm_s = 50;
            core->reflexes.touched_unheard = true;
            core->knowledge.heard = 0;
            core->session.robot.front_bumpers = (ends & 1) != 0 ? 5 : 0;
            core->session.robot.rear_bumpers = (ends & 2) != 0 ? 5 : 0;
            const argus_robot_t *const both_ends = argus_robot_chosen(PEOPLEBOT);
            core->knowledge.robot = reversed != 0 ? argus_robot_other_end(both_ends) : both_ends;
            TEST_ASSERT_EQUAL(reversed != 0, core->knowledge.robot->reversed);
            const bool has = (ends & (reversed != 0 ? 2 : 1)) != 0;
            TEST_ASSERT_EQUAL(has, argus_guard(core).creeps);
        }
    }
}

void test_a_robot_that_sees_its_way_does_not_creep(void) {
    begin_in(3000, 3000);
    core->config.creep_mm_s = 50;
    core->session.robot.front_bumpers = 5;
    TEST_ASSERT_FALSE(argus_guard(core).creeps);
    core->reflexes.touched_unheard = true; // but echoes have been heard since
    TEST_ASSERT_FALSE(argus_guard(core).creeps);
}

// What does not turn when it is told to is not told again for ever.
void test_a_turn_home_that_failed_is_said_and_waited_for(void) {
    begin_in(3000, 3000);
    argus_intent_t intent = {0};
    core->motion.kind = ARGUS_MOTION_TURN;
    core->motion.failed = true;
    core->motion.target_cdeg = core->knowledge.pose.heading_cdeg + 4500;
    TEST_ASSERT_FALSE(argus_is_home(core, false, &intent));
    TEST_ASSERT_EQUAL(ARGUS_EV_TURN_FAILED, intent.event);
    TEST_ASSERT_EQUAL_INT32(45, intent.value);
    TEST_ASSERT_EQUAL(ARGUS_DO_WAIT, intent.act);
    TEST_ASSERT_EQUAL(ARGUS_WAIT_MOTORS, intent.why);
    core->orders.passive = true; // it turns for nobody
    TEST_ASSERT_TRUE(argus_is_home(core, false, &intent));
}

void test_hemmed_in_the_present_heading_is_home(void) {
    hem_in();
    argus_intent_t intent = {0};
    core->base.taken = true;
    core->base.cdeg = core->knowledge.pose.heading_cdeg + 9000;
    TEST_ASSERT_TRUE(argus_is_home(core, false, &intent));
    TEST_ASSERT_EQUAL(ARGUS_BASE_RENEW, intent.base);
}

// One echo is read once more; a bumper, a second time, or the profile of the paper lets nothing be read
// again.
void test_an_echo_is_read_again_once_and_not_at_a_bumper(void) {
    begin_in(3000, 3000);
    argus_guard_t guard = argus_guard(core);
    TEST_ASSERT_TRUE(argus_may_be_crosstalk(core, &guard));
    guard.bumpers = 8;
    TEST_ASSERT_FALSE(argus_may_be_crosstalk(core, &guard));
    guard.bumpers = 0;
    core->turning.again = true;
    TEST_ASSERT_FALSE(argus_may_be_crosstalk(core, &guard));
    core->turning.again = false;
    const argus_config_t paper = robot_config_of(ARGUS_PROFILE_PAPER);
    core->rules = argus_profile(&paper);
    guard = argus_guard(core);
    TEST_ASSERT_FALSE(argus_may_be_crosstalk(core, &guard));
}

// What bars a turn is told by the nearest echo, 0 where there is none.
void test_instead_of_a_turn_it_says_what_bars_it(void) {
    begin_in(330, 300);
    argus_intent_t intent = {0};
    core->turning.again = true;
    argus_instead_of_turn(core, &intent);
    TEST_ASSERT_EQUAL(ARGUS_EV_TURN_BLOCKED, intent.event);
    TEST_ASSERT_GREATER_THAN_INT32(0, intent.value);
    for (int i = 0; i < core->knowledge.sonars; i++) {
        put_health(&core->knowledge.sonar[i], ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
    }
    argus_echoes_init(&core->echoes);
    intent = (argus_intent_t){0};
    argus_instead_of_turn(core, &intent);
    TEST_ASSERT_EQUAL(ARGUS_EV_TURN_BLOCKED, intent.event);
    TEST_ASSERT_EQUAL_INT32(0, intent.value);
}

// One that creeps takes the way that it came, if nothing is pressed there; one that may command nothing,
// none.
void test_the_way_back_is_felt_where_it_creeps_and_asked_for_by_an_active_robot_only(void) {
    begin_in(3000, 3000);
    argus_guard_t guard = argus_guard(core);
    TEST_ASSERT_TRUE(argus_guard_may_back_off(&guard));
    guard.active = false;
    TEST_ASSERT_FALSE(argus_guard_may_back_off(&guard));
    put_health(&core->knowledge.sonar[12], ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
    guard = argus_guard(core);
    TEST_ASSERT_FALSE(argus_guard_may_back(&guard)); // not all that look back are left
    guard.creeps = true;
    TEST_ASSERT_TRUE(argus_guard_may_back(&guard));
    core->knowledge.bumpers_rear = 8;
    TEST_ASSERT_FALSE(argus_guard_may_back(&guard));
}

// Each policy is what is set, but the adaptive one where the rules know none.
void test_the_policy_is_what_is_set_as_far_as_the_rules_know_it(void) {
    begin_in(3000, 3000);
    argus_profile_t rules = *argus_rules(core);
    core->rules = &rules;
    for (int adapts = 0; adapts < 2; adapts++) {
        rules.adapts_plan = adapts != 0;
        core->config.policy = ARGUS_POLICY_PAPER;
        TEST_ASSERT_EQUAL(ARGUS_POLICY_PAPER, argus_policy(core));
        core->config.policy = ARGUS_POLICY_ADAPTIVE;
        TEST_ASSERT_EQUAL(adapts != 0 ? ARGUS_POLICY_ADAPTIVE : ARGUS_POLICY_PAPER, argus_policy(core));
    }
}
