// SPDX-License-Identifier: MIT
// The option that a mistyped one was meant to be, by the distance of Levenshtein.
#include "meant.h"

#include <stddef.h>
#include <string.h>

enum { NAME_MAX_LENGTH = 40, MISTYPED_MAX = 2 };

static size_t least(size_t a, size_t b) {
    return a < b ? a : b;
}

// How many letters are to be changed, put in or taken out.
static size_t distance(const char *a, size_t length, const char *b) {
    size_t row[NAME_MAX_LENGTH + 1];
    for (size_t i = 0; i <= length; i++) {
        row[i] = i;
    }
    for (size_t j = 1; b[j - 1] != '\0'; j++) {
        size_t corner = row[0];
        row[0] = j;
        for (size_t i = 1; i <= length; i++) {
            const size_t changed = corner + (a[i - 1] == b[j - 1] ? 0U : 1U);
            corner = row[i];
            row[i] = least(changed, least(row[i], row[i - 1]) + 1U);
        }
    }
    return row[length];
}

const char *option_meant(const struct option *table, const char *given) {
    given += strspn(given, "-");
    const size_t length = strcspn(given, "=");
    const char *nearest = NULL;
    size_t best = least(MISTYPED_MAX, length / 2U) + 1U;
    if (length > NAME_MAX_LENGTH) {
        return NULL;
    }
    for (; table->name != NULL; table++) {
        const size_t away = distance(given, length, table->name);
        if (away < best) {
            best = away;
            nearest = table->name;
        }
    }
    return nearest;
}
