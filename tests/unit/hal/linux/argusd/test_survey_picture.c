// SPDX-License-Identifier: MIT
// Rule: the picture of a survey shows each sonar once, by its verdict; its legend has what is drawn and no
// more.
#include "survey_picture.h"
#include "unity.h"

#include <stdlib.h>
#include <string.h>

static char *drawn;

static void draw(const survey_mark_t *marks, int count) {
    size_t size = 0;
    FILE *const out = open_memstream(&drawn, &size);
    TEST_ASSERT_NOT_NULL(out);
    survey_picture_put(out, marks, count, "13 headings of 13; 1 sonar is broken or a suspect");
    fclose(out);
}

static int times(const char *text) {
    int count = 0;
    for (const char *at = strstr(drawn, text); at != NULL; at = strstr(at + 1, text)) {
        count++;
    }
    return count;
}

void tearDown(void) {
    free(drawn);
    drawn = NULL;
}

void test_each_sonar_once_and_what_is_drawn_in_the_legend(void) {
    static const survey_mark_t marks[] = {{0, 90, SURVEY_HEALTHY, "healthy", "100 %"},
                                          {3, 10, SURVEY_BROKEN, "broken: off", "proven, 13 of 13 differ"},
                                          {7, -90, SURVEY_HEALTHY, "healthy", "98 %"}};
    draw(marks, 3);
    TEST_ASSERT_EQUAL(4, times("<polygon")); // and the arrow ahead
    TEST_ASSERT_EQUAL(1, times(">3: broken: off</text>"));
    TEST_ASSERT_EQUAL(1, times(">3: broken: off, proven, 13 of 13 differ</title>"));
    TEST_ASSERT_EQUAL(1, times(">broken</text>"));
    TEST_ASSERT_EQUAL(1, times(">healthy</text>"));
    TEST_ASSERT_EQUAL(0, times(">suspect</text>"));
    TEST_ASSERT_EQUAL(0, times(">not told</text>"));
    TEST_ASSERT_EQUAL(times("<g"), times("</g>"));
    TEST_ASSERT_EQUAL(times("<text"), times("</text>"));
    TEST_ASSERT_EQUAL_STRING("</svg>\n", drawn + strlen(drawn) - 7);
}

void test_two_on_one_bearing_lie_side_by_side_the_first_nearer_to_ahead(void) {
    static const survey_mark_t marks[] = {{0, 90, SURVEY_HEALTHY, "healthy", "100 %"},
                                          {7, -90, SURVEY_HEALTHY, "healthy", "100 %"},
                                          {8, -90, SURVEY_OPEN, "not judged", "open"},
                                          {15, 90, SURVEY_SUSPECT, "suspect, perhaps off", "40 %"}};
    static const char *const turns[] = {"rotate(-85)\"><polygon", "rotate(85)\"><polygon",
                                        "rotate(95)\"><polygon", "rotate(-95)\"><polygon"};
    draw(marks, 4);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(1, times(turns[i]), turns[i]);
    }
    TEST_ASSERT_EQUAL(1, times(">not told</text>"));
}
