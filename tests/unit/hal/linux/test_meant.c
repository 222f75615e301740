// SPDX-License-Identifier: MIT
// Rule: a word with one or two wrong letters gets the name of the one that was meant, any other gets none.
#include "hal/meant.h"
#include "unity.h"

#include <string.h>

static char asked[80];

static const char *ask(const char *word, const char *names) {
    hal_meant_t meant;
    hal_meant_begin(&meant, word, strlen(word));
    hal_meant_weigh_list(&meant, names);
    hal_meant_ask(&meant, "--", asked, sizeof asked);
    return asked;
}

void test_near_ones(void) {
    static const char *const near[][2] = {{"lnik", "link"},
                                          {"lin", "link"},
                                          {"gaol", "goal"},
                                          {"guard-reading", "guard-readings"},
                                          {"tpc", "tcp"}};
    for (size_t i = 0; i < sizeof near / sizeof near[0]; i++) {
        char expected[80] = "; did you mean --";
        strcat(strcat(expected, near[i][1]), "?");
        TEST_ASSERT_EQUAL_STRING(expected, ask(near[i][0], "tcp|link|goal|guard-readings"));
    }
}

void test_the_nearest_of_near_ones(void) {
    TEST_ASSERT_EQUAL_STRING("; did you mean --fewest?", ask("fewst", "newest|fewest|west"));
}

void test_far_ones(void) {
    static const char *const far[] = {
        "frob",  "z",  "",
        "guard", "ab", "a-word-that-is-so-long-that-no-name-in-any-table-has-as-many-letters"};
    for (size_t i = 0; i < sizeof far / sizeof far[0]; i++) {
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", ask(far[i], "link|goal|guard-readings"), far[i]);
    }
    TEST_ASSERT_EQUAL_STRING("",
                             ask("link", "a-name-that-is-longer-than-any-word-that-people-give-to-options"));
}

static const char *ask_by_heads(const char *word, const char *names) {
    hal_meant_t meant;
    hal_meant_begin(&meant, word, strlen(word));
    hal_meant_weigh_list(&meant, names);
    hal_meant_weigh_heads(&meant, names);
    hal_meant_ask(&meant, "", asked, sizeof asked);
    return asked;
}

void test_names_that_are_told_by_their_heads(void) {
    static const char robots[] = "by-subclass|p3dx-sh|amigo-sh|p3at-sh|peoplebot-sh";
    static const char *const near[][2] = {
        {"p3xd", "p3dx-sh"}, {"p3dx", "p3dx-sh"},    {"p3at", "p3at-sh"},          {"amgio", "amigo-sh"},
        {"p3a", "p3at-sh"},  {"p3dx-hs", "p3dx-sh"}, {"poeplebot", "peoplebot-sh"}};
    for (size_t i = 0; i < sizeof near / sizeof near[0]; i++) {
        char expected[80] = "; did you mean ";
        strcat(strcat(expected, near[i][1]), "?");
        TEST_ASSERT_EQUAL_STRING(expected, ask_by_heads(near[i][0], robots));
    }
    TEST_ASSERT_EQUAL_STRING("", ask_by_heads("turtlebot", robots));
    TEST_ASSERT_EQUAL_STRING("; did you mean a-b?", ask_by_heads("a-c", "a-b|ac")); // the whole name wins
}

void test_a_word_ends_where_it_is_said_to(void) {
    hal_meant_t meant;
    hal_meant_begin(&meant, "serail:/dev/ttyS0", 6);
    hal_meant_weigh(&meant, "serial", 6);
    hal_meant_ask(&meant, "", asked, sizeof asked);
    TEST_ASSERT_EQUAL_STRING("; did you mean serial?", asked);
    hal_meant_ask(&meant, "", asked, 8); // no room for all
    TEST_ASSERT_EQUAL_STRING("; did y", asked);
}
