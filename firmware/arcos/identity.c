// SPDX-License-Identifier: MIT
// Compares robots part by part.
#include "arcos/identity.h"

#include <stddef.h>

#include "argus/argus.h"

#define FNV_BASIS 2166136261u
#define FNV_PRIME 16777619u

static uint32_t hash(const char *text) {
    uint32_t value = FNV_BASIS;
    if (text == NULL || text[0] == '\0') {
        return 0;
    }
    for (; *text != '\0'; text++) {
        value = (value ^ (uint8_t)*text) * FNV_PRIME;
    }
    return value != 0 ? value : 1;
}

static bool differs(argus_identity_part_t part, uint32_t before, uint32_t now) {
    if (part == ARGUS_IDENTITY_SERIAL && (before == 0 || now == 0)) {
        return false;
    }
    return before != now;
}

int argus_identity_meet(argus_identity_t *self, const char *const texts[ARGUS_IDENTITY_PARTS]) {
    const uint32_t serial = self->part[ARGUS_IDENTITY_SERIAL];
    ARGUS_ASSERT(self->met || serial == 0); // begun anew, or with what was met
    int first = 0;
    for (int i = ARGUS_IDENTITY_PARTS - 1; i >= 0; i--) {
        const uint32_t now = hash(texts[i]);
        if (self->met && differs((argus_identity_part_t)i, self->part[i], now)) {
            first = i + 1;
        }
        self->part[i] = now;
    }
    if (first == 0 && self->part[ARGUS_IDENTITY_SERIAL] == 0) {
        self->part[ARGUS_IDENTITY_SERIAL] = serial; // not given this time, but still its own
    }
    self->met = true;
    ARGUS_ASSERT(first >= 0 && first <= ARGUS_IDENTITY_PARTS);
    return first;
}
