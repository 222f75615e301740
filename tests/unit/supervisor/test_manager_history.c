// SPDX-License-Identifier: MIT
// Rule under attack: what one mission learnt of a sonar holds in the next, of this robot only, until evidence
// says otherwise; an operator can look at one sonar again, pin it or take it out, and nothing else.
#include "analysis/record.h"
#include "supervisor/manager.h"

#include <string.h>

#include "awareness/numbers.h"
#include "health.h"
#include "robot.h"
#include "unity.h"

#define SONARS (ARGUS_SONARS < 16 ? ARGUS_SONARS : 16) // that its robot has, of those that a build manages

static robot_t robot;
static uint8_t record[ARGUS_RECORD_BYTES];

static void start(int32_t profile) {
    const argus_config_t config = robot_config_of(profile);
    robot_init(&robot, &config, 4711);
    robot_box(&robot, -1500, -1500, 2500, 1500);
    robot.world = robot_world_segments;
}

static void start_idle(void) {
    start(ARGUS_PROFILE_ARGUS);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
}

static void finish(void) {
    robot_drain(&robot);
    TEST_ASSERT_EQUAL_STRING("", robot.violation);
    TEST_ASSERT_EQUAL(0, argus_invariants_broken(&robot.argus));
}

static uint32_t now(void) {
    return robot.start_ms + robot.t_ms;
}

static argus_sonar_t *sonar(int number) {
    return &robot.argus.knowledge.sonar[number];
}

static void ask(argus_op_t op, int32_t argument) {
    argus_operator(&robot.argus, now(), op, argument);
    robot_drain(&robot);
}

// The record of a mission in which 3 was disabled and 9 was on probation.
static void save_one(void) {
    start_idle();
    put_health(sonar(3), ARGUS_DISABLED, ARGUS_KIND_OFF, now());
    put_health(sonar(9), ARGUS_PROBATION, ARGUS_KIND_WRONG, now());
    TEST_ASSERT_EQUAL(ARGUS_RECORD_BYTES, argus_record_save(&robot.argus, record, sizeof record));
}

void test_what_was_out_starts_on_probation(void) {
    save_one();
    start(ARGUS_PROFILE_ARGUS);
    TEST_ASSERT_TRUE(argus_record_load(&robot.argus, record, sizeof record));
    TEST_ASSERT_EQUAL(ARGUS_PROBATION, sonar(3)->health);
    TEST_ASSERT_EQUAL(ARGUS_KIND_OFF, sonar(3)->kind);
    TEST_ASSERT_EQUAL(ARGUS_PROBATION, sonar(9)->health);
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, sonar(9)->kind);
    TEST_ASSERT_EQUAL_HEX16(1u << 3, robot.argus.plan.disabled); // its bearing is covered by rotations
    TEST_ASSERT_EQUAL(0, argus_invariants_broken(&robot.argus));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    TEST_ASSERT_EQUAL(2, robot_count_events(&robot, ARGUS_EV_SONAR_PROBATION, 0));
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_RECORD_IGNORED, 0));
    TEST_ASSERT_EQUAL(ARGUS_PROBATION, sonar(3)->health);
    TEST_ASSERT_EQUAL(0, sonar(3)->disabled_times);
    TEST_ASSERT_EQUAL(1, sonar(3)->disabled_before);
    finish();
}

void test_what_was_repaired_comes_back_and_what_was_not_does_not(void) {
    for (int dead = 0; dead < 2; dead++) {
        save_one();
        start(ARGUS_PROFILE_ARGUS);
        robot.fault[3] = dead != 0 ? ROBOT_OFF : ROBOT_OK;
        TEST_ASSERT_TRUE(argus_record_load(&robot.argus, record, sizeof record));
        for (int leg = 0; leg < 12 && sonar(3)->health != ARGUS_HEALTHY; leg++) {
            TEST_ASSERT_TRUE(robot_goal(&robot, leg % 2 == 0 ? 900 : 0, leg % 3 * 300));
            robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 30000);
        }
        TEST_ASSERT_EQUAL(dead == 0, sonar(3)->health == ARGUS_HEALTHY);
        TEST_ASSERT_EQUAL(dead != 0, argus_is_out(&robot.argus.knowledge, 3));
        finish();
    }
}

void test_a_relapse_makes_probation_longer(void) {
    save_one();
    start(ARGUS_PROFILE_ARGUS);
    TEST_ASSERT_TRUE(argus_record_load(&robot.argus, record, sizeof record));
    put_health(sonar(3), ARGUS_DISABLED, ARGUS_KIND_OFF, now());
    TEST_ASSERT_EQUAL(1, sonar(3)->relapses);
    put_health(sonar(5), ARGUS_DISABLED, ARGUS_KIND_OFF, now());
    TEST_ASSERT_EQUAL(0, sonar(5)->relapses);
    put_health(sonar(5), ARGUS_PROBATION, ARGUS_KIND_OFF, now());
    put_health(sonar(5), ARGUS_DISABLED, ARGUS_KIND_OFF, now());
    TEST_ASSERT_EQUAL(1, sonar(5)->relapses);
}

void test_under_paper_it_is_history_only(void) {
    save_one();
    start(ARGUS_PROFILE_PAPER);
    TEST_ASSERT_TRUE(argus_record_load(&robot.argus, record, sizeof record));
    TEST_ASSERT_EQUAL(ARGUS_UNKNOWN, sonar(3)->health);
    TEST_ASSERT_EQUAL(ARGUS_KIND_OFF, sonar(3)->kind_before);
    TEST_ASSERT_EQUAL_HEX16(0, robot.argus.plan.disabled);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, sonar(3)->health);
    finish();
}

void test_the_record_of_another_robot_is_said_and_taken_back(void) {
    save_one();
    record[6] ^= 1; // its identity
    unsigned crc = 0xFFFFu;
    for (size_t i = 0; i < sizeof record - 2; i++) {
        crc ^= (unsigned)record[i] << 8;
        for (int bit = 0; bit < 8; bit++) {
            crc = (crc & 0x8000u) != 0 ? (crc << 1 ^ 0x1021u) & 0xFFFFu : crc << 1 & 0xFFFFu;
        }
    }
    record[sizeof record - 2] = (uint8_t)(crc & 0xFFu);
    record[sizeof record - 1] = (uint8_t)(crc >> 8);
    start(ARGUS_PROFILE_ARGUS);
    TEST_ASSERT_TRUE(argus_record_load(&robot.argus, record, sizeof record));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_RECORD_IGNORED, 0));
    TEST_ASSERT_EQUAL(ARGUS_RECORD_OTHER_ROBOT, robot_last_event(&robot, ARGUS_EV_RECORD_IGNORED)->value);
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, sonar(3)->health);
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, sonar(9)->health);
    TEST_ASSERT_EQUAL(0, sonar(3)->disabled_before);
    TEST_ASSERT_EQUAL_HEX16(0, robot.argus.plan.disabled);
    finish();
}

void test_a_damaged_record_is_said_and_changes_nothing(void) {
    save_one();
    record[100] ^= 4;
    start(ARGUS_PROFILE_ARGUS);
    TEST_ASSERT_FALSE(argus_record_load(&robot.argus, record, sizeof record));
    robot_drain(&robot);
    TEST_ASSERT_EQUAL(ARGUS_RECORD_DAMAGED, robot_last_event(&robot, ARGUS_EV_RECORD_IGNORED)->value);
    TEST_ASSERT_EQUAL_HEX16(0, argus_out(&robot.argus.knowledge));
}

void test_retest_of_one_in_use_makes_it_a_suspect_and_looks(void) {
    start_idle();
    robot.argus.evidence.of[4].score[ARGUS_TEST_PEERS] = 250;
    const int from = robot.events;
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, now(), ARGUS_OP_RETEST, 4));
    robot_drain(&robot);
    TEST_ASSERT_EQUAL(ARGUS_SUSPECT, sonar(4)->health);
    TEST_ASSERT_EQUAL(0, robot.argus.evidence.of[4].score[ARGUS_TEST_PEERS]);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_VERIFYING, 8000));
    TEST_ASSERT_EQUAL(4, robot_last_event(&robot, ARGUS_EV_SONAR_VERIFYING)->sonar);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 60000));
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, sonar(4)->health);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_OPERATOR, from));
    finish();
}

// Whatever an operator hopes: one that is out comes back on evidence only.
void test_retest_of_one_that_is_out_begins_its_probation_anew(void) {
    start_idle();
    ask(ARGUS_OP_DISABLE, 4);
    ask(ARGUS_OP_UNPIN, 4);
    sonar(4)->relapses = 3;
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, now(), ARGUS_OP_RETEST, 4));
    TEST_ASSERT_EQUAL(ARGUS_PROBATION, sonar(4)->health);
    TEST_ASSERT_EQUAL(0, sonar(4)->relapses);
    TEST_ASSERT_TRUE(robot_goal(&robot, 900, 0));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 120000));
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, sonar(4)->health);
    finish();
}

void test_a_pinned_sonar_keeps_its_health(void) {
    start_idle();
    ask(ARGUS_OP_PIN, 3);
    TEST_ASSERT_EQUAL(1, robot_last_event(&robot, ARGUS_EV_SONAR_PINNED)->value);
    for (int test = 0; test < ARGUS_TESTS; test++) {
        robot.argus.evidence.of[3].score[test] = 2000;
    }
    robot_run(&robot, 3000);
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, sonar(3)->health);
    TEST_ASSERT_FALSE(argus_operator(&robot.argus, now(), ARGUS_OP_RETEST, 3));
    for (int test = 0; test < ARGUS_TESTS; test++) {
        robot.argus.evidence.of[3].score[test] = 0;
    }
    robot.argus.evidence.of[3].score[ARGUS_TEST_STUCK] = ARGUS_CEILING;
    ask(ARGUS_OP_UNPIN, 3);
    TEST_ASSERT_EQUAL(0, robot_last_event(&robot, ARGUS_EV_SONAR_PINNED)->value);
    robot_run(&robot, 1000);
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, sonar(3)->health);
    finish();
}

// What others agreed to before it was taken out is nothing that brings it back.
void test_what_is_disabled_by_hand_begins_without_agreements(void) {
    start_idle();
    for (int i = 0; i < SONARS; i++) {
        robot.argus.evidence.of[i].agreed = 200;
        ask(ARGUS_OP_DISABLE, i);
        TEST_ASSERT_EQUAL(ARGUS_DISABLED, sonar(i)->health);
        TEST_ASSERT_EQUAL(0, robot.argus.evidence.of[i].agreed);
        ask(ARGUS_OP_UNPIN, i);
    }
    robot_run(&robot, 6000);
    for (int i = 0; i < SONARS; i++) {
        TEST_ASSERT_EQUAL(ARGUS_DISABLED, sonar(i)->health);
    }
}

// The record tells of faults, not of caution: that is the config's.
void test_a_record_leaves_the_caution_alone(void) {
    save_one();
    argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    config.caution = 200;
    robot_init(&robot, &config, 4711);
    TEST_ASSERT_TRUE(argus_record_load(&robot.argus, record, sizeof record));
    TEST_ASSERT_EQUAL(200, robot.argus.evidence.caution);
}

void test_taken_out_by_hand_it_stays_out(void) {
    start_idle();
    ask(ARGUS_OP_DISABLE, 2);
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, sonar(2)->health);
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, sonar(2)->kind);
    TEST_ASSERT_TRUE(robot_goal(&robot, 900, 0));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 120000));
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, sonar(2)->health);
    finish();
}

void test_a_pin_does_not_end_a_stop(void) {
    start_idle();
    ask(ARGUS_OP_STOP, 0);
    ask(ARGUS_OP_PIN, 3);
    TEST_ASSERT_TRUE(robot.argus.orders.stay);
    ask(ARGUS_OP_RECHECK, 0);
    TEST_ASSERT_EQUAL_HEX8(ARGUS_STAY_HELD, robot.argus.orders.stay); // for a client it holds on
}

void test_what_cannot_be_done_is_refused(void) {
    static const argus_op_t ops[] = {ARGUS_OP_RETEST, ARGUS_OP_PIN, ARGUS_OP_UNPIN, ARGUS_OP_DISABLE};
    static const int32_t bad[] = {-1, 16, 17, 256, INT32_MAX, INT32_MIN};
    start_idle();
    const int from = robot.events;
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 6; j++) {
            ask(ops[i], bad[j]);
        }
    }
    ask(ARGUS_OP_UNPIN, 3); // it is not pinned
    TEST_ASSERT_FALSE(argus_operator(&robot.argus, now(), ARGUS_OP_RETEST, 16));
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_OPERATOR, from));
    TEST_ASSERT_EQUAL_HEX16(0, robot.argus.orders.pinned);
    start(ARGUS_PROFILE_ARGUS);
    TEST_ASSERT_FALSE(argus_operator(&robot.argus, now(), ARGUS_OP_RETEST, 3)); // no session
    start(ARGUS_PROFILE_PAPER);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    for (int i = 1; i < 4; i++) {
        ask(ops[i], 3);
    }
    TEST_ASSERT_EQUAL_HEX16(0, robot.argus.orders.pinned);
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, sonar(3)->health);
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_OPERATOR, 0));
    finish();
}

// Gives a sonar the name of a fault, as the evidence does.
static void name_it(int number) {
    robot.argus.evidence.of[number].score[ARGUS_TEST_DROPOUT] = 1500;
    robot_run(&robot, 300);
    robot.argus.evidence.of[number].score[ARGUS_TEST_DROPOUT] = 1500;
    robot_run(&robot, 1500);
}

static void next_mission(void) {
    TEST_ASSERT_TRUE(argus_record_save(&robot.argus, record, sizeof record) > 0);
    start(ARGUS_PROFILE_ARGUS);
    TEST_ASSERT_TRUE(argus_record_load(&robot.argus, record, sizeof record));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
}

// Named in a second mission in a row it is reported as degrading, once; in a first one, or retested, it is
// not.
void test_what_is_named_in_one_mission_after_the_other_degrades(void) {
    start_idle();
    name_it(5);
    TEST_ASSERT_TRUE(robot.argus.knowledge.sonar[5].named);
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_SONAR_DEGRADING, 0));
    next_mission();
    TEST_ASSERT_EQUAL(1, robot.argus.knowledge.sonar[5].missions_named);
    const int from = robot.events;
    name_it(5);
    name_it(4);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_SONAR_DEGRADING, from));
    TEST_ASSERT_EQUAL(5, robot_last_event(&robot, ARGUS_EV_SONAR_DEGRADING)->sonar);
    TEST_ASSERT_EQUAL(2, robot_last_event(&robot, ARGUS_EV_SONAR_DEGRADING)->value);
    next_mission();
    TEST_ASSERT_EQUAL(2, robot.argus.knowledge.sonar[5].missions_named);
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, now(), ARGUS_OP_RETEST, 5));
    TEST_ASSERT_EQUAL(0, robot.argus.knowledge.sonar[5].missions_named);
    finish();
}
