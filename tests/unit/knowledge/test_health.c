// SPDX-License-Identifier: MIT
// Rule under attack: every change of a sonar's health leads where the table of changes says, counts failures
// once, and returns the event that says it.
#include "knowledge/health.h"

#include <string.h>

#include "unity.h"

#define ME 4
#define NOW_MS 777u

static argus_knowledge_t k;

static const argus_health_t all[] = {ARGUS_UNKNOWN,   ARGUS_HEALTHY, ARGUS_SUSPECT, ARGUS_DISABLED,
                                     ARGUS_PROBATION, ARGUS_STALE,   ARGUS_ABSENT};

void setUp(void) {
    memset(&k, 0, sizeof k);
}

static argus_event_t set(argus_change_t change, argus_fault_kind_t kind) {
    return argus_health_set(&k, ME, change, kind, 123, NOW_MS);
}

static void expect_from(argus_change_t change, const char *from) {
    static const char initial[] = "UHSDPTA";
    for (int i = 0; i < 7; i++) {
        k.sonar[ME].health = all[i];
        TEST_ASSERT_EQUAL_MESSAGE(strchr(from, initial[i]) != NULL, argus_health_may(&k, ME, change), from);
    }
}

static void expect_to(argus_change_t change, argus_health_t to, int event) {
    const argus_fault_kind_t kind =
        to == ARGUS_DISABLED || to == ARGUS_PROBATION ? ARGUS_KIND_SLOW : ARGUS_KIND_NONE;
    const argus_event_t said = set(change, kind);
    TEST_ASSERT_EQUAL(to, k.sonar[ME].health);
    TEST_ASSERT_EQUAL(kind, k.sonar[ME].kind);
    TEST_ASSERT_EQUAL(event, said.id);
    TEST_ASSERT_EQUAL(ME, said.sonar);
    TEST_ASSERT_EQUAL(123, said.value);
}

void test_each_change_has_its_states_its_end_and_its_event(void) {
#define CHECK(name, from, to, event, meaning) \
    expect_from(ARGUS_CHANGE_##name, from);   \
    expect_to(ARGUS_CHANGE_##name, ARGUS_##to, ARGUS_EV_##event);
#define ARGUS_EV_NONE 0
    ARGUS_CHANGE_TABLE(CHECK)
#undef ARGUS_EV_NONE
#undef CHECK
}

// A sonar that is out comes back over its probation alone, and never becomes a suspect on the way; unless it
// is another robot's.
void test_no_short_way_back(void) {
    k.sonar[ME].health = ARGUS_DISABLED;
    for (int change = 0; change < ARGUS_CHANGES; change++) {
        const bool stays_out =
            change == ARGUS_CHANGE_RENAMED || change == ARGUS_CHANGE_TRIED || change == ARGUS_CHANGE_RETESTED;
        const bool other_robot = change == ARGUS_CHANGE_FORGOTTEN || change == ARGUS_CHANGE_MISSING;
        TEST_ASSERT_EQUAL(stays_out || other_robot, argus_health_may(&k, ME, (argus_change_t)change));
    }
}

void test_entry_is_timed_and_a_better_name_is_none(void) {
    set(ARGUS_CHANGE_DISABLED, ARGUS_KIND_OFF);
    k.sonar[ME].since_ms = 5;
    set(ARGUS_CHANGE_RENAMED, ARGUS_KIND_STUCK);
    TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, k.sonar[ME].kind);
    TEST_ASSERT_EQUAL(5, k.sonar[ME].since_ms);
    set(ARGUS_CHANGE_TRIED, ARGUS_KIND_STUCK);
    TEST_ASSERT_EQUAL(NOW_MS, k.sonar[ME].since_ms);
}

void test_failures_and_relapses_are_counted(void) {
    set(ARGUS_CHANGE_DISABLED, ARGUS_KIND_OFF);
    TEST_ASSERT_EQUAL(1, k.sonar[ME].disabled_times);
    TEST_ASSERT_EQUAL(0, k.sonar[ME].relapses);
    set(ARGUS_CHANGE_TRIED, ARGUS_KIND_OFF);
    set(ARGUS_CHANGE_DISABLED, ARGUS_KIND_OFF);
    TEST_ASSERT_EQUAL(2, k.sonar[ME].disabled_times);
    TEST_ASSERT_EQUAL(1, k.sonar[ME].relapses);
    set(ARGUS_CHANGE_RETESTED, ARGUS_KIND_OFF);
    TEST_ASSERT_EQUAL(0, k.sonar[ME].relapses);
}

void test_a_failure_after_a_mission_with_one_is_a_relapse(void) {
    k.sonar[ME].disabled_before = 1;
    set(ARGUS_CHANGE_DISABLED, ARGUS_KIND_OFF);
    TEST_ASSERT_EQUAL(1, k.sonar[ME].relapses);
}

void test_counters_stop_at_their_end(void) {
    k.sonar[ME].disabled_times = UINT16_MAX;
    k.sonar[ME].relapses = UINT8_MAX;
    set(ARGUS_CHANGE_DISABLED, ARGUS_KIND_OFF);
    TEST_ASSERT_EQUAL(UINT16_MAX, k.sonar[ME].disabled_times);
    TEST_ASSERT_EQUAL(UINT8_MAX, k.sonar[ME].relapses);
}

void test_the_others_are_let_be(void) {
    argus_knowledge_t before = k;
    set(ARGUS_CHANGE_DISABLED, ARGUS_KIND_OFF);
    k.sonar[ME] = before.sonar[ME];
    TEST_ASSERT_EQUAL_MEMORY(&before, &k, sizeof k);
}

// What counts over missions: a name of a fault. A suspicion without one, or its end, is none.
void test_a_mission_in_which_a_fault_was_named_is_remembered_until_it_is_forgiven(void) {
    set(ARGUS_CHANGE_SUSPECTED, ARGUS_KIND_OFF);
    TEST_ASSERT_FALSE(k.sonar[ME].named);
    set(ARGUS_CHANGE_NAMED, ARGUS_KIND_NONE);
    TEST_ASSERT_FALSE(k.sonar[ME].named);
    set(ARGUS_CHANGE_NAMED, ARGUS_KIND_OFF);
    TEST_ASSERT_TRUE(k.sonar[ME].named);
    set(ARGUS_CHANGE_CLEARED, ARGUS_KIND_NONE);
    TEST_ASSERT_TRUE(k.sonar[ME].named);
    k.sonar[ME].missions_named = 2;
    argus_health_forgive(&k, ME);
    TEST_ASSERT_FALSE(k.sonar[ME].named);
    TEST_ASSERT_EQUAL(0, k.sonar[ME].missions_named);
    set(ARGUS_CHANGE_DISABLED, ARGUS_KIND_OFF);
    TEST_ASSERT_TRUE(k.sonar[ME].named);
}
