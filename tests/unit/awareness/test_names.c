// SPDX-License-Identifier: MIT
// Rule under attack (profile argus): a sonar is suspected, named and convicted by what its tests amount to
// and by no less: a suspicion comes before a name, a name before a conviction, and the others say it twice.
#include "awareness/names.h"

#include <stdio.h>
#include <string.h>

#include "awareness/evidence.h"
#include "awareness/numbers.h"
#include "scene.h"
#include "unity.h"

#define SONAR 4
#define OTHER 9

static argus_evidence_t e;
static argus_knowledge_t k;
static argus_case_t *c;
static char text[160];

void setUp(void) {
    scene_blank(&k, &e);
    c = &e.of[SONAR];
}

static argus_fault_kind_t named(void) {
    return argus_evidence_names(&e, SONAR);
}

static argus_fault_kind_t convicted(void) {
    return argus_evidence_convicts(&e, SONAR);
}

// All that the others need beside a score, for a name and for a conviction.
static void give_ground(void) {
    c->against = 7;
    c->episodes = UINT8_MAX;
}

static const argus_fault_kind_t kind_of[ARGUS_TESTS] = {[ARGUS_TEST_STUCK] = ARGUS_KIND_STUCK,
                                                        [ARGUS_TEST_GARBAGE] = ARGUS_KIND_GARBAGE,
                                                        [ARGUS_TEST_DROPOUT] = ARGUS_KIND_INTERMITTENT,
                                                        [ARGUS_TEST_PEERS] = ARGUS_KIND_WRONG};

void test_nothing_is_said_of_a_fresh_sonar(void) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        TEST_ASSERT_FALSE(argus_evidence_suspects(&e, i));
        TEST_ASSERT_FALSE(argus_evidence_holds(&e, i));
        TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_evidence_names(&e, i));
        TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_evidence_convicts(&e, i));
    }
}

// The more a test says, the more is done about it: suspected, named, convicted, each once and of its kind.
void test_suspicion_name_and_conviction_come_in_this_order(void) {
    for (int test = 0; test < ARGUS_TESTS; test++) {
        setUp();
        give_ground();
        int reached = 0;
        for (int score = 0; score <= ARGUS_CEILING; score += 10) {
            c->score[test] = (int16_t)score;
            const bool suspect = argus_evidence_suspects(&e, SONAR);
            const bool name = named() != ARGUS_KIND_NONE;
            const bool conviction = convicted() != ARGUS_KIND_NONE;
            snprintf(text, sizeof text, "test %d at %d", test, score);
            TEST_ASSERT_TRUE_MESSAGE(!conviction || name, text);
            TEST_ASSERT_TRUE_MESSAGE(!name || (suspect && argus_evidence_holds(&e, SONAR)), text);
            TEST_ASSERT_TRUE_MESSAGE(!name || named() == kind_of[test], text);
            TEST_ASSERT_TRUE_MESSAGE(!conviction || convicted() == kind_of[test], text);
            TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_NONE, argus_evidence_names(&e, OTHER), text);
            const int now = suspect + name + conviction;
            TEST_ASSERT_TRUE_MESSAGE(now >= reached, text);
            reached = now;
        }
        TEST_ASSERT_EQUAL(3, reached);
    }
}

// A wrong one takes a third: one other that contradicts it, however often, names neither.
void test_one_other_names_nobody(void) {
    c->score[ARGUS_TEST_PEERS] = ARGUS_CEILING;
    c->episodes = UINT8_MAX;
    for (int other = 0; other < ARGUS_SONARS; other++) {
        c->against = (argus_mask_t)(1u << other);
        TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, named());
        TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, convicted());
    }
}

// What others say convicts at several times only, and not while people are about; its own readings do.
void test_others_convict_at_several_times_and_in_calm(void) {
    for (int test = 0; test < ARGUS_TESTS; test++) {
        for (int busy = 0; busy < 2; busy++) {
            for (int once = 0; once < 2; once++) {
                setUp();
                give_ground();
                c->score[test] = ARGUS_CEILING;
                c->episodes = once != 0 ? 1 : UINT8_MAX;
                e.busy = busy != 0;
                const bool by_others = test == ARGUS_TEST_PEERS;
                snprintf(text, sizeof text, "test %d, busy %d, once %d", test, busy, once);
                TEST_ASSERT_EQUAL_MESSAGE(!by_others || (busy == 0 && once == 0),
                                          convicted() != ARGUS_KIND_NONE, text);
                TEST_ASSERT_EQUAL_MESSAGE(kind_of[test], named(), text);
            }
        }
    }
}

// Contradicted for silence only it is off as long as it hears nothing, and has gaps once it is heard again.
void test_silence_alone_is_off_or_gaps(void) {
    give_ground();
    c->score[ARGUS_TEST_PEERS] = 900;
    c->silent_bits = 0xFF;
    c->none_run = 30;
    TEST_ASSERT_EQUAL(ARGUS_KIND_OFF, named());
    c->none_run = 0;
    TEST_ASSERT_EQUAL(ARGUS_KIND_INTERMITTENT, named());
    c->silent_bits = 0;
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, named());
}

// One that is deaf to some surfaces, and whose echoes others bear out, is neither named nor given up for
// silence; gaps between echoes of one thing name it, or a silence of many contradicted readings in a row.
void test_one_that_hears_some_is_not_named_for_silence(void) {
    for (unsigned bits = 0; bits <= UINT8_MAX; bits++) {
        for (int heard = 0; heard < 2; heard++) {
            setUp();
            give_ground();
            c->score[ARGUS_TEST_PEERS] = ARGUS_CEILING;
            c->silent_bits = (uint8_t)bits;
            c->none_run = 30;
            c->borne_out = heard != 0;
            const bool deaf = heard != 0 && (bits & 7u) != 0;
            snprintf(text, sizeof text, "bits %02x, heard %d", bits, heard);
            TEST_ASSERT_EQUAL_MESSAGE(!deaf || bits == UINT8_MAX, named() != ARGUS_KIND_NONE, text);
            TEST_ASSERT_EQUAL_MESSAGE(!deaf || bits == UINT8_MAX, argus_evidence_suspects(&e, SONAR), text);
            TEST_ASSERT_EQUAL_MESSAGE(!deaf, convicted() != ARGUS_KIND_NONE, text);
            c->score[ARGUS_TEST_DROPOUT] = 300;
            TEST_ASSERT_NOT_EQUAL_MESSAGE(ARGUS_KIND_NONE, named(), text);
        }
    }
}

// A silence that all contradict is off sooner than an echo is wrong, unless an echo of it was borne out.
void test_a_silence_that_all_contradict_is_off_sooner(void) {
    give_ground();
    c->silent_bits = 0xFF;
    c->none_run = 30;
    int off = 0;
    while (named() == ARGUS_KIND_NONE) {
        c->score[ARGUS_TEST_PEERS] = (int16_t)++off;
    }
    TEST_ASSERT_EQUAL(ARGUS_KIND_OFF, named());
    c->borne_out = true;
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, named());
    TEST_ASSERT_TRUE(off < argus_bounds[ARGUS_TEST_PEERS].naming);
}

// A lag and an axis offset are names by themselves, each of its kind, and only where the others rather
// contradict it.
void test_hypotheses_name_where_others_contradict(void) {
    for (int d = 0; d < ARGUS_HYPOTHESES; d++) {
        setUp();
        give_ground();
        c->hypothesis[d] = (argus_hypothesis_t){1500, 900};
        c->score[ARGUS_TEST_PEERS] = 400;
        snprintf(text, sizeof text, "hypothesis %d", d);
        TEST_ASSERT_EQUAL_MESSAGE(d < ARGUS_LAGS ? ARGUS_KIND_SLOW : ARGUS_KIND_WRONG, named(), text);
        TEST_ASSERT_TRUE_MESSAGE(argus_evidence_suspects(&e, SONAR), text);
        c->score[ARGUS_TEST_PEERS] = -100;
        TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_NONE, named(), text);
        c->score[ARGUS_TEST_PEERS] = 400;
        c->hypothesis[d].over_other = 0; // another fault explains it as well
        TEST_ASSERT_EQUAL_MESSAGE(d < ARGUS_LAGS ? ARGUS_KIND_SLOW : ARGUS_KIND_NONE, named(), text);
    }
}

// In a turn a late sonar looks as if its axis were offset: what tells more of the lag is late.
void test_what_is_late_does_not_look_offset(void) {
    give_ground();
    c->score[ARGUS_TEST_PEERS] = 400;
    c->hypothesis[ARGUS_LAGS] = (argus_hypothesis_t){1500, 400};
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, named());
    c->hypothesis[0] = (argus_hypothesis_t){ARGUS_LATE_NAMING - 100, 900};
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, named());
    c->hypothesis[0].over_healthy = 1500;
    TEST_ASSERT_EQUAL(ARGUS_KIND_SLOW, named());
}

// ... and so is one that is late by what others heard, whatever its score among them.
void test_a_suspicion_of_lateness_is_held_until_little_is_left(void) {
    for (int lag = 0; lag < ARGUS_LAGS; lag++) {
        setUp();
        const int32_t border = ARGUS_LATE_NAMING * ARGUS_HELD_PERCENT / 100;
        c->hypothesis[lag].over_healthy = (int16_t)border;
        TEST_ASSERT_FALSE(argus_evidence_holds(&e, SONAR));
        c->hypothesis[lag].over_healthy = (int16_t)(border + (ARGUS_LATE_NAMING + 99) / 100);
        TEST_ASSERT_TRUE(argus_evidence_holds(&e, SONAR));
    }
}

// A suspect is held until little is left of it.
void test_a_suspicion_is_held_until_little_is_left(void) {
    for (int score = ARGUS_CEILING; score >= 0; score -= 10) {
        c->score[ARGUS_TEST_PEERS] = (int16_t)score;
        TEST_ASSERT_TRUE(!argus_evidence_suspects(&e, SONAR) || argus_evidence_holds(&e, SONAR));
    }
    TEST_ASSERT_FALSE(argus_evidence_holds(&e, SONAR));
}

// What is kept of one mission names none in the next by itself, and suspects only one that was out.
void test_what_is_kept_names_nobody_by_itself(void) {
    for (int kept = 0; kept < ARGUS_KEPT; kept++) {
        for (int out = 0; out < 2; out++) {
            setUp();
            give_ground();
            argus_evidence_restore(&e, SONAR, (argus_kept_t)kept, INT16_MAX, out != 0);
            snprintf(text, sizeof text, "kept %d, out %d", kept, out);
            TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_NONE, named(), text);
            TEST_ASSERT_TRUE_MESSAGE(out != 0 || !argus_evidence_suspects(&e, SONAR), text);
            argus_evidence_restore(&e, SONAR, (argus_kept_t)kept, INT16_MIN, out != 0);
            TEST_ASSERT_EQUAL_MESSAGE(0, argus_evidence_kept(&e, SONAR, (argus_kept_t)kept), text);
        }
    }
}

// By its own readings no sonar is given up as late: others contradict it as well, several times, and in calm.
void test_a_lag_convicts_only_where_others_contradict_and_nobody_walks_about(void) {
    for (int lacks = 0; lacks < 5; lacks++) {
        setUp();
        give_ground();
        c->hypothesis[1] = (argus_hypothesis_t){ARGUS_CEILING, 900};
        c->score[ARGUS_TEST_PEERS] = (int16_t)(lacks == 1 ? -10 : 0);
        c->against = lacks == 2 ? 1 : c->against;
        c->episodes = lacks == 3 ? 1 : c->episodes;
        e.busy = lacks == 4;
        snprintf(text, sizeof text, "lacks %d", lacks);
        TEST_ASSERT_EQUAL_MESSAGE(lacks == 0 ? ARGUS_KIND_SLOW : ARGUS_KIND_NONE, convicted(), text);
    }
}

// Below a name the best explanation so far is told, and how much of a verdict there is.
void test_the_best_explanation_so_far_is_told_with_its_share(void) {
    for (int test = 0; test < ARGUS_TESTS; test++) {
        setUp();
        uint8_t percent = 0;
        TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_names_best(&e, SONAR, &percent));
        TEST_ASSERT_EQUAL(0, percent);
        c->score[test] = (int16_t)(argus_bounds[test].convincing / 10 + 1);
        TEST_ASSERT_EQUAL(kind_of[test], argus_names_best(&e, SONAR, &percent));
        TEST_ASSERT_UINT_WITHIN(1, 10, percent);
        c->score[test] = INT16_MAX;
        argus_names_best(&e, SONAR, &percent);
        TEST_ASSERT_EQUAL(100, percent);
    }
    setUp();
    uint8_t percent = 0;
    c->hypothesis[0].over_healthy = (int16_t)(ARGUS_LATE_CONVINCING / 10 + 1);
    TEST_ASSERT_EQUAL(ARGUS_KIND_SLOW, argus_names_best(&e, SONAR, &percent));
    TEST_ASSERT_UINT_WITHIN(1, 10, percent);
    c->score[ARGUS_TEST_GARBAGE] = (int16_t)(argus_bounds[ARGUS_TEST_GARBAGE].convincing / 5);
    TEST_ASSERT_EQUAL(ARGUS_KIND_GARBAGE, argus_names_best(&e, SONAR, &percent)); // which is more
}

// Exactly as much as a name takes is enough for it, and one less is not.
void test_a_name_takes_exactly_what_it_takes(void) {
    for (int test = 0; test < ARGUS_TESTS; test++) {
        setUp();
        give_ground();
        c->score[test] = argus_bounds[test].naming;
        TEST_ASSERT_EQUAL(kind_of[test], named());
        c->score[test] = (int16_t)(argus_bounds[test].naming - 1);
        TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, named());
    }
}

// Of an offset the bound itself is enough, and one less is not.
void test_an_offset_is_named_from_its_bound_on(void) {
    give_ground();
    c->score[ARGUS_TEST_PEERS] = ARGUS_OFFSET_CONTRADICTED;
    for (int less = 0; less < 2; less++) {
        c->hypothesis[ARGUS_LAGS] =
            (argus_hypothesis_t){(int16_t)(ARGUS_OFFSET_NAMING - less), ARGUS_OFFSET_LEAD};
        TEST_ASSERT_EQUAL(less == 0 ? ARGUS_KIND_WRONG : ARGUS_KIND_NONE, named());
    }
    c->hypothesis[ARGUS_LAGS] = (argus_hypothesis_t){ARGUS_OFFSET_NAMING, ARGUS_OFFSET_LEAD - 1};
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, named());
}

// A suspicion begins at its share of what a name takes, and is held above another.
void test_a_suspicion_begins_at_its_bound(void) {
    for (int test = 0; test < ARGUS_TESTS; test++) {
        setUp();
        give_ground();
        const int32_t bound = argus_bounds[test].naming * ARGUS_SUSPECT_PERCENT / 100;
        c->score[test] = (int16_t)(bound - 1);
        TEST_ASSERT_FALSE(argus_evidence_suspects(&e, SONAR));
        c->score[test] = (int16_t)bound;
        TEST_ASSERT_TRUE(argus_evidence_suspects(&e, SONAR));
    }
    setUp();
    const int32_t held = argus_bounds[ARGUS_TEST_PEERS].naming * ARGUS_HELD_PERCENT / 100;
    c->score[ARGUS_TEST_PEERS] = (int16_t)held;
    TEST_ASSERT_FALSE(argus_evidence_holds(&e, SONAR));
}
