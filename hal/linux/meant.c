// SPDX-License-Identifier: MIT
// Nearness of words: letters that are to be changed, put in, taken out, or exchanged with the next one.
#include "hal/meant.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { NAME_MAX_LENGTH = 40, MISTYPED_MAX = 2, HEAD_MISTYPED_MAX = 1 };

static size_t least(size_t a, size_t b) {
    return a < b ? a : b;
}

// Whether the last two letters are those of the other one, exchanged.
static size_t cost_of_exchange(const char *a, size_t i, const char *b, size_t j, size_t before) {
    const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
    return exchanged ? before + 1U : NAME_MAX_LENGTH;
}

static size_t distance(const char *a, size_t a_length, const char *b, size_t b_length) {
    size_t rows[3][NAME_MAX_LENGTH + 1];
    for (size_t i = 0; i <= a_length; i++) {
        rows[0][i] = i;
    }
    for (size_t j = 1; j <= b_length; j++) {
        size_t *const now = rows[j % 3];
        const size_t *const last = rows[(j + 2) % 3];
        const size_t *const before = rows[(j + 1) % 3]; // unset at first, and not used then
        now[0] = j;
        for (size_t i = 1; i <= a_length; i++) {
            const size_t changed = last[i - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U);
            const size_t exchanged = j > 1 && i > 1 ? cost_of_exchange(a, i, b, j, before[i - 2]) : changed;
            now[i] = least(least(changed, exchanged), least(last[i], now[i - 1]) + 1U);
        }
    }
    return rows[b_length % 3][a_length];
}

void hal_meant_begin(hal_meant_t *self, const char *word, size_t length) {
    *self = (hal_meant_t){.word = word, .length = length, .best = least(MISTYPED_MAX, length / 2U) + 1U};
}

// The name is `length` bytes long; `told_by` of them are held against the word.
static void weigh(hal_meant_t *self, const char *name, size_t length, size_t told_by) {
    if (self->length > NAME_MAX_LENGTH || told_by > NAME_MAX_LENGTH) {
        return;
    }
    const size_t away = distance(self->word, self->length, name, told_by);
    if (away < self->best) {
        self->best = away;
        self->nearest = name;
        self->nearest_length = (int)length;
    }
}

void hal_meant_weigh(hal_meant_t *self, const char *name, size_t length) {
    weigh(self, name, length, length);
}

// Each of "a|b|c", by what of it stands before the first of `ends`.
static void weigh_list(hal_meant_t *self, const char *names, const char *ends) {
    for (;;) {
        const size_t length = strcspn(names, "|");
        weigh(self, names, length, strcspn(names, ends));
        if (names[length] == '\0') {
            return;
        }
        names += length + 1;
    }
}

void hal_meant_weigh_list(hal_meant_t *self, const char *names) {
    weigh_list(self, names, "|");
}

void hal_meant_weigh_heads(hal_meant_t *self, const char *names) {
    self->best = least(self->best, HEAD_MISTYPED_MAX + 1U);
    weigh_list(self, names, "-|");
}

void hal_meant_ask(const hal_meant_t *self, const char *before, char *text, size_t capacity) {
    text[0] = '\0';
    if (self->nearest != NULL) {
        snprintf(text, capacity, "; did you mean %s%.*s?", before, self->nearest_length, self->nearest);
    }
}
