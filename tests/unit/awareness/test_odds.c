// SPDX-License-Identifier: MIT
// Rule under attack: what is odd in the readings of one sonar counts against it by how rarely all the others
// in use read as oddly, and by nothing that it, or one that is out, read itself.
#include "awareness/odds.h"

#include <math.h>
#include <string.h>

#include "awareness/numbers.h"
#include "robot/robot.h"
#include "unity.h"

#define ME 3

static argus_evidence_t e;
static argus_knowledge_t k;

void setUp(void) {
    argus_evidence_t *const self = &e;
    memset(self, 0, sizeof *self);
    memset(&k, 0, sizeof k);
    k.robot = argus_robot_default();
    k.sonars = ARGUS_SONARS < 16 ? ARGUS_SONARS : 16;
    for (int i = 0; i < k.sonars; i++) {
        k.sonar[i].health = ARGUS_HEALTHY;
    }
}

static void note(int sonar, argus_test_t test, int odd, int even) {
    for (int i = 0; i < odd + even; i++) {
        argus_odds_note(&e, sonar, test, i < odd);
    }
}

static int worth(argus_test_t test, bool odd) {
    return argus_odds_of(&e, &k, ME, test, odd);
}

void test_the_logarithm_is_one(void) {
    for (int32_t n = 1; n < 100000; n += 1 + n / 40) {
        TEST_ASSERT_INT_WITHIN(8 + n / 10000, lround(100 * log(n)), argus_ln(n));
    }
    for (int32_t n = 1; n < 3000; n++) {
        TEST_ASSERT_TRUE(argus_ln(n + 1) >= argus_ln(n));
    }
}

void test_the_oftener_all_others_read_oddly_the_less_it_says(void) {
    for (int test = 0; test < ARGUS_TESTS; test++) {
        int before = INT16_MAX;
        int first = 0;
        for (int odd = 0; odd <= 100; odd += 5) {
            setUp();
            note(5, (argus_test_t)test, odd, 100 - odd);
            const int now = worth((argus_test_t)test, true);
            first = odd == 0 ? now : first;
            TEST_ASSERT_TRUE(now > 0 && now <= before);
            TEST_ASSERT_TRUE(worth((argus_test_t)test, false) <= 0);
            before = now;
        }
        TEST_ASSERT_TRUE(before < first / 2);
    }
}

void test_neither_its_own_readings_count_nor_those_of_who_is_out(void) {
    const int usual = worth(ARGUS_TEST_DROPOUT, true);
    note(ME, ARGUS_TEST_DROPOUT, 60, 40);
    TEST_ASSERT_EQUAL(usual, worth(ARGUS_TEST_DROPOUT, true));
    note(5, ARGUS_TEST_DROPOUT, 60, 40);
    TEST_ASSERT_TRUE(worth(ARGUS_TEST_DROPOUT, true) < usual);
    k.sonar[5].health = ARGUS_DISABLED;
    TEST_ASSERT_EQUAL(usual, worth(ARGUS_TEST_DROPOUT, true));
    TEST_ASSERT_TRUE(argus_odds_permille(&e, &k, -1, ARGUS_TEST_DROPOUT) > 400);
}

void test_another_test_is_another_rate(void) {
    const int usual = worth(ARGUS_TEST_GARBAGE, true);
    note(5, ARGUS_TEST_STUCK, 100, 0);
    TEST_ASSERT_EQUAL(usual, worth(ARGUS_TEST_GARBAGE, true));
}

// One value that changes ends what repeated.
void test_what_its_fault_cannot_read_is_enough(void) {
    TEST_ASSERT_EQUAL(-ARGUS_CEILING, worth(ARGUS_TEST_STUCK, false));
}

void test_what_was_odd_is_forgotten(void) {
    const int usual = worth(ARGUS_TEST_PEERS, true);
    note(5, ARGUS_TEST_PEERS, 80, 20);
    TEST_ASSERT_TRUE(worth(ARGUS_TEST_PEERS, true) < usual / 2);
    for (int seconds = 0; seconds < 60; seconds++) {
        argus_odds_fade(&e);
    }
    TEST_ASSERT_INT_WITHIN(usual / 10, usual, worth(ARGUS_TEST_PEERS, true));
}

// The oftener a sonar was silent where others heard something, and heard again, the less its silence says;
// one of which little is known is as all are; and one that is not heard again stays as it was: it may be
// dead.
void test_the_deafer_a_sonar_the_less_its_silence_says(void) {
    int before = argus_odds_deaf_permille(&e, ME);
    for (int silent = 1; silent <= 4; silent++) {
        setUp();
        for (int i = 0; i < 50 * (silent + 1); i++) {
            argus_odds_note_deaf(&e, ME, i % (silent + 1) != silent);
        }
        const int deaf = argus_odds_deaf_permille(&e, ME);
        TEST_ASSERT_TRUE(deaf > before);
        TEST_ASSERT_INT_WITHIN(50, 1000 * silent / (silent + 1), deaf);
        TEST_ASSERT_TRUE(argus_odds_deaf_permille(&e, 5) > 90);
        TEST_ASSERT_TRUE(argus_odds_where(&e, &k, ME, ARGUS_TEST_PEERS, true, deaf) <=
                         argus_odds_where(&e, &k, ME, ARGUS_TEST_PEERS, true, before));
        before = deaf;
    }
    TEST_ASSERT_TRUE(argus_odds_where(&e, &k, ME, ARGUS_TEST_PEERS, true, before) <
                     worth(ARGUS_TEST_PEERS, true) / 2);
    for (int i = 0; i < 100; i++) {
        argus_odds_note_deaf(&e, ME, true);
    }
    TEST_ASSERT_EQUAL(before, argus_odds_deaf_permille(&e, ME));
}

// Sonars differ: a dozen readings of its own outweigh those of all others.
void test_its_own_readings_outweigh_those_of_the_ring(void) {
    for (int i = 0; i < 400; i++) {
        argus_odds_note_deaf(&e, 5, i % 10 == 0);
    }
    TEST_ASSERT_TRUE(argus_odds_deaf_permille(&e, ME) < 130);
    for (int i = 0; i < 12; i++) {
        argus_odds_note_deaf(&e, ME, i % 2 == 0);
    }
    TEST_ASSERT_TRUE(argus_odds_deaf_permille(&e, ME) > 380);
}

// What is known of it fades, and an hour of silences cannot overflow it.
void test_deafness_fades_and_does_not_overflow(void) {
    for (int i = 0; i < 20000; i++) {
        argus_odds_note_deaf(&e, ME, i % 9 != 8);
    }
    const int deaf = argus_odds_deaf_permille(&e, ME);
    TEST_ASSERT_TRUE(deaf >= 0 && deaf <= 1000);
    for (int s = 0; s < 3600; s++) {
        argus_odds_fade(&e);
    }
    TEST_ASSERT_TRUE(argus_odds_deaf_permille(&e, ME) <= deaf);
    TEST_ASSERT_TRUE(e.deaf[ME].all < 120 * ARGUS_RATE_ONE);
}

// Of one that nothing is known of, as often as is taken for granted.
void test_a_fresh_sonar_is_as_deaf_as_is_taken_for_granted(void) {
    TEST_ASSERT_EQUAL_INT32(1000 / ARGUS_DEAF_EARLIER, argus_odds_deaf_permille(&e, ME));
    for (int i = 0; i < 20; i++) { // others hear all
        argus_odds_note_deaf(&e, 5, false);
    }
    const int32_t less = argus_odds_deaf_permille(&e, ME);
    TEST_ASSERT_TRUE(less > 0 && less < 1000 / ARGUS_DEAF_EARLIER);
}
