// SPDX-License-Identifier: MIT
// Rule under attack: the tables of the modes say the same as the safety rules and as each other.
#include "behaviour/mode.h"

#include "unity.h"

typedef struct {
    argus_mode_t mode;
    argus_mode_t then;
    uint32_t limit_ms;
} row_t;

static const row_t rows[] = {
#define ROW(name, may, limit, then, meaning) {ARGUS_MODE_##name, ARGUS_MODE_##then, (limit)},
    ARGUS_MODE_TABLE(ROW)
#undef ROW
};
#define MODES ((int)(sizeof rows / sizeof rows[0]))

// One row for each mode, in the order of the enumeration: the row is found by its number.
void test_every_mode_has_its_row(void) {
    TEST_ASSERT_EQUAL(ARGUS_MODE_CREEPING + 1, MODES);
    for (int i = 0; i < MODES; i++) {
        TEST_ASSERT_EQUAL(i, rows[i].mode);
        TEST_ASSERT_EQUAL(rows[i].limit_ms, argus_mode_limit_ms(rows[i].mode));
    }
}

void test_a_limit_ends_where_a_way_leads(void) {
    for (int i = 0; i < MODES; i++) {
        TEST_ASSERT_EQUAL(rows[i].limit_ms != 0, rows[i].then != rows[i].mode);
        TEST_ASSERT_TRUE(argus_mode_may_follow(rows[i].mode, rows[i].then));
    }
}

// S6: what translates is entered from what has checked, or by an operator's order.
void test_nothing_translates_from_offline_waiting_or_verifying(void) {
    static const argus_mode_t from[] = {ARGUS_MODE_OFFLINE, ARGUS_MODE_WAITING, ARGUS_MODE_VERIFYING,
                                        ARGUS_MODE_BACKING, ARGUS_MODE_CLOSING, ARGUS_MODE_CLOSED};
    for (size_t i = 0; i < sizeof from / sizeof from[0]; i++) {
        TEST_ASSERT_FALSE(argus_mode_may_follow(from[i], ARGUS_MODE_DRIVING));
        TEST_ASSERT_FALSE(argus_mode_may_follow(from[i], ARGUS_MODE_STEPPING));
        TEST_ASSERT_FALSE(argus_mode_may_follow(from[i], ARGUS_MODE_CREEPING));
    }
}

void test_what_moves_is_watched(void) {
    for (int i = 0; i < MODES; i++) {
        const argus_mode_t mode = (argus_mode_t)i;
        const bool moves = argus_mode_may(mode, ARGUS_MAY_TURN) || argus_mode_may(mode, ARGUS_MAY_TRANSLATE);
        TEST_ASSERT_TRUE(!moves || argus_mode_may(mode, ARGUS_MAY_REACT));
        TEST_ASSERT_TRUE(!moves || argus_mode_may_follow(mode, ARGUS_MODE_CHECKING));
    }
}

// From OFFLINE to the end, over every mode between.
void test_every_mode_is_reached_and_left(void) {
    bool reached[ARGUS_MODE_CREEPING + 1] = {[ARGUS_MODE_OFFLINE] = true};
    for (int round = 0; round < MODES; round++) {
        for (int from = 0; from < MODES; from++) {
            for (int to = 0; reached[from] && to < MODES; to++) {
                reached[to] = reached[to] || argus_mode_may_follow((argus_mode_t)from, (argus_mode_t)to);
            }
        }
    }
    for (int i = 0; i < MODES; i++) {
        TEST_ASSERT_TRUE(reached[i]);
        TEST_ASSERT_EQUAL(i != ARGUS_MODE_CLOSED,
                          argus_mode_may_follow((argus_mode_t)i, ARGUS_MODE_CLOSING) ||
                              argus_mode_may_follow((argus_mode_t)i, ARGUS_MODE_OFFLINE));
    }
}
