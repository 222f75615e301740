// SPDX-License-Identifier: MIT
// Rule under attack: the tolerance range to the millimetre, and Algorithm 1 as paper.md settles it.
#include "paper/disparity.h"

#include <math.h>
#include <stdio.h>

#include "health.h"
#include "unity.h"

static argus_knowledge_t k;
static int32_t difference;

void setUp(void) {
    argus_knowledge_init(&k);
    for (int i = 0; i < 16; i++) {
        k.sonar[i].reported = true;
        k.sonar[i].reading_mm = 1000;
    }
}

static argus_verdict_t judge(int sonar) {
    return argus_disparity(&k, sonar, &difference);
}

static void read3(int left, int own, int right) {
    k.sonar[3].reading_mm = (uint16_t)left;
    k.sonar[4].reading_mm = (uint16_t)own;
    k.sonar[5].reading_mm = (uint16_t)right;
}

void test_tolerance_of_every_reading(void) {
    for (int a1 = 0; a1 <= 65535; a1++) {
        const double exact = (a1 + 167) * (1 / cos(20 * 3.14159265358979323846 / 180) - 1);
        char text[30];
        snprintf(text, sizeof text, "tr(%d)", a1);
        TEST_ASSERT_EQUAL_MESSAGE((int32_t)lround(exact), argus_tolerance_mm(argus_robot_default(), a1),
                                  text);
    }
    TEST_ASSERT_EQUAL(26, argus_tolerance_mm(argus_robot_default(), 245));
    TEST_ASSERT_EQUAL(75, argus_tolerance_mm(argus_robot_default(), 1000));
    TEST_ASSERT_EQUAL(267, argus_tolerance_mm(argus_robot_default(), 4000));
    TEST_ASSERT_TRUE(argus_tolerance_mm(argus_robot_default(), 65535) > 4000);
}

void test_the_papers_example(void) {
    k.sonar[4].reading_mm = 415;
    k.sonar[5].reading_mm = 245;
    k.sonar[6].reading_mm = 417;
    TEST_ASSERT_EQUAL(ARGUS_DISPARATE, judge(5));
    TEST_ASSERT_EQUAL(172, difference);
}

void test_equal_to_the_tolerance_agrees(void) {
    const int tr = 75;
    read3(1000 + tr, 1000, 1000 + tr);
    TEST_ASSERT_EQUAL(ARGUS_AGREES, judge(4));
    read3(1000 + tr + 1, 1000, 1000 + tr + 1);
    TEST_ASSERT_EQUAL(ARGUS_DISPARATE, judge(4));
}

void test_neighbours_that_differ_give_no_verdict(void) {
    read3(1500, 1000, 1575); // by tr(1000): they agree
    TEST_ASSERT_EQUAL(ARGUS_DISPARATE, judge(4));
    TEST_ASSERT_EQUAL(575, difference); // r(s + 1) - r(s)
    read3(1500, 1000, 1576);
    TEST_ASSERT_EQUAL(ARGUS_NO_VERDICT, judge(4));
    read3(1576, 1000, 1500); // the absolute value that the listing lacks
    TEST_ASSERT_EQUAL(ARGUS_NO_VERDICT, judge(4));
}

void test_too_high_is_not_found(void) {
    read3(1000, 3000, 1000);
    TEST_ASSERT_EQUAL(ARGUS_AGREES, judge(4));
    TEST_ASSERT_EQUAL(-2000, difference);
}

void test_edge_sonars_have_one_neighbour(void) {
    k.sonar[0].reading_mm = k.sonar[7].reading_mm = 5000; // never neighbours of the six
    k.sonar[2].reading_mm = k.sonar[5].reading_mm = 1075;
    TEST_ASSERT_EQUAL(ARGUS_AGREES, judge(1));
    TEST_ASSERT_EQUAL(ARGUS_AGREES, judge(6));
    k.sonar[2].reading_mm = k.sonar[5].reading_mm = 1076;
    TEST_ASSERT_EQUAL(ARGUS_DISPARATE, judge(1));
    TEST_ASSERT_EQUAL(76, difference);
    TEST_ASSERT_EQUAL(ARGUS_DISPARATE, judge(6));
    TEST_ASSERT_EQUAL(76, difference);
}

static void put_out(int sonar, int how) {
    if (how == 0) {
        put_health(&k.sonar[sonar], ARGUS_DISABLED, ARGUS_KIND_WRONG, 0);
    } else if (how == 1) {
        k.sonar[sonar].reading_mm = 5000;
    } else {
        k.sonar[sonar].reported = false;
    }
}

void test_an_inner_sonar_with_one_usable_neighbour_is_an_edge_sonar(void) {
    for (int how = 0; how < 3; how++) {
        for (int side = 0; side < 2; side++) {
            setUp();
            read3(1200, 1000, 1300); // apart by more than tr: with both there would be no verdict
            put_out(side == 0 ? 3 : 5, how);
            TEST_ASSERT_EQUAL(ARGUS_DISPARATE, judge(4));
            TEST_ASSERT_EQUAL(side == 0 ? 300 : 200, difference);
        }
    }
}

void test_without_a_usable_neighbour_there_is_no_verdict(void) {
    for (int how = 0; how < 3; how++) {
        setUp();
        read3(2000, 1000, 2000);
        put_out(3, how);
        put_out(5, how);
        TEST_ASSERT_EQUAL(ARGUS_NO_VERDICT, judge(4));
        setUp();
        k.sonar[1].reading_mm = 500;
        put_out(2, how);
        TEST_ASSERT_EQUAL(ARGUS_NO_VERDICT, judge(1));
    }
}

void test_a_sonar_that_is_out_is_not_judged(void) {
    for (int how = 0; how < 3; how++) {
        setUp();
        put_out(4, how);
        TEST_ASSERT_EQUAL(ARGUS_NO_VERDICT, judge(4));
    }
}

void test_only_the_six_are_judged(void) {
    k.sonar[0].reading_mm = k.sonar[7].reading_mm = k.sonar[12].reading_mm = 100;
    TEST_ASSERT_EQUAL(ARGUS_NO_VERDICT, judge(0));
    TEST_ASSERT_EQUAL(ARGUS_NO_VERDICT, judge(7));
    TEST_ASSERT_EQUAL(ARGUS_NO_VERDICT, judge(12));
}

void test_no_verdict_has_no_difference(void) {
    argus_knowledge_init(&k);
    int32_t difference_mm = 4711;
    TEST_ASSERT_EQUAL(ARGUS_NO_VERDICT, argus_disparity(&k, 3, &difference_mm)); // none has reported
    TEST_ASSERT_EQUAL_INT32(0, difference_mm);
}
