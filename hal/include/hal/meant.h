// SPDX-License-Identifier: MIT
// The word that a mistyped one was meant to be: of options, settings, their choices, sections, schemes of
// links.
#ifndef HAL_MEANT_H
#define HAL_MEANT_H

#include <stddef.h>

#define HAL_MEANT_MAX 80 // bytes of a question

typedef struct {
    const char *word; // as it was typed
    size_t length;
    const char *nearest; // of those weighed; NULL: none is near
    int nearest_length;
    size_t best;
} hal_meant_t;

void hal_meant_begin(hal_meant_t *self, const char *word, size_t length);

void hal_meant_weigh(hal_meant_t *self, const char *name, size_t length);

// Weighs each of "a|b|c".
void hal_meant_weigh_list(hal_meant_t *self, const char *names);

// Weighs the head of each, that is "p3dx" of "p3dx-sh", behind the whole names: one letter may be wrong.
void hal_meant_weigh_heads(hal_meant_t *self, const char *names);

// Writes "; did you mean NAME?", NAME with `before` ahead of it; "" when none is near.
void hal_meant_ask(const hal_meant_t *self, const char *before, char *text, size_t capacity);

#endif
