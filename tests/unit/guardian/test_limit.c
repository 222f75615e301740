// SPDX-License-Identifier: MIT
// Attacks: what a client may take of the robot's line is bounded at every rate and across the clock's wrap,
// and comes back with time.
#include "guardian/limit.h"

#include <string.h>

#include "unity.h"

static argus_limit_t limit;

void setUp(void) {
    memset(&limit, 0, sizeof limit);
}

void test_no_rate_takes_more_than_its_share(void) {
    for (uint32_t every_ms = 1; every_ms <= 500; every_ms += 7) {
        setUp();
        uint32_t passed = 0;
        const uint32_t start_ms = UINT32_MAX - 3000; // the clock wraps
        for (uint32_t t_ms = 0; t_ms < 10000; t_ms += every_ms) {
            passed += argus_limit_pass(&limit, start_ms + t_ms, 9) ? 9 : 0;
        }
        TEST_ASSERT_TRUE(passed <= 400 + 3000);
        TEST_ASSERT_TRUE(every_ms > 20 || passed > 2900);
    }
}

void test_what_is_dropped_is_counted_once_a_second(void) {
    for (int i = 0; i < 100; i++) {
        argus_limit_pass(&limit, 5000, 40);
    }
    TEST_ASSERT_EQUAL_UINT32(90, argus_limit_second(&limit, 5000));
    TEST_ASSERT_EQUAL_UINT32(0, argus_limit_second(&limit, 5500));
    TEST_ASSERT_TRUE(argus_limit_pass(&limit, 7000, 40));
}

void test_orders_wait_for_the_next_sip(void) {
    for (int sip = 0; sip < 3; sip++) {
        int passed = 0;
        for (int i = 0; i < 100; i++) {
            passed += argus_limit_order(&limit);
        }
        TEST_ASSERT_EQUAL_INT(10, passed);
        argus_limit_sip(&limit);
    }
}

void test_words_come_back_after_a_second(void) {
    for (uint32_t t_ms = 1000; t_ms <= 4000; t_ms += 1000) {
        int passed = 0;
        for (int i = 0; i < 20; i++) {
            passed += argus_limit_word(&limit);
        }
        TEST_ASSERT_EQUAL_INT(5, passed);
        TEST_ASSERT_EQUAL_UINT32(15, argus_limit_second(&limit, t_ms));
        TEST_ASSERT_EQUAL_UINT32(0, argus_limit_second(&limit, t_ms + 999));
    }
}

// From full to empty, after ten seconds and after any longer time.
void test_after_long_all_of_it_is_there_again(void) {
    static const uint32_t after_ms[] = {9999, 10000, 10001, 20000, 0x80000000u};
    for (unsigned i = 0; i < sizeof after_ms / sizeof after_ms[0]; i++) {
        setUp();
        TEST_ASSERT_TRUE(argus_limit_pass(&limit, 0, 400));
        TEST_ASSERT_FALSE(argus_limit_pass(&limit, 0, 1));
        TEST_ASSERT_TRUE(argus_limit_pass(&limit, after_ms[i], 400));
    }
}
