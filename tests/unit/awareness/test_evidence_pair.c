// SPDX-License-Identifier: MIT
// Rule under attack: two readings on one bearing agree, differ, miss or tell nothing, by limits to the
// millimetre, and the same whichever of the two is the newer.
#include <math.h>
#include <stdio.h>

#include "awareness/evidence_internal.h"
#include "unity.h"

#define NONE_MM 5000

static char text[96];

void setUp(void) {
}

void tearDown(void) {
}

static argus_outcome_t swapped(argus_outcome_t of) {
    if (of == ARGUS_PAIR_NOW_MISSES) {
        return ARGUS_PAIR_THEN_MISSES;
    }
    return of == ARGUS_PAIR_THEN_MISSES ? ARGUS_PAIR_NOW_MISSES : of;
}

static void says(argus_outcome_t outcome, int now_mm, int then_mm, int along_mm) {
    snprintf(text, sizeof text, "now %d, then %d, along %d", now_mm, then_mm, along_mm);
    TEST_ASSERT_EQUAL_MESSAGE(outcome, argus_pair_compare(now_mm, then_mm, along_mm), text);
}

// 80 mm and a twentieth of the shorter one, less the way that one was made ahead of the other.
void test_echoes_agree_within_80_mm_and_5_percent_of_the_shorter(void) {
    for (int sign = -1; sign <= 1; sign += 2) {
        for (int along = -200; along <= 200; along += 50) {
            const int limit = sign > 0 ? 80 + 2000 * 5 / 100 : 80 + (2000 - 171) * 5 / 100;
            says(ARGUS_PAIR_AGREE, 2000 + sign * limit, 2000 + along, along);
            says(ARGUS_PAIR_DIFFER, 2000 + sign * (limit + 1), 2000 + along, along);
        }
    }
    says(ARGUS_PAIR_AGREE, 4800, 4900, 0); // from afar, too
    says(ARGUS_PAIR_DIFFER, 1000, 4900, 0);
}

void test_who_hears_none_where_the_other_hears_one_misses(void) {
    says(ARGUS_PAIR_QUIET, NONE_MM, NONE_MM, 100);
    says(ARGUS_PAIR_NOW_MISSES, NONE_MM, 4600, 0);
    says(ARGUS_PAIR_NOTHING, NONE_MM, 4601, 0);
    says(ARGUS_PAIR_NOW_MISSES, NONE_MM, 4700, 100);
    says(ARGUS_PAIR_THEN_MISSES, 4500, NONE_MM, 100);
    says(ARGUS_PAIR_NOTHING, 4501, NONE_MM, 100);
}

// The air may have swallowed the echo: only of silences, from 4 m on, of the place where it is missed.
void test_a_silence_is_faint_where_the_echo_would_be_beyond_4_m(void) {
    TEST_ASSERT_FALSE(argus_pair_is_faint(NONE_MM, 4000, 0));
    TEST_ASSERT_TRUE(argus_pair_is_faint(NONE_MM, 4001, 0));
    TEST_ASSERT_FALSE(argus_pair_is_faint(NONE_MM, 4100, 100));
    TEST_ASSERT_TRUE(argus_pair_is_faint(3901, NONE_MM, 100));
    TEST_ASSERT_FALSE(argus_pair_is_faint(3900, NONE_MM, 100));
    TEST_ASSERT_FALSE(argus_pair_is_faint(4500, 1000, 0));
    TEST_ASSERT_FALSE(argus_pair_is_faint(NONE_MM, NONE_MM, 0));
}

void test_what_would_be_nearer_than_150_mm_tells_nothing(void) {
    for (int now = 100; now <= NONE_MM; now += 100) {
        says(ARGUS_PAIR_NOTHING, now, 249, 100);
    }
    says(ARGUS_PAIR_AGREE, 100, 250, 100);
    says(ARGUS_PAIR_NOW_MISSES, NONE_MM, 250, 100);
    says(ARGUS_PAIR_NOTHING, 149, NONE_MM, 0);
}

// From one place neither is the first.
void test_the_two_may_change_places(void) {
    for (int a = 150; a <= NONE_MM; a += 50) {
        for (int b = 150; b <= NONE_MM; b += 25) {
            says(swapped(argus_pair_compare(a, b, 0)), b, a, 0);
        }
    }
}

void test_a_shift_is_split_along_the_bearing_and_across_it(void) {
    for (int bearing = -18000; bearing < 18000; bearing += 250) {
        const double rad = bearing / 18000.0 * 3.14159265358979;
        for (int along = -200; along <= 200; along += 100) {
            for (int across = -60; across <= 60; across += 30) {
                const long dx = lround(along * cos(rad) - across * sin(rad));
                const long dy = lround(along * sin(rad) + across * cos(rad));
                const argus_shift_t shift = argus_pair_shift((int32_t)dx, (int32_t)dy, bearing);
                snprintf(text, sizeof text, "bearing %d, along %d, across %d", bearing, along, across);
                TEST_ASSERT_INT_WITHIN_MESSAGE(2, along, shift.along_mm, text);
                TEST_ASSERT_INT_WITHIN_MESSAGE(2, across < 0 ? -across : across, shift.lateral_mm, text);
            }
        }
    }
}
