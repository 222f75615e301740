// SPDX-License-Identifier: MIT
// Rule under attack (profile argus): a sonar is late when its readings change with what the robot did some
// firings ago; one whose readings change with the robot at once is never called slow, nor is anyone by what
// walks about.
#include "argus/evidence.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "awareness/evidence_internal.h"
#include "scene.h"
#include "unity.h"

#define START_MS 0xFFFF8000u // the clock wraps on the way
#define RAD (3.14159265358979323846 / 180)
#define BINS 36
#define PAST 16
#define CASES 3

static const int sonars[CASES] = {1, 4, 12};

static scene_t s;
static int range_mm[BINS]; // what stands on each heading
static int past[PAST];     // what it would have read, newest first
static int lag;
static int sonar;
static int walker_mm; // what something that moves adds
static bool ever_slow;
static char text[200];

static const char *told(unsigned seed) {
    snprintf(text, sizeof text, "seed %u, sonar %d, lag %d, score %d, doubt %d / lead %d", seed, sonar, lag,
             s.e.of[sonar].score[ARGUS_TEST_LAG], s.e.of[sonar].lag_doubt[0],
             (int)argus_trail_lag_lead(&s.e.of[sonar]));
    return text;
}

// Another range on each heading, on one in six nothing at all.
static void start(unsigned seed, int of, int late) {
    scene_init(&s, seed, START_MS);
    s.noise_mm = 5;
    for (int i = 0; i < BINS; i++) {
        range_mm[i] = scene_random(&s, 6) == 0 ? 5000 : 500 + (int)scene_random(&s, 2500);
    }
    memset(past, 0, sizeof past);
    sonar = of;
    lag = late;
    walker_mm = 0;
    ever_slow = false;
}

static int truth(void) {
    const int bin = ((int)lround(s.th / RAD / 10) % BINS + BINS) % BINS;
    const int noise = (int)scene_random(&s, 11) - 5;
    return range_mm[bin] >= 5000 ? 5000 : range_mm[bin] + walker_mm + noise;
}

// One firing takes three SIPs; the robot moves meanwhile.
static void fire(void) {
    static int reading[ARGUS_SONARS];
    memmove(past + 1, past, (PAST - 1) * sizeof past[0]);
    past[0] = truth();
    reading[sonar] = past[lag] > 0 ? past[lag] : past[0];
    for (int sip = 0; sip < 3; sip++) {
        scene_say(&s, sip == 0 ? 1u << sonar : 0u, reading);
        s.th += s.w_rad_s / 10;
        ever_slow = ever_slow || argus_evidence_names(&s.e, sonar) == ARGUS_KIND_SLOW;
    }
}

static void stand(int firings) {
    s.w_rad_s = 0;
    for (int i = 0; i < firings; i++) {
        fire();
    }
}

static void turn(double deg) {
    const int firings = 1 + (int)(fabs(deg) / 20);
    s.w_rad_s = deg * RAD / firings / 0.3;
    for (int i = 0; i < firings; i++) {
        fire();
    }
    s.w_rad_s = 0;
    s.th = lround(s.th / RAD / 10) * 10 * RAD;
}

// Turns and stops.
static void turn_about(int turns) {
    static const double by[] = {20, 40, -20, 60, -40, 90, -60, 30};
    for (int i = 0; i < turns; i++) {
        turn(by[scene_random(&s, 8)]);
        stand(7 + (int)scene_random(&s, 8));
    }
}

void test_a_late_sonar_is_named_slow(void) {
    static const int lags[] = {3, 5, 8};
    for (int n = 0; n < 3; n++) {
        for (unsigned seed = 1; seed <= 12; seed++) {
            start(seed, sonars[seed % CASES], lags[n]);
            turn_about(16);
            TEST_ASSERT_TRUE_MESSAGE(ever_slow, told(seed));
        }
    }
}

void test_a_sonar_that_is_not_late_is_never_named_slow(void) {
    for (unsigned seed = 1; seed <= 40; seed++) {
        start(seed, sonars[seed % CASES], 0);
        turn_about(60);
        TEST_ASSERT_FALSE_MESSAGE(ever_slow, told(seed));
        TEST_ASSERT_TRUE_MESSAGE(
            s.e.of[sonar].score[ARGUS_TEST_LAG] < argus_bounds[ARGUS_TEST_LAG].suspicious, told(seed));
    }
}

// The lag begins on the way: what it read before that does not speak for it for ever.
void test_a_sonar_that_becomes_late_is_named_slow(void) {
    for (unsigned seed = 1; seed <= 6; seed++) {
        start(seed, sonars[seed % CASES], 0);
        turn_about(20);
        TEST_ASSERT_FALSE_MESSAGE(ever_slow, told(seed));
        lag = 5;
        turn_about(20);
        TEST_ASSERT_TRUE_MESSAGE(ever_slow, told(seed));
    }
}

// Something comes and goes before a robot that stands, just after it came to rest, too.
static void walk(int firings) {
    int step = scene_random(&s, 2) == 0 ? 120 : -120;
    for (int i = 0; i < firings; i++) {
        walker_mm += step;
        step = walker_mm >= 900 || walker_mm <= -300 ? -step : step;
        stand(1);
    }
    walker_mm = 0;
}

void test_what_walks_before_a_standing_robot_names_nobody_slow(void) {
    for (unsigned seed = 1; seed <= 20; seed++) {
        start(seed, sonars[seed % CASES], 0);
        stand(12);
        walk(120);
        TEST_ASSERT_FALSE_MESSAGE(ever_slow, told(seed));
        TEST_ASSERT_EQUAL_MESSAGE(0, s.e.of[sonar].score[ARGUS_TEST_LAG], told(seed));
    }
}

// A name may be withdrawn; it is the verdict that nobody who walks brings about, at every stop anew.
void test_what_walks_at_every_stop_convicts_nobody_of_being_slow(void) {
    for (unsigned seed = 1; seed <= 60; seed++) {
        start(seed, sonars[seed % CASES], 0);
        for (int i = 0; i < 30; i++) {
            turn_about(1);
            walk((int)scene_random(&s, 12));
        }
        TEST_ASSERT_NOT_EQUAL_MESSAGE(ARGUS_KIND_SLOW, s.convicted[sonar], told(seed));
    }
}

void test_who_stands_is_never_named_slow_however_late(void) {
    start(3, 4, 8);
    stand(400);
    TEST_ASSERT_FALSE(ever_slow);
    TEST_ASSERT_EQUAL(0, s.e.of[4].score[ARGUS_TEST_LAG]);
    for (int n = 0; n < ARGUS_TRAIL; n++) {
        TEST_ASSERT_EQUAL(0, s.e.of[4].lag_doubt[n]); // no change, no doubt
    }
}

// The lag that explains the readings is the one that is doubted least.
void test_the_true_lag_is_doubted_less_than_none(void) {
    for (int late = 2; late <= 8; late++) {
        start((unsigned)late, 4, late);
        turn_about(16);
        const int16_t *doubt = s.e.of[4].lag_doubt;
        TEST_ASSERT_TRUE_MESSAGE(doubt[late] * 3 <= doubt[0], told((unsigned)late));
        TEST_ASSERT_TRUE_MESSAGE(argus_trail_lag_lead(&s.e.of[4]) > 0, told((unsigned)late));
    }
    start(1, 4, 0);
    turn_about(16);
    TEST_ASSERT_EQUAL(0, argus_trail_lag_lead(&s.e.of[4]));
}

// ---- by hand

static argus_case_t *doubts(int at_once, int least_at, int least, int others) {
    argus_evidence_init(&s.e);
    argus_case_t *c = &s.e.of[4];
    for (int n = 0; n < ARGUS_TRAIL; n++) {
        c->lag_doubt[n] = (int16_t)others;
    }
    c->lag_doubt[0] = (int16_t)at_once;
    c->lag_doubt[least_at] = (int16_t)least;
    return c;
}

void test_a_lead_takes_a_lag_that_is_clearly_better(void) {
    for (int n = 2; n < ARGUS_TRAIL; n++) {
        TEST_ASSERT_EQUAL(900, argus_trail_lag_lead(doubts(900, n, 0, 900)));
        TEST_ASSERT_EQUAL(600, argus_trail_lag_lead(doubts(900, n, 300, 900)));
        TEST_ASSERT_EQUAL(0, argus_trail_lag_lead(doubts(900, n, 301, 900)));
        TEST_ASSERT_EQUAL(0, argus_trail_lag_lead(doubts(0, n, 0, 900)));
    }
    TEST_ASSERT_EQUAL(0, argus_trail_lag_lead(doubts(900, 1, 0, 900))); // one firing is within a SIP's age
}

// Contradicted by two others: what its own changes tell says whether it is late or wrong.
static argus_fault_kind_t contradicted(argus_case_t *c) {
    c->score[ARGUS_TEST_VIEW] = argus_bounds[ARGUS_TEST_VIEW].naming;
    c->conflicts = 5;
    for (int i = 0; i < ARGUS_REFUTED; i++) {
        c->refuted[i].partner = (int8_t)(i % 3);
    }
    c->echoes = 8;
    return argus_evidence_names(&s.e, 4);
}

void test_a_contradicted_sonar_is_slow_when_its_changes_come_late(void) {
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, contradicted(doubts(0, 5, 0, 0)));
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, contradicted(doubts(100, 5, 0, 0)));
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, contradicted(doubts(2000, 5, 1500, 2000)));
    TEST_ASSERT_EQUAL(ARGUS_KIND_SLOW, contradicted(doubts(2000, 5, 0, 2000)));
}

// A change of the reading some firings after a turn, with such doubts of each lag so far.
static int score_after_a_late_change(int doubts_so_far, int restless) {
    start(5, 4, 0);
    for (int i = 0; i < BINS; i++) {
        range_mm[i] = 1500;
    }
    turn(60);
    stand(5);
    for (int n = 0; n < ARGUS_TRAIL; n++) {
        s.e.of[4].lag_doubt[n] = (int16_t)doubts_so_far;
    }
    if (restless >= 0) {
        argus_note_unrest(&s.e, &s.k, restless);
    }
    walker_mm = 400;
    fire();
    TEST_ASSERT_EQUAL(restless < 0 || restless == 4, s.e.of[4].lag_doubt[0] > doubts_so_far);
    return s.e.of[4].score[ARGUS_TEST_LAG];
}

void test_a_late_change_counts_only_where_a_lag_explains_them_all_better(void) {
    TEST_ASSERT_TRUE(score_after_a_late_change(0, -1) > 100);
    TEST_ASSERT_EQUAL(0, score_after_a_late_change(2000, -1));
}

// What moves beside it may as well move before it.
void test_a_late_change_counts_for_nothing_while_something_moves_beside_it(void) {
    TEST_ASSERT_EQUAL(0, score_after_a_late_change(0, 5));
    TEST_ASSERT_EQUAL(0, score_after_a_late_change(0, 12));
}

void test_a_restart_forgets_the_doubts(void) {
    doubts(2000, 5, 100, 900);
    argus_evidence_restart(&s.e);
    for (int n = 0; n < ARGUS_TRAIL; n++) {
        TEST_ASSERT_EQUAL(0, s.e.of[4].lag_doubt[n]);
    }
    TEST_ASSERT_EQUAL(0, argus_trail_lag_lead(&s.e.of[4]));
}

// Doubt fades with every change that is counted: no counter wraps, however long it goes on.
void test_doubt_is_bounded_whatever_is_read(void) {
    for (unsigned seed = 1; seed <= 4; seed++) {
        start(seed, 4, 0);
        for (int i = 0; i < 3000; i++) {
            for (int bin = 0; bin < BINS; bin++) {
                range_mm[bin] = 100 + (int)scene_random(&s, 5000); // no two firings alike
            }
            if (scene_random(&s, 4) == 0) {
                turn(scene_random(&s, 2) == 0 ? 20 : -40);
            }
            stand(1);
            for (int n = 0; n < ARGUS_TRAIL; n++) {
                TEST_ASSERT_TRUE_MESSAGE(s.e.of[4].lag_doubt[n] >= 0, told(seed));
                TEST_ASSERT_TRUE_MESSAGE(s.e.of[4].lag_doubt[n] < 4000, told(seed));
            }
            TEST_ASSERT_EQUAL_STRING("", s.broken);
        }
    }
}
