// SPDX-License-Identifier: MIT
// Rule under attack (profile argus): a look must pay. None comes by the clock, for a doubt without a name, or
// for a name that others see for; one comes at once where none does, when the time lost has reached what a
// look costs and not before, and when an operator asks.
#include "behaviour/looks.h"

#include <stdio.h>

#include "adjustment/guard.h"
#include "awareness/numbers.h"
#include "behaviour/state.h"
#include "knowledge/config.h"
#include "robot.h"
#include "unity.h"

#define SONARS (ARGUS_SONARS < 16 ? ARGUS_SONARS : 16) // that its robot has, of those that a build manages

#define LOOK_COST_MS 9000.0 // DESIGN.md: what a look takes

static robot_t robot;
static char text[160];

static void start_in(double x1, double y1, double x2, double y2) {
    const argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &config, 0xFFFF8000u);
    robot.noise_mm = 5;
    robot_box(&robot, x1, y1, x2, y2);
    robot.world = robot_world_segments;
}

// A hall with a way so long that the robot comes to its highest speed.
static void start_in_a_hall(void) {
    start_in(-2500, -1500, 40000, 1500);
}

static void drive_off(void) {
    TEST_ASSERT_TRUE(robot_goal(&robot, 30000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
    robot_run(&robot, 4000);
}

static void finish(void) {
    TEST_ASSERT_EQUAL_STRING("", robot.violation);
}

// The score of one of its tests, held against what the next readings say; `over`: beyond what names it.
static void hold(unsigned sonars, int over) {
    for (int i = 0; i < SONARS; i++) {
        if ((sonars >> i & 1u) != 0) {
            robot.argus.evidence.of[i].score[ARGUS_TEST_DROPOUT] =
                (int16_t)(argus_bounds[ARGUS_TEST_DROPOUT].naming + over);
        }
    }
}

static bool is_named(int sonar) {
    return robot.argus.knowledge.sonar[sonar].kind != ARGUS_KIND_NONE;
}

static int looks(void) {
    return robot_count_events(&robot, ARGUS_EV_LOOK, 0) +
           robot_count_events(&robot, ARGUS_EV_SONAR_VERIFYING, 0);
}

static bool looking(void) {
    return robot.argus.mode == ARGUS_MODE_VERIFYING;
}

static bool are_named(unsigned sonars) {
    bool all = true;
    for (int k = 0; k < SONARS; k++) {
        all = all && ((sonars >> k & 1u) == 0 || is_named(k));
    }
    return all;
}

// SIPs until they are all named, at most six seconds.
static void name(unsigned sonars) {
    for (int i = 0; i < 60 && !are_named(sonars); i++) {
        hold(sonars, 60);
        robot_next_sip(&robot);
    }
    TEST_ASSERT_TRUE_MESSAGE(are_named(sonars), "not named within six seconds");
}

static double free_speed(void) {
    const argus_guard_t guard = argus_guard(&robot.argus);
    return argus_guard_free_speed_mm_s(&guard, argus_guard_seen_mm(&guard));
}

// ---- none

void test_no_look_by_the_clock(void) {
    start_in(-2500, -2300, 3300, 2500);
    for (int leg = 0; leg < 8; leg++) {
        TEST_ASSERT_TRUE(robot_goal(&robot, leg % 2 == 0 ? 1800 : -800, leg % 3 * 400 - 400));
        TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 40000));
    }
    TEST_ASSERT_EQUAL(0, looks());
    robot_run(&robot, 60000); // nor at rest
    TEST_ASSERT_EQUAL(0, looks());
    finish();
}

// Doubt without a name costs neither a look nor speed.
void test_doubt_without_a_name_costs_nothing(void) {
    start_in_a_hall();
    drive_off();
    for (int i = 0; i < 150; i++) {
        hold(1u << 2 | 1u << 3 | 1u << 4, -20);
        robot_next_sip(&robot);
        TEST_ASSERT_EQUAL(ARGUS_MODE_DRIVING, robot.argus.mode);
    }
    TEST_ASSERT_EQUAL(ARGUS_SUSPECT, robot.argus.knowledge.sonar[3].health);
    TEST_ASSERT_TRUE(robot.v > 400);
    TEST_ASSERT_EQUAL(0, robot.argus.looks.lost_ms);
    TEST_ASSERT_EQUAL(0, looks());
    finish();
}

// S5 by what the others have seen of the way, in the steps that the speed is asked in.
static int32_t speed_by_others(void) {
    const argus_t *argus = &robot.argus;
    const int32_t half_mm = argus_guard_straight_half_mm(argus->knowledge.robot);
    const int32_t seen_mm = argus_rays_seen_mm(&argus->rays, &argus->knowledge, half_mm, 1200);
    const int32_t range_mm = seen_mm < 250 ? 250 : seen_mm;
    const int32_t safe_mm_s = argus_config_speed_mm_s(&argus->config, argus->knowledge.robot, range_mm, 0);
    const int32_t asked_mm_s = safe_mm_s / 25 * 25;
    return asked_mm_s < argus->config.speed_mm_s ? argus->config.speed_mm_s : asked_mm_s;
}

// A name ahead beside one that is trusted stops nothing; what it has seen is not counted on.
void test_a_name_that_others_see_for_stops_nothing(void) {
    for (int sonar = 1; sonar <= 6; sonar++) {
        start_in_a_hall();
        drive_off();
        TEST_ASSERT_TRUE(robot.v > 400);
        const int from = robot.commands;
        name(1u << sonar);
        for (int i = 0; i < 20; i++) {
            hold(1u << sonar, 60);
            robot_next_sip(&robot);
            TEST_ASSERT_EQUAL(ARGUS_MODE_DRIVING, robot.argus.mode);
            TEST_ASSERT_TRUE(robot.speed_asked_mm_s <= speed_by_others());
        }
        TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_STOP, from));
        for (int i = 0; i < robot.argus.rays.count; i++) {
            const argus_ray_t *ray = &robot.argus.rays.at[i];
            TEST_ASSERT_TRUE(ray->sonar != sonar || ray->free_mm == 0);
        }
        TEST_ASSERT_EQUAL(0, looks());
        finish();
    }
}

// Both in the middle are doubted, so no sonar sees the way itself: no faster than a step.
void test_what_nobody_sees_is_driven_at_the_speed_of_a_step(void) {
    const unsigned two = 3u << 3;
    start_in_a_hall();
    drive_off();
    name(two);
    int slow = 0;
    for (int i = 0; i < 60 && !looking(); i++) {
        hold(two, 60);
        robot_next_sip(&robot);
        const int32_t half_mm = argus_guard_straight_half_mm(robot.argus.knowledge.robot);
        const int32_t seen_mm = argus_rays_seen_mm(&robot.argus.rays, &robot.argus.knowledge, half_mm, 1200);
        if (robot.argus.mode == ARGUS_MODE_DRIVING && seen_mm < 300) {
            TEST_ASSERT_TRUE(robot.speed_asked_mm_s <= robot.argus.config.step_speed_mm_s);
            slow++;
        }
    }
    TEST_ASSERT_TRUE(slow > 20);
    finish();
}

// One behind, or a wall close beside, costs no time that a look could save.
void test_what_a_look_would_not_save_is_not_counted(void) {
    start_in_a_hall();
    drive_off();
    name(1u << 12);
    robot.fault[0] = ROBOT_VALUE; // a wall on the left, within what slows down
    robot.fault_value[0] = 300;
    for (int i = 0; i < 200; i++) {
        hold(1u << 12, 60);
        robot_next_sip(&robot);
        TEST_ASSERT_EQUAL(0, robot.argus.looks.lost_ms);
    }
    TEST_ASSERT_EQUAL(0, looks());
    finish();
}

// ---- at once

void test_a_name_that_nobody_sees_for_is_looked_at_at_once(void) {
    for (int sonar = 1; sonar <= 4; sonar++) {
        const unsigned three = 7u << sonar;
        start_in_a_hall();
        drive_off();
        name(three);
        TEST_ASSERT_TRUE_MESSAGE(looking(), "three names in a row, and no look");
        TEST_ASSERT_TRUE(robot.argus.looks.lost_ms < LOOK_COST_MS);
        robot_run(&robot, 40000);
        finish();
    }
}

// ... but not again within the distance in which it was cleared.
void test_what_was_cleared_here_is_not_looked_at_again(void) {
    start_in_a_hall();
    drive_off();
    uint32_t before = 0;
    for (int i = 0; i < 60 && !are_named(7u << 2); i++) {
        for (int k = 0; k < SONARS; k++) {
            robot.argus.looks.hold[k].cleared = 1;
            robot.argus.looks.hold[k].odometer_mm = before = robot.argus.knowledge.odometer_mm;
        }
        hold(7u << 2, 60);
        robot_next_sip(&robot);
    }
    TEST_ASSERT_TRUE(are_named(7u << 2) && !looking());
    while (!looking() && robot.argus.knowledge.odometer_mm - before < 1000) {
        hold(7u << 2, 60);
        robot_next_sip(&robot);
    }
    const uint32_t way_mm = robot.argus.knowledge.odometer_mm - before;
    snprintf(text, sizeof text, "looked at again after %u mm", (unsigned)way_mm);
    TEST_ASSERT_TRUE_MESSAGE(way_mm >= 400 && way_mm <= 460, text);
    finish();
}

void test_a_retest_brings_a_look(void) {
    for (int sonar = 0; sonar < SONARS; sonar += 3) {
        start_in_a_hall();
        drive_off();
        TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_RETEST, sonar));
        robot_drain(&robot);
        TEST_ASSERT_EQUAL(ARGUS_SUSPECT, robot.argus.knowledge.sonar[sonar].health);
        TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_VERIFYING, 8000));
        TEST_ASSERT_EQUAL(sonar, robot_last_event(&robot, ARGUS_EV_SONAR_VERIFYING)->sonar);
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 40000));
        TEST_ASSERT_FALSE(robot.argus.looks.asked);
        TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_SONAR_VERIFYING, 0));
        finish();
    }
}

// ---- to hire or to buy

// Drives with two names side by side, the way between them unseen, until a look comes; what that has cost by
// this count, in ms.
static double lost_until_look(unsigned two) {
    double lost_ms = 0;
    for (int i = 0; i < 1200 && !looking(); i++) {
        hold(two, 60);
        robot_next_sip(&robot);
        const argus_guard_t guard = argus_guard(&robot.argus);
        const bool open = argus_named(&robot.argus.knowledge) != 0 && robot.argus.mode == ARGUS_MODE_DRIVING;
        lost_ms += open ? 100.0 *
                              (free_speed() - argus_guard_speed_mm_s(&guard, argus_guard_seen_mm(&guard))) /
                              free_speed()
                        : 0;
        TEST_ASSERT_TRUE(looking() || robot.argus.looks.lost_ms < LOOK_COST_MS);
    }
    return lost_ms;
}

void test_a_look_comes_when_the_time_lost_is_what_it_costs(void) {
    for (int sonar = 2; sonar <= 4; sonar++) {
        start_in_a_hall();
        drive_off();
        const double lost_ms = lost_until_look(3u << sonar);
        TEST_ASSERT_TRUE(looking());
        snprintf(text, sizeof text, "sonar %d: %.0f ms lost", sonar, lost_ms);
        TEST_ASSERT_TRUE_MESSAGE(lost_ms >= LOOK_COST_MS - 300 && lost_ms <= LOOK_COST_MS + 300, text);
        robot_run(&robot, 20000);
        finish();
    }
}

// What was lost before a look, or before the doubt went, does not count for the next.
void test_the_loss_begins_anew(void) {
    const unsigned two = 3u << 3;
    start_in_a_hall();
    drive_off();
    name(two);
    for (int i = 0; i < 40; i++) {
        hold(two, 60);
        robot_next_sip(&robot);
    }
    TEST_ASSERT_TRUE(robot.argus.looks.lost_ms > 1000);
    for (int i = 0; i < 30; i++) { // they do well again
        hold(two, -argus_bounds[ARGUS_TEST_DROPOUT].naming);
        robot_next_sip(&robot);
    }
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, robot.argus.knowledge.sonar[3].health);
    TEST_ASSERT_EQUAL(0, robot.argus.looks.lost_ms);
    lost_until_look(two);
    TEST_ASSERT_TRUE(looking());
    hold(two, -argus_bounds[ARGUS_TEST_DROPOUT].naming);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 60000));
    TEST_ASSERT_EQUAL(0, robot.argus.looks.lost_ms);
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, robot.argus.knowledge.sonar[3].health);
    finish();
}

// A suspect that is not looked at does not keep a robot that must sweep from its step.
void test_a_name_behind_does_not_hold_up_a_sweep(void) {
    start_in(-2500, -2300, 3300, 2500);
    robot.fault[2] = robot.fault[3] = robot.fault[4] = ROBOT_SILENT;
    TEST_ASSERT_TRUE(robot_goal(&robot, 900, 0));
    for (int i = 0; i < 900 && robot.argus.mission == ARGUS_MISSION_RUNNING; i++) {
        hold(1u << 12, 60);
        robot_next_sip(&robot);
    }
    TEST_ASSERT_EQUAL_MESSAGE(ARGUS_MISSION_REACHED, robot.argus.mission, "the way is not gone");
    finish();
}

// ---- names

// Two others contradict it; `late`: its readings are better explained as late ones.
static argus_fault_kind_t kind_after(int sonar, bool late, int sips) {
    argus_case_t *c = &robot.argus.evidence.of[sonar];
    for (int i = 0; i < sips; i++) {
        c->against = (argus_mask_t)(1u << 2 | 1u << 5);
        c->score[ARGUS_TEST_PEERS] = (int16_t)(argus_bounds[ARGUS_TEST_PEERS].naming + 60);
        c->hypothesis[0].over_healthy = late ? ARGUS_LATE_NAMING + 60 : 0;
        c->hypothesis[0].over_other = late ? ARGUS_LATE_LEAD + 60 : 0;
        robot_next_sip(&robot);
    }
    return (argus_fault_kind_t)robot.argus.knowledge.sonar[sonar].kind;
}

// Half the truth looks late in one turn and wrong in the next: looks that each leave it another name would
// prove nothing for ever. A law that was given up is not said again until the sonar is cleared.
void test_a_law_that_was_given_up_is_not_said_again(void) {
    start_in_a_hall();
    drive_off();
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, kind_after(3, false, 15));
    TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_SLOW, kind_after(3, true, 15), "first wrong, then late: it is late");
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, kind_after(3, false, 15));
    TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_WRONG, kind_after(3, true, 15), "no law holds");
    const argus_t *const argus = &robot.argus;
    const argus_finding_t finding = argus_finding(&argus->evidence, &argus->extremes, &argus->common, 3);
    TEST_ASSERT_EQUAL(ARGUS_KIND_SLOW, finding.named);
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, argus_named_kind(argus, 3, &finding));
    argus_evidence_forget(&robot.argus.evidence, 3);
    robot_run(&robot, 1000);
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, robot.argus.knowledge.sonar[3].health);
    TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_SLOW, kind_after(3, true, 15), "cleared since then");
    finish();
}

// ---- at the goal

static int looks_at_the_goal(int sonar) {
    start_in(-2500, -1500, 3000, 1500);
    TEST_ASSERT_TRUE(robot_goal(&robot, 1200, 0));
    for (int i = 0; i < 3000 && robot.argus.mission == ARGUS_MISSION_RUNNING; i++) {
        hold(1u << sonar, 60);
        robot_next_sip(&robot);
    }
    TEST_ASSERT_EQUAL(ARGUS_MISSION_REACHED, robot.argus.mission);
    return robot_count_events(&robot, ARGUS_EV_SONAR_VERIFYING, 0);
}

// The looks at a goal where sonar 0 hears something within the swing circle as a turn is asked for: once, or
// from then on.
static int looks_beside(bool stays) {
    bool asked = false;
    start_in(-2500, -1500, 3000, 1500);
    TEST_ASSERT_TRUE(robot_goal(&robot, 1200, 0));
    for (int i = 0; i < 600 && robot.argus.mission == ARGUS_MISSION_RUNNING; i++) {
        const bool there = robot.argus.travel.arriving;
        hold(1u << 3, 60);
        asked = asked || (there && robot.argus.mode == ARGUS_MODE_CHECKING);
        robot.fault[0] = stays && (there || asked) ? ROBOT_VALUE : ROBOT_OK;
        robot.fault_value[0] = 100;
        robot_next_sip(&robot);
        asked = asked || (there && robot.argus.mode == ARGUS_MODE_CHECKING);
        if (robot.argus.travel.arriving && !asked) {
            robot.argus.knowledge.sonar[0].reading_mm = 100;
        }
    }
    TEST_ASSERT_TRUE(asked);
    TEST_ASSERT_EQUAL_MESSAGE(ARGUS_MISSION_REACHED, robot.argus.mission, "it waits no longer than that");
    finish();
    return robot_count_events(&robot, ARGUS_EV_SONAR_VERIFYING, 0);
}

void test_at_the_goal_a_single_echo_does_not_cost_the_looks(void) {
    TEST_ASSERT_TRUE(looks_beside(false) > 2);
}

void test_at_a_goal_without_room_to_turn_the_looks_are_done_without(void) {
    TEST_ASSERT_TRUE(looks_beside(true) < 2);
}

// Looks prove nothing of one behind, so a third one is for nothing.
void test_what_looks_cannot_prove_is_looked_at_twice(void) {
    TEST_ASSERT_EQUAL(2, looks_at_the_goal(12));
    TEST_ASSERT_TRUE(looks_at_the_goal(3) > 2);
    finish();
}

// An operator's stop holds looks, too, whatever they would show.
void test_no_look_is_due_while_an_operator_has_stopped_the_robot(void) {
    start_in(-3000, -3000, 3000, 3000);
    robot_run(&robot, 6000);
    argus_t *const core = &robot.argus;
    core->looks.asked = true;
    TEST_ASSERT_TRUE(argus_look_pays(core));
    core->orders.stay = ARGUS_STAY_OPERATOR;
    TEST_ASSERT_FALSE(argus_look_pays(core));
    core->orders.stay = 0;
    core->knowledge.heard = 1u << 7; // abeam
    TEST_ASSERT_NOT_EQUAL(0, argus_to_try(core));
    core->orders.stay = ARGUS_STAY_OPERATOR;
    TEST_ASSERT_EQUAL(0, argus_to_try(core));
}
