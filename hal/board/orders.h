// SPDX-License-Identifier: MIT
// What an operator may say over the second UART: a word and what it is about, a line each (docs/flash.md).
#ifndef BOARD_ORDERS_H
#define BOARD_ORDERS_H

#include "argus/argus.h"

#define BOARD_ORDER_LINE_MAX 160 // characters; what is longer is refused
#define BOARD_ORDER_POINTS_MAX 16

// What is left to the loop.
typedef enum {
    BOARD_WISH_NONE,
    BOARD_WISH_STATUS,
    BOARD_WISH_SETTINGS, // tell all of them
    BOARD_WISH_SAVE,
    BOARD_WISH_SHUTDOWN,
    BOARD_WISH_RESTART
} board_wish_t;

typedef struct {
    char line[BOARD_ORDER_LINE_MAX];
    uint16_t length;
    bool is_bad; // too long, or not text: it is refused as a whole
} board_orders_t;

// Takes one byte; true: `line` is a whole order, to be obeyed before the next byte is given.
bool board_orders_take(board_orders_t *self, uint8_t byte);

// Obeys the line. `config` is what the next start is to run with. Returns the answer, static text.
const char *board_orders_obey(board_orders_t *self, argus_t *core, uint32_t now_ms, argus_config_t *config,
                              board_wish_t *wish);

#endif
