// SPDX-License-Identifier: MIT
// Attacks: every number of every table has its name, and a number beyond has none.
#include "argus/argus.h"
#include "unity.h"

static void expect(argus_name_of_t of, int first, int last, const char *name_of_last) {
    TEST_ASSERT_EQUAL_STRING(name_of_last, argus_name(of, last));
    for (int i = first; i <= last; i++) {
        TEST_ASSERT_TRUE_MESSAGE(argus_name(of, i)[0] != '?', argus_name(of, i));
    }
    TEST_ASSERT_EQUAL_STRING("?", argus_name(of, first - 1));
    TEST_ASSERT_EQUAL_STRING("?", argus_name(of, last + 1));
    TEST_ASSERT_EQUAL_STRING("?", argus_name(of, 1000000));
}

void test_every_enumeration_is_named_from_end_to_end(void) {
    expect(ARGUS_NAME_LEVEL, ARGUS_LEVEL_OK, ARGUS_LEVEL_STALE, "STALE");
    expect(ARGUS_NAME_MODE, ARGUS_MODE_OFFLINE, ARGUS_MODE_CREEPING, "CREEPING");
    expect(ARGUS_NAME_MISSION, ARGUS_MISSION_NONE, ARGUS_MISSION_FAILED, "failed");
    expect(ARGUS_NAME_WAIT, ARGUS_WAIT_NONE, ARGUS_WAIT_ECHO, "echo");
    expect(ARGUS_NAME_FAILURE, ARGUS_IS_NORMAL, ARGUS_IS_CATASTROPHIC, "IsCatastrophic");
    expect(ARGUS_NAME_HEALTH, ARGUS_UNKNOWN, ARGUS_ABSENT, "ABSENT");
#define NAMED(name, number, word, meaning) \
    TEST_ASSERT_EQUAL_STRING(word, argus_name(ARGUS_NAME_KIND, number));
    ARGUS_FAULT_KIND_TABLE(NAMED)
#undef NAMED
    expect(ARGUS_NAME_KIND, ARGUS_KIND_NONE, ARGUS_KINDS - 1, argus_name(ARGUS_NAME_KIND, ARGUS_KINDS - 1));
    expect(ARGUS_NAME_OP, ARGUS_OP_STOP, ARGUS_OP_DISABLE, "DISABLE");
    TEST_ASSERT_EQUAL_STRING("", argus_name(ARGUS_NAME_KIND, ARGUS_KIND_NONE));
    TEST_ASSERT_EQUAL_STRING("?", argus_name((argus_name_of_t)99, 1));
}

void test_why_driving_is_barred_is_named(void) {
    TEST_ASSERT_EQUAL_STRING("", argus_name(ARGUS_NAME_BAR, ARGUS_BAR_NONE));
    TEST_ASSERT_EQUAL_STRING("unknown", argus_name(ARGUS_NAME_BAR, 1));
    TEST_ASSERT_EQUAL_STRING("sonars", argus_name(ARGUS_NAME_BAR, 3));
    TEST_ASSERT_EQUAL_STRING("?", argus_name(ARGUS_NAME_BAR, 4));
}

void test_an_event_that_is_none_is_about_nothing(void) {
    TEST_ASSERT_EQUAL_STRING("?", argus_name(ARGUS_NAME_SUBJECT, 0xFFFF));
    TEST_ASSERT_EQUAL_STRING("?", argus_name(ARGUS_NAME_SUBJECT, -1));
}
