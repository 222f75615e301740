// SPDX-License-Identifier: MIT
// Words of an order or of a setting: which of a list of texts one is, or which number.
#ifndef BOARD_WORD_H
#define BOARD_WORD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// A part of a text; it has no end of its own.
typedef struct {
    const char *at;
    size_t length;
} board_word_t;

bool board_word_is(board_word_t word, const char *text);

// Where the first such character is; `to`: there is none.
const char *board_word_find(const char *from, const char *to, char character);

// Texts stand in a row, each with its end, an empty one behind the last: "stop\0" "go\0". A table of pointers
// would take half as much again.
const char *board_word_nth(const char *texts, int row);
int board_word_row(board_word_t word, const char *texts); // -1: none of them

// A whole number of 1 to 9 digits, with or without a sign; false: something else, `*value` is any.
bool board_word_number(board_word_t word, int32_t *value);

#endif
