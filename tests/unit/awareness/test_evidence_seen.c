// SPDX-License-Identifier: MIT
// Rule under attack (profile argus): what a robot at rest sees again and again fills one place of the memory,
// and no reading that differs is lost; how many firings ago something was seen stays known.
#include <stdio.h>
#include <string.h>

#include "awareness/evidence_said.h"
#include "unity.h"

static argus_peer_t me;
static char text[200];

void setUp(void) {
    memset(&me, 0, sizeof me);
}

void tearDown(void) {
}

static argus_glimpse_t seen(uint32_t t_ms, int x_mm, int y_mm, int bearing_cdeg, int mm) {
    return (argus_glimpse_t){.t_ms = t_ms,
                             .x_mm = (uint16_t)x_mm,
                             .y_mm = (uint16_t)y_mm,
                             .bearing_cdeg = (int16_t)bearing_cdeg,
                             .reading_mm = (uint16_t)mm};
}

static void note(uint32_t t_ms, int x_mm, int mm) {
    argus_seen_note(&me, seen(t_ms, x_mm, 0, 0, mm));
}

// ---- what is one glimpse

// From within 5 mm, on within 0.3 degrees, within 30 mm: one glimpse, the first, of the time of the last.
void test_what_is_alike_is_one_glimpse(void) {
    static const struct {
        int x_mm;
        int y_mm;
        int bearing_cdeg;
        int mm;
        int glimpses;
    } by[] = {{0, 0, 0, 1000, 1},  {5, 0, 0, 1000, 1},   {6, 0, 0, 1000, 2},  {0, -5, 0, 1000, 1},
              {0, -6, 0, 1000, 2}, {0, 0, 30, 1000, 1},  {0, 0, 31, 1000, 2}, {0, 0, -31, 1000, 2},
              {0, 0, 0, 1030, 1},  {0, 0, 0, 1031, 2},   {0, 0, 0, 969, 2},   {0, 0, 0, 5000, 2},
              {0, 0, 0, 970, 1},   {-5, 5, -30, 970, 1}, {-6, 0, 0, 1000, 2}, {32768, 0, 0, 1000, 2}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        setUp();
        argus_seen_note(&me, seen(100, 0, 0, 0, 1000));
        const argus_glimpse_t now = seen(420, by[i].x_mm, by[i].y_mm, by[i].bearing_cdeg, by[i].mm);
        argus_seen_note(&me, now);
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].glimpses, me.count, text);
        const argus_glimpse_t *last = argus_seen_at(&me, 1);
        const bool new = by[i].glimpses == 2;
        TEST_ASSERT_EQUAL_MESSAGE(420, last->t_ms, text);
        TEST_ASSERT_EQUAL_MESSAGE(new ? now.x_mm : 0, last->x_mm, text);
        TEST_ASSERT_EQUAL_MESSAGE(new ? now.y_mm : 0, last->y_mm, text);
        TEST_ASSERT_EQUAL_MESSAGE(new ? now.bearing_cdeg : 0, last->bearing_cdeg, text);
        TEST_ASSERT_EQUAL_MESSAGE(new ? now.reading_mm : 1000, last->reading_mm, text);
        TEST_ASSERT_EQUAL_MESSAGE(2 - by[i].glimpses, last->repeats, text);
    }
}

// Both sides of the seams of place and bearing are alike.
void test_what_is_alike_is_so_across_the_seams(void) {
    argus_seen_note(&me, seen(0, 65534, 2, 17990, 1000));
    argus_seen_note(&me, seen(1, 1, 65535, -17990, 1000));
    TEST_ASSERT_EQUAL(1, me.count);
}

// An echo from afar is no silence.
void test_an_echo_is_never_alike_to_a_silence(void) {
    static const int mm[][3] = {
        {5000, 5000, 1}, {5000, 65535, 2}, {4999, 5000, 2}, {5000, 4999, 2}, {4999, 4998, 1}};
    for (int i = 0; i < 5; i++) {
        setUp();
        note(1, 0, mm[i][0]);
        note(2, 0, mm[i][1]);
        TEST_ASSERT_EQUAL(mm[i][2], me.count);
    }
}

// Small steps add up: each is alike to the one before, but not to the first.
void test_what_creeps_is_not_one_glimpse(void) {
    for (int way = 0; way < 3; way++) {
        setUp();
        for (int i = 0; i < 21; i++) {
            argus_seen_note(&me, seen((uint32_t)i, way == 0 ? 5 * i : 0, 0, way == 1 ? 30 * i : 0,
                                      way == 2 ? 1000 + 30 * i : 1000));
        }
        TEST_ASSERT_EQUAL(11, me.count);
    }
}

// Only what follows at once: an echo that is heard again after a gap is another glimpse.
void test_what_comes_again_is_a_glimpse_of_its_own(void) {
    for (int i = 0; i < 9; i++) {
        note((uint32_t)i, 0, i % 3 == 2 ? 5000 : 1000);
    }
    TEST_ASSERT_EQUAL(6, me.count);
    static const int mm[] = {5000, 1000, 5000, 1000, 5000, 1000};
    for (int back = 1; back <= 6; back++) {
        TEST_ASSERT_EQUAL(mm[back - 1], argus_seen_at(&me, back)->reading_mm);
    }
    TEST_ASSERT_NULL(argus_seen_at(&me, 7));
}

// However long the robot stands, what it saw before is remembered; the count ends, it does not wrap.
void test_a_robot_at_rest_forgets_nothing(void) {
    note(1, 500, 3000);
    for (uint32_t i = 0; i < 70000; i++) {
        note(2 + i / 2, 0, 1000);
    }
    TEST_ASSERT_EQUAL(2, me.count);
    TEST_ASSERT_EQUAL(UINT16_MAX, argus_seen_at(&me, 1)->repeats);
    TEST_ASSERT_EQUAL(3000, argus_seen_at(&me, 2)->reading_mm);
}

// ... for 40 s, across the wrap of the clock; a clock that has come round finds nothing that looks new.
void test_what_is_too_old_goes(void) {
    for (uint32_t late = 0; late < 2; late++) {
        setUp();
        note(UINT32_MAX - 20000, 0, 1000);
        note(UINT32_MAX - 19000, 500, 1000);
        note(UINT32_MAX - 20000 + 40000 + late, 900, 1000);
        TEST_ASSERT_EQUAL(3 - late, me.count);
        TEST_ASSERT_EQUAL(late == 0 ? 0 : 500, argus_seen_at(&me, me.count)->x_mm);
    }
    note(60000000, 0, 1000);
    TEST_ASSERT_EQUAL(1, me.count);
    argus_seen_weigh(&me, 1);
    argus_seen_forget(&me);
    TEST_ASSERT_NULL(argus_seen_at(&me, 1));
    note(60000001, 0, 1000);
    TEST_ASSERT_EQUAL(1, me.count);
    TEST_ASSERT_FALSE(argus_seen_is_weighed(&me, 1));
}

// In motion the last 64 are remembered.
void test_the_oldest_glimpse_makes_room(void) {
    for (int i = 1; i <= 3 * ARGUS_GLIMPSES; i++) {
        note((uint32_t)i, 10 * i, 1000);
        TEST_ASSERT_EQUAL(i < ARGUS_GLIMPSES ? i : ARGUS_GLIMPSES, me.count);
        TEST_ASSERT_EQUAL(i, argus_seen_at(&me, 1)->t_ms);
        TEST_ASSERT_EQUAL(i - me.count + 1, argus_seen_at(&me, me.count)->t_ms);
    }
}

// ---- so many firings before

// A robot that drove, stood for a while and drove on: each firing has the place that it was made from.
void test_the_place_of_each_firing_stays_known(void) {
    enum { FIRINGS = 40 };
    int x_mm[FIRINGS];
    for (int i = 0; i < FIRINGS; i++) {
        const bool moves = i < 10 || (i >= 17 && i < 25) || i == 30;
        x_mm[i] = (i > 0 ? x_mm[i - 1] : 0) + (moves ? 60 : 0);
        note((uint32_t)i, x_mm[i], 1000);
    }
    for (int firings = 0; firings < FIRINGS; firings++) {
        snprintf(text, sizeof text, "%d before", firings);
        const argus_glimpse_t *at = argus_seen_before(&me, 1, firings);
        TEST_ASSERT_NOT_NULL_MESSAGE(at, text);
        TEST_ASSERT_EQUAL_MESSAGE(x_mm[FIRINGS - 1 - firings], at->x_mm, text);
    }
    TEST_ASSERT_NULL(argus_seen_before(&me, 1, FIRINGS));
}

// From a glimpse farther back: its last firing counts.
void test_firings_count_from_the_last_of_a_glimpse(void) {
    for (int i = 0; i < 12; i++) {
        note((uint32_t)i, 100 * (i / 3), 1000); // four places, three firings in each
    }
    TEST_ASSERT_EQUAL(4, me.count);
    for (int back = 1; back <= 4; back++) {
        for (int firings = 0; firings < 12; firings++) {
            const int place = 4 - back - firings / 3;
            const argus_glimpse_t *at = argus_seen_before(&me, back, firings);
            snprintf(text, sizeof text, "%d back, %d before", back, firings);
            if (place < 0) {
                TEST_ASSERT_NULL_MESSAGE(at, text);
            } else {
                TEST_ASSERT_EQUAL_MESSAGE(100 * place, at->x_mm, text);
            }
        }
    }
}

// ---- judged once

// Each glimpse for itself, through the whole ring; a new one, or one more reading of it, is not judged yet.
void test_what_was_judged_is_known_for_each_glimpse(void) {
    for (int i = 0; i < 100; i++) {
        note((uint32_t)i, 10 * i, 1000);
        TEST_ASSERT_FALSE(argus_seen_is_weighed(&me, 1));
        if (i % 3 == 0) {
            argus_seen_weigh(&me, 1);
        }
    }
    for (int back = 1; back <= ARGUS_GLIMPSES; back++) {
        TEST_ASSERT_EQUAL((100 - back) % 3 == 0, argus_seen_is_weighed(&me, back));
    }
    argus_seen_weigh(&me, 1);
    note(100, 990, 1000);
    TEST_ASSERT_FALSE(argus_seen_is_weighed(&me, 1));
}

// ---- finding

// The latest that is near enough in place, bearing and time; older ones after it, none beyond the age.
void test_the_latest_from_there_is_found_first(void) {
    for (int i = 0; i < 20; i++) {
        argus_seen_note(&me, seen((uint32_t)(100 * i), 0, 0, i % 2 == 0 ? 0 : 2000, 1000 + 100 * i));
    }
    const argus_glimpse_t at = seen(2000, 100, 0, 299, 0);
    const argus_gaze_t gaze = {.at = &at, .now_ms = 2000, .age_ms = 1000, .span_cdeg = 300};
    int32_t along_mm = 0;
    int found = 0;
    for (int back = argus_seen_find(&me, &gaze, 0, &along_mm); back > 0;
         back = argus_seen_find(&me, &gaze, back, &along_mm)) {
        found++;
        TEST_ASSERT_EQUAL(2 * found, back);
        TEST_ASSERT_INT_WITHIN(1, 100, along_mm);
    }
    TEST_ASSERT_EQUAL(5, found); // of 1000 ms and later
}
