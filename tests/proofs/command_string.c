// SPDX-License-Identifier: MIT
// A command with a text is one packet within its room, or refused; its text and length arrive as they are.
// Bounds: texts of 0 to 24 bytes, room of 0 to 34 bytes
// Sources: firmware/arcos/command.c firmware/arcos/frame.c
// Unwind: 16
// Ci: yes
// Mutant: firmware/arcos/command.c | capacity < ARCOS_FRAME_OVERHEAD + STRING_HEAD + count | capacity < ARCOS_FRAME_OVERHEAD + count
// Mutant: firmware/arcos/command.c | return argus_frame_seal(packet, capacity, STRING_HEAD + count); | return argus_frame_seal(packet, capacity, count);
#include "proof.h"

#include "arcos/command.h"

void proof(void) {
    const size_t capacity = nondet_size();
    const size_t count = nondet_size();
    ASSUME(capacity <= 34 && count <= 24);
    uint8_t packet[capacity];
    uint8_t text[count];
    const size_t total = argus_command_string(packet, capacity, nondet_u8(), text, count);
    const size_t at = nondet_size();
    ASSUME(at < count);
    PROVE(total <= capacity && total <= ARCOS_FRAME_SEND_TOTAL_MAX, "within its room");
    PROVE(total == 0 || (packet[5] == count && packet[6 + at] == text[at]), "as it is");
    PROVE(total != 0 || capacity < count + 8, "refused only where it does not fit");
}
