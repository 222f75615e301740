// SPDX-License-Identifier: MIT
// The key table.
#include "tui_key.h"

#define CTRL_C 3

tui_key_t tui_meaning(int key) {
    switch (key) {
    case TUI_KEY_UP:
    case 'w':
        return TUI_AHEAD;
    case TUI_KEY_DOWN:
    case 's':
        return TUI_BACK;
    case TUI_KEY_LEFT:
    case 'a':
        return TUI_LEFT;
    case TUI_KEY_RIGHT:
    case 'd':
        return TUI_RIGHT;
    case ' ':
        return TUI_STOP;
    case 'g':
        return TUI_GO;
    case 'r':
        return TUI_RECHECK;
    case 'p':
        return TUI_PASSIVE;
    case 'q':
    case CTRL_C: // the terminal is raw: this arrives as a key
        return TUI_QUIT;
    default:
        return TUI_NONE;
    }
}
