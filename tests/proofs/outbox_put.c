// SPDX-License-Identifier: MIT
// An outbox in any state takes a packet whole or not at all, keeps its reserve free, and gives it out as it
// was put.
// Bounds: eight places on either side of the end of the ring; 0 to 9 or 478 to 512 bytes waiting; packets of numbers; the empty outbox for what comes out
// Sources: firmware/arcos/frame.c
// Unwind: 12
// Ci: no
// Mutant: firmware/arcos/command.c | self->length + total > ARGUS_OUTBOX_BYTES - ARGUS_OUTBOX_RESERVE | self->length + total > ARGUS_OUTBOX_BYTES + ARGUS_OUTBOX_RESERVE
// Mutant: firmware/arcos/command.c | return index % ARGUS_OUTBOX_BYTES; | return index;
#include "proof.h"

#include "arcos/command.c"

void proof(void) {
    argus_outbox_t box;
    ASSUME(box.head < 8 || (box.head >= ARGUS_OUTBOX_BYTES - 8 && box.head < ARGUS_OUTBOX_BYTES));
    ASSUME(box.length < 10 || (box.length >= 478 && box.length <= ARGUS_OUTBOX_BYTES));
    const uint16_t before = box.length;
    const uint8_t command = nondet_u8();
    const int32_t argument = nondet_i32();
    const bool taken = argus_outbox_int(&box, command, argument);
    PROVE(box.length == before + (taken ? INT_TOTAL : 0), "whole or not at all");
    PROVE(!taken || box.length <= ARGUS_OUTBOX_BYTES - ARGUS_OUTBOX_RESERVE, "the reserve stays");
    if (before == 0) {
        uint8_t packet[INT_TOTAL];
        uint8_t same[INT_TOTAL];
        PROVE(argus_outbox_first(&box) == command, "it comes next");
        PROVE(argus_outbox_fetch(&box, packet, sizeof packet) == INT_TOTAL, "it comes out");
        PROVE(argus_command_int(same, sizeof same, command, argument) == INT_TOTAL, "as it was put");
        const size_t at = nondet_size();
        ASSUME(at < INT_TOTAL);
        PROVE(packet[at] == same[at] && box.length == 0, "as it was put");
    }
}
