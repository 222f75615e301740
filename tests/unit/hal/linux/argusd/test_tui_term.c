// SPDX-License-Identifier: MIT
// Attacks: a terminal without a movable cursor, or one that is unknown, gets no screen.
#include <stdlib.h>

#include "tui_term.h"
#include "unity.h"

static bool can_draw(const char *terminal) {
    if (terminal == NULL) {
        unsetenv("TERM");
    } else {
        setenv("TERM", terminal, 1);
    }
    return tui_term_can_draw();
}

void test_what_cannot_move_its_cursor_gets_no_screen(void) {
    TEST_ASSERT_FALSE(can_draw("dumb"));
    TEST_ASSERT_FALSE(can_draw("no-such-terminal"));
    TEST_ASSERT_FALSE(can_draw(""));
    TEST_ASSERT_FALSE(can_draw(NULL));
}

void test_common_terminals_get_one(void) {
#if defined(ARGUS_TUI)
    TEST_ASSERT_TRUE(can_draw("vt100"));
    TEST_ASSERT_TRUE(can_draw("xterm"));
    TEST_ASSERT_TRUE(can_draw("linux"));
#else
    TEST_IGNORE_MESSAGE("argusd is built without its screen");
#endif
}
