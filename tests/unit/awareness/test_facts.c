// SPDX-License-Identifier: MIT
// Rule under attack: a score takes what it is given by caution, more of what speaks for a sonar that is out,
// and never leaves its bounds; what explains nothing against a healthy one explains nothing at all.
#include "awareness/facts.h"

#include "awareness/numbers.h"
#include "scene.h"
#include "unity.h"

#define ME 3

static argus_knowledge_t k;
static argus_evidence_t e;

void setUp(void) {
    scene_blank(&k, &e);
}

static int16_t *score(const int test) {
    return &e.of[ME].score[test];
}

void test_caution_divides_what_is_added(void) {
    static const struct {
        uint16_t caution;
        int32_t adds, sum;
    } rows[] = {{100, 60, 60}, {200, 60, 30}, {50, 60, 120}, {400, 60, 15}, {25, 60, 240}, {100, 0, 0}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        for (int test = 0; test < ARGUS_TESTS; test++) {
            setUp();
            e.caution = rows[i].caution;
            argus_score(&e, ME, (argus_test_t)test, rows[i].adds);
            TEST_ASSERT_EQUAL(rows[i].sum, *score(test));
            TEST_ASSERT_EQUAL(0, e.of[ME + 1].score[test]);
        }
    }
}

// Only what speaks for it, and only of one that is out.
void test_what_speaks_for_one_that_is_out_counts_more(void) {
    for (int out = 0; out < 2; out++) {
        for (int32_t adds = -20; adds <= 20; adds += 20) {
            setUp();
            e.of[ME].out = out != 0;
            *score(ARGUS_TEST_PEERS) = 500;
            argus_score(&e, ME, ARGUS_TEST_PEERS, adds);
            const int32_t times = out != 0 && adds < 0 ? ARGUS_OUT_TIMES : 1;
            TEST_ASSERT_EQUAL(500 + times * adds, *score(ARGUS_TEST_PEERS));
        }
    }
}

void test_a_score_ends_at_its_bounds(void) {
    for (int test = 0; test < ARGUS_TESTS; test++) {
        setUp();
        *score(test) = ARGUS_CEILING - 1;
        argus_score(&e, ME, (argus_test_t)test, 1);
        TEST_ASSERT_EQUAL(ARGUS_CEILING, *score(test));
        argus_score(&e, ME, (argus_test_t)test, 1);
        TEST_ASSERT_EQUAL(ARGUS_CEILING, *score(test));
        *score(test) = (int16_t)(argus_bounds[test].floor + 1);
        argus_score(&e, ME, (argus_test_t)test, -1);
        TEST_ASSERT_EQUAL(argus_bounds[test].floor, *score(test));
        argus_score(&e, ME, (argus_test_t)test, -1);
        TEST_ASSERT_EQUAL(argus_bounds[test].floor, *score(test));
    }
}

static const argus_hypothesis_t *after(const int32_t healthy, const int32_t other, const int32_t add_healthy,
                                       const int32_t add_other) {
    argus_hypothesis_t *const d = &e.of[ME].hypothesis[1];
    *d = (argus_hypothesis_t){(int16_t)healthy, (int16_t)other};
    argus_hypothesis_add(&e, ME, 1, add_healthy, add_other);
    return d;
}

void test_a_hypothesis_holds_against_other_faults_while_it_holds_against_healthy(void) {
    static const int32_t rows[][6] = {
        // before, added, after: against healthy, against other faults
        {0, 0, 100, 50, 100, 50},  {0, 0, 1, 50, 1, 50},
        {0, 0, 0, 50, 0, 0},       {100, 60, -99, 5, 1, 65},
        {100, 60, -100, 5, 0, 0},  {100, 60, -101, 5, 0, 0},
        {100, 60, 5, -60, 105, 0}, {100, 60, 5, -61, 105, 0},
        {100, 60, 5, -59, 105, 1}, {ARGUS_CEILING, ARGUS_CEILING - 1, 1, 2, ARGUS_CEILING, ARGUS_CEILING},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        const argus_hypothesis_t *const d = after(rows[i][0], rows[i][1], rows[i][2], rows[i][3]);
        TEST_ASSERT_EQUAL(rows[i][4], d->over_healthy);
        TEST_ASSERT_EQUAL(rows[i][5], d->over_other);
    }
}

// Both sums are taken by caution.
void test_caution_divides_what_a_hypothesis_gains(void) {
    e.caution = 200;
    const argus_hypothesis_t *const d = after(0, 0, 100, 60);
    TEST_ASSERT_EQUAL(50, d->over_healthy);
    TEST_ASSERT_EQUAL(30, d->over_other);
}
