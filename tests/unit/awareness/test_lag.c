// SPDX-License-Identifier: MIT
// Rule under attack: one that hands its echoes out late repeats readings that vary, as many firings later, on
// a way or in a turn; two such in a row tell, more than so many no more, and nothing else does.
#include "awareness/lag.h"

#include "awareness/numbers.h"
#include "scene.h"
#include "unity.h"

#define ME 3
#define WAY_MM 100 // between two firings

static argus_knowledge_t k;
static argus_evidence_t e;
static int32_t x_mm, bearing_cdeg;

void setUp(void) {
    scene_blank(&k, &e);
    x_mm = 0;
    bearing_cdeg = 0;
}

static void read(const int mm, const int32_t way_mm, const int32_t turn_cdeg) {
    x_mm += way_mm;
    bearing_cdeg += turn_cdeg;
    k.sip_ms += 100;
    const argus_ping_t now = {.t_ms = (uint16_t)k.sip_ms,
                              .x_mm = (uint16_t)x_mm,
                              .bearing_cdeg = (int16_t)bearing_cdeg,
                              .reading_mm = (uint16_t)mm};
    argus_lag_take(&e, &k, ME, &now);
    argus_pings_note(&e.pings[ME], now);
}

// Readings that differ from each other: of a stretch of the past.
static int past_mm(const int firing) {
    return 800 + 300 * firing;
}

// The stretch of `lag` firings, and so many of it again.
static void replay(const int lag, const int again, const int32_t way_mm, const int32_t turn_cdeg) {
    for (int i = 0; i < lag + again; i++) {
        read(past_mm(i % lag), way_mm, turn_cdeg);
    }
}

static int16_t gain_of(const int lag) {
    return e.of[ME].hypothesis[lag - ARGUS_LEAST_LAG].over_healthy;
}

void test_each_lag_is_told_by_two_repeats_in_a_row(void) {
    for (int lag = ARGUS_LEAST_LAG; lag < ARGUS_LEAST_LAG + ARGUS_LAGS; lag++) {
        setUp();
        replay(lag, 1, WAY_MM, 0);
        TEST_ASSERT_EQUAL(0, gain_of(lag));
        TEST_ASSERT_EQUAL(1, e.of[ME].lag_run[lag - ARGUS_LEAST_LAG]);
        setUp();
        replay(lag, 2, WAY_MM, 0);
        TEST_ASSERT_GREATER_THAN(0, gain_of(lag));
        TEST_ASSERT_EQUAL(gain_of(lag), e.of[ME].hypothesis[lag - ARGUS_LEAST_LAG].over_other);
        for (int other = ARGUS_LEAST_LAG; other < lag; other++) {
            TEST_ASSERT_EQUAL(0, gain_of(other));
        }
    }
}

// As many as it is late, and no more than so many: what comes later repeats what was repeated.
void test_repeats_are_counted_up_to_the_lag(void) {
    for (int lag = ARGUS_LEAST_LAG; lag < ARGUS_LEAST_LAG + ARGUS_LAGS; lag++) {
        int16_t gain[7] = {0};
        for (int again = 1; again <= 6; again++) {
            setUp();
            replay(lag, again, WAY_MM, 0);
            gain[again] = gain_of(lag);
            const int most = lag < ARGUS_REPLAY_RUN_MOST ? lag : ARGUS_REPLAY_RUN_MOST;
            TEST_ASSERT_EQUAL(again < most ? again : most, e.of[ME].lag_run[lag - ARGUS_LEAST_LAG]);
        }
        TEST_ASSERT_EQUAL(lag > 2, gain[3] > gain[2]); // the third is one that is late by three or more
        TEST_ASSERT_EQUAL(gain[3], gain[4]);
        TEST_ASSERT_EQUAL(gain[3], gain[6]);
    }
}

// The first of a row counts as well, once there is a second.
void test_the_second_repeat_tells_twice_what_the_third_does(void) {
    for (int again = 0; again < 5; again++) {
        read(past_mm(again), WAY_MM, 0);
    }
    read(past_mm(0), WAY_MM, 0);
    read(past_mm(1), WAY_MM, 0);
    const int32_t second = gain_of(5);
    read(past_mm(2), WAY_MM, 0);
    TEST_ASSERT_EQUAL(second / 2, gain_of(5) - second);
}

void test_a_reading_that_is_not_of_then_begins_the_row_anew(void) {
    replay(4, 1, WAY_MM, 0);
    read(past_mm(1) + 1, WAY_MM, 0);
    TEST_ASSERT_EQUAL(0, e.of[ME].lag_run[4 - ARGUS_LEAST_LAG]);
    TEST_ASSERT_EQUAL(0, gain_of(4));
}

// A healthy one that stands reads the same again: it takes a way or a turn between the two.
void test_at_rest_a_repeat_tells_nothing(void) {
    static const struct {
        int32_t way_mm, turn_cdeg;
        bool tells;
    } rows[] = {{0, 0, false},
                {ARGUS_STILL_MM / 3 - 1, 0, false}, // of three firings
                {ARGUS_STILL_MM / 3, 0, true},
                {0, ARGUS_STILL_CDEG / 3 - 1, false},
                {0, ARGUS_STILL_CDEG / 3, true},
                {0, -ARGUS_STILL_CDEG / 3, true}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        replay(3, 2, rows[i].way_mm, rows[i].turn_cdeg);
        TEST_ASSERT_EQUAL(rows[i].tells, gain_of(3) > 0);
    }
}

static int16_t gain_of_three(const int first_mm, const int second_mm, const int third_mm) {
    const int mm[] = {first_mm, second_mm, third_mm};
    setUp();
    for (int i = 0; i < 5; i++) {
        read(mm[i % 3], WAY_MM, 0);
    }
    return gain_of(3);
}

// No echo is none to repeat, nor is one at the least that a sonar reads; and a stretch must vary.
void test_what_does_not_vary_is_no_stretch_of_the_past(void) {
    TEST_ASSERT_GREATER_THAN(0, gain_of_three(1000, 1400, 1800));
    TEST_ASSERT_EQUAL(0, gain_of_three(ARGUS_NO_ECHO_MM, ARGUS_NO_ECHO_MM, ARGUS_NO_ECHO_MM));
    TEST_ASSERT_EQUAL(0, gain_of_three(1000, 1000, 1000));
    TEST_ASSERT_EQUAL(0, gain_of_three(1000, 1000 + ARGUS_ALIKE_MM, 1800));
    TEST_ASSERT_GREATER_THAN(0, gain_of_three(1000, 1001 + ARGUS_ALIKE_MM, 1800));
    TEST_ASSERT_EQUAL(0, gain_of_three(ARGUS_CLIPPED_MM, 1400, 1800));
    TEST_ASSERT_GREATER_THAN(0, gain_of_three(1 + ARGUS_CLIPPED_MM, 1400, 1800));
}

// The more a stretch varies the less it comes again by chance.
void test_a_stretch_that_varies_more_tells_more(void) {
    TEST_ASSERT_GREATER_THAN(gain_of_three(1000, 1100, 1200), gain_of_three(1000, 1100, 2400));
    TEST_ASSERT_GREATER_THAN(gain_of_three(2000, 1900, 1800), gain_of_three(2000, 1900, 600));
}
