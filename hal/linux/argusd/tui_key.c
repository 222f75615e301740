// SPDX-License-Identifier: MIT
// The key table.
#include "tui_key.h"

#include <stddef.h>

#define CTRL_C 3

tui_key_t tui_meaning(int key) {
    if (key == TUI_KEY_NONE) {
        return TUI_NONE;
    }
    static const struct {
        int key;
        tui_key_t meaning;
    } table[] = {
        {TUI_KEY_UP, TUI_AHEAD},
        {'w', TUI_AHEAD},
        {TUI_KEY_DOWN, TUI_BACK},
        {'s', TUI_BACK},
        {TUI_KEY_LEFT, TUI_LEFT},
        {'a', TUI_LEFT},
        {TUI_KEY_RIGHT, TUI_RIGHT},
        {'d', TUI_RIGHT},
        {' ', TUI_STOP},
        {'g', TUI_GO},
        {'r', TUI_RECHECK},
        {'p', TUI_PASSIVE},
        {'n', TUI_NEXT},
        {'b', TUI_PREVIOUS},
        {'t', TUI_RETEST},
        {'k', TUI_PIN},
        {'x', TUI_TAKE_OUT},
        {'?', TUI_HELP},
        {'q', TUI_QUIT},
        {CTRL_C, TUI_QUIT}, // the terminal is raw: this
                            // arrives as a key
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        if (table[i].key == key) {
            return table[i].meaning;
        }
    }
    return TUI_UNKNOWN;
}

const char *tui_keys_of(tui_key_t meaning) {
    switch (meaning) {
#define KEYS(name, keys, effect) \
    case TUI_##name:             \
        return keys;
        TUI_KEY_TABLE(KEYS)
#undef KEYS
    default:
        return "";
    }
}

const char *tui_effect_of(tui_key_t meaning) {
    switch (meaning) {
#define EFFECT(name, keys, effect) \
    case TUI_##name:               \
        return effect;
        TUI_KEY_TABLE(EFFECT)
#undef EFFECT
    default:
        return "";
    }
}
