// SPDX-License-Identifier: MIT
// What a key means.
#ifndef ARGUSD_TUI_KEY_H
#define ARGUSD_TUI_KEY_H

#include "tui.h"

// `key`: a character, or one of the four below for the arrows.
enum { TUI_KEY_UP = 0x1000, TUI_KEY_DOWN, TUI_KEY_LEFT, TUI_KEY_RIGHT };
tui_key_t tui_meaning(int key);

#endif
