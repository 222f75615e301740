// SPDX-License-Identifier: MIT
// One line of JSON into the ring of the second UART, whole or not at all. Keys and names are plain ASCII of
// ours; text from outside is made so.
#ifndef BOARD_LINE_H
#define BOARD_LINE_H

#include "board/ring.h"

typedef struct {
    board_ring_t *ring; // NULL: no reader
    uint16_t at;        // where the next byte goes, not yet to be seen by the taker
    uint16_t end;       // first place that is not free
    bool cut;           // there was no room
    bool comma;
} board_line_t;

board_line_t board_line_begin(board_ring_t *ring); // opens the object
bool board_line_end(board_line_t *self);           // false: there was no room, nothing is sent

void board_line_name(board_line_t *self, const char *name);
void board_line_text(board_line_t *self, const char *name, const char *value);
void board_line_int(board_line_t *self, const char *name, int32_t value);
void board_line_bool(board_line_t *self, const char *name, bool value);
void board_line_sonar(board_line_t *self, const char *name, int sonar);     // its array and number
void board_line_hex(board_line_t *self, const char *name, uint32_t value);  // as text, 8 digits
void board_line_seconds(board_line_t *self, const char *name, uint32_t ms); // 1234 is written as 1.234

// An array of whole numbers or of texts.
void board_line_open(board_line_t *self, const char *name);
void board_line_item(board_line_t *self, int32_t value);
void board_line_word(board_line_t *self, const char *value);
void board_line_close(board_line_t *self);

#endif
