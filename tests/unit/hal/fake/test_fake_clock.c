// SPDX-License-Identifier: MIT
// Attacks: the fake clock shows what it was set to, wraps like a real one, and counts its readings.
#include "hal/fake_clock.h"
#include "unity.h"

void test_shows_what_was_set(void) {
    hal_fake_clock_t fake = {.now_ms = UINT32_MAX};
    const hal_clock_t clock = hal_fake_clock(&fake);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, hal_clock_now_ms(&clock));
    fake.now_ms += 2;
    TEST_ASSERT_EQUAL_UINT32(1, hal_clock_now_ms(&clock));
    TEST_ASSERT_EQUAL_UINT32(2, fake.calls);
}
