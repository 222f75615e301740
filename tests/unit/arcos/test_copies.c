// SPDX-License-Identifier: MIT
// Rule under attack: a SIP that a link delivers again, behind newer ones, is told from one of now; no other
// is.
#include "arcos/copies.h"

#include <string.h>

#include "unity.h"

#define BYTES 40

static argus_copies_t copies;
static uint8_t data[BYTES];

void setUp(void) {
    memset(&copies, 0, sizeof copies);
    memset(data, 0, sizeof data);
    data[0] = 0x32;
}

static bool has(void) {
    const argus_packet_t packet = {.data = data, .count = BYTES};
    return argus_copies_has(&copies, &packet);
}

// At x, with a reading of its own.
static bool has_at(int x, int reading) {
    data[1] = (uint8_t)x;
    data[2] = (uint8_t)(x >> 8);
    data[24] = (uint8_t)reading;
    data[25] = (uint8_t)(reading >> 8);
    return has();
}

void test_what_comes_again_behind_newer_ones_is_a_copy(void) {
    uint32_t sent = 0;
    for (int i = 0; i < 300; i++) {
        TEST_ASSERT_FALSE(has_at(i * 50, 2000 - i));
        const int back = 1 + i % (ARGUS_COPIES_KEPT - 1);
        if (i >= back) {
            TEST_ASSERT_TRUE(has_at((i - back) * 50, 2000 - i + back));
            sent++;
        }
    }
    TEST_ASSERT_EQUAL_UINT32(sent, copies.found);
}

void test_a_burst_of_old_ones_is_told_whole(void) {
    for (int i = 0; i < ARGUS_COPIES_KEPT; i++) {
        TEST_ASSERT_FALSE(has_at(i * 50, 0));
    }
    for (int i = 0; i < ARGUS_COPIES_KEPT - 1; i++) {
        TEST_ASSERT_TRUE(has_at(i * 50, 0));
    }
    TEST_ASSERT_FALSE(has_at(ARGUS_COPIES_KEPT * 50, 0));
}

void test_at_rest_all_are_alike_and_none_is_a_copy(void) {
    for (int i = 0; i < 100; i++) {
        TEST_ASSERT_FALSE(has_at(500, 1000));
    }
    TEST_ASSERT_EQUAL_UINT32(0, copies.found);
}

// The same place again is none: what is read there is of now.
void test_one_that_comes_back_is_there(void) {
    for (int i = 0; i < 100; i++) {
        TEST_ASSERT_FALSE(has_at(i % 2 * 100, i));
    }
}

// Where nothing is noisy a robot that comes back to rest says the same as before.
void test_one_that_comes_back_to_rest_says_the_same(void) {
    for (int i = 0; i < 100; i++) {
        TEST_ASSERT_FALSE(has_at(i / 2 % 2 * 40, 0));
    }
}

// An emulator may put the robot back to where it began, and all is as it was.
void test_one_that_is_put_back_is_there_with_the_next(void) {
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_FALSE(has_at(i * 50, 0));
    }
    TEST_ASSERT_TRUE(has_at(0, 0));
    for (int i = 0; i < 100; i++) {
        TEST_ASSERT_FALSE(has_at(0, 0));
    }
}

// Beside it, or with another heading, is another place, also right after a copy.
void test_one_that_is_put_back_and_moved_is_of_now(void) {
    static const int high_bytes[] = {4, 6}; // of y, of the heading
    for (size_t k = 0; k < sizeof high_bytes / sizeof high_bytes[0]; k++) {
        setUp();
        for (int i = 0; i < 10; i++) {
            TEST_ASSERT_FALSE(has_at(i * 50, 0));
        }
        TEST_ASSERT_TRUE(has_at(0, 0));
        data[high_bytes[k]] = 4;
        TEST_ASSERT_FALSE(has_at(0, 0));
    }
}

void test_one_that_is_older_than_those_kept_is_not_known(void) {
    TEST_ASSERT_FALSE(has_at(1, 0));
    for (int i = 0; i < ARGUS_COPIES_KEPT; i++) {
        TEST_ASSERT_FALSE(has_at(100 + 50 * i, 0));
    }
    TEST_ASSERT_FALSE(has_at(1, 0));
}

void test_what_is_too_short_for_a_place_is_none(void) {
    const argus_packet_t packet = {.data = data, .count = 6};
    TEST_ASSERT_FALSE(argus_copies_has(&copies, &packet));
    TEST_ASSERT_FALSE(argus_copies_has(&copies, &packet));
    TEST_ASSERT_EQUAL_UINT8(0, copies.count);
}
