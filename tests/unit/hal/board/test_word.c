// SPDX-License-Identifier: MIT
// Rule under attack: a word is a text of a list, or a number, only when it is all of it.
#include "board/word.h"

#include <string.h>

#include "unity.h"

static board_word_t word(const char *text) {
    return (board_word_t){text, strlen(text)};
}

void test_rows_are_found_whole(void) {
    static const char texts[] = "stop\0go\0recheck\0";
    TEST_ASSERT_EQUAL_INT(0, board_word_row(word("stop"), texts));
    TEST_ASSERT_EQUAL_INT(2, board_word_row(word("recheck"), texts));
    static const char *const others[] = {"",     "s",  "sto",   "stops",    "stop ",
                                         "STOP", "re", "check", "gorecheck"};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(-1, board_word_row(word(others[i]), texts), others[i]);
    }
}

void test_a_word_ends_where_it_says(void) {
    const board_word_t go = {"going", 2};
    int32_t value = 7;
    TEST_ASSERT_EQUAL_INT(1, board_word_row(go, "stop\0go\0"));
    TEST_ASSERT_TRUE(board_word_number((board_word_t){"123", 2}, &value));
    TEST_ASSERT_EQUAL_INT32(12, value);
}

void test_numbers(void) {
    static const struct {
        const char *text;
        int32_t value;
    } rows[] = {{"0", 0},
                {"-0", 0},
                {"+5", 5},
                {"-7", -7},
                {"007", 7},
                {"999999999", 999999999},
                {"-999999999", -999999999}};
    static const char *const wrong[] = {"",    "-",   "+", "--1",        "+-1", "1-", "1.5",
                                        "0x1", "1e3", "a", "1000000000", " 1",  "1 "};
    int32_t value = 0;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(board_word_number(word(rows[i].text), &value), rows[i].text);
        TEST_ASSERT_EQUAL_INT32_MESSAGE(rows[i].value, value, rows[i].text);
    }
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(board_word_number(word(wrong[i]), &value), wrong[i]);
    }
}

void test_where_a_character_is(void) {
    const char text[] = "12,-4,5";
    const char *const end = text + strlen(text);
    TEST_ASSERT_EQUAL_PTR(text + 2, board_word_find(text, end, ','));
    TEST_ASSERT_EQUAL_PTR(end, board_word_find(text, end, ';'));
    TEST_ASSERT_EQUAL_PTR(text, board_word_find(text, text, '1'));
}
