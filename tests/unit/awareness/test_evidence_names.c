// SPDX-License-Identifier: MIT
// Rule under attack (profile argus): a sonar is suspected, named and convicted by what its tests amount to
// and by no less; the more definite test gives the kind, and a name stays until its ground is gone.
#include "awareness/evidence.h"

#include <stdio.h>
#include <string.h>

#include "awareness/evidence_internal.h"
#include "unity.h"

#define SONAR 4
#define OTHER 9
#define LAG 5

static argus_evidence_t e;
static argus_case_t *c;
static argus_peer_t *peer;
static char text[160];

void setUp(void) {
    argus_evidence_init(&e);
    c = &e.of[SONAR];
    peer = &e.peers.of[SONAR];
}

static argus_fault_kind_t named(void) {
    return argus_evidence_names(&e, SONAR);
}

static argus_fault_kind_t convicted(void) {
    return argus_evidence_convicts(&e, SONAR);
}

// Conflicts with these partners, the last one last.
static void conflicts_with(const int8_t *partner, int count) {
    for (int i = 0; i < count; i++) {
        c->refuted[c->refuted_next].partner = partner[i];
        c->refuted_next = (uint8_t)((c->refuted_next + 1) % ARGUS_REFUTED);
    }
    c->conflicts = (uint8_t)(c->conflicts + count);
}

// All that a test needs beside its score, for a name and for a conviction.
static void give_ground(void) {
    static const int8_t partner[] = {1, 2, 3, 1, 2, 3};
    conflicts_with(partner, 6);
    c->episodes = 3;
    c->misses = 2;
    c->echoes = 8;
    peer->against = 3;
}

static void accuse(argus_test_t test, int score) {
    c->score[test] = (int16_t)score;
    c->none_run = test == ARGUS_TEST_OFF ? 5 : c->none_run;
    peer->told[LAG] = test == ARGUS_TEST_LAG ? 1 : peer->told[LAG];
}

static const struct {
    argus_test_t test;
    argus_fault_kind_t kind;
} by_precedence[ARGUS_TESTS] = {
    {ARGUS_TEST_OFF, ARGUS_KIND_OFF},
    {ARGUS_TEST_STUCK, ARGUS_KIND_STUCK},
    {ARGUS_TEST_LAG, ARGUS_KIND_SLOW},
    {ARGUS_TEST_GARBAGE, ARGUS_KIND_GARBAGE},
    {ARGUS_TEST_DROPOUT, ARGUS_KIND_INTERMITTENT},
    {ARGUS_TEST_VIEW, ARGUS_KIND_WRONG},
    {ARGUS_TEST_PEERS, ARGUS_KIND_WRONG},
};

// ---- what is needed

// Of a fresh sonar nothing is said at all.
void test_nothing_is_said_of_a_fresh_sonar(void) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        TEST_ASSERT_FALSE(argus_evidence_suspects(&e, i));
        TEST_ASSERT_FALSE(argus_evidence_holds(&e, i));
        TEST_ASSERT_FALSE(argus_evidence_is_unsteady(&e, i));
        TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_evidence_names(&e, i));
        TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_evidence_relapses(&e, i));
        TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_evidence_convicts(&e, i));
    }
}

// Each test names its kind from its own level on; what is said of one sonar is not said of another.
void test_each_test_names_its_kind_from_its_level_on(void) {
    for (int i = 0; i < ARGUS_TESTS; i++) {
        const argus_test_t test = by_precedence[i].test;
        for (int below = 0; below < 2; below++) {
            setUp();
            give_ground();
            accuse(test, argus_bounds[test].naming - below);
            snprintf(text, sizeof text, "test %d, %d below", (int)test, below);
            TEST_ASSERT_EQUAL_MESSAGE(below == 0 ? by_precedence[i].kind : ARGUS_KIND_NONE, named(), text);
            TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_NONE, argus_evidence_names(&e, OTHER), text);
        }
    }
}

// Readings that match nothing name garbage sooner where nothing moves, and convict no sooner; no test names
// sooner where something does.
void test_garbage_is_named_sooner_where_nothing_moves(void) {
    static const struct {
        int score;
        bool busy;
        argus_fault_kind_t named;
    } by[] = {{499, false, ARGUS_KIND_NONE},
              {500, false, ARGUS_KIND_GARBAGE},
              {649, true, ARGUS_KIND_NONE},
              {650, true, ARGUS_KIND_GARBAGE}};
    for (int i = 0; i < 4; i++) {
        setUp();
        accuse(ARGUS_TEST_GARBAGE, by[i].score);
        e.busy = by[i].busy;
        snprintf(text, sizeof text, "%d, busy %d", by[i].score, by[i].busy);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].named, named(), text);
        TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_NONE, convicted(), text);
    }
    for (int test = 0; test < ARGUS_TESTS; test++) {
        TEST_ASSERT_TRUE(argus_bounds[test].naming_busy >= argus_bounds[test].naming);
    }
}

// Each test convicts from its own level on, but the peers do not at any score.
void test_each_test_but_the_peers_convicts_from_its_level_on(void) {
    for (int i = 0; i < ARGUS_TESTS; i++) {
        const argus_test_t test = by_precedence[i].test;
        for (int below = 0; below < 2; below++) {
            setUp();
            give_ground();
            const bool peers = test == ARGUS_TEST_PEERS;
            accuse(test, (peers ? argus_bounds[test].ceiling : argus_bounds[test].convincing) - below);
            snprintf(text, sizeof text, "test %d, %d below", (int)test, below);
            TEST_ASSERT_EQUAL_MESSAGE(below == 0 && !peers ? by_precedence[i].kind : ARGUS_KIND_NONE,
                                      convicted(), text);
            TEST_ASSERT_EQUAL_MESSAGE(by_precedence[i].kind, named(), text);
        }
    }
    TEST_ASSERT_TRUE(argus_bounds[ARGUS_TEST_PEERS].ceiling < argus_bounds[ARGUS_TEST_PEERS].convincing);
}

// Where several tests name, the more definite one gives the kind; so it is with convictions.
void test_the_more_definite_test_gives_the_kind(void) {
    for (int first = 0; first < ARGUS_TESTS; first++) {
        setUp();
        give_ground();
        for (int i = first; i < ARGUS_TESTS; i++) {
            const argus_test_t test = by_precedence[i].test;
            accuse(test, argus_bounds[test].ceiling);
        }
        c->none_run = first == 0 ? 5 : 0;
        snprintf(text, sizeof text, "first %d", first);
        TEST_ASSERT_EQUAL_MESSAGE(by_precedence[first].kind, named(), text);
        const bool peers = by_precedence[first].test == ARGUS_TEST_PEERS;
        TEST_ASSERT_EQUAL_MESSAGE(peers ? ARGUS_KIND_NONE : by_precedence[first].kind, convicted(), text);
    }
}

// Off takes five readings in a row without an echo and a miss.
void test_off_takes_a_run_and_misses(void) {
    for (int run = 4; run <= 5; run++) {
        for (int misses = 0; misses <= 1; misses++) {
            setUp();
            give_ground();
            accuse(ARGUS_TEST_OFF, argus_bounds[ARGUS_TEST_OFF].ceiling);
            c->none_run = (uint8_t)run;
            c->misses = (uint8_t)misses;
            TEST_ASSERT_EQUAL(run == 5 && misses == 1 ? ARGUS_KIND_OFF : ARGUS_KIND_NONE, named());
            TEST_ASSERT_EQUAL(run == 5 && misses == 1 ? ARGUS_KIND_OFF : ARGUS_KIND_NONE, convicted());
        }
    }
}

static argus_fault_kind_t named_by_views(const int8_t *partner, int count) {
    setUp();
    c->score[ARGUS_TEST_VIEW] = argus_bounds[ARGUS_TEST_VIEW].naming;
    c->echoes = 8;
    conflicts_with(partner, count);
    return named();
}

// A view is one of a pair: who is wrong takes three conflicts, with two others.
void test_views_name_only_with_conflicts_with_two_others(void) {
    static const int8_t alone[] = {3, 3, 3, 3, 3, 3}, two[] = {3, 5, 3}, nobody[] = {-1, -1, -1, -1};
    static const int8_t scan[] = {ARGUS_SCAN_PARTNER, ARGUS_SCAN_PARTNER, ARGUS_SCAN_PARTNER};
    static const int8_t past[] = {5, 3, 3, 3, 3, 3, 3}, low[] = {0, 15, 0}, one[] = {-1, 3, -1};
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, named_by_views(alone, 6));
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, named_by_views(two, 2));
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, named_by_views(two, 3));
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, named_by_views(low, 3));
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, named_by_views(nobody, 4));
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, named_by_views(one, 3));
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, named_by_views(scan, 3)); // it stands for two
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, named_by_views(past, 6));
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, named_by_views(past, 7)); // the first is forgotten
}

// Who is wrong takes a third, among peers too.
void test_peers_name_only_with_two_others_against(void) {
    for (unsigned against = 0; against < 64; against++) {
        setUp();
        c->echoes = 8;
        c->score[ARGUS_TEST_PEERS] = argus_bounds[ARGUS_TEST_PEERS].ceiling;
        peer->against = (uint16_t)(against << 10);
        const bool two = (against & (against - 1)) != 0;
        snprintf(text, sizeof text, "against %04X", against << 10);
        TEST_ASSERT_EQUAL_MESSAGE(two ? ARGUS_KIND_WRONG : ARGUS_KIND_NONE, named(), text);
    }
}

// A view or a miss convicts again at other times, where nothing moves, against others than one liar beside.
void test_views_convict_only_with_ground_at_several_times(void) {
    static const int8_t main_of_six[] = {3, 3, 3, 3, 5, 6}, four[] = {1, 2, 3, 5};
    static const int8_t three[] = {1, 2, 3}, three_beside[] = {3, 5, 6, 3, 3, 7};
    static const int8_t scans[] = {ARGUS_SCAN_PARTNER, ARGUS_SCAN_PARTNER, ARGUS_SCAN_PARTNER,
                                   ARGUS_SCAN_PARTNER};
    static const int8_t scan[] = {3, 3, ARGUS_SCAN_PARTNER, ARGUS_SCAN_PARTNER, ARGUS_SCAN_PARTNER, 3};
    const struct {
        const int8_t *partner;
        int count;
        int episodes;
        int borne_out;
        bool busy;
        bool enough;     // for a view
        bool enough_off; // for silence: twice as many conflicts are enough
    } by[] = {{four, 4, 3, 0, false, true, true},           {four, 4, 2, 0, false, false, false},
              {three_beside, 6, 3, 2, false, true, true},   {three_beside, 6, 3, 3, false, false, true},
              {three_beside, 6, 3, 4, false, false, false}, {four, 4, 3, 0, true, false, false},
              {three, 3, 3, 0, false, false, false},        {main_of_six, 6, 3, 0, false, false, false},
              {three_beside, 6, 3, 0, false, true, true},   {scan, 6, 3, 0, false, true, true},
              {scans, 3, 3, 0, false, false, false},        {scans, 4, 3, 0, false, true, true}};
    static const argus_test_t tests[] = {ARGUS_TEST_VIEW, ARGUS_TEST_OFF};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        for (int t = 0; t < 2; t++) {
            setUp();
            conflicts_with(by[i].partner, by[i].count);
            c->episodes = (uint8_t)by[i].episodes;
            c->borne_out = (uint8_t)by[i].borne_out;
            c->misses = 4;
            c->echoes = 8;
            e.busy = by[i].busy;
            accuse(tests[t], argus_bounds[tests[t]].convincing);
            const argus_fault_kind_t kind = t == 0 ? ARGUS_KIND_WRONG : ARGUS_KIND_OFF;
            snprintf(text, sizeof text, "case %d, test %d", i, t);
            const bool enough = t == 0 ? by[i].enough : by[i].enough_off;
            TEST_ASSERT_EQUAL_MESSAGE(enough ? kind : ARGUS_KIND_NONE, convicted(), text);
            TEST_ASSERT_EQUAL_MESSAGE(kind, named(), text);
        }
    }
}

// Who walks away looks late: while something moves before others no lag convicts, but it names.
void test_no_lag_convicts_while_something_moves_beside(void) {
    for (int who = 0; who < ARGUS_SONARS; who++) {
        setUp();
        c->score[ARGUS_TEST_LAG] = argus_bounds[ARGUS_TEST_LAG].convincing;
        peer->told[LAG] = 1;
        e.stirred = (uint16_t)(1u << who);
        const bool beside = who != SONAR;
        TEST_ASSERT_EQUAL(beside ? ARGUS_KIND_NONE : ARGUS_KIND_SLOW, convicted());
        TEST_ASSERT_EQUAL(ARGUS_KIND_SLOW, named());
        TEST_ASSERT_EQUAL(beside, argus_evidence_is_unsteady(&e, SONAR));
    }
}

// No lag convicts by the own trail alone: the others must tell of one, however little.
void test_no_lag_convicts_of_which_the_others_do_not_tell(void) {
    for (int below = 0; below < 2; below++) {
        setUp();
        c->score[ARGUS_TEST_LAG] = argus_bounds[ARGUS_TEST_LAG].ceiling;
        peer->told[LAG] = (int16_t)(1 - below);
        TEST_ASSERT_EQUAL(below ? ARGUS_KIND_NONE : ARGUS_KIND_SLOW, convicted());
        TEST_ASSERT_EQUAL(ARGUS_KIND_SLOW, named());
    }
}

// Where the sonars contradict each other as they do among people, nobody is given up for what others saw, nor
// for a lag; the name stays, and the own trail convicts.
void test_in_a_crowd_neither_views_nor_lags_convict(void) {
    for (int i = 0; i < ARGUS_TESTS - 1; i++) {
        const argus_test_t test = by_precedence[i].test;
        const bool apart = test == ARGUS_TEST_VIEW || test == ARGUS_TEST_OFF || test == ARGUS_TEST_LAG;
        for (int crowded = 0; crowded < 2; crowded++) {
            setUp();
            give_ground();
            e.crowded = crowded != 0;
            accuse(test, argus_bounds[test].convincing);
            snprintf(text, sizeof text, "test %d, crowded %d", (int)test, crowded);
            TEST_ASSERT_EQUAL_MESSAGE(crowded && apart ? ARGUS_KIND_NONE : by_precedence[i].kind, convicted(),
                                      text);
            TEST_ASSERT_EQUAL_MESSAGE(by_precedence[i].kind, named(), text);
        }
    }
}

// Its own trail convicts whatever moves about and whoever bears it out (LAG does not, above).
void test_the_own_trail_convicts_without_others(void) {
    static const argus_test_t own[] = {ARGUS_TEST_STUCK, ARGUS_TEST_GARBAGE, ARGUS_TEST_DROPOUT};
    for (int i = 0; i < (int)(sizeof own / sizeof own[0]); i++) {
        setUp();
        e.busy = true;
        c->borne_out = 9;
        accuse(own[i], argus_bounds[own[i]].convincing);
        TEST_ASSERT_NOT_EQUAL(ARGUS_KIND_NONE, convicted());
    }
}

// ---- which kind

// Views: all echoes are wrong, gaps that its own trail shows intermittent, a run without an echo off.
void test_what_the_readings_look_like_tells_the_kind_of_a_view(void) {
    static const struct {
        int none_run;
        int echoes;
        int dropout;
        argus_fault_kind_t kind;
    } by[] = {
        {0, 6, 0, ARGUS_KIND_WRONG}, {0, 6, 1, ARGUS_KIND_WRONG},        {0, 5, 1, ARGUS_KIND_INTERMITTENT},
        {0, 5, 0, ARGUS_KIND_WRONG}, {1, 7, 1, ARGUS_KIND_INTERMITTENT}, {2, 0, 0, ARGUS_KIND_WRONG},
        {3, 0, 0, ARGUS_KIND_OFF},   {3, 0, 1, ARGUS_KIND_INTERMITTENT}, {3, 8, 0, ARGUS_KIND_OFF}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        setUp();
        give_ground();
        accuse(ARGUS_TEST_VIEW, argus_bounds[ARGUS_TEST_VIEW].naming);
        c->none_run = (uint8_t)by[i].none_run;
        c->echoes = (uint8_t)by[i].echoes;
        c->score[ARGUS_TEST_DROPOUT] = (int16_t)by[i].dropout;
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].kind, named(), text);
    }
}

// Gaps, too: its silences alone are contradicted, four of the last four, and an echo since was borne out.
void test_views_of_one_contradicted_for_its_silences_tell_of_gaps(void) {
    static const struct {
        unsigned hollow;
        bool borne_out;
        int none_run;
        argus_fault_kind_t kind;
    } by[] = {{0x0F, true, 0, ARGUS_KIND_INTERMITTENT}, {0x0F, true, 2, ARGUS_KIND_INTERMITTENT},
              {0x0F, true, 3, ARGUS_KIND_OFF},          {0x0F, false, 0, ARGUS_KIND_WRONG},
              {0x0E, true, 0, ARGUS_KIND_WRONG},        {0xF7, true, 2, ARGUS_KIND_WRONG}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        setUp();
        give_ground();
        accuse(ARGUS_TEST_VIEW, argus_bounds[ARGUS_TEST_VIEW].naming);
        peer->hollow = (uint8_t)by[i].hollow;
        peer->borne_out = by[i].borne_out;
        c->none_run = (uint8_t)by[i].none_run;
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].kind, named(), text);
    }
}

// Peers: off is who was silent the last three times that it was contradicted and is silent since five
// readings, twelve where an echo of it was borne out of late; otherwise its silence comes and goes.
void test_what_was_contradicted_tells_the_kind_of_the_peers(void) {
    static const struct {
        int none_run;
        unsigned hollow; // bit i: the one i before
        int dropout;
        bool borne_out;
        argus_fault_kind_t kind;
    } by[] = {
        {5, 0x07, 0, false, ARGUS_KIND_OFF},          {4, 0x07, 0, false, ARGUS_KIND_INTERMITTENT},
        {5, 0x07, 0, true, ARGUS_KIND_INTERMITTENT},  {5, 0x07, 1, false, ARGUS_KIND_OFF},
        {12, 0x07, 1, true, ARGUS_KIND_OFF},          {11, 0x07, 0, true, ARGUS_KIND_INTERMITTENT},
        {5, 0xFB, 0, false, ARGUS_KIND_WRONG},        {0, 0x01, 1, false, ARGUS_KIND_INTERMITTENT},
        {0, 0x04, 1, false, ARGUS_KIND_INTERMITTENT}, {0, 0x08, 1, false, ARGUS_KIND_WRONG},
        {0, 0x01, 0, true, ARGUS_KIND_WRONG},         {0, 0x00, 1, true, ARGUS_KIND_WRONG},
    };
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        setUp();
        accuse(ARGUS_TEST_PEERS, argus_bounds[ARGUS_TEST_PEERS].naming);
        peer->against = 3;
        peer->hollow = (uint8_t)by[i].hollow;
        peer->borne_out = by[i].borne_out;
        c->none_run = (uint8_t)by[i].none_run;
        c->score[ARGUS_TEST_DROPOUT] = (int16_t)by[i].dropout;
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].kind, named(), text);
    }
}

#define WAYS 3

// A lateness of so much, in each of its ways: what the peers say, what it shows itself, and some of each.
// Late and not well is none.
static void be_late(int way, int by) {
    memset(peer->late, 0, sizeof peer->late);
    memset(peer->told, 0, sizeof peer->told);
    c->score[ARGUS_TEST_LAG] = 0;
    peer->late[LAG] = 2000;
    switch (way) {
    case 0:
        peer->told[LAG] = (int16_t)by;
        break;
    case 1:
        c->score[ARGUS_TEST_LAG] = (int16_t)by;
        break;
    default:
        peer->told[LAG] = (int16_t)(by - 100);
        c->score[ARGUS_TEST_LAG] = 100;
        break;
    }
}

// What others contradict is late from 430 on, all that tells late from wrong taken together.
void test_late_is_told_from_wrong_by_all_that_speaks_for_it(void) {
    for (int way = 0; way < WAYS; way++) {
        for (int peers = 0; peers < 2; peers++) {
            setUp();
            give_ground();
            const argus_test_t test = peers != 0 ? ARGUS_TEST_PEERS : ARGUS_TEST_VIEW;
            accuse(test, argus_bounds[test].naming);
            snprintf(text, sizeof text, "way %d, peers %d", way, peers);
            be_late(way, 429);
            TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_WRONG, named(), text);
            be_late(way, 430);
            TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_SLOW, named(), text);
        }
    }
}

// Convicted by views, it takes more to be called late.
void test_a_conviction_tells_late_from_wrong_too(void) {
    give_ground();
    accuse(ARGUS_TEST_VIEW, argus_bounds[ARGUS_TEST_VIEW].convincing);
    be_late(0, 879);
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, convicted());
    be_late(0, 880);
    TEST_ASSERT_EQUAL(ARGUS_KIND_SLOW, convicted());
}

// ---- a bent axis

static void bend(int well, int told) {
    peer->bend[2] = (int16_t)well;
    peer->bend_told[2] = (int16_t)told;
}

// Bent and not well from 1,100 on (1,500 while something moves about before others), told of by 200,
// contradicted and by two, or from 600 on, told of by 500 and rather contradicted, while nothing moves:
// wrong, and worth a look; never a conviction.
void test_a_bent_axis_is_a_name_by_itself(void) {
    static const struct {
        int well;
        int told;
        int peers;
        unsigned against;
        bool busy;
        bool wrong;
    } by[] = {{1100, 200, 300, 3, false, true},  {1099, 499, 300, 3, false, false},
              {3000, 199, 300, 3, false, false}, {3000, 499, 299, 3, false, false},
              {600, 500, 0, 3, false, true},     {599, 900, 0, 3, false, false},
              {600, 499, 0, 3, false, false},    {3000, 900, -1, 3, false, false},
              {600, 500, 0, 1, false, false},    {600, 500, 0, 3, true, false},
              {3000, 900, 300, 1, false, false}, {1500, 200, 300, 3, true, true},
              {1499, 200, 300, 3, true, false}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        setUp();
        bend(by[i].well, by[i].told);
        peer->against = (uint16_t)by[i].against;
        c->score[ARGUS_TEST_PEERS] = (int16_t)by[i].peers;
        e.stirred = (uint16_t)(1u << SONAR | (by[i].busy ? 1u << (SONAR + 1) : 0u));
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].wrong ? ARGUS_KIND_WRONG : ARGUS_KIND_NONE, named(), text);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].wrong, argus_evidence_suspects(&e, SONAR), text);
        TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_NONE, convicted(), text);
    }
}

// One that is late, or silent more often than not, does not look bent.
void test_what_is_late_or_silent_does_not_look_bent(void) {
    static const struct {
        int late_told;
        uint8_t hollow;
        bool wrong;
    } by[] = {{399, 0x00, true}, {400, 0x00, false}, {0, 0x1F, true}, {0, 0x3F, false}};
    for (int i = 0; i < 4; i++) {
        setUp();
        bend(1100, 200);
        peer->told[LAG] = (int16_t)by[i].late_told;
        peer->hollow = by[i].hollow;
        peer->against = 3;
        c->score[ARGUS_TEST_PEERS] = 300;
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].wrong ? ARGUS_KIND_WRONG : ARGUS_KIND_NONE, named(), text);
    }
}

// What sticks and what is off is told by its readings: a bend says nothing of either.
void test_a_bend_takes_nothing_from_stuck_and_off(void) {
    static const argus_test_t tests[] = {ARGUS_TEST_STUCK, ARGUS_TEST_OFF};
    for (int t = 0; t < 2; t++) {
        setUp();
        give_ground();
        accuse(tests[t], argus_bounds[tests[t]].naming);
        bend(3000, 900);
        TEST_ASSERT_EQUAL(t == 0 ? ARGUS_KIND_STUCK : ARGUS_KIND_OFF, named());
    }
}

// ---- on probation

// What ends a probation is what names, but for what the peers alone say.
void test_a_relapse_ignores_the_peers(void) {
    for (int i = 0; i < ARGUS_TESTS; i++) {
        const argus_test_t test = by_precedence[i].test;
        const bool peers = test == ARGUS_TEST_PEERS;
        setUp();
        give_ground();
        accuse(ARGUS_TEST_PEERS, argus_bounds[ARGUS_TEST_PEERS].ceiling);
        peer->late[LAG] = 2000;
        peer->told[LAG] = 900;
        TEST_ASSERT_EQUAL(ARGUS_KIND_SLOW, named());
        TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_evidence_relapses(&e, SONAR));
        peer->late[LAG] = peer->told[LAG] = 0;
        accuse(test, argus_bounds[test].naming);
        snprintf(text, sizeof text, "test %d", (int)test);
        TEST_ASSERT_EQUAL_MESSAGE(peers ? ARGUS_KIND_NONE : by_precedence[i].kind,
                                  argus_evidence_relapses(&e, SONAR), text);
        TEST_ASSERT_EQUAL_MESSAGE(by_precedence[i].kind, named(), text);
    }
}

// Each test of its own and the views keep a sonar out from their first level on; the peers do not.
void test_the_peers_alone_keep_nobody_out(void) {
    for (int test = 0; test < ARGUS_TESTS; test++) {
        setUp();
        peer->late[LAG] = 2000;
        c->score[test] = argus_bounds[test].suspicious;
        snprintf(text, sizeof text, "test %d", test);
        TEST_ASSERT_EQUAL_MESSAGE(test != ARGUS_TEST_PEERS, argus_evidence_keeps_out(&e, SONAR), text);
        c->score[test] = (int16_t)(argus_bounds[test].suspicious - 1);
        TEST_ASSERT_FALSE_MESSAGE(argus_evidence_keeps_out(&e, SONAR), text);
    }
}

// ---- suspicions

// Each test suspects from its own level on, none below it.
void test_each_test_suspects_from_its_level_on(void) {
    for (int test = 0; test < ARGUS_TESTS; test++) {
        for (int below = 0; below < 2; below++) {
            setUp();
            c->score[test] = (int16_t)(argus_bounds[test].suspicious - below);
            snprintf(text, sizeof text, "test %d, %d below", test, below);
            TEST_ASSERT_EQUAL_MESSAGE(below == 0, argus_evidence_suspects(&e, SONAR), text);
            TEST_ASSERT_FALSE_MESSAGE(argus_evidence_suspects(&e, OTHER), text);
            TEST_ASSERT_EQUAL_MESSAGE(below == 0 || test == ARGUS_TEST_PEERS, argus_evidence_holds(&e, SONAR),
                                      text);
            TEST_ASSERT_FALSE_MESSAGE(argus_evidence_holds(&e, OTHER), text);
        }
    }
}

// A suspicion is held until what the peers say has come down to 150, below the level that raised it.
void test_a_suspicion_is_held_until_the_peers_have_nothing_left(void) {
    for (int level = 0; level <= 600; level++) {
        setUp();
        snprintf(text, sizeof text, "level %d", level);
        c->score[ARGUS_TEST_PEERS] = (int16_t)level;
        TEST_ASSERT_EQUAL_MESSAGE(level > 150, argus_evidence_holds(&e, SONAR), text);
        c->score[ARGUS_TEST_PEERS] = 0;
        peer->late[LAG] = (int16_t)level;
        TEST_ASSERT_EQUAL_MESSAGE(level > 150, argus_evidence_holds(&e, SONAR), text);
        peer->late[LAG] = 0;
        peer->told[LAG] = (int16_t)level; // of late or wrong, not of well
        TEST_ASSERT_FALSE_MESSAGE(argus_evidence_holds(&e, SONAR), text);
    }
}

// One that does not agree with itself is watched at rest, until that has convicted it.
void test_unsteady_is_who_is_suspected_by_its_own_readings_and_not_convicted(void) {
    for (int test = 0; test < ARGUS_TESTS; test++) {
        const bool own = test == ARGUS_TEST_GARBAGE || test == ARGUS_TEST_DROPOUT || test == ARGUS_TEST_LAG;
        const argus_bounds_t *bounds = &argus_bounds[test];
        const int scores[] = {bounds->suspicious - 1, bounds->suspicious, bounds->convincing - 1,
                              bounds->convincing};
        for (int i = 0; i < 4; i++) {
            setUp();
            accuse((argus_test_t)test, scores[i]);
            snprintf(text, sizeof text, "test %d at %d", test, scores[i]);
            TEST_ASSERT_EQUAL_MESSAGE(own && (i == 1 || i == 2), argus_evidence_is_unsteady(&e, SONAR), text);
        }
    }
}
