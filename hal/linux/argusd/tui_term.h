// SPDX-License-Identifier: MIT
// What the terminal can do.
#ifndef ARGUSD_TUI_TERM_H
#define ARGUSD_TUI_TERM_H

#include <stdbool.h>

// Whether TERM names a terminal on which the cursor can be moved: not "dumb", not one that is unknown here.
bool tui_term_can_draw(void);

#endif
