// SPDX-License-Identifier: MIT
// Attacks: whatever the strings hold, the output is one valid JSON text in valid UTF-8, or is known not to
// fit.
#include <stdlib.h>
#include <string.h>

#include "json.h"
#include "unity.h"

static char buffer[256];

static const char *string_of(const char *value) {
    json_t json = json_in(buffer, sizeof buffer);
    json_string(&json, value);
    TEST_ASSERT_TRUE(json_fits(&json));
    return buffer;
}

void test_commas_and_nesting(void) {
    json_t json = json_in(buffer, sizeof buffer);
    json_open(&json, '{');
    json_name(&json, "a");
    json_int(&json, -1);
    json_name(&json, "b");
    json_open(&json, '[');
    json_close(&json, ']');
    json_name(&json, "c");
    json_open(&json, '[');
    json_bool(&json, true);
    json_bool(&json, false);
    json_open(&json, '{');
    json_close(&json, '}');
    json_string(&json, "x");
    json_close(&json, ']');
    json_name(&json, "d");
    json_thousandths(&json, 1002);
    json_close(&json, '}');
    TEST_ASSERT_EQUAL_STRING("{\"a\":-1,\"b\":[],\"c\":[true,false,{},\"x\"],\"d\":1.002}", buffer);
}

void test_thousandths(void) {
    static const struct {
        int64_t value;
        const char *text;
    } cases[] = {
        {0, "0.000"}, {7, "0.007"}, {-7, "-0.007"}, {-1500, "-1.500"}, {INT64_MIN, "-9223372036854775.808"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        json_t json = json_in(buffer, sizeof buffer);
        json_thousandths(&json, cases[i].value);
        TEST_ASSERT_EQUAL_STRING(cases[i].text, buffer);
    }
}

void test_escapes(void) {
    TEST_ASSERT_EQUAL_STRING("\"\\\"\\\\/\"", string_of("\"\\/"));
    TEST_ASSERT_EQUAL_STRING("\"\\u000a\\u0001\\u001f\\u007f\"", string_of("\n\x01\x1f\x7f"));
    TEST_ASSERT_EQUAL_STRING("\"\"", string_of(""));
}

void test_utf8_passes_and_what_is_none_is_replaced(void) {
    TEST_ASSERT_EQUAL_STRING("\"\xC3\xA9\xE2\x82\xAC\xF0\x9F\xA4\x96\"",
                             string_of("\xC3\xA9\xE2\x82\xAC\xF0\x9F\xA4\x96"));
    static const char *const one[] = {"\x80", "\xFF", "\xC3", "\xF5"};
    for (size_t i = 0; i < sizeof one / sizeof one[0]; i++) {
        TEST_ASSERT_EQUAL_STRING("\"\\ufffd\"", string_of(one[i]));
    }
    TEST_ASSERT_EQUAL_STRING("\"\\ufffd\\ufffd\"", string_of("\xC0\xAF"));            // overlong
    TEST_ASSERT_EQUAL_STRING("\"\\ufffd\\ufffd\\ufffd\"", string_of("\xED\xA0\x80")); // surrogate
    TEST_ASSERT_EQUAL_STRING("\"\\ufffd\\ufffd\\ufffd\\ufffd\"",
                             string_of("\xF4\x90\x80\x80")); // beyond the last
    TEST_ASSERT_EQUAL_STRING("\"\\ufffd\\ufffda\"", string_of("\xE2\x82"
                                                              "a"));
}

void test_a_small_buffer_is_noticed_at_every_size(void) {
    for (size_t capacity = 1; capacity < 40; capacity++) {
        char small[41];
        memset(small, '#', sizeof small);
        json_t json = json_in(small, capacity);
        json_open(&json, '{');
        json_name(&json, "name");
        json_string(&json, "value\n");
        json_close(&json, '}');
        TEST_ASSERT_EQUAL_INT(capacity > strlen("{\"name\":\"value\\u000a\"}"), json_fits(&json));
        TEST_ASSERT_EQUAL_CHAR('#', small[capacity]);
        TEST_ASSERT_LESS_THAN_size_t(capacity, strlen(small));
    }
}

void test_random_bytes_give_no_control_characters_and_balanced_quotes(void) {
    srand(5);
    for (int round = 0; round < 50000; round++) {
        char value[24];
        const int length = rand() % 20;
        for (int i = 0; i < length; i++) {
            value[i] = (char)(1 + rand() % 255);
        }
        value[length] = '\0';
        const char *const text = string_of(value);
        const size_t size = strlen(text);
        TEST_ASSERT_TRUE(text[0] == '"' && text[size - 1] == '"');
        for (size_t i = 1; i + 1 < size; i++) {
            TEST_ASSERT_TRUE((unsigned char)text[i] >= 0x20);
            if (text[i] == '\\') {
                i++;
            } else {
                TEST_ASSERT_NOT_EQUAL('"', text[i]);
            }
        }
    }
}
