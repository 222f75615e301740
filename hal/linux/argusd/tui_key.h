// SPDX-License-Identifier: MIT
// What a key means.
#ifndef ARGUSD_TUI_KEY_H
#define ARGUSD_TUI_KEY_H

typedef enum {
    TUI_NONE,
    TUI_AHEAD,
    TUI_BACK,
    TUI_LEFT,
    TUI_RIGHT,
    TUI_STOP,
    TUI_GO,
    TUI_RECHECK,
    TUI_PASSIVE,
    TUI_NEXT, // choose a sonar,
    TUI_PREVIOUS,
    TUI_RETEST, // ... and what to do with it
    TUI_PIN,
    TUI_TAKE_OUT,
    TUI_QUIT,
    TUI_GONE // the screen's process has ended
} tui_key_t;

// `key`: a character, or one of the four below for the arrows.
enum { TUI_KEY_UP = 0x1000, TUI_KEY_DOWN, TUI_KEY_LEFT, TUI_KEY_RIGHT };
tui_key_t tui_meaning(int key);

#endif
