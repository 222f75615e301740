// SPDX-License-Identifier: MIT
// Rule under attack (profile argus): a sonar is late when its readings change with what the robot did some
// firings ago; one whose readings change with the robot at once is never called slow, nor is anyone by what
// walks about.
#include "awareness/evidence.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "awareness/evidence_internal.h"
#include "knowledge/angle.h"
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
    snprintf(text, sizeof text, "seed %u, sonar %d, lag %d, score %d", seed, sonar, lag,
             s.e.of[sonar].score[ARGUS_TEST_LAG]);
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
        TEST_ASSERT_EQUAL(0, s.e.of[4].lag[n]); // all lags explain it alike
    }
}

static int best_lag(void) {
    int best = ARGUS_LEAST_LAG;
    for (int n = ARGUS_LEAST_LAG; n < ARGUS_TRAIL; n++) {
        best = s.e.of[4].lag[n] > s.e.of[4].lag[best] ? n : best;
    }
    return best;
}

void test_the_true_lag_is_the_one_that_speaks_for_itself(void) {
    for (int late = ARGUS_LEAST_LAG; late <= 8; late++) {
        start((unsigned)late, 4, late);
        turn_about(6);
        TEST_ASSERT_EQUAL_MESSAGE(late, best_lag(), told((unsigned)late));
        TEST_ASSERT_EQUAL(s.e.of[4].lag[late], s.e.of[4].score[ARGUS_TEST_LAG]);
    }
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
    static const struct {
        int by;
        argus_fault_kind_t kind;
    } of[] = {
        {0, ARGUS_KIND_WRONG}, {420, ARGUS_KIND_WRONG}, {430, ARGUS_KIND_SLOW}, {2000, ARGUS_KIND_SLOW}};
    for (int i = 0; i < 4; i++) {
        argus_evidence_init(&s.e);
        s.e.of[4].score[ARGUS_TEST_LAG] = (int16_t)of[i].by;
        TEST_ASSERT_EQUAL(of[i].kind, contradicted(&s.e.of[4]));
    }
}

// ---- by hand: one sonar, reading by reading

static argus_case_t one;

static void begin(void) {
    argus_evidence_init(&s.e);
    one = s.e.of[4];
}

static void put(const argus_trail_t *now) {
    one.trail[one.trail_next] = *now;
    one.trail_next = (uint8_t)((one.trail_next + 1) % ARGUS_TRAIL);
    one.trail_count = (uint8_t)(one.trail_count < ARGUS_TRAIL ? one.trail_count + 1 : ARGUS_TRAIL);
}

static void read_at(int of, int reading_mm, int x_mm, int heading_cdeg, bool unrest) {
    const argus_trail_t now = {.reading_mm = (uint16_t)reading_mm,
                               .x_mm = (uint16_t)x_mm,
                               .heading_cdeg = (int16_t)heading_cdeg,
                               .steady = true};
    if (one.trail_count > 0) {
        argus_lag_test(&one, &now, unrest, of);
    }
    put(&now);
}

static int score(void) {
    return one.score[ARGUS_TEST_LAG];
}

static const char *by_hand(int of, int late) {
    snprintf(text, sizeof text, "sonar %d, lag %d, score %d", of, late, score());
    return text;
}

static void be_late(int by) {
    one.score[ARGUS_TEST_LAG] = (int16_t)by;
    argus_lag_restore(&one);
}

#define AHEAD 4      // looks 10 degrees aside
#define FROM_X 65000 // x wraps on the way

// A robot that drives at a wall and stops: the range of a late sonar goes on shrinking.
static void drive_and_stop_on(int late, bool unrest) {
    int wall_mm[40];
    for (int i = 0; i < 40; i++) {
        const int way_mm = i < 12 ? 0 : (i < 26 ? (i - 11) * 60 : 15 * 60);
        wall_mm[i] = 2500 - way_mm * 985 / 1000;
        read_at(AHEAD, wall_mm[i > late ? i - late : 0], FROM_X + way_mm, 0, unrest);
    }
}

static int drive_and_stop(int late, bool unrest) {
    begin();
    drive_and_stop_on(late, unrest);
    return score();
}

void test_who_stops_and_still_sees_the_wall_come_nearer_is_late(void) {
    for (int late = ARGUS_LEAST_LAG; late < ARGUS_TRAIL; late++) {
        TEST_ASSERT_TRUE_MESSAGE(drive_and_stop(late, false) > 250 * argus_min(late, 4),
                                 by_hand(AHEAD, late));
        TEST_ASSERT_EQUAL(score(), one.lag[late]);
    }
    TEST_ASSERT_EQUAL(0, drive_and_stop(0, false));
}

// What moves beside it may as well move before it.
void test_no_step_speaks_for_a_lag_in_unrest(void) {
    TEST_ASSERT_EQUAL(0, drive_and_stop(5, true));
}

// Three stops are enough whatever the lag is, in unrest too, and no more of one that is out: a late sonar
// does well at every rest.
void test_steps_at_once_with_the_motion_clear(void) {
    for (int out = 0; out < 2; out++) {
        begin();
        one.out = out != 0;
        be_late(3000);
        drive_and_stop_on(0, true);
        TEST_ASSERT_TRUE(score() > argus_bounds[ARGUS_TEST_LAG].naming);
        drive_and_stop_on(0, true);
        drive_and_stop_on(0, true);
        TEST_ASSERT_TRUE(score() < argus_bounds[ARGUS_TEST_LAG].suspicious);
    }
}

// A step counts for 3 nats at most, for a lag or against it, however unlikely; time takes a little.
void test_one_step_says_little(void) {
    begin();
    be_late(1500);
    for (int i = 0; i < ARGUS_TRAIL; i++) {
        read_at(AHEAD, 2000, 0, 0, false);
    }
    TEST_ASSERT_EQUAL(1500 - 4 * (ARGUS_TRAIL - 1), score());
    const int before = score();
    read_at(AHEAD, 2000 - 900 * 985 / 1000, 900, 0, false); // drives on, and the reading with it
    for (int n = ARGUS_LEAST_LAG; n < ARGUS_TRAIL; n++) {
        TEST_ASSERT_EQUAL(before - 304, one.lag[n]);
    }
    for (int n = ARGUS_LEAST_LAG; n < ARGUS_TRAIL; n++) { // stands; so does the reading, now it would not
        read_at(AHEAD, 2000 - 900 * 985 / 1000, 900, 0, false);
    }
    TEST_ASSERT_EQUAL(before - 304 - 304 - 4 * (ARGUS_TRAIL - 1 - ARGUS_LEAST_LAG), one.lag[ARGUS_LEAST_LAG]);
    drive_and_stop(ARGUS_LEAST_LAG, false);
    TEST_ASSERT_TRUE(score() <= 2 * 300);
}

// The range of a wall seen aslant may stay the same, or change by all that the robot drives, whatever the
// axis of the sonar foretells: that makes nobody late, and of who is late it takes nothing.
void test_a_wall_beside_the_way_says_nothing_of_a_lag(void) {
    for (int of = 0; of < ARGUS_SONARS; of++) {
        for (int way = 0; way < 6; way++) {
            const int late = way % 2 * 2200;
            begin();
            be_late(late);
            for (int i = 0; i < 60; i++) {
                const int driven_mm = argus_max(0, i - 12) * 60;
                read_at(of, 900 + i % 3 + way / 2 * driven_mm / 2, FROM_X + driven_mm, 0, false);
                TEST_ASSERT_TRUE_MESSAGE(score() <= late, by_hand(of, 0));
            }
            const int forgotten = 4 * 59 + 30 * 12; // and what tells still from straight in the noise
            TEST_ASSERT_TRUE_MESSAGE(score() >= late - 2 * forgotten, by_hand(of, 0));
        }
    }
}

// What reads at random, or hears now and then nothing, while the robot stands and turns, is explained by no
// lag.
void test_random_readings_and_gaps_make_nobody_late(void) {
    for (unsigned seed = 1; seed <= 8; seed++) {
        begin();
        scene_init(&s, seed, START_MS);
        int turned = 0;
        for (int i = 0; i < 3000; i++) {
            const bool turns = i / 10 % 2 == 0 && scene_random(&s, 2) == 0;
            turned += turns ? 1 : 0;
            const bool gap = scene_random(&s, 3) == 0;
            const int random_mm = 200 + (int)scene_random(&s, 4800);
            const int heading_cdeg = turned * 1500 % 36000 - 18000;
            const int there_mm = 800 + turned % 24 * 7919 % 2000;
            read_at(AHEAD, seed % 2 == 0 ? random_mm : (gap ? 5000 : there_mm), 0, heading_cdeg, false);
            TEST_ASSERT_TRUE_MESSAGE(score() < argus_bounds[ARGUS_TEST_LAG].naming, told(seed));
        }
    }
}

// An echo that comes or goes while the robot stands, and would not have while it turned, is late; one that
// does so in a turn is not.
void test_echoes_that_come_and_go_after_a_turn_are_late(void) {
    for (int late = 0; late < 5; late += 4) {
        begin();
        for (int turn = 0; turn < 6; turn++) {
            for (int i = 0; i < 14; i++) {
                const int step = turn * 14 + i;
                const int seen = step - late; // an echo on every other heading
                const bool echo = seen < 0 || seen / 14 % 2 == 0;
                read_at(AHEAD, echo ? 1500 : 5000, 0, step / 14 * 3000, false);
            }
        }
        TEST_ASSERT_EQUAL_MESSAGE(late > 0, score() >= 700, by_hand(AHEAD, late));
    }
}

// A stretch that it has read before, on a steady way among people; `same`: so many readings of it.
static int replay(int lag_of, int same, int spread_mm) {
    begin();
    int last[ARGUS_TRAIL];
    for (int i = 0; i < ARGUS_TRAIL; i++) {
        last[i] = 1400 + (ARGUS_TRAIL - i) * spread_mm + i % 2;
        read_at(AHEAD, last[i], i * spread_mm, 0, true);
    }
    for (int i = 0; i < same; i++) {
        read_at(AHEAD, last[ARGUS_TRAIL - lag_of + i], (ARGUS_TRAIL + i) * spread_mm, 0, true);
    }
    return score();
}

void test_three_readings_that_it_has_given_before_name_it_also_among_people(void) {
    const argus_bounds_t *const level = &argus_bounds[ARGUS_TEST_LAG];
    for (int n = 3; n < ARGUS_TRAIL; n++) {
        TEST_ASSERT_TRUE_MESSAGE(replay(n, 2, 60) < level->naming, by_hand(AHEAD, n));
        TEST_ASSERT_TRUE_MESSAGE(replay(n, 3, 60) >= level->naming_busy, by_hand(AHEAD, n));
    }
}

// However long the stretch is, and so the lag.
void test_readings_given_before_convict_nobody(void) {
    for (int n = ARGUS_LEAST_LAG; n < ARGUS_TRAIL; n++) {
        replay(n, n, 60);
        TEST_ASSERT_TRUE_MESSAGE(score() < argus_bounds[ARGUS_TEST_LAG].convincing, by_hand(AHEAD, n));
    }
}

// Where all readings are much alike some are the same by chance; the shortest are all alike.
void test_what_hardly_varies_is_not_known_again(void) {
    for (int n = 3; n < ARGUS_TRAIL; n++) {
        replay(n, 3, 5);
        TEST_ASSERT_TRUE_MESSAGE(score() < argus_bounds[ARGUS_TEST_LAG].suspicious, by_hand(AHEAD, n));
    }
    replay(3, 3, 60);
    const int known = score();
    begin();
    for (int i = 0; i < 12; i++) {
        read_at(AHEAD, i % 4 == 0 ? 400 : 100 + i % 4, i * 60, 0, true);
    }
    TEST_ASSERT_TRUE(score() < known / 2);
}

// At an edge two or three echoes take turns: no stretch of the past comes again and again.
void test_echoes_that_take_turns_make_nobody_late(void) {
    for (int period = 2; period < 4; period++) {
        begin();
        for (int i = 0; i < 60; i++) {
            read_at(AHEAD, 1000 + i % period * 300, 0, 0, true);
            const argus_bounds_t *const level = &argus_bounds[ARGUS_TEST_LAG];
            TEST_ASSERT_TRUE_MESSAGE(score() < (period == 2 ? level->naming : level->naming_busy),
                                     by_hand(AHEAD, period));
        }
        TEST_ASSERT_TRUE_MESSAGE(score() < argus_bounds[ARGUS_TEST_LAG].naming, by_hand(AHEAD, period));
    }
}

// Trails are forgotten with the session, sums are not.
void test_a_restart_compares_nothing_with_what_was_before(void) {
    begin();
    for (int i = 0; i < ARGUS_TRAIL; i++) {
        read_at(AHEAD, 2000 - i * 60, i * 60, 0, false);
    }
    be_late(700);
    s.e.of[4] = one;
    argus_evidence_restart(&s.e);
    one = s.e.of[4];
    for (int i = 0; i < 5; i++) { // as five firings ago
        read_at(AHEAD, 2000 - (5 + i) * 60, (ARGUS_TRAIL + i) * 60, 0, false);
    }
    TEST_ASSERT_TRUE(score() <= 700 && score() >= 680);
}

// Caution makes every step, and what is forgotten, worth less; less caution than usual leaves them as they
// are, since its levels are as low as they may be.
void test_caution_scales_the_sums(void) {
    const int full = drive_and_stop(5, false);
    static const struct {
        int caution;
        int of_full;
    } by[] = {{25, 100}, {50, 100}, {100, 100}, {200, 50}, {400, 25}};
    for (int i = 0; i < 5; i++) {
        begin();
        one.caution = (uint16_t)by[i].caution;
        drive_and_stop_on(5, false);
        TEST_ASSERT_INT_WITHIN(by[i].of_full < 100 ? 60 : 0, full * by[i].of_full / 100, score());
    }
}

// No counter wraps, whatever is read and however long it goes on.
void test_sums_are_bounded_whatever_is_read(void) {
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
                TEST_ASSERT_TRUE_MESSAGE(s.e.of[4].lag[n] >= 0, told(seed));
                TEST_ASSERT_TRUE_MESSAGE(s.e.of[4].lag[n] <= argus_bounds[ARGUS_TEST_LAG].ceiling,
                                         told(seed));
            }
            TEST_ASSERT_EQUAL_STRING("", s.broken);
        }
    }
}
