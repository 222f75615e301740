// SPDX-License-Identifier: MIT
// Rule: an option with one or two wrong letters gets the name of the one that was meant, any other gets none.
#include "meant.h"
#include "unity.h"

#include <stddef.h>

static const struct option table[] = {
    {"link", 0, NULL, 0}, {"goal", 0, NULL, 0}, {"guard-readings", 0, NULL, 0}, {NULL, 0, NULL, 0}};

void test_near_ones(void) {
    TEST_ASSERT_EQUAL_STRING("link", option_meant(table, "--lnik"));
    TEST_ASSERT_EQUAL_STRING("link", option_meant(table, "--lin=serial:x"));
    TEST_ASSERT_EQUAL_STRING("goal", option_meant(table, "--gaol"));
    TEST_ASSERT_EQUAL_STRING("guard-readings", option_meant(table, "--guard-reading"));
}

void test_far_ones(void) {
    static const char *const far[] = {
        "--frob", "-z",      "--",
        "",       "--guard", "--an-option-that-is-so-long-that-no-name-in-any-table-has-as-many-letters"};
    for (size_t i = 0; i < sizeof far / sizeof far[0]; i++) {
        TEST_ASSERT_NULL_MESSAGE(option_meant(table, far[i]), far[i]);
    }
}
