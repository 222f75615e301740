// SPDX-License-Identifier: MIT
// Asks terminfo, in a file of its own: its header makes macros of common words.
#include "tui_term.h"

#if defined(ARGUS_TUI)
#include <unistd.h>
// Order matters: term.h needs what curses.h declares.
#include <curses.h>
#include <term.h>

bool tui_term_can_draw(void) {
    char capability[] = "cup"; // moves the cursor
    int error = 0;
    if (setupterm(NULL, STDOUT_FILENO, &error) != OK) { // initscr() would end the process instead
        return false;
    }
    const char *const moves = tigetstr(capability);
    const bool can = moves != NULL && moves != (char *)-1;
    del_curterm(cur_term);
    return can;
}

#else

bool tui_term_can_draw(void) {
    return false;
}

#endif
