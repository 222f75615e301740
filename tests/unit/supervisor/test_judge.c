// SPDX-License-Identifier: MIT
// Rule under attack (profile argus): what the evidence of a SIP makes of one sonar: a conviction ahead breaks
// the way off only where the rest does not carry it, a worse name yields to a better one, and probation ends
// by evidence alone.
#include "supervisor/judge.h"

#include "awareness/numbers.h"
#include "behaviour/reverse.h"
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
    robot_in_box(&robot, ARGUS_PROFILE_ARGUS, -3000, -3000, 3000, 3000);
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

// ---- what names and looks do

// Under rules that do not drive by what others have seen, each conviction ahead is checked at rest.
void test_a_conviction_breaks_off_by_each_of_its_reasons(void) {
    core->mode = ARGUS_MODE_DRIVING;
    argus_profile_t rules = *argus_rules(core);
    rules.drives_seen = 0;
    core->rules = &rules;
    score(AHEAD, ARGUS_TEST_STUCK, ARGUS_CEILING);
    judge(AHEAD);
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act);
    setUp();
    core->mode = ARGUS_MODE_DRIVING;
    for (int i = 1; i <= 3; i++) { // with the fourth most of the front is lost, and the rear is sound
        put_health(sonar(i), ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
    }
    score(4, ARGUS_TEST_STUCK, ARGUS_CEILING);
    judge(4);
    TEST_ASSERT_TRUE(argus_should_turn_about(core));
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act);
}

// With the rear ahead, a front that is whole again is to lead: that is decided at rest.
void test_a_sonar_that_makes_the_other_end_better_breaks_off(void) {
    for (int about = 0; about < 2; about++) {
        setUp();
        core->mode = ARGUS_MODE_DRIVING;
        if (about != 0) {
            core->knowledge.robot = argus_robot_other_end(core->knowledge.robot);
            core->plan = argus_plan(core->knowledge.robot, argus_policy(core), 0, 0);
        }
        put_health(sonar(AHEAD), ARGUS_PROBATION, ARGUS_KIND_WRONG, core->now_ms - 4000);
        core->evidence.of[AHEAD].agreed = 200;
        judge(AHEAD);
        TEST_ASSERT_EQUAL(ARGUS_HEALTHY, sonar(AHEAD)->health);
        TEST_ASSERT_EQUAL(about != 0 ? ARGUS_DO_CHECK : ARGUS_DO_NOTHING, intent.act);
    }
}

// Four seconds on probation, four agreements, twice as many after each relapse, up to four times doubled.
void test_probation_ends_by_time_and_agreements(void) {
    static const int wanted[] = {4, 8, 16, 32, 64, 64};
    for (int relapses = 0; relapses < 6; relapses++) {
        for (int less = 0; less < 2; less++) {
            for (int early = 0; early < 2; early++) {
                setUp();
                put_health(sonar(AHEAD), ARGUS_PROBATION, ARGUS_KIND_WRONG,
                           core->now_ms - 4000 + (uint32_t)early);
                sonar(AHEAD)->relapses = (uint8_t)relapses;
                core->evidence.of[AHEAD].agreed = (uint8_t)(wanted[relapses] - less);
                judge(AHEAD);
                TEST_ASSERT_EQUAL(less == 0 && early == 0 ? ARGUS_HEALTHY : ARGUS_PROBATION,
                                  sonar(AHEAD)->health);
            }
        }
    }
}

// One that is out goes on probation after as many as a first relapse takes, however often it was out.
void test_one_that_is_out_is_tried_after_four_agreements(void) {
    for (int less = 0; less < 2; less++) {
        setUp();
        put_health(sonar(AHEAD), ARGUS_DISABLED, ARGUS_KIND_WRONG, core->now_ms - 4000);
        sonar(AHEAD)->relapses = 3;
        core->evidence.of[AHEAD].agreed = (uint8_t)(4 - less);
        judge(AHEAD);
        TEST_ASSERT_EQUAL(less == 0 ? ARGUS_PROBATION : ARGUS_DISABLED, sonar(AHEAD)->health);
    }
}

// At the bound of the setting it is not silent yet, one more and it is.
void test_silence_is_longer_than_its_bound(void) {
    for (uint32_t more = 0; more < 2; more++) {
        setUp();
        core->firing = (argus_firing_t){0};
        sonar(BEHIND)->heard_ms = core->knowledge.sip_ms - (uint32_t)core->config.stale_ms - more;
        judge(BEHIND);
        TEST_ASSERT_EQUAL(more != 0 ? ARGUS_DISABLED : ARGUS_HEALTHY, sonar(BEHIND)->health);
    }
}

// A firing order that is older than a sonar may be silent excuses nobody.
void test_an_old_firing_order_passes_nobody_over(void) {
    const bool polled = (argus_robot_polled(core->knowledge.robot) >> BEHIND & 1u) != 0;
    for (uint32_t older = 0; older < 2; older++) {
        setUp();
        sonar(BEHIND)->heard_ms = core->knowledge.sip_ms - (uint32_t)core->config.stale_ms - 1;
        core->firing = (argus_firing_t){.ordered = true,
                                        .ordered_ms = core->now_ms - (uint32_t)core->config.stale_ms - older};
        judge(BEHIND);
        TEST_ASSERT_EQUAL(older == 0 && polled ? ARGUS_HEALTHY : ARGUS_DISABLED, sonar(BEHIND)->health);
    }
}

// A name takes a second of its own before it is said; then the sonar is a suspect with that name, and the
// second mission in a row that names it warns, once.
void test_a_name_is_said_once_it_stands(void) {
    for (int missions = 0; missions < 2; missions++) {
        setUp();
        sonar(AHEAD)->missions_named = (uint8_t)missions;
        score(AHEAD, ARGUS_TEST_GARBAGE, argus_bounds[ARGUS_TEST_GARBAGE].naming);
        const uint32_t began_ms = core->now_ms;
        judge(AHEAD);
        core->now_ms = began_ms + 999;
        judge(AHEAD);
        TEST_ASSERT_EQUAL(0, events(ARGUS_EV_SONAR_NAMED));
        core->now_ms = began_ms + 1000;
        judge(AHEAD);
        judge(AHEAD);
        TEST_ASSERT_EQUAL(ARGUS_SUSPECT, sonar(AHEAD)->health);
        TEST_ASSERT_EQUAL(ARGUS_KIND_GARBAGE, sonar(AHEAD)->kind);
        TEST_ASSERT_EQUAL(1, events(ARGUS_EV_SONAR_NAMED));
        TEST_ASSERT_EQUAL(missions, events(ARGUS_EV_SONAR_DEGRADING));
    }
}

// A suspicion goes with its evidence, but neither during the looks that are to judge it nor before the look
// that an operator has asked for.
void test_a_suspicion_goes_with_its_evidence(void) {
    for (int kept = 0; kept < 3; kept++) {
        setUp();
        put_health(sonar(AHEAD), ARGUS_SUSPECT, ARGUS_KIND_GARBAGE, core->now_ms);
        score(AHEAD, ARGUS_TEST_GARBAGE, 0);
        core->mode = kept == 1 ? ARGUS_MODE_VERIFYING : ARGUS_MODE_DRIVING;
        core->looks.asked = kept == 2;
        judge(AHEAD);
        TEST_ASSERT_EQUAL(kept == 0 ? ARGUS_HEALTHY : ARGUS_SUSPECT, sonar(AHEAD)->health);
    }
}

// Where the robot may not turn, no look can prove what is not certain: there it is out for what it is named
// for.
void test_hemmed_in_a_suspect_is_given_up_for_its_name(void) {
    for (int hemmed = 0; hemmed < 2; hemmed++) {
        setUp();
        if (hemmed != 0) {
            const argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
            robot_init(&robot, &config, 1000);
            robot.world = robot_world_segments;
            robot_box(&robot, -330, -300, 330, 300);
            robot_run(&robot, 5000);
            core->mission = ARGUS_MISSION_RUNNING;
            core->waiting.last = ARGUS_WAIT_TURN;
            core->waiting.since_ms = core->now_ms - 10000;
        }
        const argus_guard_t guard = argus_guard(core);
        int one = AHEAD;
        for (int i = 0; i < 8 && hemmed != 0; i++) {
            one = argus_guard_echo_blocks(&guard, i) ? i : one;
        }
        TEST_ASSERT_EQUAL(hemmed != 0, argus_guard_echo_blocks(&guard, one));
        put_health(sonar(one), ARGUS_SUSPECT, ARGUS_KIND_OFF, core->now_ms);
        TEST_ASSERT_EQUAL(hemmed != 0, argus_is_hemmed_in(core));
        score(one, ARGUS_TEST_PEERS, ARGUS_CEILING);
        judge(one);
        TEST_ASSERT_EQUAL(ARGUS_DISABLED, sonar(one)->health);
        TEST_ASSERT_EQUAL(hemmed != 0 ? ARGUS_KIND_OFF : ARGUS_KIND_WRONG, sonar(one)->kind);
    }
}
