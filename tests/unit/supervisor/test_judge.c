// SPDX-License-Identifier: MIT
// Rule under attack (profile argus): what the evidence of a SIP makes of one sonar: a conviction ahead breaks
// the way off only where the rest does not carry it, a worse name yields to a better one, and probation ends
// by evidence alone.
#include "supervisor/judge.h"

#include "awareness/numbers.h"
#include "behaviour/state.h"
#include "health.h"
#include "robot.h"
#include "unity.h"

#define AHEAD 3
#define BEHIND 12

static robot_t robot;
static argus_t *core;
static argus_intent_t intent;
static int said; // events

void setUp(void) {
    const argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &config, 1000);
    robot.world = robot_world_segments;
    robot_box(&robot, -3000, -3000, 3000, 3000);
    robot_run(&robot, 6000);
    core = &robot.argus;
    robot_drain(&robot);
    said = robot.events;
}

static int events(int id) {
    robot_drain(&robot);
    return robot_count_events(&robot, id, said);
}

static argus_sonar_t *sonar(int i) {
    return &core->knowledge.sonar[i];
}

static void score(int i, argus_test_t test, int by) {
    argus_case_t *const c = &core->evidence.of[i];
    for (int k = 0; k < ARGUS_TESTS; k++) {
        c->score[k] = 0;
    }
    c->score[test] = (int16_t)by;
    c->against = 7u << 8;
    c->episodes = UINT8_MAX;
}

static void judge(int i) {
    intent = (argus_intent_t){0};
    argus_judge(core, i, &intent);
}

// ---- a conviction

void test_a_conviction_ahead_breaks_off_only_what_the_rest_does_not_carry(void) {
    core->mode = ARGUS_MODE_DRIVING;
    score(AHEAD, ARGUS_TEST_STUCK, ARGUS_CEILING);
    judge(AHEAD);
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, sonar(AHEAD)->health);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act); // the others see its bearing
    setUp();
    core->mode = ARGUS_MODE_DRIVING;
    for (int i = 0; i < core->knowledge.sonars; i++) { // it is the last
        if (i != AHEAD) {
            put_health(sonar(i), ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
        }
    }
    score(AHEAD, ARGUS_TEST_STUCK, ARGUS_CEILING);
    judge(AHEAD);
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act);
    TEST_ASSERT_EQUAL(ARGUS_STOP_HALT, intent.stop);
    setUp();
    core->mode = ARGUS_MODE_DRIVING;
    score(BEHIND, ARGUS_TEST_STUCK, ARGUS_CEILING);
    judge(BEHIND);
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, sonar(BEHIND)->health);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act); // it does not look ahead
}

void test_what_an_operator_pinned_is_not_judged(void) {
    core->orders.pinned = 1u << AHEAD;
    score(AHEAD, ARGUS_TEST_STUCK, ARGUS_CEILING);
    judge(AHEAD);
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, sonar(AHEAD)->health);
    core->orders.pinned = 0;
    judge(AHEAD);
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, sonar(AHEAD)->health);
}

// ---- one that is out

static argus_fault_kind_t renamed(argus_fault_kind_t known, argus_test_t test, int by) {
    setUp();
    put_health(sonar(AHEAD), ARGUS_DISABLED, known, core->now_ms);
    score(AHEAD, test, by);
    judge(AHEAD);
    return sonar(AHEAD)->kind;
}

// What is anywhere is contradicted too, so `wrong` says less than `garbage`; any other verdict says more.
void test_one_that_is_out_takes_the_name_that_says_more(void) {
    TEST_ASSERT_EQUAL(ARGUS_KIND_GARBAGE, renamed(ARGUS_KIND_GARBAGE, ARGUS_TEST_PEERS, ARGUS_CEILING));
    TEST_ASSERT_EQUAL(0, events(ARGUS_EV_SONAR_KIND));
    TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, renamed(ARGUS_KIND_GARBAGE, ARGUS_TEST_STUCK, ARGUS_CEILING));
    TEST_ASSERT_EQUAL(1, events(ARGUS_EV_SONAR_KIND));
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, renamed(ARGUS_KIND_OFF, ARGUS_TEST_PEERS, ARGUS_CEILING));
    TEST_ASSERT_EQUAL(ARGUS_KIND_OFF, renamed(ARGUS_KIND_OFF, ARGUS_TEST_PEERS, 0));
}

// What repeated one value and shows another one now was not stuck: there a name is enough.
void test_one_that_was_stuck_and_moves_takes_any_name(void) {
    const int naming = argus_bounds[ARGUS_TEST_GARBAGE].naming;
    TEST_ASSERT_EQUAL(ARGUS_KIND_GARBAGE, renamed(ARGUS_KIND_STUCK, ARGUS_TEST_GARBAGE, naming));
    TEST_ASSERT_EQUAL(ARGUS_KIND_OFF, renamed(ARGUS_KIND_OFF, ARGUS_TEST_GARBAGE, naming));
}

void test_on_probation_a_name_is_enough_to_go_out_again(void) {
    put_health(sonar(AHEAD), ARGUS_PROBATION, ARGUS_KIND_WRONG, core->now_ms);
    score(AHEAD, ARGUS_TEST_GARBAGE, argus_bounds[ARGUS_TEST_GARBAGE].naming);
    judge(AHEAD);
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, sonar(AHEAD)->health);
    TEST_ASSERT_EQUAL(ARGUS_KIND_GARBAGE, sonar(AHEAD)->kind);
    setUp(); // a suspicion without a name keeps it there
    put_health(sonar(AHEAD), ARGUS_PROBATION, ARGUS_KIND_WRONG, core->now_ms);
    score(AHEAD, ARGUS_TEST_GARBAGE, argus_bounds[ARGUS_TEST_GARBAGE].naming - 1);
    judge(AHEAD);
    TEST_ASSERT_EQUAL(ARGUS_PROBATION, sonar(AHEAD)->health);
}

// ---- silence

static argus_health_t silent(int i, bool ordered) {
    setUp();
    sonar(i)->heard_ms = core->knowledge.sip_ms - (uint32_t)core->config.stale_ms - 1;
    core->firing = (argus_firing_t){.ordered = ordered, .ordered_ms = core->now_ms};
    judge(i);
    return sonar(i)->health;
}

// A new order begins the round anew: what it passes over has not fallen silent. One ahead is the reflex's.
void test_one_that_yields_nothing_is_out_unless_its_turn_has_not_come(void) {
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, silent(BEHIND, false));
    TEST_ASSERT_EQUAL(ARGUS_KIND_SILENT, sonar(BEHIND)->kind);
    TEST_ASSERT_EQUAL((argus_robot_polled(core->knowledge.robot) >> BEHIND & 1u) != 0 ? ARGUS_HEALTHY
                                                                                      : ARGUS_DISABLED,
                      silent(BEHIND, true));
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, silent(AHEAD, false));
}

// An array that was never listed is none that failed.
void test_an_array_that_was_never_listed_is_missing(void) {
    core->knowledge.listed = 0xFF;
    core->firing = (argus_firing_t){0};
    sonar(BEHIND)->heard_ms = core->knowledge.sip_ms - (uint32_t)core->config.stale_ms - 1;
    judge(BEHIND);
    TEST_ASSERT_EQUAL(ARGUS_ABSENT, sonar(BEHIND)->health);
}
