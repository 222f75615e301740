// SPDX-License-Identifier: MIT
// Rule: one finding tells all of a sonar: each level holds what those before it do, and what is certain comes
// first.
#include "awareness/finding.h"

#include <stdio.h>
#include <unity.h>

#define SONAR 3
#define SEEDS 20000u

static argus_evidence_t evidence;
static argus_extremes_t extremes;
static argus_common_t common;

void setUp(void) {
    argus_evidence_init(&evidence);
    argus_extremes_init(&extremes);
    argus_common_init(&common);
}

static argus_finding_t find(void) {
    return argus_finding(&evidence, &extremes, &common, SONAR);
}

void test_nothing_is_found_of_a_sonar_that_nothing_is_known_of(void) {
    const argus_finding_t finding = find();
    TEST_ASSERT_EQUAL(ARGUS_FOUND_NONE, finding.level);
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, finding.kind);
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, finding.named);
    TEST_ASSERT_FALSE(finding.doubted || finding.excused || finding.keeps_out);
}

void test_an_outage_of_the_array_is_certain_and_comes_before_all(void) {
    extremes.of[SONAR].proved = true;
    TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, find().kind);
    common.of[0] = (argus_dark_t){.sonars = 0xFF, .doubted = true};
    TEST_ASSERT_TRUE(find().doubted);
    TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, find().kind);
    common.of[0].proven = true;
    TEST_ASSERT_EQUAL(ARGUS_KIND_OFF, find().kind);
    TEST_ASSERT_EQUAL(ARGUS_FOUND_CERTAIN, find().level);
    TEST_ASSERT_TRUE(find().keeps_out);
}

void test_another_array_that_may_have_failed_excuses_it(void) {
    common.of[1] = (argus_dark_t){.sonars = 0xFF00};
    TEST_ASSERT_TRUE(find().excused);
    common.of[1].proven = true;
    TEST_ASSERT_FALSE(find().excused);
}

void test_range_limits_keep_out_before_they_convict(void) {
    extremes.of[SONAR].level = ARGUS_IMPOSSIBLE_CONVICTS / 2 + 1;
    TEST_ASSERT_TRUE(find().keeps_out);
    TEST_ASSERT_EQUAL(ARGUS_FOUND_NONE, find().level);
}

static uint32_t state;

static int32_t upto(const int32_t most) {
    state = state * 1664525u + 1013904223u;
    return (int32_t)(state >> 8) % most;
}

static void scatter(argus_case_t *const c) {
    for (int i = 0; i < ARGUS_TESTS; i++) {
        c->score[i] = (int16_t)upto(2000);
    }
    for (int i = 0; i < ARGUS_HYPOTHESES; i++) {
        c->hypothesis[i] = (argus_hypothesis_t){(int16_t)(upto(3000) - 1000), (int16_t)(upto(3000) - 1000)};
    }
    c->against = (argus_mask_t)(upto(1 << 16) & ~(1 << SONAR));
    c->episodes = (uint8_t)upto(4);
    c->borne_out = upto(2) != 0;
}

void test_each_level_holds_what_those_before_it_do(void) {
    int seen[ARGUS_FOUND_CERTAIN + 1] = {0};
    for (uint32_t seed = 0; seed < SEEDS; seed++) {
        char text[40];
        (void)snprintf(text, sizeof text, "seed %u", (unsigned)seed);
        state = seed;
        setUp();
        scatter(&evidence.of[SONAR]);
        const argus_finding_t found = find();
        seen[found.level]++;
        TEST_ASSERT_EQUAL_MESSAGE(argus_evidence_convicts(&evidence, SONAR), found.kind, text);
        TEST_ASSERT_EQUAL_MESSAGE(argus_evidence_names(&evidence, SONAR), found.named, text);
        TEST_ASSERT_EQUAL_MESSAGE(found.level >= ARGUS_FOUND_CONVICTED, found.kind != ARGUS_KIND_NONE, text);
        if (found.level < ARGUS_FOUND_CONVICTED) {
            const bool suspect = argus_evidence_suspects(&evidence, SONAR);
            const bool held = argus_evidence_holds(&evidence, SONAR);
            TEST_ASSERT_EQUAL_MESSAGE(found.level >= ARGUS_FOUND_SUSPECT, suspect, text);
            TEST_ASSERT_EQUAL_MESSAGE(found.level >= ARGUS_FOUND_HELD, held, text);
            TEST_ASSERT_EQUAL_MESSAGE(found.level == ARGUS_FOUND_NAMED, found.named != ARGUS_KIND_NONE, text);
        }
    }
    TEST_ASSERT_TRUE_MESSAGE(seen[ARGUS_FOUND_NAMED] > 0 && seen[ARGUS_FOUND_CONVICTED] > 0,
                             "both were made");
}
