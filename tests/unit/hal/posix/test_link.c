// SPDX-License-Identifier: MIT
// Attacks: every error has a text of its own, and a link that is not there says so instead of crashing.
#include <string.h>

#include "hal/fd_link.h"
#include "hal/link.h"
#include "unity.h"

void test_every_error_has_its_own_text(void) {
    static const int codes[] = {
#define CODE(name, value, text) value,
        HAL_LINK_ERROR_TABLE(CODE)
#undef CODE
    };
    const size_t count = sizeof codes / sizeof codes[0];
    for (size_t i = 0; i < count; i++) {
        TEST_ASSERT_LESS_THAN(0, codes[i]);
        for (size_t k = 0; k < i; k++) {
            TEST_ASSERT_NOT_EQUAL(codes[i], codes[k]);
            TEST_ASSERT_TRUE(strcmp(hal_link_error_text(codes[i]), hal_link_error_text(codes[k])) != 0);
        }
    }
    TEST_ASSERT_EQUAL_STRING("ok", hal_link_error_text(0));
    TEST_ASSERT_EQUAL_STRING("unknown error", hal_link_error_text(-999));
    TEST_ASSERT_EQUAL_STRING("unknown error", hal_link_error_text(1));
}

void test_no_link_says_so(void) {
    const hal_link_t none = {0};
    uint8_t bytes[4] = {0};
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_OPEN, hal_link_read(&none, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_OPEN, hal_link_write(&none, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_OPEN, hal_link_flush(&none));
    TEST_ASSERT_EQUAL_UINT32(0, hal_link_hold_ms(&none));
    TEST_ASSERT_EQUAL_INT(-1, hal_link_fd(&none));
    TEST_ASSERT_EQUAL_STRING("no link", hal_link_describe(&none));
    TEST_ASSERT_EQUAL_UINT32(0, hal_link_counters(&none).bytes_in);
    hal_link_close(&none);
}

void test_closed_descriptor_says_so(void) {
    hal_fd_link_t link;
    uint8_t bytes[4] = {0};
    hal_fd_link_init(&link);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_OPEN, hal_fd_link_read(&link, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_OPEN, hal_fd_link_write(&link, bytes, sizeof bytes));
}
