// SPDX-License-Identifier: MIT
// Rule under attack: an order is done as it is written or it is refused with a reason; what is no order,
// noise above all, moves nothing.
#include "board/orders.h"

#include <stdlib.h>
#include <string.h>

#include "unity.h"

static argus_storage_t storage;
static argus_config_t config;
static argus_t *core;
static board_orders_t orders;
static board_wish_t wish;

void setUp(void) {
    argus_config_default(&config);
    config.active = 0;
    core = argus_init(&storage, &config, 0);
    memset(&orders, 0, sizeof orders);
}

// The answer to the first line in it; "" when there is no whole line.
static const char *give(const char *text) {
    for (; *text != '\0'; text++) {
        if (board_orders_take(&orders, (uint8_t)*text)) {
            return board_orders_obey(&orders, core, 10, &config, &wish);
        }
    }
    return "";
}

static argus_status_t status(void) {
    argus_status_t now;
    argus_status(core, &now);
    return now;
}

void test_orders_reach_the_manager(void) {
    TEST_ASSERT_EQUAL_STRING("taken", give("active\n"));
    TEST_ASSERT_TRUE(status().active);
    TEST_ASSERT_EQUAL_STRING("taken", give("passive\r"));
    TEST_ASSERT_FALSE(status().active);
    TEST_ASSERT_EQUAL_STRING("taken", give("  course 1000,0 2000,-500 \n"));
    TEST_ASSERT_EQUAL_UINT16(2, status().waypoints);
    TEST_ASSERT_EQUAL(BOARD_WISH_NONE, wish);
}

void test_a_course_that_is_wrong_changes_nothing(void) {
    static const char *const wrong[] = {
        "course\n",         "course 1\n",
        "course 1,\n",      "course ,1\n",
        "course 1,2,3\n",   "course 1 2\n",
        "course 40000,0\n", "course 1,x\n",
        "course 1;2\n",     "course 9999999,1\n",
        "course 1,2 3x\n",  "course 1,2 -\n",
        "course --1,2\n",   "course 1,1 1,1 1,1 1,1 1,1 1,1 1,1 1,1 1,1 1,1 1,1 1,1 1,1 1,1 1,1 1,1 1,1\n"};
    give("course 5,6\n");
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        TEST_ASSERT_NOT_EQUAL_MESSAGE(0, strcmp("taken", give(wrong[i])), wrong[i]);
        TEST_ASSERT_EQUAL_UINT16(1, status().waypoints);
    }
}

void test_words_that_are_not_quite_orders(void) {
    static const char *const wrong[] = {"activ\n",  "actives\n",  "ACTIVE\n",   "active now\n",   "move\n",
                                        "move x\n", "move 1 2\n", "turn 1.5\n", "status please\n"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        TEST_ASSERT_NOT_EQUAL_MESSAGE(0, strcmp("taken", give(wrong[i])), wrong[i]);
        TEST_ASSERT_EQUAL(BOARD_WISH_NONE, wish);
        TEST_ASSERT_FALSE(status().active);
    }
}

void test_a_line_too_long_or_with_noise_is_refused_as_a_whole_and_the_next_is_taken(void) {
    char line[2 * BOARD_ORDER_LINE_MAX];
    memset(line, ' ', sizeof line);
    memcpy(line + sizeof line - 8, "active\n", 8);
    TEST_ASSERT_EQUAL_STRING("too long or no text", give(line));
    TEST_ASSERT_EQUAL_STRING("too long or no text", give("act\x01ive\n"));
    TEST_ASSERT_EQUAL_STRING("too long or no text", give("\xFF\n"));
    TEST_ASSERT_FALSE(status().active);
    TEST_ASSERT_EQUAL_STRING("taken", give("active\n"));
}

void test_settings_are_for_the_next_start(void) {
    TEST_ASSERT_EQUAL_STRING("from the next start, if it is saved", give("set step_mm 120\n"));
    TEST_ASSERT_EQUAL_INT32(120, config.step_mm);
    TEST_ASSERT_EQUAL_STRING("out of its range", give("set step_mm 12000\n"));
    TEST_ASSERT_EQUAL_STRING("no such key", give("set stepp_mm 120\n"));
    TEST_ASSERT_EQUAL_STRING("give a key and a value", give("set step_mm 120 130\n"));
    TEST_ASSERT_EQUAL_INT32(120, config.step_mm);
}

void test_wishes_are_left_to_the_loop(void) {
    static const struct {
        const char *line;
        board_wish_t wish;
    } rows[] = {{"status\n", BOARD_WISH_STATUS},
                {"settings\n", BOARD_WISH_SETTINGS},
                {"save\n", BOARD_WISH_SAVE},
                {"shutdown\n", BOARD_WISH_SHUTDOWN},
                {" restart \n", BOARD_WISH_RESTART}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        give(rows[i].line);
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].wish, wish, rows[i].line);
    }
}

void test_a_flood_of_noise_makes_it_drive_nowhere(void) {
    srand(30);
    for (int i = 0; i < 200000; i++) {
        if (board_orders_take(&orders, (uint8_t)rand())) {
            board_orders_obey(&orders, core, 10, &config, &wish);
            TEST_ASSERT_EQUAL(BOARD_WISH_NONE, wish);
        }
    }
    TEST_ASSERT_FALSE(status().active);
    TEST_ASSERT_EQUAL(0, argus_invariants_broken(core));
}
