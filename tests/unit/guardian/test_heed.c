// SPDX-License-Identifier: MIT
// Rule: an order that got lost is found within four SIPs and as many as the link is late by. One that is
// being obeyed, however weakly the robot brakes, is never given again.
#include "guardian/heed.h"

#include "unity.h"

static argus_heed_t heed;

void setUp(void) {
    heed = (argus_heed_t){0};
}

static bool sip(int given, int seen, int late_ms) {
    return argus_heed_sip(&heed, given, seen, 40, 10, late_ms);
}

void test_a_robot_that_goes_on_is_found(void) {
    for (int late_ms = 0; late_ms <= 2000; late_ms += 100) {
        setUp();
        int sips = 1;
        while (!sip(0, 300, late_ms) && sips < 100) {
            sips++;
        }
        TEST_ASSERT_EQUAL_INT(4 + late_ms / 100, sips);
    }
}

void test_it_is_found_again_and_again(void) {
    int found = 0;
    for (int k = 0; k < 100; k++) {
        found += sip(100, 300, 0);
    }
    TEST_ASSERT_INT_WITHIN(4, 33, found);
}

// With each brake from 10 to 200 mm/s in a SIP, also where it begins two SIPs late and scatters.
void test_a_robot_that_brakes_obeys(void) {
    for (int brakes = 25; brakes <= 200; brakes++) {
        setUp();
        int seen = 750;
        for (int k = 0; k < 80; k++) {
            seen = k < 2 ? seen : seen > brakes ? seen - brakes : 0;
            TEST_ASSERT_FALSE(sip(0, seen + (k % 2 == 0 && seen > 60 ? 5 : 0), 0));
        }
    }
}

void test_wheels_that_keep_a_speed_obey(void) {
    for (int k = 0; k < 200; k++) {
        TEST_ASSERT_FALSE(sip(300, k % 2 == 0 ? 330 : 270, 0));
    }
}

// An eighth above the order, and what is spared, is kept; one more is not.
void test_how_much_faster_is_too_fast(void) {
    for (int given = 0; given <= 750; given += 8) {
        setUp();
        for (int k = 0; k < 20; k++) {
            TEST_ASSERT_FALSE(sip(given, given + given / 8 + 40, 0));
        }
        int found = 0;
        for (int k = 0; k < 4; k++) {
            found += sip(given, given + given / 8 + 41, 0);
        }
        TEST_ASSERT_EQUAL_INT(1, found);
    }
}

// However late the link is, it is found.
void test_no_lateness_hides_it_for_ever(void) {
    int sips = 1;
    while (!sip(0, 300, 1000000) && sips < 1000) {
        sips++;
    }
    TEST_ASSERT_EQUAL_INT(255, sips);
}

// Given 10 mm/s a SIP as the weakest brake: one that loses 10 obeys for good, one that loses 9 does not at
// once.
void test_the_weakest_brake_is_the_limit(void) {
    for (int k = 0; k < 70; k++) {
        TEST_ASSERT_FALSE(sip(0, 750 - 10 * k, 0));
    }
    setUp();
    int sips = 1;
    while (!sip(0, 750 - 9 * sips, 0) && sips < 50) {
        sips++;
    }
    TEST_ASSERT_EQUAL_INT(4, sips);
}

// One SIP in which it keeps to the order begins the count anew.
void test_what_was_beyond_before_it_obeyed_does_not_count(void) {
    TEST_ASSERT_FALSE(sip(0, 300, 0));
    TEST_ASSERT_FALSE(sip(0, 300, 0));
    TEST_ASSERT_FALSE(sip(0, 300, 0));
    TEST_ASSERT_FALSE(sip(0, 0, 0));
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_FALSE(sip(0, 300, 0));
    }
    TEST_ASSERT_TRUE(sip(0, 300, 0));
}
