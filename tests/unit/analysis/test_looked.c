// SPDX-License-Identifier: MIT
// Rule under attack: a cleared sonar is left alone for a way that doubles twice and no more; a look proves
// only in a row; a name stands after a second of its own; doubt costs a look once it has cost as much time.
#include "analysis/looked.h"

#include "health.h"
#include "unity.h"

static argus_looks_t looks;
static argus_knowledge_t k;

void setUp(void) {
    argus_looks_init(&looks);
    argus_knowledge_init(&k);
}

static void clear(const int sonar, const uint32_t odometer_mm) {
    k.odometer_mm = odometer_mm;
    argus_looks_clear(&looks, &k, sonar);
}

void test_what_was_never_cleared_is_not_held(void) {
    for (int i = 0; i < 8; i++) {
        TEST_ASSERT_FALSE(argus_looks_hold(&looks, i, 0));
    }
}

// 400 mm, 800, 1600, and 1600 however often, from any odometer, its wrap too.
void test_the_way_that_it_is_held_for_doubles_twice(void) {
    static const uint32_t held_mm[] = {400, 800, 1600, 1600, 1600};
    static const uint32_t starts_mm[] = {0, 12345, UINT32_MAX - 700};
    for (unsigned s = 0; s < 3; s++) {
        setUp();
        for (unsigned times = 0; times < 5; times++) {
            clear(7, starts_mm[s]);
            TEST_ASSERT_TRUE(argus_looks_hold(&looks, 7, starts_mm[s]));
            TEST_ASSERT_TRUE(argus_looks_hold(&looks, 7, starts_mm[s] + held_mm[times] - 1));
            TEST_ASSERT_FALSE(argus_looks_hold(&looks, 7, starts_mm[s] + held_mm[times]));
            TEST_ASSERT_FALSE(argus_looks_hold(&looks, 6, starts_mm[s]));
        }
    }
}

void test_clearances_are_forgotten_after_four_metres_and_not_before(void) {
    clear(2, 1000);
    clear(2, 5000);
    TEST_ASSERT_TRUE(argus_looks_hold(&looks, 2, 5000 + 799));
    clear(2, 9001);
    TEST_ASSERT_TRUE(argus_looks_hold(&looks, 2, 9001 + 399));
    TEST_ASSERT_FALSE(argus_looks_hold(&looks, 2, 9001 + 400));
}

void test_a_look_that_is_asked_for_is_not_held_and_asked_once(void) {
    clear(2, 1000);
    argus_looks_ask(&looks, 2);
    TEST_ASSERT_FALSE(argus_looks_hold(&looks, 2, 1000));
    TEST_ASSERT_TRUE(looks.asked);
    argus_looks_over(&looks);
    TEST_ASSERT_FALSE(looks.asked);
}

void test_three_looks_in_a_row_prove_and_two_at_a_goal(void) {
    for (int settling = 0; settling <= 2; settling++) {
        setUp();
        looks.settling = (uint8_t)settling;
        const int wanted = settling > 0 ? 2 : 3;
        for (int times = 1; times <= 300; times++) {
            TEST_ASSERT_EQUAL(times >= wanted, argus_looks_prove(&looks, 5));
        }
        argus_looks_forget(&looks, 5);
        TEST_ASSERT_EQUAL(wanted == 1, argus_looks_prove(&looks, 5));
        clear(5, 0); // a clearance breaks the row as well
        TEST_ASSERT_FALSE(argus_looks_prove(&looks, 5));
    }
}

void test_looks_at_a_goal_are_counted_until_it_is_left(void) {
    argus_looks_begin(&looks, true);
    argus_looks_begin(&looks, true);
    TEST_ASSERT_EQUAL(2, looks.settling);
    argus_looks_begin(&looks, false);
    TEST_ASSERT_EQUAL(0, looks.settling);
    argus_looks_begin(&looks, true);
    argus_looks_leave(&looks);
    TEST_ASSERT_EQUAL(0, looks.settling);
}

void test_a_name_stands_after_a_second_of_its_own(void) {
    const uint32_t t = UINT32_MAX - 300; // the clock wraps
    TEST_ASSERT_FALSE(argus_looks_stands(&looks, 3, ARGUS_KIND_SLOW, t));
    TEST_ASSERT_FALSE(argus_looks_stands(&looks, 3, ARGUS_KIND_SLOW, t + 999));
    TEST_ASSERT_TRUE(argus_looks_stands(&looks, 3, ARGUS_KIND_SLOW, t + 1000));
    TEST_ASSERT_FALSE(argus_looks_stands(&looks, 3, ARGUS_KIND_WRONG, t + 1000));
    TEST_ASSERT_FALSE(argus_looks_stands(&looks, 3, ARGUS_KIND_WRONG, t + 1999));
    TEST_ASSERT_TRUE(argus_looks_stands(&looks, 3, ARGUS_KIND_WRONG, t + 2000));
    TEST_ASSERT_FALSE(argus_looks_stands(&looks, 3, ARGUS_KIND_NONE, t + 2000));
    TEST_ASSERT_FALSE(argus_looks_stands(&looks, 3, ARGUS_KIND_NONE, t + 9000)); // no name is none for ever
}

// Each pair of kinds; only a slow one that is wrong after all is withdrawn, until it is no suspect any more.
void test_only_slow_is_withdrawn_by_wrong(void) {
    for (int from = 0; from < ARGUS_KINDS; from++) {
        for (int to = 0; to < ARGUS_KINDS; to++) {
            setUp();
            argus_looks_rename(&looks, 4, (argus_fault_kind_t)from, (argus_fault_kind_t)to);
            const bool withdrawn = from == ARGUS_KIND_SLOW && to == ARGUS_KIND_WRONG;
            TEST_ASSERT_EQUAL(withdrawn, looks.hold[4].slow_withdrawn);
            argus_looks_rename(&looks, 4, ARGUS_KIND_WRONG, ARGUS_KIND_OFF);
            TEST_ASSERT_EQUAL(withdrawn, looks.hold[4].slow_withdrawn); // and stays so
            argus_looks_forget(&looks, 4);
            TEST_ASSERT_FALSE(looks.hold[4].slow_withdrawn);
        }
    }
}

// A robot that doubt stops loses 100 ms a SIP, one at half its speed 50: 9 s are a look.
void test_doubt_costs_what_it_loses(void) {
    static const struct {
        int32_t lost_mm_s;
        int sips;
    } rows[] = {{400, 90}, {200, 180}, {100, 360}};
    for (unsigned i = 0; i < 3; i++) {
        setUp();
        for (int sip = 1; sip <= rows[i].sips; sip++) {
            TEST_ASSERT_FALSE(argus_looks_cost(&looks));
            argus_looks_lose(&looks, rows[i].lost_mm_s, 400);
        }
        TEST_ASSERT_TRUE(argus_looks_cost(&looks));
        argus_looks_free(&looks);
        TEST_ASSERT_FALSE(argus_looks_cost(&looks));
    }
    looks.lost_ms = 9000;
    argus_looks_over(&looks);
    TEST_ASSERT_FALSE(argus_looks_cost(&looks));
}

void test_silence_ahead_is_said_once_a_session(void) {
    TEST_ASSERT_TRUE(argus_looks_unheard(&looks));
    TEST_ASSERT_FALSE(argus_looks_unheard(&looks));
    argus_looks_tried(&looks);
    TEST_ASSERT_TRUE(looks.tried);
    argus_looks_open(&looks);
    TEST_ASSERT_FALSE(looks.tried);
    TEST_ASSERT_TRUE(argus_looks_unheard(&looks));
}

void test_the_time_of_a_check_is_kept(void) {
    argus_looks_checked(&looks, 4711);
    TEST_ASSERT_EQUAL(4711, looks.check_ms);
}
