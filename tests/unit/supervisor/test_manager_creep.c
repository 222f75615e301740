// SPDX-License-Identifier: MIT
// Rule under attack: with no sonar left the robot stops, says so and stands; it creeps on, told by its
// bumpers, only where the setting lets it, and never faster. Where no sonar ahead has heard an echo in the
// session it goes no faster than a step, and what it then touches shows that it is blind.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "behaviour/state.h"
#include "knowledge/body.h"
#include "robot.h"
#include "unity.h"

#define SONARS (ARGUS_SONARS < 16 ? ARGUS_SONARS : 16) // that its robot has, of those that a build manages
#define CREEP_MM_S 60
#define CONTACT_MM \
    700.0 // where the test has something that no sonar sees; the front leads on the first metre

static robot_t robot;
static char text[120];

// A CONFIGpac of zeros but for its three strings and its bumpers: 11 bytes of ceilings, an empty name, 14 of
// equipment, 33 of motion stand before these (SPEC.md, CONFIGpac).
static void fit_bumpers(uint8_t front, uint8_t rear) {
    static const char strings[] = "\x20"
                                  "Pioneer\0p3dx-sh\0SERIAL-1";
    static uint8_t config[sizeof strings + 11 + 1 + 14 + 33 + 2];
    memcpy(config, strings, sizeof strings);
    config[sizeof config - 2] = front;
    config[sizeof config - 1] = rear;
    robot.config = config;
    robot.config_count = sizeof config;
}

static void start(int32_t profile, int32_t creep_mm_s) {
    argus_config_t config = robot_config_of(profile);
    config.creep_mm_s = creep_mm_s;
    robot_init(&robot, &config, 0xFFFF8000u);
    robot.noise_mm = 5;
    fit_bumpers(5, 0);
    robot_box(&robot, -2500, -2500, 4900, 2500); // the rules of the paper take 5000 for a dead sonar
    robot.world = robot_world_segments;
}

static void lose(int first, int last, robot_fault_t how) {
    for (int i = first; i <= last; i++) {
        robot.fault[i] = how;
    }
}

// Under way with all sonars, and then with none.
static void lose_all_on_the_way(robot_fault_t how) {
    TEST_ASSERT_TRUE(robot_goal(&robot, 3800, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
    robot_run(&robot, 3000);
    lose(0, SONARS - 1, how);
}

static bool is_blind(void) {
    return robot.argus.mission == ARGUS_MISSION_FAILED || robot.argus.mode == ARGUS_MODE_CREEPING;
}

static bool until_blind(uint32_t ms) {
    for (uint32_t at = 0; at < ms && !is_blind(); at += 10) {
        robot_tick(&robot);
    }
    return is_blind();
}

// The bumper of the end that leads: it touches what stands on its way.
static void press(bool touches) {
    const bool rear = robot.argus.knowledge.robot->reversed;
    robot.bumpers_front = touches && !rear ? 1u << 3 : 0;
    robot.bumpers_rear = touches && rear ? 1u << 3 : 0;
}

// The greatest speed, forth or back, over some time; the touch at CONTACT_MM is the test's.
static double fastest(uint32_t ms, bool touches) {
    double most = 0;
    for (uint32_t at = 0; at < ms && robot.argus.mission == ARGUS_MISSION_RUNNING; at += 10) {
        robot_tick(&robot);
        press(touches && robot.x >= CONTACT_MM);
        most = fmax(most, fabs(robot.v));
    }
    return most;
}

static void finish(void) {
    TEST_ASSERT_EQUAL_STRING("", robot.violation);
    TEST_ASSERT_EQUAL(0, argus_invariants_broken(&robot.argus));
}

// ---- none left

void test_with_none_left_it_stops_says_so_and_stands(void) {
    static const robot_fault_t ways[] = {ROBOT_SILENT, ROBOT_OFF};
    for (size_t k = 0; k < sizeof ways / sizeof ways[0]; k++) {
        start(ARGUS_PROFILE_ARGUS, 0);
        lose_all_on_the_way(ways[k]);
        snprintf(text, sizeof text, "fault %d: mode %d", (int)ways[k], (int)robot.argus.mode);
        TEST_ASSERT_TRUE_MESSAGE(until_blind(30000), text);
        TEST_ASSERT_EQUAL(ARGUS_IS_CATASTROPHIC, robot.argus.events.state);
        TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_MISSION_FAILED, 0));
        robot_run(&robot, 2000);
        const double x = robot.x;
        const int from = robot.commands;
        robot_run(&robot, 60000);
        TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, from));
        TEST_ASSERT_TRUE(fabs(robot.x - x) < 1);
        TEST_ASSERT_EQUAL(ARGUS_MODE_WAITING, robot.argus.mode);
        TEST_ASSERT_EQUAL(ARGUS_WAIT_CATASTROPHIC, robot.argus.waiting.why);
        TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_CREEPING, 0));
        finish();
    }
}

void test_it_creeps_to_its_goal_where_it_may(void) {
    static const int32_t profiles[] = {ARGUS_PROFILE_PAPER, ARGUS_PROFILE_ARGUS};
    for (size_t k = 0; k < sizeof profiles / sizeof profiles[0]; k++) {
        start(profiles[k], CREEP_MM_S);
        lose_all_on_the_way(ROBOT_SILENT);
        TEST_ASSERT_TRUE(until_blind(30000));
        TEST_ASSERT_EQUAL(ARGUS_MODE_CREEPING, robot.argus.mode);
        TEST_ASSERT_EQUAL(CREEP_MM_S, robot_last_event(&robot, ARGUS_EV_CREEPING)->value);
        const double x = robot.x;
        const double most = fastest(120000, false);
        TEST_ASSERT_EQUAL(ARGUS_MISSION_REACHED, robot.argus.mission);
        TEST_ASSERT_TRUE(robot.x > x + 500);
        TEST_ASSERT_TRUE(most > CREEP_MM_S / 2 && most <= CREEP_MM_S + 1);
        finish();
    }
}

// Nor is a step's speed exceeded, whatever is allowed.
void test_a_slower_step_bounds_it(void) {
    argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    config.creep_mm_s = 100;
    config.step_speed_mm_s = 40;
    robot_init(&robot, &config, 0);
    const argus_guard_t guard = argus_guard(&robot.argus);
    TEST_ASSERT_EQUAL(40, argus_guard_unseen_mm_s(&guard));
}

void test_a_touch_stops_it_and_it_backs_off_and_goes_round(void) {
    start(ARGUS_PROFILE_ARGUS, CREEP_MM_S);
    TEST_ASSERT_TRUE(robot_goal(&robot, 3000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
    lose(0, SONARS - 1, ROBOT_SILENT);
    TEST_ASSERT_TRUE(until_blind(30000));
    TEST_ASSERT_TRUE(robot.x < CONTACT_MM - 50);
    double most = 0;
    for (int i = 0; i < 12000 && robot_count_events(&robot, ARGUS_EV_BUMPER, 0) == 0; i++) {
        most = fmax(most, fastest(10, true));
    }
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_BUMPER, 0));
    TEST_ASSERT_EQUAL(1, robot_count_commands(&robot, ARCOS_CMD_E_STOP, 0));
    most = fmax(most, fastest(8000, true));
    TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_BACKING, 0) > 0);
    TEST_ASSERT_TRUE(robot.x < CONTACT_MM - 60);
    const int turned_from = robot_count_events(&robot, ARGUS_EV_AVOIDING, 0);
    most = fmax(most, fastest(20000, true));
    TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_AVOIDING, 0) + turned_from > 0);
    TEST_ASSERT_TRUE(fabs(robot.y) > 50); // beside what it has touched, not at it again
    TEST_ASSERT_TRUE(most <= CREEP_MM_S + 1);
    finish();
}

// Neither ahead nor back while a bumper is pressed on that side.
void test_pressed_on_both_sides_it_stands(void) {
    start(ARGUS_PROFILE_ARGUS, CREEP_MM_S);
    lose_all_on_the_way(ROBOT_SILENT);
    TEST_ASSERT_TRUE(until_blind(30000));
    robot.bumpers_front = robot.bumpers_rear = 1u << 3;
    robot_run(&robot, 3000);
    const double x = robot.x;
    const int from = robot.commands;
    robot_run(&robot, 20000);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, from));
    TEST_ASSERT_TRUE(fabs(robot.x - x) < 1);
    TEST_ASSERT_EQUAL(ARGUS_WAIT_BUMPER, robot.argus.waiting.why);
    finish();
}

// What hears again is used again.
void test_a_sonar_that_does_well_again_ends_it(void) {
    start(ARGUS_PROFILE_ARGUS, CREEP_MM_S);
    lose_all_on_the_way(ROBOT_SILENT);
    TEST_ASSERT_TRUE(until_blind(30000));
    lose(0, SONARS - 1, ROBOT_OK);
    const double most = fastest(120000, false);
    TEST_ASSERT_EQUAL(ARGUS_MISSION_REACHED, robot.argus.mission);
    TEST_ASSERT_TRUE(most > 150);
    finish();
}

// ---- nothing was ever heard

static void start_unheard(int32_t creep_mm_s) {
    start(ARGUS_PROFILE_ARGUS, creep_mm_s);
    lose(0, SONARS - 1, ROBOT_OFF);
    TEST_ASSERT_TRUE(robot_goal(&robot, 4000, 0));
}

void test_it_is_slow_until_one_has_heard_an_echo(void) {
    start_unheard(0);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
    const double unheard = fastest(8000, false);
    TEST_ASSERT_TRUE(unheard > 50 && unheard <= robot.argus.config.step_speed_mm_s + 1);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_NO_ECHO, 0));
    lose(0, SONARS - 1, ROBOT_OK);
    TEST_ASSERT_TRUE(fastest(8000, false) > 300);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_NO_ECHO, 0));
    finish();
}

// One end after the other.
void test_what_it_touches_then_shows_that_it_is_blind(void) {
    start_unheard(0);
    fastest(60000, true);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_REVERSED, 0));
    TEST_ASSERT_EQUAL(2, robot_count_events(&robot, ARGUS_EV_BUMPER, 0));
    TEST_ASSERT_EQUAL(ARGUS_MODE_WAITING, robot.argus.mode);
    TEST_ASSERT_EQUAL(ARGUS_WAIT_BUMPER, robot.argus.waiting.why); // nothing is known of the way back either
    robot.bumpers_rear = 0;
    for (int i = 0; i < 3000 && robot.argus.waiting.why != ARGUS_WAIT_ECHO; i++) {
        robot_tick(&robot);
    }
    TEST_ASSERT_EQUAL(ARGUS_WAIT_ECHO, robot.argus.waiting.why);
    lose(0, SONARS - 1, ROBOT_OK); // somebody has mended them
    robot_run(&robot, 8000);
    TEST_ASSERT_EQUAL(ARGUS_WAIT_NONE, robot.argus.waiting.why);
    finish();
}

// A touch behind says nothing of those ahead.
void test_a_touch_behind_does_not_show_that(void) {
    start_unheard(0);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
    robot.bumpers_rear = 1u << 3;
    robot_run(&robot, 1000);
    robot.bumpers_rear = 0;
    const double x = robot.x;
    robot_run(&robot, 20000);
    TEST_ASSERT_NOT_EQUAL(ARGUS_WAIT_ECHO, robot.argus.waiting.why);
    TEST_ASSERT_TRUE(robot.x > x + 300);
    finish();
}

// One MOVE, and it is done.
void test_an_operators_step_ends(void) {
    start(ARGUS_PROFILE_ARGUS, CREEP_MM_S);
    lose_all_on_the_way(ROBOT_SILENT);
    TEST_ASSERT_TRUE(until_blind(30000));
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_STOP, 0);
    robot_run(&robot, 3000);
    const double x = robot.x;
    const int from = robot.commands;
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_MOVE, 100);
    robot_run(&robot, 20000);
    TEST_ASSERT_EQUAL(1, robot_count_commands(&robot, ARCOS_CMD_MOVE, from));
    TEST_ASSERT_TRUE(robot.x > x + 80 && robot.x < x + 130);
    TEST_ASSERT_EQUAL(ARGUS_MODE_IDLE, robot.argus.mode);
    finish();
}

// With no bumper on the end that leads there is nothing to creep by. The robot says what it has; until it has
// said so it has none.
void test_without_a_bumper_it_stands(void) {
    start_unheard(CREEP_MM_S);
    robot.argus.reflexes.touched_unheard = true;
    TEST_ASSERT_FALSE(argus_guard(&robot.argus).creeps);
    robot_run(&robot, 2000);
    robot.argus.reflexes.touched_unheard = true;
    TEST_ASSERT_EQUAL(5, robot.argus.session.robot.front_bumpers);
    TEST_ASSERT_TRUE(argus_guard(&robot.argus).creeps);
    argus_body_is(&robot.argus.knowledge, argus_robot_find("amigo-sh"), 0);
    TEST_ASSERT_FALSE(argus_guard(&robot.argus).creeps);
}

void test_a_robot_that_says_it_has_no_bumper_stands(void) {
    start(ARGUS_PROFILE_ARGUS, CREEP_MM_S);
    fit_bumpers(0, 5);
    lose_all_on_the_way(ROBOT_SILENT);
    TEST_ASSERT_TRUE(until_blind(30000));
    robot_run(&robot, 20000);
    TEST_ASSERT_EQUAL(ARGUS_WAIT_CATASTROPHIC, robot.argus.waiting.why);
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_CREEPING, 0));
    finish();
}

void test_with_leave_it_creeps_from_there(void) {
    start_unheard(CREEP_MM_S);
    TEST_ASSERT_TRUE(fastest(120000, true) <= CREEP_MM_S + 1);
    TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_BUMPER, 0) > 0);
    TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_CREEPING, 0) > 0);
    finish();
}

// The end that has been heard leads before anything moves.
void test_the_rear_leads_when_the_front_was_never_heard(void) {
    start(ARGUS_PROFILE_ARGUS, 0);
    lose(0, 7, ROBOT_OFF);
    TEST_ASSERT_TRUE(robot_goal(&robot, 3000, 0));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_REVERSED, 20000));
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, 0));
    TEST_ASSERT_EQUAL(1, robot_last_event(&robot, ARGUS_EV_REVERSED)->value);
    fastest(90000, false);
    TEST_ASSERT_EQUAL(ARGUS_MISSION_REACHED, robot.argus.mission);
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_NO_ECHO, 0));
    finish();
}

// Of two ends that hear nothing each looks where the other drives: after 1 m, then after 4 m each time.
void test_where_nothing_is_heard_the_rear_looks(void) {
    start_unheard(0);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_REVERSED, 30000));
    TEST_ASSERT_EQUAL(1, robot_last_event(&robot, ARGUS_EV_REVERSED)->value);
    TEST_ASSERT_TRUE(robot.x > 990 && robot.x < 1100);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_REVERSED, 30000));
    TEST_ASSERT_EQUAL(0, robot_last_event(&robot, ARGUS_EV_REVERSED)->value);
    TEST_ASSERT_TRUE(robot.x < 1100);
    fastest(90000, false);
    TEST_ASSERT_EQUAL(ARGUS_MISSION_REACHED, robot.argus.mission);
    TEST_ASSERT_EQUAL(2, robot_count_events(&robot, ARGUS_EV_REVERSED, 0));
    finish();
}

// The paper's rules call such a sonar dead, and know nothing of echoes.
void test_the_rules_of_the_paper_do_not_ask(void) {
    start(ARGUS_PROFILE_PAPER, 0);
    robot.argus.knowledge.heard = 0;
    const argus_guard_t guard = argus_guard(&robot.argus);
    TEST_ASSERT_TRUE(argus_guard_is_heard(&guard));
}
