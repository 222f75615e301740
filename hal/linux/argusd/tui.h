// SPDX-License-Identifier: MIT
// The screen as a process of its own: a terminal that blocks, hangs up or crashes never holds up the robot.
#ifndef ARGUSD_TUI_H
#define ARGUSD_TUI_H

#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>
#include <termios.h>

#include "screen.h"
#include "tui_key.h"

typedef struct {
    bool on;
    pid_t child;
    int fd; // poll it for keys
    struct termios saved;
} tui_t;

bool tui_is_built(void);

// Takes over the terminal on standard input and output. False: there is none, it cannot be drawn on, or the
// system refuses.
bool tui_start(tui_t *self);

// Never wait; a picture or a line that the screen is too busy for is not shown.
void tui_show(const tui_t *self, const view_t *view);
// `key`: see screen_log_add().
void tui_log(const tui_t *self, const char *line, tone_t tone, uint16_t key);

tui_key_t tui_key(tui_t *self);

// Gives the terminal back as it was.
void tui_stop(tui_t *self);

#endif
