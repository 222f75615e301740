// SPDX-License-Identifier: MIT
// Rule under attack: a weave looks to both sides in turn, each for a round of the array, never farther than
// the gap asks.
#include "adjustment/weave.h"

#include "unity.h"

void test_it_begins_on_the_left(void) {
    argus_weave_t weave = {0};
    TEST_ASSERT_EQUAL(1000, argus_weave_cdeg(&weave, 1, 0, 0));
    TEST_ASSERT_EQUAL(1000, argus_weave_cdeg(&weave, 1, 0, 0)); // not there yet
}

void test_each_side_is_held_for_a_round(void) {
    argus_weave_t weave = {.side = 1};
    for (int side = 1, turns = 0; turns < 6; turns++, side = -side) {
        for (int i = 1; i < 4; i++) {
            TEST_ASSERT_EQUAL(9000 + side * 1000, argus_weave_cdeg(&weave, 1, 9000 + side * 1000, 9000));
        }
        TEST_ASSERT_EQUAL(9000 - side * 1000, argus_weave_cdeg(&weave, 1, 9000 + side * 700, 9000));
    }
}

void test_a_heading_that_is_off_begins_the_round_anew(void) {
    argus_weave_t weave = {.side = 1};
    for (int i = 0; i < 40; i++) {
        TEST_ASSERT_EQUAL(1000, argus_weave_cdeg(&weave, 1, i % 4 == 3 ? 699 : 700, 0));
    }
}

void test_the_swing_grows_with_the_gap_up_to_two(void) {
    const int32_t swing_cdeg[] = {0, 1000, 2000, 2000, 2000};
    for (int gap = 0; gap < 5; gap++) {
        TEST_ASSERT_EQUAL(swing_cdeg[gap], argus_weave_swing_cdeg(gap));
    }
}

void test_it_wraps_at_half_a_turn(void) {
    argus_weave_t weave = {0};
    TEST_ASSERT_EQUAL(-16500, argus_weave_cdeg(&weave, 2, 0, 17500));
}
