// SPDX-License-Identifier: MIT
// Attacks: the clock never goes back, and it counts milliseconds of CLOCK_MONOTONIC.
#include <time.h>

#include "hal/clock.h"
#include "unity.h"

void test_never_goes_back(void) {
    const hal_clock_t clock = hal_clock_monotonic();
    uint32_t last = hal_clock_now_ms(&clock);
    for (int i = 0; i < 100000; i++) {
        const uint32_t now = hal_clock_now_ms(&clock);
        TEST_ASSERT_TRUE((int32_t)(now - last) >= 0);
        last = now;
    }
}

void test_lies_between_two_readings_of_the_system(void) {
    const hal_clock_t clock = hal_clock_monotonic();
    struct timespec before;
    struct timespec after;
    clock_gettime(CLOCK_MONOTONIC, &before);
    const uint32_t now = hal_clock_now_ms(&clock);
    clock_gettime(CLOCK_MONOTONIC, &after);
    const uint32_t low = (uint32_t)((uint64_t)before.tv_sec * 1000u + (uint64_t)before.tv_nsec / 1000000u);
    const uint32_t high = (uint32_t)((uint64_t)after.tv_sec * 1000u + (uint64_t)after.tv_nsec / 1000000u);
    TEST_ASSERT_TRUE(now - low <= high - low);
}
