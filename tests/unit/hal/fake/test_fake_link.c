// SPDX-License-Identifier: MIT
// Attacks: the fake link is a perfect wire without faults, injects each fault as asked, and repeats itself by
// seed.
#include <string.h>

#include "hal/fake_clock.h"
#include "hal/fake_link.h"
#include "unity.h"

static hal_fake_link_t fake;
static hal_fake_clock_t time_;
static hal_clock_t clock_;
static hal_link_t link_;

void setUp(void) {
    time_ = (hal_fake_clock_t){.now_ms = 1000};
    clock_ = hal_fake_clock(&time_);
    hal_fake_link_init(&fake, 1, &clock_);
    link_ = hal_fake_link(&fake);
}

void test_perfect_wire(void) {
    uint8_t bytes[16];
    TEST_ASSERT_EQUAL_INT(0, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(4, hal_link_write(&link_, (const uint8_t *)"ping", 4));
    TEST_ASSERT_EQUAL_size_t(4, hal_fake_link_take(&fake, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_MEMORY("ping", bytes, 4);
    TEST_ASSERT_EQUAL_size_t(4, hal_fake_link_put(&fake, (const uint8_t *)"pong", 4));
    TEST_ASSERT_EQUAL_INT(4, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_MEMORY("pong", bytes, 4);
    TEST_ASSERT_EQUAL_STRING("fake", hal_link_describe(&link_));
    TEST_ASSERT_EQUAL_INT(-1, hal_link_fd(&link_));
    TEST_ASSERT_EQUAL_INT(0, hal_link_flush(&link_));
    TEST_ASSERT_EQUAL_UINT32(4, hal_link_counters(&link_).bytes_in);
    hal_link_close(&link_);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_OPEN, hal_link_read(&link_, bytes, sizeof bytes));
}

void test_long_traffic_wraps_the_buffer(void) {
    uint8_t sent[100];
    uint8_t got[100];
    for (int round = 0; round < 500; round++) {
        memset(sent, round, sizeof sent);
        TEST_ASSERT_EQUAL_size_t(sizeof sent, hal_fake_link_put(&fake, sent, sizeof sent));
        TEST_ASSERT_EQUAL_INT(sizeof got, hal_link_read(&link_, got, sizeof got));
        TEST_ASSERT_EQUAL_MEMORY(sent, got, sizeof got);
    }
}

void test_full_is_would_block(void) {
    static uint8_t packet[HAL_LINK_PACKET_MAX + 1];
    TEST_ASSERT_EQUAL_INT(HAL_LINK_TOO_LONG, hal_link_write(&link_, packet, sizeof packet));
    for (int i = 0; i < HAL_FAKE_BYTES / HAL_LINK_PACKET_MAX; i++) {
        TEST_ASSERT_EQUAL_INT(HAL_LINK_PACKET_MAX, hal_link_write(&link_, packet, HAL_LINK_PACKET_MAX));
    }
    TEST_ASSERT_EQUAL_INT(0, hal_link_write(&link_, packet, 1));
    TEST_ASSERT_EQUAL_UINT32(1, hal_link_counters(&link_).would_block);
}

void test_short_reads(void) {
    uint8_t bytes[16];
    fake.read_max = 3;
    hal_fake_link_put(&fake, (const uint8_t *)"12345678", 8);
    TEST_ASSERT_EQUAL_INT(3, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(3, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(2, hal_link_read(&link_, bytes, sizeof bytes));
}

void test_delay(void) {
    uint8_t bytes[16];
    fake.from_robot.delay_ms = 40;
    hal_fake_link_put(&fake, (const uint8_t *)"a", 1);
    time_.now_ms += 39;
    TEST_ASSERT_EQUAL_INT(0, hal_link_read(&link_, bytes, sizeof bytes));
    time_.now_ms += 1;
    TEST_ASSERT_EQUAL_INT(1, hal_link_read(&link_, bytes, sizeof bytes));
}

void test_cut_loses_everything_silently(void) {
    uint8_t bytes[16];
    fake.to_robot.cut = true;
    TEST_ASSERT_EQUAL_INT(4, hal_link_write(&link_, (const uint8_t *)"ping", 4));
    TEST_ASSERT_EQUAL_size_t(0, hal_fake_link_take(&fake, bytes, sizeof bytes));
    fake.to_robot.cut = false;
    TEST_ASSERT_EQUAL_INT(4, hal_link_write(&link_, (const uint8_t *)"pong", 4));
    TEST_ASSERT_EQUAL_size_t(4, hal_fake_link_take(&fake, bytes, sizeof bytes));
}

void test_error_at_call_n(void) {
    uint8_t bytes[16];
    fake.fail_read_at = 3;
    fake.fail_write_at = 2;
    fake.failure = HAL_LINK_CLOSED;
    TEST_ASSERT_EQUAL_INT(0, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(0, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_CLOSED, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_CLOSED, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(1, hal_link_write(&link_, bytes, 1));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_CLOSED, hal_link_write(&link_, bytes, 1));
}

static void run(uint32_t seed, uint8_t *got, size_t *count, uint32_t *blocked) {
    hal_fake_link_init(&fake, seed, NULL);
    link_ = hal_fake_link(&fake);
    fake.from_robot = (hal_fake_faults_t){.drop_permille = 100, .corrupt_permille = 100};
    fake.would_block_permille = 300;
    *blocked = 0;
    uint8_t bytes[1000] = {0};
    hal_fake_link_put(&fake, bytes, sizeof bytes);
    for (int i = 0; i < 100; i++) {
        *blocked += hal_link_write(&link_, bytes, 1) == 0;
    }
    *count = (size_t)hal_link_read(&link_, got, 1000);
}

void test_faults_come_at_their_rate_and_repeat_by_seed(void) {
    static uint8_t first[1000];
    static uint8_t again[1000];
    size_t first_count = 0;
    size_t again_count = 0;
    uint32_t first_blocked = 0;
    uint32_t again_blocked = 0;
    run(42, first, &first_count, &first_blocked);
    TEST_ASSERT_UINT32_WITHIN(40, 100, fake.in.dropped);
    TEST_ASSERT_UINT32_WITHIN(40, 90, fake.in.corrupted);
    TEST_ASSERT_UINT32_WITHIN(20, 30, first_blocked);
    TEST_ASSERT_EQUAL_size_t(1000 - fake.in.dropped, first_count);
    uint32_t flipped = 0;
    for (size_t i = 0; i < first_count; i++) {
        flipped += first[i] != 0;
        TEST_ASSERT_TRUE((first[i] & (first[i] - 1)) == 0);
    }
    TEST_ASSERT_EQUAL_UINT32(fake.in.corrupted, flipped);
    run(42, again, &again_count, &again_blocked);
    TEST_ASSERT_EQUAL_size_t(first_count, again_count);
    TEST_ASSERT_EQUAL_UINT32(first_blocked, again_blocked);
    TEST_ASSERT_EQUAL_MEMORY(first, again, first_count);
    run(43, again, &again_count, &again_blocked);
    TEST_ASSERT_TRUE(first_count != again_count || memcmp(first, again, first_count) != 0);
}
