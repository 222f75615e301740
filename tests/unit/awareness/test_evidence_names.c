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
#define KINDS 8

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

static bool replaces(argus_fault_kind_t present, argus_fault_kind_t found) {
    return argus_evidence_replaces(&e, SONAR, present, found);
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
        peer->late[LAG] = 300; // the peers know of a lag
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

// Late and not well from 800 on, 1,400 while something moves before others, names one that others contradict,
// 300 (100 of one that is later by 400) and by two, where it is late and not wrong as well.
void test_lateness_alone_names_only_one_that_others_contradict(void) {
    static const struct {
        int late;
        int peers;
        unsigned against;
        int told;
        bool busy;
        argus_fault_kind_t kind;
    } by[] = {{800, 300, 3, 430, false, ARGUS_KIND_SLOW},  {799, 300, 3, 900, false, ARGUS_KIND_NONE},
              {800, 299, 3, 900, false, ARGUS_KIND_NONE},  {800, 300, 1, 900, false, ARGUS_KIND_NONE},
              {800, 300, 3, 429, false, ARGUS_KIND_NONE},  {1400, 300, 3, 430, true, ARGUS_KIND_SLOW},
              {1399, 449, 3, 900, true, ARGUS_KIND_NONE},  {1400, 450, 3, 430, true, ARGUS_KIND_SLOW},
              {799, 450, 3, 900, false, ARGUS_KIND_NONE},  {2000, 99, 3, 900, false, ARGUS_KIND_NONE},
              {1199, 299, 3, 900, false, ARGUS_KIND_NONE}, {1200, 100, 3, 430, false, ARGUS_KIND_SLOW},
              {1799, 299, 3, 900, true, ARGUS_KIND_NONE},  {1800, 100, 3, 430, true, ARGUS_KIND_SLOW}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        setUp();
        peer->late[LAG] = (int16_t)by[i].late;
        peer->told[LAG] = (int16_t)by[i].told;
        peer->against = (uint16_t)by[i].against;
        c->score[ARGUS_TEST_PEERS] = (int16_t)by[i].peers;
        e.busy = true;
        e.stirred = (uint16_t)(1u << SONAR | (by[i].busy ? 1u << (SONAR + 1) : 0u));
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].kind, named(), text);
        TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_NONE, convicted(), text);
        const bool late = by[i].kind == ARGUS_KIND_SLOW || by[i].against == 1; // by one: a look, no name
        TEST_ASSERT_EQUAL_MESSAGE(by[i].peers >= 450 || late, argus_evidence_suspects(&e, SONAR), text);
    }
}

// Who has heard nothing eight times in a row, and was contradicted for a silence the last two times, is off,
// whatever an echo before that made of it.
void test_who_hears_nothing_is_neither_late_nor_wrong(void) {
    static const struct {
        int run;
        unsigned hollow; // bit i: the one i before
        bool deaf;
    } by[] = {{8, 0x03, true}, {7, 0x03, false}, {8, 0x02, false}, {8, 0x01, false}, {255, 0xFB, true}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        for (int late = 0; late < 2; late++) {
            setUp();
            peer->hollow = (uint8_t)by[i].hollow;
            peer->against = 3;
            c->none_run = (uint8_t)by[i].run;
            accuse(ARGUS_TEST_PEERS, argus_bounds[ARGUS_TEST_PEERS].naming);
            be_late(0, late != 0 ? 430 : 0);
            snprintf(text, sizeof text, "case %d, late %d", i, late);
            const argus_fault_kind_t other = late != 0 ? ARGUS_KIND_SLOW : ARGUS_KIND_WRONG;
            TEST_ASSERT_EQUAL_MESSAGE(by[i].deaf ? ARGUS_KIND_OFF : other, named(), text);
        }
    }
}

// It followed an echo and has heard none four times in a row: one other that hears something there, since, is
// enough.
void test_a_lost_echo_and_one_voice_are_off(void) {
    static const struct {
        bool followed;
        int run;
        int peers;
        int reading_mm; // that was contradicted last,
        int since_ms;   // ... so long after the last echo
        bool borne_out;
        bool busy;
        argus_fault_kind_t kind;
    } by[] = {{true, 4, 200, 5000, 1, false, false, ARGUS_KIND_OFF},
              {false, 4, 200, 5000, 1, false, false, ARGUS_KIND_NONE},
              {true, 3, 200, 5000, 1, false, false, ARGUS_KIND_NONE},
              {true, 4, 199, 5000, 1, false, false, ARGUS_KIND_NONE},
              {true, 4, 200, 4999, 1, false, false, ARGUS_KIND_NONE},
              {true, 4, 200, 5000, 0, false, false, ARGUS_KIND_NONE},
              {true, 4, 200, 5000, -900, false, false, ARGUS_KIND_NONE}, // in another silence
              {true, 4, 200, 5000, 1, true, false, ARGUS_KIND_NONE},
              {true, 4, 200, 5000, 1, false, true, ARGUS_KIND_NONE}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        for (int next = 0; next < ARGUS_COUNTED; next++) {
            setUp();
            c->followed = by[i].followed;
            c->none_run = (uint8_t)by[i].run;
            c->score[ARGUS_TEST_PEERS] = (int16_t)by[i].peers;
            c->alive_ms = UINT32_MAX; // the clock wraps then
            peer->counted_next = (uint8_t)next;
            argus_glimpse_t *const last = &peer->counted[(next + ARGUS_COUNTED - 1) % ARGUS_COUNTED];
            last->t_ms = c->alive_ms + (uint32_t)by[i].since_ms;
            last->reading_mm = (uint16_t)by[i].reading_mm;
            peer->against = 1;
            peer->borne_out = by[i].borne_out;
            e.stirred = (uint16_t)(1u << SONAR | (by[i].busy ? 1u << OTHER : 0u));
            snprintf(text, sizeof text, "case %d, next %d", i, next);
            TEST_ASSERT_EQUAL_MESSAGE(by[i].kind, named(), text);
            TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_NONE, convicted(), text);
            peer->counted_next = (uint8_t)((next + 1) % ARGUS_COUNTED); // an echo was judged since
            peer->counted[next].t_ms = last->t_ms - 20000;
            peer->counted[next].reading_mm = 1000;
            TEST_ASSERT_EQUAL_MESSAGE(by[i].kind, named(), text);
        }
    }
}

// Of one lag, its own readings (300 at least) and the peers together: 1,000, or 1,300 while something moves
// before others, name it where the others do not bear it out; whoever they are, it needs no second of them.
// From 1,450 on, 150 of its own are enough; where the others contradict it (200) and nothing moves, 850.
void test_its_own_readings_and_the_peers_name_together(void) {
    static const struct {
        int own;
        int late;
        int late_other; // of the next lag
        int peers;
        bool busy;
        argus_fault_kind_t kind;
    } by[] = {{300, 700, 0, 0, false, ARGUS_KIND_SLOW},    {299, 1150, 0, 0, false, ARGUS_KIND_NONE},
              {300, 699, 0, 0, false, ARGUS_KIND_NONE},    {300, 700, 0, -1, false, ARGUS_KIND_NONE},
              {300, 0, 700, 0, false, ARGUS_KIND_NONE},    {700, 599, 0, 0, true, ARGUS_KIND_NONE},
              {700, 600, 0, 0, true, ARGUS_KIND_SLOW},     {899, 0, 0, 0, false, ARGUS_KIND_NONE},
              {899, 101, 0, 0, false, ARGUS_KIND_SLOW},    {150, 1300, 0, 0, false, ARGUS_KIND_SLOW},
              {150, 1299, 0, 0, false, ARGUS_KIND_NONE},   {149, 2000, 0, 0, false, ARGUS_KIND_NONE},
              {150, 1300, 0, 0, true, ARGUS_KIND_SLOW},    {299, 1151, 0, 0, false, ARGUS_KIND_SLOW},
              {150, 700, 1300, 0, false, ARGUS_KIND_NONE}, {300, 550, 0, 200, false, ARGUS_KIND_SLOW},
              {300, 549, 0, 200, false, ARGUS_KIND_NONE},  {300, 550, 0, 199, false, ARGUS_KIND_NONE},
              {300, 550, 0, 200, true, ARGUS_KIND_NONE},   {299, 700, 0, 200, false, ARGUS_KIND_NONE}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        setUp();
        c->lag[LAG] = (int16_t)by[i].own;
        c->score[ARGUS_TEST_LAG] = (int16_t)by[i].own;
        peer->late[LAG] = (int16_t)by[i].late;
        peer->late[LAG + 1] = (int16_t)by[i].late_other;
        c->score[ARGUS_TEST_PEERS] = (int16_t)by[i].peers;
        e.stirred = (uint16_t)(1u << SONAR | (by[i].busy ? 1u << OTHER : 0u));
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].kind, named(), text);
        TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_NONE, convicted(), text);
        const bool suspect =
            by[i].kind == ARGUS_KIND_SLOW || by[i].own >= argus_bounds[ARGUS_TEST_LAG].suspicious;
        TEST_ASSERT_EQUAL_MESSAGE(suspect, argus_evidence_suspects(&e, SONAR), text);
    }
}

// The echoes of a late sonar look like gaps or like garbage at times: late and not well from 1,000 on, late
// and not wrong, contradicted and by two, it is slow, in a conviction too.
void test_late_for_sure_is_neither_garbage_nor_gaps(void) {
    static const argus_test_t tests[] = {ARGUS_TEST_GARBAGE, ARGUS_TEST_DROPOUT, ARGUS_TEST_VIEW};
    static const argus_fault_kind_t kinds[] = {ARGUS_KIND_GARBAGE, ARGUS_KIND_INTERMITTENT,
                                               ARGUS_KIND_INTERMITTENT};
    static const struct {
        int late;
        int told;
        int peers;
        unsigned against;
        bool slow;
    } by[] = {{1000, 430, 300, 3, true},  {999, 900, 300, 3, false}, {2000, 429, 300, 3, false},
              {1399, 900, 299, 3, false}, {1400, 430, 100, 3, true}, {2000, 900, 99, 3, false},
              {2000, 900, 300, 1, false}};
    for (int t = 0; t < 3; t++) {
        for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
            setUp();
            give_ground();
            peer->hollow = 0x0F; // so that a view tells of gaps
            peer->borne_out = true;
            accuse(tests[t], argus_bounds[tests[t]].naming);
            peer->late[LAG] = (int16_t)by[i].late;
            peer->told[LAG] = (int16_t)by[i].told;
            peer->against = (uint16_t)by[i].against;
            c->score[ARGUS_TEST_PEERS] = (int16_t)by[i].peers;
            snprintf(text, sizeof text, "test %d, case %d", (int)tests[t], i);
            TEST_ASSERT_EQUAL_MESSAGE(by[i].slow ? ARGUS_KIND_SLOW : kinds[t], named(), text);
            accuse(tests[t], argus_bounds[tests[t]].convincing);
            TEST_ASSERT_EQUAL_MESSAGE(by[i].slow ? ARGUS_KIND_SLOW : kinds[t], convicted(), text);
        }
    }
}

// ... and so it is by its own readings (300) and the peers together from 1,200 on, not borne out, whatever it
// was called before.
void test_late_by_both_is_neither_garbage_nor_gaps(void) {
    static const argus_test_t tests[] = {ARGUS_TEST_GARBAGE, ARGUS_TEST_DROPOUT};
    static const argus_fault_kind_t kinds[] = {ARGUS_KIND_GARBAGE, ARGUS_KIND_INTERMITTENT};
    static const struct {
        int own;
        int late;
        int peers;
        bool slow;
    } by[] = {{300, 900, 0, true}, {300, 899, 0, false}, {299, 1100, 0, false}, {300, 900, -1, false}};
    for (int t = 0; t < 2; t++) {
        for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
            setUp();
            accuse(tests[t], argus_bounds[tests[t]].convincing);
            c->lag[LAG] = c->score[ARGUS_TEST_LAG] = (int16_t)by[i].own;
            peer->late[LAG] = (int16_t)by[i].late;
            c->score[ARGUS_TEST_PEERS] = (int16_t)by[i].peers;
            snprintf(text, sizeof text, "test %d, case %d", (int)tests[t], i);
            TEST_ASSERT_EQUAL_MESSAGE(by[i].slow ? ARGUS_KIND_SLOW : kinds[t], named(), text);
            TEST_ASSERT_EQUAL_MESSAGE(by[i].slow ? ARGUS_KIND_SLOW : kinds[t], convicted(), text);
            TEST_ASSERT_EQUAL_MESSAGE(by[i].slow, replaces(kinds[t], ARGUS_KIND_SLOW), text);
        }
    }
}

// What was called wrong for a bent axis, and looks bent still, is slow where both together say 1,450.
void test_late_by_both_for_sure_is_not_bent(void) {
    for (int below = 0; below < 2; below++) {
        setUp();
        peer->bend[2] = 600;
        peer->bend_told[2] = 900;
        peer->told[LAG] = 300;
        c->lag[LAG] = c->score[ARGUS_TEST_LAG] = 580;
        peer->late[LAG] = (int16_t)(870 - below);
        TEST_ASSERT_EQUAL(!below, replaces(ARGUS_KIND_WRONG, ARGUS_KIND_SLOW));
    }
}

// ... and goes back to a bent axis for sure only under 1,000.
void test_late_by_both_goes_back_to_bent_for_less_than_it_took(void) {
    for (int below = 0; below < 2; below++) {
        setUp();
        peer->bend[2] = 1000;
        peer->bend_told[2] = 900;
        peer->against = 3;
        peer->told[LAG] = 400;
        c->lag[LAG] = c->score[ARGUS_TEST_LAG] = 400;
        peer->late[LAG] = (int16_t)(600 - below);
        TEST_ASSERT_EQUAL(below, replaces(ARGUS_KIND_SLOW, ARGUS_KIND_WRONG));
    }
}

// Gaps and silence take the name of what tells of no lag any more (150), where nearly all that contradicts it
// is silence.
void test_slow_without_a_lag_gives_way_to_gaps(void) {
    static const struct {
        int told;
        uint8_t hollow;
        bool gives_way;
    } by[] = {{149, 0x07, true}, {150, 0x07, false}, {149, 0x03, false}, {0, 0x0E, true}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        setUp();
        peer->told[LAG] = (int16_t)by[i].told;
        peer->hollow = by[i].hollow;
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].gives_way, replaces(ARGUS_KIND_SLOW, ARGUS_KIND_INTERMITTENT), text);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].gives_way, replaces(ARGUS_KIND_SLOW, ARGUS_KIND_OFF), text);
        TEST_ASSERT_FALSE_MESSAGE(replaces(ARGUS_KIND_SLOW, ARGUS_KIND_STUCK), text);
    }
}

// In no state two names take each other's place, SIP after SIP.
void test_names_of_lateness_do_not_go_to_and_fro(void) {
    static const argus_fault_kind_t others[] = {ARGUS_KIND_GARBAGE, ARGUS_KIND_INTERMITTENT, ARGUS_KIND_OFF,
                                                ARGUS_KIND_WRONG};
    static const int own[] = {0, 149, 150, 300, 420, 600, 950}, late[] = {0, 250, 300, 600, 900, 1000, 2000};
    static const int told[] = {0, 50, 149, 400, 430, 900}, leaps[] = {0, 400, 2800};
    static const uint8_t hollow[] = {0x00, 0x07, 0xFF}, runs[] = {0, 12, 30};
    for (unsigned at = 0; at < 7u * 7 * 6 * 3 * 3 * 3 * 2; at++) {
        setUp();
        unsigned rest = at;
        c->lag[LAG] = c->score[ARGUS_TEST_LAG] = (int16_t)own[rest % 7];
        rest /= 7;
        peer->late[LAG] = (int16_t)late[rest % 7];
        rest /= 7;
        peer->told[LAG] = (int16_t)told[rest % 6];
        rest /= 6;
        c->score[ARGUS_TEST_GARBAGE] = (int16_t)leaps[rest % 3];
        rest /= 3;
        peer->hollow = hollow[rest % 3];
        rest /= 3;
        c->none_run = runs[rest % 3];
        rest /= 3;
        peer->bend[2] = rest != 0 ? 1000 : 0;
        peer->bend_told[2] = rest != 0 ? 600 : 0;
        c->score[ARGUS_TEST_PEERS] = 400;
        c->score[ARGUS_TEST_DROPOUT] = 600;
        peer->against = 3;
        const argus_fault_kind_t found = named();
        if (found != ARGUS_KIND_SLOW) {
            continue;
        }
        for (int i = 0; i < 4; i++) {
            const bool goes = replaces(others[i], ARGUS_KIND_SLOW);
            const bool comes = replaces(ARGUS_KIND_SLOW, others[i]);
            snprintf(text, sizeof text, "state %u, kind %d", at, (int)others[i]);
            TEST_ASSERT_FALSE_MESSAGE(goes && comes, text);
        }
    }
}

// Another name comes before lateness.
void test_lateness_takes_nothing_from_another_name(void) {
    peer->late[LAG] = 2000;
    peer->told[LAG] = 900;
    peer->against = 3;
    c->score[ARGUS_TEST_PEERS] = 300;
    accuse(ARGUS_TEST_STUCK, argus_bounds[ARGUS_TEST_STUCK].naming);
    TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, named());
}

// Some lag explains a few of the readings of garbage by chance: it is slow only if the peers know of a lag,
// 300, and gives the name back.
void test_wild_readings_are_slow_only_if_the_peers_know_of_a_lag(void) {
    for (int late = 299; late <= 300; late++) {
        for (int below = 0; below < 2; below++) {
            setUp();
            give_ground();
            accuse(ARGUS_TEST_LAG, argus_bounds[ARGUS_TEST_LAG].ceiling);
            accuse(ARGUS_TEST_GARBAGE, argus_bounds[ARGUS_TEST_GARBAGE].naming - below);
            peer->late[LAG] = (int16_t)late;
            c->score[ARGUS_TEST_PEERS] = 300;
            const bool wild = late < 300 && !below;
            snprintf(text, sizeof text, "late %d, %d below", late, below);
            TEST_ASSERT_EQUAL_MESSAGE(wild ? ARGUS_KIND_GARBAGE : ARGUS_KIND_SLOW, named(), text);
            TEST_ASSERT_EQUAL_MESSAGE(wild ? ARGUS_KIND_GARBAGE : ARGUS_KIND_SLOW, convicted(), text);
            TEST_ASSERT_EQUAL_MESSAGE(wild, replaces(ARGUS_KIND_SLOW, ARGUS_KIND_GARBAGE), text);
            argus_evidence_restart(
                &e); // what the peers knew of a lag is forgotten: no ground for another name
            TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_SLOW, named(), text);
            TEST_ASSERT_FALSE_MESSAGE(replaces(ARGUS_KIND_SLOW, ARGUS_KIND_GARBAGE), text);
        }
    }
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

// What comes and goes about a level does not change the name to and fro.
void test_a_bent_axis_that_took_a_name_keeps_it(void) {
    static const argus_test_t tests[] = {ARGUS_TEST_GARBAGE, ARGUS_TEST_DROPOUT, ARGUS_TEST_LAG};
    for (int t = 0; t < 3; t++) {
        setUp();
        give_ground();
        accuse(tests[t], 900);
        peer->hollow = 0x07;
        argus_fault_kind_t kind = named();
        const argus_fault_kind_t first = kind;
        int changes = 0;
        for (int i = 0; i < 60; i++) {
            bend(i % 2 ? 999 : 1000, i % 3 ? 500 : 440);
            const argus_fault_kind_t found = named();
            if (replaces(kind, found)) {
                kind = found;
                changes++;
            }
        }
        snprintf(text, sizeof text, "test %d", (int)tests[t]);
        TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_WRONG, kind, text);
        TEST_ASSERT_EQUAL_MESSAGE(1, changes, text);
        bend(499, 900);
        TEST_ASSERT_TRUE_MESSAGE(replaces(ARGUS_KIND_WRONG, first), text);
        bend(500, 900);
        TEST_ASSERT_FALSE_MESSAGE(replaces(ARGUS_KIND_WRONG, first), text);
    }
}

// Two leaps that the others contradict are garbage, where nothing moves and nobody knows of a lag; gone, they
// leave what is wrong its name.
void test_leaps_that_are_contradicted_are_garbage_sooner(void) {
    static const struct {
        int leaps;
        int peers;
        int late;
        unsigned against;
        bool busy;
        argus_fault_kind_t kind;
    } by[] = {{360, 450, 299, 3, false, ARGUS_KIND_GARBAGE}, {359, 450, 0, 3, false, ARGUS_KIND_NONE},
              {360, 449, 0, 3, false, ARGUS_KIND_NONE},      {360, 450, 300, 3, false, ARGUS_KIND_NONE},
              {360, 450, 0, 1, false, ARGUS_KIND_NONE},      {360, 450, 0, 3, true, ARGUS_KIND_NONE},
              {360, 650, 0, 3, false, ARGUS_KIND_GARBAGE},   {359, 650, 0, 3, false, ARGUS_KIND_WRONG}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        setUp();
        c->score[ARGUS_TEST_GARBAGE] = (int16_t)by[i].leaps;
        c->score[ARGUS_TEST_PEERS] = (int16_t)by[i].peers;
        peer->late[LAG] = (int16_t)by[i].late;
        peer->against = (uint16_t)by[i].against;
        e.stirred = (uint16_t)(by[i].busy ? 1u << (SONAR + 1) : 0u);
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].kind, named(), text);
        TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_NONE, convicted(), text);
    }
    c->score[ARGUS_TEST_GARBAGE] = 1;
    TEST_ASSERT_FALSE(replaces(ARGUS_KIND_GARBAGE, ARGUS_KIND_WRONG));
    c->score[ARGUS_TEST_GARBAGE] = 0;
    TEST_ASSERT_TRUE(replaces(ARGUS_KIND_GARBAGE, ARGUS_KIND_WRONG));
}

// In its place a bent axis takes the names that it may look like: gaps, garbage and lateness, also of one
// that is out; not that of one that tells more of a lag, nor of one that mostly hears nothing.
void test_bent_for_sure_takes_the_place_of_what_it_looks_like(void) {
    static const argus_test_t tests[] = {ARGUS_TEST_GARBAGE, ARGUS_TEST_DROPOUT, ARGUS_TEST_LAG};
    static const argus_fault_kind_t kinds[] = {ARGUS_KIND_GARBAGE, ARGUS_KIND_INTERMITTENT, ARGUS_KIND_SLOW};
    static const struct {
        int well;
        int told;
        unsigned against;
        uint8_t hollow;
        int late_told; // beside the score of LAG
        bool wrong;
    } by[] = {{1000, 900, 3, 0x00, 0, true},     {999, 900, 3, 0x00, 0, false},
              {1000, 299, 3, 0x00, 0, false},    {1000, 900, 1, 0x00, 0, false},
              {1000, 900, 3, 0x1F, 0, true},     {1000, 900, 3, 0x3F, 0, false},
              {1000, 900, 3, 0x00, 1800, false}, {1000, 300, 3, 0x00, 600, false}};
    for (int t = 0; t < 3; t++) {
        for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
            setUp();
            give_ground();
            accuse(tests[t], argus_bounds[tests[t]].naming);
            bend(by[i].well, by[i].told);
            peer->told[LAG] = (int16_t)by[i].late_told;
            peer->against = (uint16_t)by[i].against;
            peer->hollow = by[i].hollow;
            const bool outdone =
                tests[t] == ARGUS_TEST_LAG && 2 * by[i].told <= argus_bounds[tests[t]].naming;
            const argus_fault_kind_t kind = by[i].wrong && !outdone ? ARGUS_KIND_WRONG : kinds[t];
            snprintf(text, sizeof text, "test %d, case %d", (int)tests[t], i);
            TEST_ASSERT_EQUAL_MESSAGE(kind, named(), text);
            TEST_ASSERT_EQUAL_MESSAGE(kind != kinds[t], replaces(kinds[t], ARGUS_KIND_WRONG), text);
        }
    }
}

void test_a_bent_axis_is_convicted_as_wrong(void) {
    give_ground();
    accuse(ARGUS_TEST_GARBAGE, argus_bounds[ARGUS_TEST_GARBAGE].convincing);
    TEST_ASSERT_EQUAL(ARGUS_KIND_GARBAGE, convicted());
    bend(1000, 300);
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, convicted());
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

// ---- silence alone

// Contradicted for nothing but silence and silent for five readings: off from 380 on, two against it.
void test_a_silence_that_all_contradict_is_off_sooner(void) {
    static const struct {
        int peers;
        int run;
        uint8_t hollow;
        unsigned against;
        bool borne_out;
        argus_fault_kind_t kind;
    } by[] = {{380, 5, 0x07, 3, false, ARGUS_KIND_OFF},  {379, 5, 0x07, 3, false, ARGUS_KIND_NONE},
              {649, 4, 0x07, 3, false, ARGUS_KIND_NONE}, {649, 5, 0x06, 3, false, ARGUS_KIND_NONE},
              {649, 5, 0x07, 1, false, ARGUS_KIND_NONE}, {649, 5, 0x07, 3, true, ARGUS_KIND_NONE}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        setUp();
        c->score[ARGUS_TEST_PEERS] = (int16_t)by[i].peers;
        c->none_run = (uint8_t)by[i].run;
        peer->hollow = by[i].hollow;
        peer->against = (uint16_t)by[i].against;
        peer->borne_out = by[i].borne_out;
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].kind, named(), text);
        TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_NONE, convicted(), text);
    }
}

// One stray echo among the silences that contradict it may be crosstalk: off becomes nothing but
// intermittent.
void test_off_stays_off_through_a_stray_echo(void) {
    static const uint8_t hollow[] = {0x0F, 0x0E, 0x07, 0x06, 0x00};
    for (int i = 0; i < 5; i++) {
        setUp();
        peer->hollow = hollow[i];
        TEST_ASSERT_TRUE(replaces(ARGUS_KIND_OFF, ARGUS_KIND_INTERMITTENT));
        TEST_ASSERT_EQUAL(i >= 3, replaces(ARGUS_KIND_OFF, ARGUS_KIND_WRONG));
        TEST_ASSERT_EQUAL(i >= 3, replaces(ARGUS_KIND_OFF, ARGUS_KIND_SLOW));
        c->score[ARGUS_TEST_LAG] = argus_bounds[ARGUS_TEST_LAG].naming; // its own readings tell of a lag
        TEST_ASSERT_TRUE(replaces(ARGUS_KIND_OFF, ARGUS_KIND_SLOW));
        c->score[ARGUS_TEST_LAG] = 0;
        peer->late[LAG] = 1000; // ... or all of the others do
        peer->told[LAG] = 430;
        c->score[ARGUS_TEST_PEERS] = 300;
        TEST_ASSERT_TRUE(replaces(ARGUS_KIND_OFF, ARGUS_KIND_SLOW));
        TEST_ASSERT_EQUAL(i >= 3, replaces(ARGUS_KIND_OFF, ARGUS_KIND_WRONG));
    }
}

// Three echoes of one thing in a row are no crosstalk.
void test_off_is_over_when_an_echo_is_followed_again(void) {
    for (int track = 0; track <= 4; track++) {
        for (int run = 0; run < 2; run++) {
            setUp();
            peer->hollow = 0x0F;
            c->track = (uint8_t)track;
            c->none_run = (uint8_t)run;
            snprintf(text, sizeof text, "track %d, run %d", track, run);
            const bool heard = track >= 3 && run == 0;
            TEST_ASSERT_EQUAL_MESSAGE(heard, replaces(ARGUS_KIND_OFF, ARGUS_KIND_WRONG), text);
            TEST_ASSERT_EQUAL_MESSAGE(heard, replaces(ARGUS_KIND_OFF, ARGUS_KIND_SLOW), text);
        }
    }
}

// Who was taken for off, hears again what another hears, and was contradicted for little but silence has
// gaps; nobody else is named for that, and what the evidence names comes first.
void test_off_that_is_heard_again_has_gaps(void) {
    static const struct {
        argus_fault_kind_t present;
        int run;
        int peers;
        uint8_t hollow;
        bool borne_out;
        int lag;
        argus_fault_kind_t kind;
    } by[] = {{ARGUS_KIND_OFF, 2, 200, 0x0D, true, 429, ARGUS_KIND_INTERMITTENT},
              {ARGUS_KIND_NONE, 2, 200, 0x0D, true, 429, ARGUS_KIND_NONE},
              {ARGUS_KIND_WRONG, 2, 200, 0x0D, true, 429, ARGUS_KIND_NONE},
              {ARGUS_KIND_OFF, 3, 200, 0x0D, true, 429, ARGUS_KIND_NONE},
              {ARGUS_KIND_OFF, 2, 199, 0x0D, true, 429, ARGUS_KIND_NONE},
              {ARGUS_KIND_OFF, 2, 200, 0x0C, true, 429, ARGUS_KIND_NONE},
              {ARGUS_KIND_OFF, 2, 200, 0x0D, false, 429, ARGUS_KIND_NONE},
              {ARGUS_KIND_OFF, 2, 200, 0x0D, true, 430, ARGUS_KIND_NONE},
              {ARGUS_KIND_OFF, 2, 200, 0x0D, true, 900, ARGUS_KIND_SLOW}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        setUp();
        c->none_run = (uint8_t)by[i].run;
        c->score[ARGUS_TEST_PEERS] = (int16_t)by[i].peers;
        c->score[ARGUS_TEST_LAG] = (int16_t)by[i].lag;
        peer->hollow = by[i].hollow;
        peer->borne_out = by[i].borne_out;
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].kind, argus_evidence_renames(&e, SONAR, by[i].present), text);
        TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_evidence_renames(&e, OTHER, by[i].present));
    }
}

void test_off_that_is_heard_again_gets_the_name_that_the_evidence_has(void) {
    c->score[ARGUS_TEST_PEERS] = 200;
    peer->hollow = 0x0F;
    peer->borne_out = true;
    TEST_ASSERT_EQUAL(ARGUS_KIND_INTERMITTENT, argus_evidence_renames(&e, SONAR, ARGUS_KIND_OFF));
    accuse(ARGUS_TEST_GARBAGE, argus_bounds[ARGUS_TEST_GARBAGE].naming);
    TEST_ASSERT_EQUAL(ARGUS_KIND_GARBAGE, argus_evidence_renames(&e, SONAR, ARGUS_KIND_OFF));
}

// What it heard before it was called off does not tell that it hears; other names take nothing back.
void test_the_name_off_begins_the_hearing_anew(void) {
    for (int kind = ARGUS_KIND_NONE; kind < KINDS; kind++) {
        setUp();
        peer->borne_out = true;
        e.peers.of[OTHER].borne_out = true;
        argus_evidence_note_name(&e, SONAR, (argus_fault_kind_t)kind);
        TEST_ASSERT_EQUAL(kind != ARGUS_KIND_OFF, peer->borne_out);
        TEST_ASSERT_TRUE(e.peers.of[OTHER].borne_out);
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

// ---- names that stay

#define NEVER 0
#define ALWAYS 1
#define IF_MOVED 2 // the STUCK score is 0
#define IF_WELL 3  // lateness below 420
#define IF_LATE 4  // lateness from 880 on
#define IF_DEAF 5  // 12 readings without an echo, the last three contradicted ones too
#define IF_GAPS 6  // three of the last four contradicted ones without an echo
#define IF_SURE 7  // late and not well from 1,000 on, lateness from 430 on
#define IF_BENT 8  // bent from 1,000 on, told of by more than half of the lateness
#define IF_HEARD 9 // less than three of the last four contradicted ones without an echo
#define IF_LAG 10  // ... or late for sure

// Rows: the kind that it carries; columns: the kind that is found.
static const uint8_t replaced_when[KINDS][KINDS] = {
    [ARGUS_KIND_NONE] = {NEVER, ALWAYS, ALWAYS, ALWAYS, ALWAYS, ALWAYS, ALWAYS, ALWAYS},
    [ARGUS_KIND_OFF] = {NEVER, NEVER, ALWAYS, ALWAYS, IF_HEARD, ALWAYS, IF_LAG, ALWAYS},
    [ARGUS_KIND_SILENT] = {NEVER},
    [ARGUS_KIND_STUCK] = {NEVER, IF_MOVED, IF_MOVED, NEVER, IF_MOVED, IF_MOVED, IF_MOVED, IF_MOVED},
    [ARGUS_KIND_WRONG] = {NEVER, IF_DEAF, ALWAYS, ALWAYS, NEVER, ALWAYS, IF_LATE, IF_GAPS},
    [ARGUS_KIND_GARBAGE] = {NEVER, NEVER, NEVER, NEVER, IF_BENT, NEVER, IF_SURE, NEVER},
    [ARGUS_KIND_SLOW] = {NEVER, NEVER, NEVER, NEVER, IF_WELL, NEVER, NEVER, NEVER},
    [ARGUS_KIND_INTERMITTENT] = {NEVER, NEVER, NEVER, NEVER, IF_BENT, NEVER, IF_SURE, NEVER},
};

// Everything speaks against a change but what is asked for.
static void set_up_but(int condition) {
    setUp();
    c->score[ARGUS_TEST_STUCK] = condition == IF_MOVED ? 0 : 1;
    peer->told[LAG] = (int16_t)(condition == IF_WELL ? 419 : (condition == IF_LATE ? 880 : 430));
    peer->late[LAG] = condition == IF_SURE ? 1000 : 999;
    peer->bend[0] = condition == IF_BENT ? 1000 : 499;
    peer->bend_told[0] = 441;
    c->score[ARGUS_TEST_GARBAGE] = 1;
    peer->against = 3;
    c->score[ARGUS_TEST_PEERS] = 300;
    c->none_run = condition == IF_DEAF ? 12 : 11;
    peer->hollow = condition == IF_DEAF ? 0x07 : (condition == IF_GAPS ? 0x0D : 0x73);
}

// A kind gives way to one that says more or when its ground is gone, and to no other, whatever shows.
void test_which_kind_replaces_which(void) {
    for (int present = 0; present < KINDS; present++) {
        for (int found = 0; found < KINDS; found++) {
            for (int condition = NEVER; condition <= IF_BENT; condition++) {
                const int when = replaced_when[present][found];
                set_up_but(condition);
                snprintf(text, sizeof text, "%s by %s, condition %d",
                         argus_name(ARGUS_NAME_KIND, (int)present), argus_name(ARGUS_NAME_KIND, (int)found),
                         condition);
                const bool gaps = condition == IF_DEAF || condition == IF_GAPS; // 3 of 4, both
                const bool well = when == IF_WELL && condition == IF_BENT;
                const bool kept =
                    present == ARGUS_KIND_WRONG && found == ARGUS_KIND_GARBAGE && condition == IF_BENT;
                const bool given = (when == ALWAYS && !kept) || (when != NEVER && when == condition) ||
                                   (when == IF_GAPS && gaps) || (when == IF_HEARD && !gaps) || well ||
                                   (when == IF_LAG && !gaps);
                TEST_ASSERT_EQUAL_MESSAGE(
                    given, replaces((argus_fault_kind_t)present, (argus_fault_kind_t)found), text);
            }
        }
    }
}

// Each part of a condition is needed.
void test_wrong_gives_way_to_off_and_to_gaps_only_where_all_of_it_shows(void) {
    static const struct {
        int none_run;
        unsigned hollow;
        bool off;
        bool gaps;
    } by[] = {{12, 0x07, true, true},   {11, 0x07, false, true},  {12, 0x03, false, false},
              {12, 0x0B, false, true},  {12, 0x0E, false, true},  {255, 0xFF, true, true},
              {12, 0x0C, false, false}, {12, 0xF5, false, false}, {0, 0x0D, false, true}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        c->none_run = (uint8_t)by[i].none_run;
        peer->hollow = (uint8_t)by[i].hollow;
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].off, replaces(ARGUS_KIND_WRONG, ARGUS_KIND_OFF), text);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].gaps, replaces(ARGUS_KIND_WRONG, ARGUS_KIND_INTERMITTENT), text);
    }
}

// A bent axis that hears nothing for a while is bent all the same.
void test_a_bent_axis_is_not_off_for_a_silence(void) {
    for (int told = 0; told < 2; told++) {
        for (int well = 499; well <= 500; well++) {
            setUp();
            c->none_run = 12;
            peer->hollow = 0x07;
            bend(well, told != 0 ? 200 : 0);
            TEST_ASSERT_EQUAL(told == 0 || well < 500, replaces(ARGUS_KIND_WRONG, ARGUS_KIND_OFF));
        }
    }
}

// Silence that came and went is off after twenty readings without an echo.
void test_gaps_give_way_to_off_after_a_long_silence(void) {
    c->none_run = 19;
    TEST_ASSERT_FALSE(replaces(ARGUS_KIND_INTERMITTENT, ARGUS_KIND_OFF));
    c->none_run = 20;
    TEST_ASSERT_TRUE(replaces(ARGUS_KIND_INTERMITTENT, ARGUS_KIND_OFF));
    TEST_ASSERT_FALSE(replaces(ARGUS_KIND_INTERMITTENT, ARGUS_KIND_WRONG));
}

// Between late and wrong a name changes only when it is clear, so it does not go to and fro.
void test_between_late_and_wrong_there_is_room(void) {
    for (int way = 0; way < WAYS; way++) {
        for (int by = 110; by <= 900; by++) {
            be_late(way, by);
            snprintf(text, sizeof text, "way %d, lateness %d", way, by);
            TEST_ASSERT_EQUAL_MESSAGE(by >= 880, replaces(ARGUS_KIND_WRONG, ARGUS_KIND_SLOW), text);
            TEST_ASSERT_EQUAL_MESSAGE(by < 420, replaces(ARGUS_KIND_SLOW, ARGUS_KIND_WRONG), text);
        }
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
