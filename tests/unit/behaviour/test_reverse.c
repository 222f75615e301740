// SPDX-License-Identifier: MIT
// Rule under attack: the rear leads only where that is better and safe: the front has lost most and the rear
// has not, it was not done a moment ago, and the robot goes back to its front once that has lost nothing.
#include "behaviour/reverse.h"

#include "behaviour/state.h"
#include "health.h"
#include "robot.h"
#include "unity.h"

static robot_t robot;
static argus_t *core;

void setUp(void) {
    robot_in_box(&robot, ARGUS_PROFILE_ARGUS, -3000, -3000, 3000, 3000);
    robot_run(&robot, 6000);
    core = &robot.argus;
    TEST_ASSERT_FALSE(argus_should_turn_about(core));
}

static void lose(int from, int count) {
    for (int i = from; i < from + count; i++) {
        put_health(&core->knowledge.sonar[i], ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
    }
}

void test_it_turns_about_with_most_of_the_front_lost_and_the_rear_sound(void) {
    lose(1, 3);
    TEST_ASSERT_FALSE(argus_should_turn_about(core));
    lose(4, 1);
    TEST_ASSERT_TRUE(argus_should_turn_about(core));
    lose(9, 1);
    TEST_ASSERT_TRUE(argus_should_turn_about(core));
    lose(10, 1);
    TEST_ASSERT_FALSE(argus_should_turn_about(core));
}

void test_it_turns_about_for_nobody_else_and_by_its_rules_only(void) {
    lose(1, 4);
    core->orders.passive = true;
    TEST_ASSERT_FALSE(argus_should_turn_about(core));
    core->orders.passive = false;
    core->travel.jog_mm = 100;
    TEST_ASSERT_FALSE(argus_should_turn_about(core));
    core->travel.jog_mm = 0;
    const argus_config_t paper = robot_config_of(ARGUS_PROFILE_PAPER);
    core->rules = argus_profile(&paper);
    TEST_ASSERT_FALSE(argus_should_turn_about(core));
}

void test_it_does_not_turn_about_again_at_once(void) {
    lose(1, 4);
    core->reverse.done = true;
    core->reverse.odometer_mm = core->knowledge.odometer_mm - 1999;
    TEST_ASSERT_FALSE(argus_should_turn_about(core));
    core->reverse.odometer_mm = core->knowledge.odometer_mm - 2000;
    TEST_ASSERT_TRUE(argus_should_turn_about(core));
}

void test_an_end_that_is_not_safe_with_these_settings_does_not_lead(void) {
    lose(1, 4);
    core->config.speed_mm_s = 750;
    TEST_ASSERT_FALSE(argus_should_turn_about(core));
}

void test_with_the_rear_ahead_a_front_that_lost_nothing_leads_again(void) {
    core->knowledge.robot = argus_robot_other_end(core->knowledge.robot);
    TEST_ASSERT_TRUE(core->knowledge.robot->reversed);
    core->plan = argus_plan(core->knowledge.robot, argus_policy(core), 0, 0);
    TEST_ASSERT_TRUE(argus_should_turn_about(core));
    lose(3, 1);
    TEST_ASSERT_FALSE(argus_should_turn_about(core));
}

// The rear leads, has not set off, and hears nothing ahead while the front lives.
static void begin_hand_back(void) {
    setUp();
    core->knowledge.robot = argus_robot_other_end(core->knowledge.robot);
    core->reverse.odometer_mm = core->knowledge.odometer_mm;
    core->config.speed_mm_s = core->config.step_speed_mm_s;
    TEST_ASSERT_TRUE(argus_should_hand_back(core));
}

static void hear_nothing(unsigned sonars) {
    for (int i = 0; i < core->knowledge.sonars; i++) {
        if ((sonars >> i & 1u) != 0) {
            core->knowledge.sonar[i].reading_mm = core->knowledge.robot->no_echo_mm;
        }
    }
}

// Each reason alone keeps the rear ahead.
void test_the_front_is_handed_back_to_before_the_rear_sets_off(void) {
    begin_hand_back();
    core->reverse.odometer_mm = core->knowledge.odometer_mm - 50;
    TEST_ASSERT_TRUE(argus_should_hand_back(core));
    core->reverse.odometer_mm = core->knowledge.odometer_mm - 51;
    TEST_ASSERT_FALSE(argus_should_hand_back(core));
    begin_hand_back();
    core->knowledge.robot = argus_robot_other_end(core->knowledge.robot);
    TEST_ASSERT_FALSE(argus_should_hand_back(core)); // the front leads
    begin_hand_back();
    lose(3, 1);
    TEST_ASSERT_TRUE(argus_should_hand_back(core));
    lose(4, 1);
    TEST_ASSERT_FALSE(argus_should_hand_back(core));
    begin_hand_back();
    const argus_config_t paper = robot_config_of(ARGUS_PROFILE_PAPER);
    core->rules = argus_profile(&paper);
    TEST_ASSERT_FALSE(argus_should_hand_back(core));
    begin_hand_back();
    core->config.step_mm = 2000; // no longer safe for the front
    TEST_ASSERT_FALSE(argus_should_hand_back(core));
}

// It lives by an echo since the rear leads; where the rear hears nothing either, it leads all the same.
void test_a_front_without_an_echo_is_handed_back_to_where_the_rear_has_none(void) {
    begin_hand_back();
    const unsigned front = argus_robot_polled(argus_robot_other_end(core->knowledge.robot));
    core->knowledge.heard &= (argus_mask_t)~front;
    TEST_ASSERT_FALSE(argus_should_hand_back(core)); // the rear hears
    hear_nothing(0xFF00u);
    TEST_ASSERT_TRUE(argus_should_hand_back(core));
    core->knowledge.sonar[12].reading_mm = 1000; // one that looks ahead is enough
    TEST_ASSERT_FALSE(argus_should_hand_back(core));
    core->knowledge.heard |= (argus_mask_t)front;
    TEST_ASSERT_TRUE(argus_should_hand_back(core));
}

// An end that has heard nothing for as long as it would lead has lost all: heard once is not for ever.
void test_an_end_that_was_heard_long_ago_is_not_better(void) {
    lose(1, 4);
    TEST_ASSERT_TRUE(argus_should_turn_about(core));
    core->knowledge.odometer_mm += ARGUS_LEAD_MM - 1;
    for (int i = 0; i < 8; i++) {
        core->knowledge.sonar[i].echo_mm = core->knowledge.odometer_mm;
    }
    core->reverse.odometer_mm = core->knowledge.odometer_mm - 2000;
    TEST_ASSERT_TRUE(argus_should_turn_about(core));
    core->knowledge.odometer_mm += 1;
    TEST_ASSERT_FALSE(argus_should_turn_about(core));
}
