// SPDX-License-Identifier: MIT
// No command of a client, whatever it asks for and whatever was asked before, makes its wish overflow or
// leave its range.
// Bounds: each motion command and each number that is admitted (15 bits, VEL2 16); any heading; two in a row
// Sources: firmware/guardian/wish.c
// Unwind: 3
// Ci: yes
// Mutant: firmware/guardian/wish.c | self->half_mm_s = (right_mm_s - left_mm_s) / 2; | self->half_mm_s = right_mm_s - left_mm_s;
// Mutant: firmware/guardian/wish.c | (int32_t)(byte & 0xFFu) - | (int32_t)(byte & 0x1FFu) -
#include "proof.h"

#include "guardian/wish.h"

static void take_any(argus_wish_t *const wish, const int32_t raw_deg) {
    static const uint8_t commands[] = {ARCOS_CMD_VEL,  ARCOS_CMD_MOVE,  ARCOS_CMD_RVEL,  ARCOS_CMD_ROTATE,
                                       ARCOS_CMD_HEAD, ARCOS_CMD_DHEAD, ARCOS_CMD_DCHEAD};
    const bool both = nondet_bool();
    argus_said_t said = {.topic = both ? ARGUS_TOPIC_BOTH : ARGUS_TOPIC_WAY};
    said.command = both ? ARCOS_CMD_VEL2 : commands[any_between(0, sizeof commands - 1)];
    said.argument = both ? any_between(-65535, 65535) : any_between(-32767, 32767);
    argus_wish_take(wish, &said, nondet_u32(), raw_deg);
}

void proof(void) {
    argus_wish_t wish = {0};
    const int32_t raw_deg = any_between(-180, 180);
    for (int i = 0; i < 2; i++) {
        take_any(&wish, raw_deg);
        PROVE(wish.way <= ARGUS_WISH_MOVE && wish.turn <= ARGUS_WISH_HEAD, "a kind that there is");
        PROVE(wish.mm_s >= -32767 && wish.mm_s <= 32767, "the speed");
        PROVE(!wish.paired || (wish.mm_s >= -2560 && wish.mm_s <= 2540), "the speed of a pair");
        PROVE(wish.half_mm_s >= -2550 && wish.half_mm_s <= 2550, "its half");
        PROVE(wish.heading_deg >= -179 && wish.heading_deg <= 180, "the heading");
    }
}
