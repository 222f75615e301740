// SPDX-License-Identifier: MIT
// Rule under attack: a health check concludes what its rules let it and no more: a suspicion under `passive`
// lasts as long as the disparity, a verdict without a witness leaves it open, looks clear those that were
// asked and prove only what others have seen, each time anew and in calm.
#include "supervisor/check.h"

#include "awareness/numbers.h"
#include "behaviour/state.h"
#include "health.h"
#include "robot.h"
#include "unity.h"

#define AHEAD 3
#define ABEAM 0
#define LOOKS 12 // more than any proof takes

static robot_t robot;
static argus_t *core;
static int said; // events

static void begin(int32_t profile) {
    robot_in_box(&robot, profile, -3000, -3000, 3000, 3000);
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

// ---- passive

void test_a_suspicion_that_nobody_verifies_lasts_as_long_as_the_disparity(void) {
    begin(ARGUS_PROFILE_PAPER);
    core->orders.passive = true;
    core->looks.check_ms = core->now_ms - (uint32_t)core->config.health_check_ms;
    put_health(sonar(AHEAD), ARGUS_SUSPECT, ARGUS_KIND_NONE, core->now_ms);
    put_health(sonar(9), ARGUS_SUSPECT, ARGUS_KIND_NONE, core->now_ms);
    TEST_ASSERT_EQUAL(0, core->algorithm1.of[AHEAD].in_a_row);
    argus_intent_t intent = {0};
    argus_check_beside(core, &intent);
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, sonar(AHEAD)->health);
    TEST_ASSERT_EQUAL(ARGUS_SUSPECT, sonar(9)->health); // none that the disparity is asked of
    TEST_ASSERT_EQUAL(1, events(ARGUS_EV_SUSPICION_DROPPED));
    TEST_ASSERT_EQUAL_INT32(0, robot_last_event(&robot, ARGUS_EV_SUSPICION_DROPPED)->value);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
}

void test_a_suspicion_that_is_still_disparate_stays(void) {
    begin(ARGUS_PROFILE_PAPER);
    robot.world = robot_world_far;
    core->orders.passive = true;
    robot.fault[AHEAD] = ROBOT_SCALE;
    robot.fault_value[AHEAD] = 50;
    robot_run(&robot, 10000);
    TEST_ASSERT_EQUAL(ARGUS_SUSPECT, sonar(AHEAD)->health);
    robot.fault[AHEAD] = ROBOT_OK;
    robot_run(&robot, 5000);
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, sonar(AHEAD)->health);
}

// ---- a verdict

void test_without_a_usable_witness_a_suspect_stays_one_and_is_not_asked_again_here(void) {
    begin(ARGUS_PROFILE_PAPER);
    put_health(sonar(AHEAD), ARGUS_SUSPECT, ARGUS_KIND_NONE, core->now_ms);
    TEST_ASSERT_EQUAL_HEX32(1u << AHEAD, argus_open_suspects(core));
    argus_verify_t *const verify = &core->verifying.verify;
    *verify = (argus_verify_t){
        .phase = ARGUS_VERIFY_DONE, .result = ARGUS_RESULT_UNPROVEN, .sonar = AHEAD, .reading_mm = 777};
    argus_apply_verdict(core);
    TEST_ASSERT_EQUAL(ARGUS_SUSPECT, sonar(AHEAD)->health);
    TEST_ASSERT_EQUAL_HEX32(0, argus_open_suspects(core));
    TEST_ASSERT_EQUAL(1, events(ARGUS_EV_SONAR_UNPROVEN));
    TEST_ASSERT_EQUAL_INT32(777, robot_last_event(&robot, ARGUS_EV_SONAR_UNPROVEN)->value);
    TEST_ASSERT_EQUAL(0, events(ARGUS_EV_SONAR_WITNESS));
}

// ---- looks

void test_looks_clear_those_that_were_asked(void) {
    begin(ARGUS_PROFILE_ARGUS);
    put_health(sonar(AHEAD), ARGUS_SUSPECT, ARGUS_KIND_WRONG, core->now_ms);
    core->verifying.inquiry.suspects = 1u << 4; // a healthy one, asked beside it
    argus_conclude_looks(core);
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, sonar(AHEAD)->health);
    TEST_ASSERT_EQUAL(1, events(ARGUS_EV_SONAR_CLEARED));
    TEST_ASSERT_EQUAL(AHEAD, robot_last_event(&robot, ARGUS_EV_SONAR_CLEARED)->sonar);
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, sonar(4)->health);
}

// The others go on to contradict it, look after look; named for `kind` before.
static bool is_given_up(int i, argus_fault_kind_t kind, argus_test_t test, bool busy) {
    begin(ARGUS_PROFILE_ARGUS);
    put_health(sonar(i), ARGUS_SUSPECT, kind, core->now_ms);
    core->evidence.of[i].score[test] = ARGUS_CEILING;
    core->evidence.of[i].against = 7u << 8;
    core->evidence.of[i].episodes = 1; // no conviction by itself
    core->evidence.busy = busy;
    for (int look = 0; look < LOOKS && !argus_is_out(&core->knowledge, i); look++) {
        core->algorithm1.verified = 0;
        argus_conclude_looks(core);
    }
    return argus_is_out(&core->knowledge, i);
}

void test_looks_prove_what_others_have_seen_and_nothing_else(void) {
    TEST_ASSERT_TRUE(is_given_up(AHEAD, ARGUS_KIND_WRONG, ARGUS_TEST_PEERS, false));
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, sonar(AHEAD)->kind);
    TEST_ASSERT_FALSE(is_given_up(ABEAM, ARGUS_KIND_WRONG, ARGUS_TEST_PEERS, false)); // no neighbours
    TEST_ASSERT_FALSE(is_given_up(AHEAD, ARGUS_KIND_WRONG, ARGUS_TEST_PEERS, true));  // people walk about
    TEST_ASSERT_FALSE(
        is_given_up(AHEAD, ARGUS_KIND_OFF, ARGUS_TEST_PEERS, false)); // another name than before
    TEST_ASSERT_FALSE(is_given_up(AHEAD, ARGUS_KIND_STUCK, ARGUS_TEST_STUCK, false)); // its own readings tell
    TEST_ASSERT_GREATER_THAN(0, events(ARGUS_EV_SONAR_UNPROVEN));
}

void test_looks_say_nothing_of_one_that_is_out(void) {
    begin(ARGUS_PROFILE_ARGUS);
    put_health(sonar(AHEAD), ARGUS_DISABLED, ARGUS_KIND_WRONG, core->now_ms);
    core->verifying.inquiry.suspects = 1u << AHEAD;
    argus_conclude_looks(core);
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, sonar(AHEAD)->health);
    TEST_ASSERT_EQUAL(0, events(ARGUS_EV_SONAR_CLEARED));
}

// By the rules of the paper a check is due so long after the last one, a concluded one included.
void test_a_check_that_is_concluded_is_the_last_one(void) {
    begin(ARGUS_PROFILE_PAPER);
    core->mode = ARGUS_MODE_CHECKING;
    core->looks.check_ms = core->now_ms - 100000;
    argus_intent_t intent = {0};
    argus_conclude_check(core, &intent);
    TEST_ASSERT_EQUAL_UINT32(core->now_ms, core->looks.check_ms);
}
