// SPDX-License-Identifier: MIT
// Attacks: the CRC is the common CRC-32, in one piece or in many, and sees every single flipped bit.
#include <string.h>

#include "hal/crc32.h"
#include "unity.h"

void test_check_value_of_the_standard(void) {
    TEST_ASSERT_EQUAL_HEX32(0xCBF43926u, hal_crc32(0, "123456789", 9));
    TEST_ASSERT_EQUAL_HEX32(0u, hal_crc32(0, "", 0));
}

void test_pieces_give_the_same_as_the_whole(void) {
    const char text[] = "the quick brown fox";
    for (size_t cut = 0; cut <= strlen(text); cut++) {
        const uint32_t first = hal_crc32(0, text, cut);
        TEST_ASSERT_EQUAL_HEX32(hal_crc32(0, text, strlen(text)),
                                hal_crc32(first, text + cut, strlen(text) - cut));
    }
}

void test_every_single_bit_matters(void) {
    uint8_t bytes[32] = {0};
    const uint32_t good = hal_crc32(0, bytes, sizeof bytes);
    for (size_t bit = 0; bit < 8 * sizeof bytes; bit++) {
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        TEST_ASSERT_NOT_EQUAL(good, hal_crc32(0, bytes, sizeof bytes));
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
}
