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
    TUI_HELP,    // the screen's own: shows the keys, or hides them
    TUI_UNKNOWN, // a key that means nothing
    TUI_GONE     // the screen's process has ended
} tui_key_t;

// What `?` shows and what an answer is headed with. X(MEANING, keys, effect).
#define TUI_KEY_TABLE(X)                                     \
    X(AHEAD, "up, w", "one step ahead")                      \
    X(BACK, "down, s", "one step back")                      \
    X(LEFT, "left, a", "turn left by 20 degrees")            \
    X(RIGHT, "right, d", "turn right by 20 degrees")         \
    X(STOP, "space", "stop, and stay: the course is paused") \
    X(GO, "g", "go on with the course")                      \
    X(RECHECK, "r", "check all sonars again")                \
    X(PASSIVE, "p", "passive or active")                     \
    X(NEXT, "n", "choose the next sonar")                    \
    X(PREVIOUS, "b", "choose the previous sonar")            \
    X(RETEST, "t", "test the chosen sonar again")            \
    X(PIN, "k", "pin its health, or end that")               \
    X(TAKE_OUT, "x", "take it out of use, pinned")           \
    X(HELP, "?", "show these keys, or hide them")            \
    X(QUIT, "q, Ctrl-C", "stop and end")

// `key`: a character, or one of the four below for the arrows; or that none was pressed.
enum { TUI_KEY_UP = 0x1000, TUI_KEY_DOWN, TUI_KEY_LEFT, TUI_KEY_RIGHT, TUI_KEY_NONE };
tui_key_t tui_meaning(int key);

// The keys of a meaning, and what they do; "" for one without.
const char *tui_keys_of(tui_key_t meaning);
const char *tui_effect_of(tui_key_t meaning);

#endif
