// SPDX-License-Identifier: MIT
// Rule under attack: Algorithm 2: which way it turns, which sonars it hears, what it concludes, and that it
// always turns back.
#include "analysis/verify.h"

#include <string.h>

#include "health.h"
#include "knowledge/body.h"
#include "unity.h"

#define BASE 17500 // so that +20 degrees wraps

static argus_knowledge_t k;
static argus_verify_t v;
static argus_mark_t mark;

void setUp(void) {
    argus_knowledge_init(&k);
    k.sips = 0xFFFFFFFEu;
    for (int i = 0; i < 16; i++) {
        k.sonar[i].reported = true;
        k.sonar[i].reading_mm = 1000;
        k.sonar[i].sip = k.sips;
    }
    mark = argus_mark_now(&k);
}

static void settle(void) {
    mark = argus_mark_now(&k);
}

static void read(int sonar, int mm) {
    k.sips++;
    k.sonar[sonar].sip = k.sips;
    k.sonar[sonar].reading_mm = (uint16_t)mm;
}

// Recheck: `own` between its neighbours; then the machine wants the first turn, or is done.
static void recheck(int sonar, int own, int neighbours) {
    argus_verify_begin(&v, k.robot, sonar, BASE);
    TEST_ASSERT_EQUAL(BASE, argus_verify_heading_cdeg(&v));
    TEST_ASSERT_FALSE(argus_verify_step(&v, &k, &mark)); // nothing is fresh
    for (int i = sonar - 1; i <= sonar + 1; i++) {
        if (i >= 1 && i <= 6) {
            read(i, i == sonar ? own : neighbours);
        }
    }
    TEST_ASSERT_TRUE(argus_verify_step(&v, &k, &mark));
}

static void turned_left(void) {
    TEST_ASSERT_EQUAL(ARGUS_VERIFY_RIGHT, v.phase);
    TEST_ASSERT_EQUAL(-16500, argus_verify_heading_cdeg(&v)); // +20: s + 1 gets there
    settle();
}

static void turned_right(void) {
    TEST_ASSERT_EQUAL(ARGUS_VERIFY_LEFT, v.phase);
    TEST_ASSERT_EQUAL(15500, argus_verify_heading_cdeg(&v)); // -20: s - 1 gets there
    settle();
}

static void ends_with(argus_result_t result) {
    TEST_ASSERT_EQUAL(ARGUS_VERIFY_RETURN, v.phase);
    TEST_ASSERT_EQUAL(BASE, argus_verify_heading_cdeg(&v));
    settle();
    TEST_ASSERT_TRUE(argus_verify_step(&v, &k, &mark));
    TEST_ASSERT_EQUAL(ARGUS_VERIFY_DONE, v.phase);
    TEST_ASSERT_EQUAL(result, v.result);
    TEST_ASSERT_FALSE(argus_verify_step(&v, &k, &mark));
}

static void testify(int witness, int mm) {
    TEST_ASSERT_FALSE(argus_verify_step(&v, &k, &mark)); // it has not fired since the turn settled
    read(witness == 1 ? 4 : 1, 1234);                    // another sonar's reading changes nothing
    TEST_ASSERT_FALSE(argus_verify_step(&v, &k, &mark));
    read(witness, mm);
    TEST_ASSERT_TRUE(argus_verify_step(&v, &k, &mark));
}

static void two_witnesses(int own, int a, int b, argus_result_t result) {
    setUp();
    recheck(3, own, 2000);
    turned_right();
    testify(2, a);
    turned_left();
    testify(4, b);
    TEST_ASSERT_EQUAL(a, v.witness_mm[0]);
    TEST_ASSERT_EQUAL(b, v.witness_mm[1]);
    ends_with(result);
}

void test_the_mean_decides_and_equal_to_the_tolerance_agrees(void) {
    two_witnesses(1000, 1075, 1075, ARGUS_RESULT_CLEARED);
    two_witnesses(1000, 1076, 1076, ARGUS_RESULT_CONVICTED);
    two_witnesses(1000, 1000, 1150, ARGUS_RESULT_CLEARED);   // mean 1075
    two_witnesses(1000, 1000, 1151, ARGUS_RESULT_CONVICTED); // mean 1075.5 > tr
    two_witnesses(1000, 2000, 100, ARGUS_RESULT_CLEARED);    // mean 1050: the listing's rule, not the prose's
    two_witnesses(1000, 925, 925, ARGUS_RESULT_CLEARED);     // |.|: too low counts as well
    two_witnesses(1000, 924, 924, ARGUS_RESULT_CONVICTED);
    two_witnesses(1000, 2000, 2000, ARGUS_RESULT_CONVICTED);
}

void test_edge_sonars_have_one_witness(void) {
    recheck(1, 1000, 2000);
    turned_left();
    testify(2, 2000);
    ends_with(ARGUS_RESULT_CONVICTED);
    setUp();
    recheck(6, 1000, 2000);
    turned_right();
    testify(5, 1075);
    ends_with(ARGUS_RESULT_CLEARED);
}

void test_one_usable_witness(void) {
    for (int out = 2; out <= 4; out += 2) {
        for (int how = 0; how < 2; how++) {
            setUp();
            if (how == 0) {
                put_health(&k.sonar[out], ARGUS_DISABLED, ARGUS_KIND_OFF, 0);
            } else {
                k.sonar[out].reading_mm = 5000;
            }
            argus_verify_begin(&v, k.robot, 3, BASE);
            read(out == 2 ? 4 : 2, 2000);
            read(3, 1000);
            TEST_ASSERT_TRUE(argus_verify_step(&v, &k, &mark));
            if (out == 2) {
                turned_left();
            } else {
                turned_right();
            }
            testify(out == 2 ? 4 : 2, 1900);
            ends_with(ARGUS_RESULT_CONVICTED);
        }
    }
}

void test_no_usable_witness_leaves_it_unproven(void) {
    put_health(&k.sonar[2], ARGUS_DISABLED, ARGUS_KIND_OFF, 0);
    put_health(&k.sonar[4], ARGUS_DISABLED, ARGUS_KIND_OFF, 0);
    argus_verify_begin(&v, k.robot, 3, BASE);
    read(3, 1000);
    TEST_ASSERT_TRUE(argus_verify_step(&v, &k, &mark));
    TEST_ASSERT_EQUAL(ARGUS_VERIFY_DONE, v.phase);
    TEST_ASSERT_EQUAL(ARGUS_RESULT_UNPROVEN, v.result);
}

void test_a_suspicion_that_does_not_hold_at_rest_is_dropped_without_a_turn(void) {
    recheck(3, 1000, 1075);
    TEST_ASSERT_EQUAL(ARGUS_VERIFY_DONE, v.phase);
    TEST_ASSERT_EQUAL(ARGUS_RESULT_DROPPED, v.result);
}

void test_v_is_the_reading_at_rest(void) {
    k.sonar[3].reading_mm = 500;
    recheck(3, 1000, 2000);
    TEST_ASSERT_EQUAL(1000, v.reading_mm);
    k.sonar[3].reading_mm = 1600; // what it reads on the way is no longer v
    turned_right();
    testify(2, 1000);
    turned_left();
    testify(4, 1000);
    ends_with(ARGUS_RESULT_CLEARED);
}

void test_a_witness_that_reads_5000_is_left_out_of_the_mean(void) {
    recheck(3, 1000, 2000);
    turned_right();
    testify(2, 5000);
    turned_left();
    testify(4, 1000);
    ends_with(ARGUS_RESULT_CLEARED);
    setUp();
    recheck(3, 1000, 2000);
    turned_right();
    testify(2, 1000);
    turned_left();
    testify(4, 5000);
    ends_with(ARGUS_RESULT_CLEARED);
}

void test_both_witnesses_lost_leave_it_unproven(void) {
    recheck(3, 1000, 2000);
    turned_right();
    testify(2, 5000);
    turned_left();
    testify(4, 5000);
    ends_with(ARGUS_RESULT_UNPROVEN);
}

void test_a_witness_disabled_on_the_way_is_not_waited_for(void) {
    recheck(3, 1000, 2000);
    turned_right();
    put_health(&k.sonar[2], ARGUS_DISABLED, ARGUS_KIND_SILENT, 0);
    TEST_ASSERT_TRUE(argus_verify_step(&v, &k, &mark));
    turned_left();
    testify(4, 1900);
    ends_with(ARGUS_RESULT_CONVICTED);
}

void test_idle_does_nothing(void) {
    argus_verify_init(&v);
    TEST_ASSERT_FALSE(argus_verify_step(&v, &k, &mark));
    TEST_ASSERT_EQUAL(ARGUS_VERIFY_IDLE, v.phase);
}

// The AmigoBot's 2 looks at 15 degrees, between 41 and -15: the left one turns by -26 onto its bearing.
void test_an_amigobot_turns_by_its_own_bearings(void) {
    argus_body_is(&k, argus_robot_find("amigo-sh"), 0);
    settle();
    argus_verify_begin(&v, k.robot, 2, 0);
    read(1, 2000), read(2, 1000), read(3, 2000);
    TEST_ASSERT_TRUE(argus_verify_step(&v, &k, &mark));
    TEST_ASSERT_EQUAL(ARGUS_VERIFY_LEFT, v.phase);
    TEST_ASSERT_EQUAL(-2600, argus_verify_heading_cdeg(&v));
    settle();
    testify(1, 1950);
    TEST_ASSERT_EQUAL(ARGUS_VERIFY_RIGHT, v.phase);
    TEST_ASSERT_EQUAL(3000, argus_verify_heading_cdeg(&v));
    settle();
    testify(3, 1950);
    TEST_ASSERT_EQUAL(ARGUS_RESULT_CONVICTED, v.result);
    argus_verify_begin(&v, k.robot, 4, 0); // at the edge: one neighbour, and no sonar of another role
    read(3, 2000), read(4, 1000), read(5, 2000);
    TEST_ASSERT_TRUE(argus_verify_step(&v, &k, &mark));
    TEST_ASSERT_EQUAL(ARGUS_VERIFY_LEFT, v.phase);
    TEST_ASSERT_EQUAL(1, v.witnesses);
    TEST_ASSERT_EQUAL(-2600, argus_verify_heading_cdeg(&v));
}
