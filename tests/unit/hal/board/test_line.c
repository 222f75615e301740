// SPDX-License-Identifier: MIT
// Rule under attack: a line is JSON, whole or not there at all, whatever text and numbers are in it and
// wherever the ring wraps.
#include "board/line.h"

#include <string.h>

#include "unity.h"

static uint8_t storage[128];
static board_ring_t ring;

void setUp(void) {
    ring = (board_ring_t)BOARD_RING(storage);
}

static const char *taken(void) {
    static char text[sizeof storage + 1];
    const size_t count = board_ring_take_some(&ring, (uint8_t *)text, sizeof storage);
    text[count] = '\0';
    return text;
}

void test_every_kind_of_value(void) {
    for (uint16_t at = 0; at < sizeof storage; at++) {
        atomic_store(&ring.head, at);
        atomic_store(&ring.tail, at);
        board_line_t line = board_line_begin(&ring);
        board_line_seconds(&line, "t", 1234007);
        board_line_text(&line, "s", "x");
        board_line_int(&line, "n", INT32_MIN);
        board_line_bool(&line, "b", true);
        board_line_hex(&line, "h", 0xDEAD0042u);
        board_line_open(&line, "a");
        board_line_item(&line, 0);
        board_line_word(&line, "y");
        board_line_close(&line);
        board_line_bool(&line, "c", false);
        TEST_ASSERT_TRUE(board_ring_is_empty(&ring)); // nothing is to be seen before it is whole
        TEST_ASSERT_TRUE(board_line_end(&line));
        TEST_ASSERT_EQUAL_STRING("{\"t\":1234.007,\"s\":\"x\",\"n\":-2147483648,\"b\":true,\"h\":"
                                 "\"dead0042\",\"a\":[0,\"y\"],\"c\":false}\n",
                                 taken());
    }
}

void test_sonars_by_array_and_number(void) {
    static const struct {
        int sonar;
        const char *text;
    } rows[] = {{0, "front/00"}, {7, "front/07"}, {8, "rear/08"}, {15, "rear/15"}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        board_line_t line = board_line_begin(&ring);
        board_line_sonar(&line, "s", rows[i].sonar);
        board_line_int(&line, "n", 1);
        TEST_ASSERT_TRUE(board_line_end(&line));
        const char *const text = taken();
        TEST_ASSERT_EQUAL_STRING_LEN("{\"s\":\"sonar/", text, 12);
        TEST_ASSERT_EQUAL_STRING_LEN(rows[i].text, text + 12, strlen(rows[i].text));
        TEST_ASSERT_EQUAL_STRING("\",\"n\":1}\n", text + 12 + strlen(rows[i].text));
    }
}

void test_text_that_json_would_not_take_is_made_harmless(void) {
    board_line_t line = board_line_begin(&ring);
    board_line_text(&line, "s", "a\"b\\c\nd\x7F\xC3\xA4");
    TEST_ASSERT_TRUE(board_line_end(&line));
    TEST_ASSERT_EQUAL_STRING("{\"s\":\"a?b?c?d???\"}\n", taken());
}

void test_without_room_nothing_is_sent(void) {
    for (size_t room = 0; room < 12; room++) {
        setUp();
        for (size_t i = room; i < sizeof storage; i++) {
            board_ring_put(&ring, '.');
        }
        board_line_t line = board_line_begin(&ring);
        board_line_int(&line, "n", 12345);
        TEST_ASSERT_EQUAL(room >= sizeof "{\"n\":12345}", board_line_end(&line));
        TEST_ASSERT_EQUAL_size_t(sizeof storage - room, strspn(taken(), "."));
    }
}

void test_nobody_reads(void) {
    board_line_t line = board_line_begin(NULL);
    board_line_text(&line, "s", "x");
    TEST_ASSERT_FALSE(board_line_end(&line));
}
