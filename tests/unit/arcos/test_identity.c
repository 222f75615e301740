// SPDX-License-Identifier: MIT
// Attacks: another robot is told whichever one of its parts differs; the same one is not, however often it
// comes and whatever it leaves out.
#include "arcos/identity.h"
#include "unity.h"

static argus_identity_t identity;

void setUp(void) {
    identity = (argus_identity_t){.met = false};
}

static int meet(const char *name, const char *robot_class, const char *subclass, const char *serial) {
    const char *const texts[ARGUS_IDENTITY_PARTS] = {name, robot_class, subclass, serial};
    return argus_identity_meet(&identity, texts);
}

void test_the_first_robot_is_never_another(void) {
    TEST_ASSERT_EQUAL_INT(0, meet("", "", "", NULL));
    setUp();
    TEST_ASSERT_EQUAL_INT(0, meet("A", "Pioneer", "p3dx-sh", "1"));
}

void test_each_part_counts_and_the_first_is_told(void) {
    meet("A", "Pioneer", "p3dx-sh", "1");
    TEST_ASSERT_EQUAL_INT(0, meet("A", "Pioneer", "p3dx-sh", "1"));
    TEST_ASSERT_EQUAL_INT(1, meet("B", "Pioneer", "p3dx-sh", "1"));
    TEST_ASSERT_EQUAL_INT(2, meet("B", "Amigo", "p3dx-sh", "1"));
    TEST_ASSERT_EQUAL_INT(3, meet("B", "Amigo", "p3at-sh", "1"));
    TEST_ASSERT_EQUAL_INT(4, meet("B", "Amigo", "p3at-sh", "2"));
    TEST_ASSERT_EQUAL_INT(0, meet("B", "Amigo", "p3at-sh", "2"));
    TEST_ASSERT_EQUAL_INT(1, meet("A", "Pioneer", "p3dx-sh", "1"));
    TEST_ASSERT_EQUAL_INT(1, meet("", "Pioneer", "p3dx-sh", "1"));
    TEST_ASSERT_EQUAL_INT(3, meet("", "Pioneer", "p3dx-sh-", "1"));
}

void test_a_serial_number_left_out_is_no_other(void) {
    meet("A", "Pioneer", "p3dx-sh", NULL);
    TEST_ASSERT_EQUAL_INT(0, meet("A", "Pioneer", "p3dx-sh", "1"));
    TEST_ASSERT_EQUAL_INT(0, meet("A", "Pioneer", "p3dx-sh", ""));
    TEST_ASSERT_EQUAL_INT(0, meet("A", "Pioneer", "p3dx-sh", NULL));
    TEST_ASSERT_EQUAL_INT(4, meet("A", "Pioneer", "p3dx-sh", "2")); // it was known all the while
    TEST_ASSERT_EQUAL_INT(3, meet("A", "Pioneer", "p3at-sh", NULL));
    TEST_ASSERT_EQUAL_INT(0, meet("A", "Pioneer", "p3at-sh", "1")); // the other robot's own was not told yet
}

// 0 stands for a text that is not given: one whose hash would be 0 is given all the same.
void test_a_text_whose_hash_is_zero_is_given(void) {
    meet("A", "Pioneer", "p3dx-sh", "A7FHKFV");
    TEST_ASSERT_EQUAL_INT(0, meet("A", "Pioneer", "p3dx-sh", "A7FHKFV"));
    TEST_ASSERT_EQUAL_INT(4, meet("A", "Pioneer", "p3dx-sh", "B"));
    TEST_ASSERT_EQUAL_INT(4, meet("A", "Pioneer", "p3dx-sh", "A7FHKFV"));
}
