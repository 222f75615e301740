// SPDX-License-Identifier: MIT
// Attacks: whatever bytes come, what is taken is one JSON object within the bounds, and nothing is read
// beyond the text.
#include "json_read.h"

#include <stdlib.h>
#include <string.h>

#include "unity.h"

static json_doc_t doc;

static bool reads(const char *text) {
    return json_read(&doc, text, strlen(text));
}

void test_an_object_is_read(void) {
    int64_t value = 0;
    char text[32];
    TEST_ASSERT_TRUE(reads(" {\"do\" : \"order\", \"seq\":-12,\"f\":true,\"n\":null,\"p\":[[1,2],[3,4]] "
                           ",\"o\":{\"a\":1.5e3}} "));
    TEST_ASSERT_TRUE(json_text(&doc, json_member(&doc, 0, "do"), text, sizeof text));
    TEST_ASSERT_EQUAL_STRING("order", text);
    TEST_ASSERT_TRUE(json_whole(&doc, json_member(&doc, 0, "seq"), -100, 100, &value));
    TEST_ASSERT_EQUAL_INT(-12, (int)value);
    TEST_ASSERT_TRUE(json_is(&doc, json_member(&doc, 0, "f"), JSON_TRUE));
    TEST_ASSERT_TRUE(json_is(&doc, json_member(&doc, 0, "n"), JSON_NULL));
    TEST_ASSERT_EQUAL_INT(-1, json_member(&doc, 0, "a"));
    TEST_ASSERT_FALSE(json_whole(&doc, json_member(&doc, json_member(&doc, 0, "o"), "a"), 0, 9999, &value));
    const int list = json_member(&doc, 0, "p");
    const int first = json_first(&doc, list);
    const int second = json_next(&doc, list, first);
    TEST_ASSERT_TRUE(json_whole(&doc, json_first(&doc, second), 0, 9, &value));
    TEST_ASSERT_EQUAL_INT(3, (int)value);
    TEST_ASSERT_EQUAL_INT(-1, json_next(&doc, list, second));
}

void test_what_is_no_object_is_refused(void) {
    static const char *const bad[] = {
        "",
        " ",
        "[]",
        "1",
        "\"a\"",
        "{",
        "}",
        "{}x",
        "{}{}",
        "{\"a\"}",
        "{\"a\":}",
        "{\"a\":1,}",
        "{,}",
        "{a:1}",
        "{'a':1}",
        "{\"a\":01}",
        "{\"a\":+1}",
        "{\"a\":.5}",
        "{\"a\":1.}",
        "{\"a\":1e}",
        "{\"a\":-}",
        "{\"a\":tru}",
        "{\"a\":\"\\x\"}",
        "{\"a\":\"\\u12g4\"}",
        "{\"a\":\"b}",
        "{\"a\":\"\t\"}",
        "{\"a\":NaN}",
        "{\"a\":[1,]}",
        "{\"a\":[1 2]}",
        "{\"a\":1 \"b\":2}",
        "{\"\\u0061\":1}",
        "{\"a\":1,\"a\":2}",
        "{\"a\":1,\"b\":{\"c\":1},\"a\":2}",
        "{\"a\":[[[[1]]]]}", // five deep
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(reads(bad[i]), bad[i]);
    }
    TEST_ASSERT_TRUE(reads("{\"a\":[[[1]]]}"));
    TEST_ASSERT_TRUE(reads("{\"a\":1,\"b\":{\"a\":1}}"));
    TEST_ASSERT_FALSE(json_read(&doc, "{\0}", 3));
}

void test_whole_numbers_are_within_bounds(void) {
    static const struct {
        const char *text;
        bool taken;
    } rows[] = {{"{\"n\":5}", true},      {"{\"n\":6}", false},
                {"{\"n\":-5}", true},     {"{\"n\":-6}", false},
                {"{\"n\":0}", true},      {"{\"n\":-0}", true},
                {"{\"n\":1.0}", false},   {"{\"n\":1e0}", false},
                {"{\"n\":\"1\"}", false}, {"{\"n\":99999999999999999999999999}", false},
                {"{\"m\":1}", false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        int64_t value = 0;
        TEST_ASSERT_TRUE(reads(rows[i].text));
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].taken, json_whole(&doc, json_member(&doc, 0, "n"), -5, 5, &value),
                                  rows[i].text);
    }
}

void test_strings_are_decoded_or_refused(void) {
    char text[12];
    static const struct {
        const char *json;
        const char *meant; // NULL: refused
    } rows[] = {
        {"{\"s\":\"a\\n\\\"\\\\\\/\"}", "a\n\"\\/"},
        {"{\"s\":\"\\u0041\\u00e9\\u20ac\"}", "A\xC3\xA9\xE2\x82\xAC"},
        {"{\"s\":\"\\ud83d\\ude00\"}", "\xF0\x9F\x98\x80"},
        {"{\"s\":\"\\u0000\"}", NULL},
        {"{\"s\":\"\\ud83d\"}", NULL},
        {"{\"s\":\"\\ud83dabcdef\"}", NULL},
        {"{\"s\":\"\\ude00\"}", NULL},
        {"{\"s\":\"\\ud83d\\u0041\"}", NULL},
        {"{\"s\":\"12345678901\"}", "12345678901"},
        {"{\"s\":\"123456789012\"}", NULL},
        {"{\"s\":1}", NULL},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(reads(rows[i].json), rows[i].json);
        const bool taken = json_text(&doc, json_member(&doc, 0, "s"), text, sizeof text);
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].meant != NULL, taken, rows[i].json);
        if (taken) {
            TEST_ASSERT_EQUAL_STRING(rows[i].meant, text);
        }
    }
}

void test_more_than_fits_is_refused(void) {
    static char text[JSON_TEXT_MAX + 8];
    size_t at = 0;
    text[at++] = '{';
    for (int i = 0; i < JSON_MEMBERS_MAX; i++) {
        at += (size_t)snprintf(text + at, sizeof text - at, "%s\"m%d\":1", i == 0 ? "" : ",", i);
    }
    snprintf(text + at, sizeof text - at, "}");
    TEST_ASSERT_TRUE(reads(text));
    snprintf(text + at, sizeof text - at, ",\"x\":1}");
    TEST_ASSERT_FALSE(reads(text));
    at = (size_t)snprintf(text, sizeof text, "{\"l\":[0");
    for (int i = 0; i < JSON_TOKENS_MAX; i++) {
        at += (size_t)snprintf(text + at, sizeof text - at, ",0");
    }
    snprintf(text + at, sizeof text - at, "]}");
    TEST_ASSERT_FALSE(reads(text));
    memset(text, ' ', sizeof text);
    text[0] = '{';
    text[1] = '}';
    TEST_ASSERT_TRUE(json_read(&doc, text, JSON_TEXT_MAX));
    TEST_ASSERT_FALSE(json_read(&doc, text, JSON_TEXT_MAX + 1));
}

// Each text in memory of exactly its length, so that a sanitizer sees what is read beyond it.
void test_no_cut_or_damaged_text_is_read_beyond(void) {
    static const char whole[] = "{\"do\":\"\\u00e9\\n\",\"n\":[1.5e-3,true,null,{\"x\":-0}]}";
    for (size_t length = 0; length < sizeof whole; length++) {
        char *const cut = malloc(length + 1);
        memcpy(cut, whole, length);
        for (size_t flip = 0; flip < length; flip++) {
            for (int bit = 0; bit < 8; bit++) {
                cut[flip] = (char)(cut[flip] ^ 1 << bit);
                char *const exact = malloc(length > 0 ? length : 1);
                memcpy(exact, cut, length);
                if (json_read(&doc, exact, length)) {
                    char text[8];
                    (void)json_text(&doc, 2, text, sizeof text);
                }
                free(exact);
                cut[flip] = (char)(cut[flip] ^ 1 << bit);
            }
        }
        TEST_ASSERT_EQUAL(length == sizeof whole - 1, length < sizeof whole && json_read(&doc, cut, length));
        free(cut);
    }
}
