// SPDX-License-Identifier: MIT
// Whatever the parser holds, whatever bytes come and whenever: it takes no more than there are, keeps within
// its memory, and its invariant holds again.
// Bounds: packets scaled down to a COUNT of 9, pieces of up to 4 bytes of any content, any state that its invariant allows, any time: an inductive step
// Unwind: 14
// Ci: no
// Mutant: firmware/arcos/frame.c | if (self->first < ARGUS_FRAME_TOTAL_MAX && self->length > 0) { | if (self->first <= ARGUS_FRAME_TOTAL_MAX + 2 && self->length > 0) {
// Mutant: firmware/arcos/frame.c | self->ahead = (uint8_t)(self->ahead - count); | self->ahead = (uint8_t)(self->ahead + count);
#include "proof.h"

#include "parser_state.h"

#include "arcos/frame.c"

#define PIECE 4

void proof(void) {
    argus_parser_t parser;
    ASSUME(holds(&parser) && is_of_scale(&parser));
    const size_t count = nondet_size();
    ASSUME(count <= PIECE);
    uint8_t bytes[PIECE];
    const uint32_t skipped = parser.skipped_bytes;
    const uint16_t before = parser.length;
    const size_t taken = argus_parser_push(&parser, nondet_u32(), bytes, count);
    PROVE(taken <= count, "no more than there are");
    PROVE(holds(&parser), "the invariant");
    PROVE(parser.length + (parser.skipped_bytes - skipped) == before + taken, "held, or counted as noise");
}
