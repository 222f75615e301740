// SPDX-License-Identifier: MIT
// Rule under attack (profile argus): the log keeps what each sonar heard last, from where and on which
// bearing; what a robot at rest hears again and again fills one place of it; how many firings ago it was
// stays known.
#include "awareness/pings.h"

#include <stdio.h>
#include <string.h>

#include "unity.h"

static argus_pings_t log_;
static char text[200];

void setUp(void) {
    memset(&log_, 0, sizeof log_);
}

static argus_ping_t ping(uint32_t t_ms, int x_mm, int y_mm, int bearing_cdeg, int mm) {
    return (argus_ping_t){.t_ms = (uint16_t)(t_ms & 0xFFFFu),
                          .x_mm = (uint16_t)x_mm,
                          .y_mm = (uint16_t)y_mm,
                          .bearing_cdeg = (int16_t)bearing_cdeg,
                          .reading_mm = (uint16_t)mm,
                          .steady = 1};
}

static void note(uint32_t t_ms, int x_mm, int mm) {
    argus_pings_note(&log_, ping(t_ms, x_mm, 0, 0, mm));
}

// From one place, on one bearing, about as far: one ping, from the first place, of the last reading and time.
void test_what_is_alike_is_one_ping(void) {
    static const struct {
        int x_mm, y_mm, bearing_cdeg, mm;
        bool alike;
    } by[] = {{0, 0, 0, 1000, true},      {4, -4, 20, 1020, true},   {65532, 4, -20, 985, true},
              {60, 0, 0, 1000, false},    {0, 60, 0, 1000, false},   {0, 0, 200, 1000, false},
              {0, 0, -200, 1000, false},  {0, 0, 0, 1100, false},    {0, 0, 0, 5000, false},
              {32768, 0, 0, 1000, false}, {0, 0, 18000, 1000, false}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        setUp();
        note(100, 0, 1000);
        argus_pings_note(&log_, ping(420, by[i].x_mm, by[i].y_mm, by[i].bearing_cdeg, by[i].mm));
        snprintf(text, sizeof text, "case %d", i);
        const argus_ping_t *last = argus_pings_at(&log_, 1);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].alike ? 1 : 2, log_.count, text);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].alike, last->repeats, text);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].alike ? 0 : (uint16_t)by[i].x_mm, last->x_mm, text);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].mm, last->reading_mm, text);
        TEST_ASSERT_EQUAL_MESSAGE(420, last->t_ms, text);
    }
}

// Both sides of the seams of place and bearing are alike; an echo from afar is no silence.
void test_the_seams_part_nothing_and_silence_does(void) {
    argus_pings_note(&log_, ping(0, 65534, 2, 17990, 1000));
    argus_pings_note(&log_, ping(1, 1, 65535, -17990, 1000));
    TEST_ASSERT_EQUAL(1, log_.count);
    setUp();
    note(1, 0, 4999);
    note(2, 0, 5000);
    TEST_ASSERT_EQUAL(2, log_.count);
}

// The oldest makes room; firings count through what was alike; beyond the log there is nothing.
void test_the_place_of_each_firing_stays_known(void) {
    for (int i = 0; i < ARGUS_PINGS + 7; i++) {
        for (int again = 0; again < 3; again++) {
            note((uint32_t)(10 * i + again), 100 * i, 1000 + i);
        }
    }
    TEST_ASSERT_EQUAL(ARGUS_PINGS, log_.count);
    for (int firings = 0; firings < 3 * ARGUS_PINGS; firings++) {
        const int expect = 1000 + ARGUS_PINGS + 6 - firings / 3;
        TEST_ASSERT_EQUAL(expect, argus_pings_before(&log_, 1, firings)->reading_mm);
    }
    TEST_ASSERT_NULL(argus_pings_before(&log_, 1, 3 * ARGUS_PINGS));
    TEST_ASSERT_NULL(argus_pings_at(&log_, ARGUS_PINGS + 1));
    TEST_ASSERT_NULL(argus_pings_at(&log_, 0));
}

// What is older than 40 s goes, whatever the clock says at the time.
void test_what_is_old_goes(void) {
    for (uint32_t begin = 0; begin < 0x20000u; begin += 9973) {
        setUp();
        for (uint32_t i = 0; i < 8; i++) {
            note(begin + 10000 * i, (int)(100 * i), 1000);
            argus_pings_age(&log_, begin + 10000 * i);
        }
        snprintf(text, sizeof text, "from %u ms", (unsigned)begin);
        TEST_ASSERT_EQUAL_MESSAGE(5, log_.count, text);
        argus_pings_age(&log_, begin + 70000 + 20001);
        TEST_ASSERT_EQUAL_MESSAGE(2, log_.count, text);
    }
}

// A standing thing comes nearer by the way along the bearing, and goes on so; a leap does not.
void test_a_standing_thing_goes_on(void) {
    const argus_ping_t then = ping(0, 0, 0, 0, 2000);
    TEST_ASSERT_INT_WITHIN(1, 1900, (int)argus_ping_predict_mm(&(argus_ping_t){.x_mm = 100}, &then));
    const argus_ping_t on = ping(300, 100, 0, 0, 1900), leapt = ping(300, 100, 0, 0, 1500);
    const argus_ping_t aside = ping(300, 100, 0, 1000, 1900), none = ping(300, 100, 0, 0, 5000);
    TEST_ASSERT_TRUE(argus_ping_goes_on(&on, &then));
    TEST_ASSERT_FALSE(argus_ping_goes_on(&leapt, &then));
    TEST_ASSERT_FALSE(argus_ping_goes_on(&aside, &then));
    TEST_ASSERT_FALSE(argus_ping_goes_on(&none, &then));
    TEST_ASSERT_TRUE(argus_ping_goes_on(&none, &none));
}

// Along the bearing and beside it, on every bearing.
void test_a_shift_is_split_along_the_bearing_and_across_it(void) {
    for (int deg = -180; deg < 180; deg += 90) {
        argus_ping_t then = ping(0, 0, 0, deg * 100, 0), now = then;
        const int c = deg == 0 ? 1 : deg == -180 ? -1 : 0, s = deg == 90 ? 1 : deg == -90 ? -1 : 0;
        now.x_mm = (uint16_t)(150 * c - 40 * s);
        now.y_mm = (uint16_t)(150 * s + 40 * c);
        const argus_shift_t shift = argus_ping_shift(&now, &then);
        TEST_ASSERT_INT_WITHIN(1, 150, (int)shift.along_mm);
        TEST_ASSERT_INT_WITHIN(1, 40, (int)shift.lateral_mm);
    }
}

// ---- asked for those near another

static int near_by_definition(const argus_ping_t *at, int from) {
    for (int back = from; back <= log_.count; back++) {
        const argus_ping_t *then = argus_pings_at(&log_, back);
        if (argus_ping_turned_cdeg(at, then) <= 500 && argus_ping_is_within(at, then, 200)) {
            return back;
        }
    }
    return 0;
}

// Whatever the bearing, on both sides of the seam and of every sector: none that is near is left out.
void test_all_that_is_near_is_found(void) {
    int found = 0;
    for (int bearing = -18000 + 37; bearing <= 18000; bearing += 37) {
        const argus_ping_t at = ping(0, 65500, 100, bearing, 1000);
        setUp();
        for (int i = 0; i < ARGUS_PINGS + 5; i++) {
            const int turned = bearing + (i * 97 - 1700) % 700;
            const int wrapped = turned > 18000 ? turned - 36000 : turned <= -18000 ? turned + 36000 : turned;
            argus_pings_note(&log_,
                             ping((uint32_t)i, (65500 + 29 * i % 300) & 0xFFFF, 100, wrapped, 1000 + 40 * i));
        }
        const argus_line_t line = argus_ping_line(&at);
        uint32_t left = argus_pings_beside(&log_, &line);
        int back = 0;
        do {
            snprintf(text, sizeof text, "bearing %d from %d", bearing, back + 1);
            const int expected = near_by_definition(&at, back + 1);
            back = argus_pings_near(&log_, &left, &line);
            TEST_ASSERT_EQUAL_MESSAGE(expected, back, text);
            found += back > 0;
        } while (back > 0);
    }
    TEST_ASSERT_TRUE(found > 1000);
}

// A sonar that looked elsewhere all the time is not near, wherever it was.
void test_another_bearing_is_never_near(void) {
    for (int turn = 501; turn <= 36000 - 501; turn += 13) {
        setUp();
        argus_pings_note(&log_, ping(0, 0, 0, 0, 1000));
        const argus_ping_t at = ping(1, 0, 0, turn > 18000 ? turn - 36000 : turn, 1000);
        const argus_line_t line = argus_ping_line(&at);
        uint32_t left = argus_pings_beside(&log_, &line);
        TEST_ASSERT_EQUAL(0, argus_pings_near(&log_, &left, &line));
    }
}
