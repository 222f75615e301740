// SPDX-License-Identifier: MIT
// Rule under attack: something that moved before a sonar is unrest for the others, for a while, and for none
// once that one is out; among people the sonars contradict each other, and it takes a while to be calm again.
#include "awareness/clutter.h"

#include "awareness/numbers.h"
#include "awareness/odds.h"
#include "health.h"
#include "scene.h"
#include "unity.h"

static argus_knowledge_t k;
static argus_evidence_t e;

void setUp(void) {
    scene_blank(&k, &e);
}

void test_what_moved_is_beside_the_others_for_so_long(void) {
    const uint32_t moved_ms = UINT32_MAX - 100; // the clock wraps
    k.sip_ms = moved_ms;
    argus_clutter_note(&e, &k, 5);
    static const uint32_t spans_ms[] = {1, 200, ARGUS_UNREST_MS, ARGUS_CALM_MS};
    for (unsigned i = 0; i < sizeof spans_ms / sizeof spans_ms[0]; i++) {
        for (int but = -1; but < 8; but++) {
            k.sip_ms = moved_ms + spans_ms[i] - 1;
            TEST_ASSERT_EQUAL(but != 5, argus_clutter_beside(&e, &k, but, spans_ms[i]));
            k.sip_ms = moved_ms + spans_ms[i];
            TEST_ASSERT_FALSE(argus_clutter_beside(&e, &k, but, spans_ms[i]));
        }
    }
    TEST_ASSERT_FALSE(argus_clutter_beside(&e, &k, -1, 0));
}

void test_one_that_is_out_shows_no_unrest(void) {
    argus_clutter_note(&e, &k, 5);
    TEST_ASSERT_TRUE(argus_clutter_beside(&e, &k, -1, 1000));
    put_health(&k.sonar[5], ARGUS_DISABLED, ARGUS_KIND_GARBAGE, 0);
    TEST_ASSERT_FALSE(argus_clutter_beside(&e, &k, -1, 1000));
}

void test_unrest_ends(void) {
    argus_clutter_note(&e, &k, 5);
    const uint32_t moved_ms = k.sip_ms;
    argus_clutter_sip(&e, &k);
    TEST_ASSERT_TRUE(e.busy);
    k.sip_ms = moved_ms + ARGUS_CALM_MS - 1;
    argus_clutter_sip(&e, &k);
    TEST_ASSERT_TRUE(e.busy);
    TEST_ASSERT_TRUE(e.of[5].moved);
    k.sip_ms = moved_ms + ARGUS_CALM_MS;
    argus_clutter_sip(&e, &k);
    TEST_ASSERT_FALSE(e.busy);
    TEST_ASSERT_FALSE(e.of[5].moved);
    k.sip_ms = moved_ms; // it does not come back as the clock comes round
    argus_clutter_sip(&e, &k);
    TEST_ASSERT_FALSE(e.busy);
}

static void contradict(const uint16_t odd) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        e.of[i].rate[ARGUS_TEST_PEERS] = (argus_rate_t){1600, odd};
    }
}

// Each rate: a crowd is one above the permille, and it lasts so long after the last one.
void test_sonars_that_contradict_each_other_are_in_a_crowd(void) {
    int crowds = 0;
    for (uint16_t odd = 0; odd <= 1600; odd++) {
        setUp();
        contradict(odd);
        argus_clutter_sip(&e, &k);
        const bool crowded = argus_odds_common_permille(&e, &k, ARGUS_TEST_PEERS) > ARGUS_CROWD_PERMILLE;
        TEST_ASSERT_EQUAL(crowded, e.crowded);
        TEST_ASSERT_EQUAL(crowded, e.busy);
        crowds += crowded ? 1 : 0;
    }
    TEST_ASSERT_TRUE(crowds > 0 && crowds < 1600);
    const uint32_t last_ms = k.sip_ms;
    contradict(0);
    k.sip_ms = last_ms + ARGUS_CALM_MS - 1;
    argus_clutter_sip(&e, &k);
    TEST_ASSERT_TRUE(e.busy);
    k.sip_ms = last_ms + ARGUS_CALM_MS;
    argus_clutter_sip(&e, &k);
    TEST_ASSERT_FALSE(e.crowded);
    TEST_ASSERT_FALSE(e.busy);
}
