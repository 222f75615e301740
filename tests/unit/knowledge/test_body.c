// SPDX-License-Identifier: MIT
// Rule under attack: another robot's geometry makes absent the sonars that it has not, and what was heard of
// one before says nothing of the one that stands in its place.
#include "knowledge/body.h"

#include "health.h"
#include "knowledge/knowledge.h"
#include "unity.h"

#define LATER_MS 7000u

static argus_knowledge_t k;

void setUp(void) {
    argus_knowledge_init(&k);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        k.sonar[i].reported = true;
    }
}

void test_sonars_that_it_has_not_are_absent_and_come_back_unheard(void) {
    const argus_robot_t *const sixteen = argus_robot_chosen(1); // p3dx-sh
    const argus_robot_t *const eight = argus_robot_chosen(2);   // amigo-sh
    argus_body_is(&k, eight, LATER_MS);
    TEST_ASSERT_EQUAL_INT(8, k.sonars);
    for (int i = 8; i < 16; i++) {
        TEST_ASSERT_EQUAL(ARGUS_ABSENT, k.sonar[i].health);
        TEST_ASSERT_FALSE(k.sonar[i].reported);
        k.sonar[i].reported = true; // of a robot that is gone
    }
    argus_body_is(&k, sixteen, LATER_MS + 1);
    TEST_ASSERT_EQUAL_INT(16, k.sonars);
    for (int i = 8; i < 16; i++) {
        TEST_ASSERT_EQUAL(ARGUS_UNKNOWN, k.sonar[i].health);
        TEST_ASSERT_FALSE(k.sonar[i].reported);
    }
}

void test_what_both_have_is_left_as_it_is(void) {
    put_health(&k.sonar[3], ARGUS_DISABLED, ARGUS_KIND_OFF, 5);
    argus_body_is(&k, argus_robot_chosen(2), LATER_MS);
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, k.sonar[3].health);
    TEST_ASSERT_TRUE(k.sonar[3].reported);
}

void test_the_masks_of_what_is_out(void) {
    put_health(&k.sonar[1], ARGUS_DISABLED, ARGUS_KIND_OFF, 0);
    put_health(&k.sonar[4], ARGUS_PROBATION, ARGUS_KIND_OFF, 0);
    put_health(&k.sonar[6], ARGUS_SUSPECT, ARGUS_KIND_NONE, 0);
    argus_body_is(&k, argus_robot_chosen(2), LATER_MS);
    TEST_ASSERT_EQUAL_HEX32(1u << 1, argus_disabled(&k));
    TEST_ASSERT_EQUAL_HEX32(1u << 1 | 1u << 4, argus_out(&k) & 0xFFu);
}
