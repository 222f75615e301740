// SPDX-License-Identifier: MIT
// Attacks: text never leaves its buffer and says when it was cut; numbers are whole or refused.
#include <string.h>

#include "text.h"
#include "unity.h"

void test_appends_and_cuts(void) {
    char buffer[9] = "XXXXXXXX";
    text_t text = text_in(buffer, 8);
    text_add(&text, "%d-%s", 12, "ab");
    TEST_ASSERT_EQUAL_STRING("12-ab", buffer);
    TEST_ASSERT_FALSE(text.cut);
    text_add(&text, "cdefgh");
    TEST_ASSERT_EQUAL_STRING("12-abcd", buffer);
    TEST_ASSERT_TRUE(text.cut);
    text_add(&text, "more");
    TEST_ASSERT_EQUAL_size_t(7, strlen(buffer));
    TEST_ASSERT_EQUAL_CHAR('\0', buffer[7]);
}

void test_a_line_is_read_to_its_end_whatever_it_holds(void) {
    static const char content[] = "1234567\n12345678\n\n1\0"
                                  "2345678\nlast";
    static const struct {
        text_read_t found;
        const char *text;
    } expected[] = {{TEXT_LINE, "1234567"}, {TEXT_LONG, "1234567"}, {TEXT_LINE, ""},
                    {TEXT_NUL, "1234567"},  {TEXT_LINE, "last"},    {TEXT_END, "last"}};
    char line[8 + 1] = "XXXXXXXX";
    FILE *const file = tmpfile();
    TEST_ASSERT_NOT_NULL(file);
    fwrite(content, 1, sizeof content - 1, file);
    TEST_ASSERT_EQUAL_INT(0, fseek(file, 0, SEEK_SET));
    for (size_t i = 0; i < sizeof expected / sizeof expected[0]; i++) {
        TEST_ASSERT_EQUAL_INT(expected[i].found, text_read_line(file, line, 8));
        TEST_ASSERT_EQUAL_STRING(expected[i].text, line);
        TEST_ASSERT_EQUAL_CHAR('\0', line[8]);
    }
    fclose(file);
}

void test_refuse_is_always_false(void) {
    char buffer[16];
    TEST_ASSERT_FALSE(text_refuse(buffer, sizeof buffer, "no %s", "way"));
    TEST_ASSERT_EQUAL_STRING("no way", buffer);
}

void test_numbers(void) {
    static const struct {
        const char *text;
        int32_t value;
    } good[] = {
        {"0", 0}, {"-5", -5}, {"+7", 7}, {" 12 ", 12}, {"2147483647", INT32_MAX}, {"-2147483648", INT32_MIN}};
    static const char *const bad[] = {"",    " ",          "x",           "1x",
                                      "1 2", "1.5",        "0x1",         "1e3",
                                      "--1", "2147483648", "-2147483649", "99999999999999999999"};
    int32_t value = 0;
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(text_number(good[i].text, &value), good[i].text);
        TEST_ASSERT_EQUAL_INT32(good[i].value, value);
    }
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(text_number(bad[i], &value), bad[i]);
    }
}
