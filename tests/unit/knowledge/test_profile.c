// SPDX-License-Identifier: MIT
// Rule under attack: a setting has its own rules, one beyond the table those of the paper, and diagnosis that
// is off takes the tests away whatever the profile.
#include "knowledge/profile.h"

#include "unity.h"

static const argus_profile_t *rules_of(int32_t profile, int32_t diagnosis) {
    argus_config_t config;
    argus_config_default(&config);
    config.profile = profile;
    config.diagnosis = diagnosis;
    return argus_profile(&config);
}

void test_each_profile_has_rules_of_its_own(void) {
    for (int32_t i = 0; i < (int32_t)ARGUS_PROFILES; i++) {
        for (int32_t j = 0; j < i; j++) {
            TEST_ASSERT_TRUE(rules_of(i, 1) != rules_of(j, 1));
        }
    }
    TEST_ASSERT_EQUAL(1, rules_of(ARGUS_PROFILE_PAPER, 1)->disparity);
    TEST_ASSERT_EQUAL(0, rules_of(ARGUS_PROFILE_PAPER, 1)->evidence);
    TEST_ASSERT_EQUAL(1, rules_of(ARGUS_PROFILE_ARGUS, 1)->evidence);
}

void test_beyond_the_table_the_rules_are_the_papers(void) {
    static const int32_t beyond[] = {-1, INT32_MIN, (int32_t)ARGUS_PROFILES, INT32_MAX};
    for (unsigned i = 0; i < sizeof beyond / sizeof beyond[0]; i++) {
        TEST_ASSERT_TRUE(rules_of(beyond[i], 1) == rules_of(ARGUS_PROFILE_PAPER, 1));
    }
}

void test_without_diagnosis_none_is_judged_whatever_the_profile(void) {
    for (int32_t i = -1; i <= (int32_t)ARGUS_PROFILES; i++) {
        TEST_ASSERT_EQUAL(0, rules_of(i, 0)->disparity);
        TEST_ASSERT_EQUAL(0, rules_of(i, 0)->evidence);
        TEST_ASSERT_EQUAL(0, rules_of(i, 0)->dead_reading);
        TEST_ASSERT_EQUAL(1, rules_of(i, 0)->drives_seen);
    }
}
