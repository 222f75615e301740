// SPDX-License-Identifier: MIT
// What is true of a parser between two calls, of one for packets that are scaled down: a COUNT is up to 9
// instead of 255, and the memory is for two of them as it is. For CBMC alone; before all of firmware/.
#ifndef ARGUS_PARSER_STATE_H
#define ARGUS_PARSER_STATE_H

#include "arcos/gen_arcos.h"

#undef ARCOS_FRAME_COUNT_MAX
#define ARCOS_FRAME_COUNT_MAX 9

#include "arcos/frame.h"

#include <string.h>

// A loop for CBMC: of a length that is not known its own memcpy takes for ever.
static inline void *copied(void *const to, const void *const from, const size_t count) {
    for (size_t i = 0; i < count; i++) {
        ((uint8_t *)to)[i] = ((const uint8_t *)from)[i];
    }
    return to;
}
#define memcpy copied

// Every COUNT is of a byte; here it is of the scale.
static inline bool is_of_scale(const argus_parser_t *const self) {
    return self->first + 2 >= ARGUS_PARSER_BYTES || self->length < 3 ||
           self->held[self->first + 2] <= ARCOS_FRAME_COUNT_MAX;
}

static inline bool holds(const argus_parser_t *const self) {
    const size_t end = (size_t)self->first + self->length;
    const bool within = end <= ARGUS_PARSER_BYTES && self->searched <= end;
    if (!within || self->ahead == 0) {
        return within;
    }
    return self->length >= 3 && self->first < ARGUS_FRAME_TOTAL_MAX &&
           self->length + self->ahead < (size_t)self->held[self->first + 2] + 3;
}

#endif
