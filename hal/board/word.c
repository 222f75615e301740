// SPDX-License-Identifier: MIT
// Compares words with texts, and reads numbers.
#include "board/word.h"

#include <string.h>

#define DIGITS_MAX 9 // more than any range has, and it fits 32 bits

bool board_word_is(board_word_t word, const char *text) {
    return strlen(text) == word.length && memcmp(text, word.at, word.length) == 0;
}

const char *board_word_find(const char *from, const char *to, char character) {
    while (from < to && *from != character) {
        from++;
    }
    return from;
}

const char *board_word_nth(const char *texts, int row) {
    for (; row > 0; row--) {
        texts += strlen(texts) + 1;
    }
    return texts;
}

int board_word_row(board_word_t word, const char *texts) {
    for (int row = 0; *texts != '\0'; row++) {
        if (board_word_is(word, texts)) {
            return row;
        }
        texts = board_word_nth(texts, 1);
    }
    return -1;
}

bool board_word_number(board_word_t word, int32_t *value) {
    const size_t sign = word.length > 0 && (word.at[0] == '-' || word.at[0] == '+') ? 1 : 0;
    int32_t number = 0;
    if (word.length == sign || word.length > sign + DIGITS_MAX) {
        return false;
    }
    for (size_t i = sign; i < word.length; i++) {
        if (word.at[i] < '0' || word.at[i] > '9') {
            return false;
        }
        number = number * 10 + (word.at[i] - '0');
    }
    *value = word.at[0] == '-' ? -number : number;
    return true;
}
