// SPDX-License-Identifier: MIT
// A text is taken out of any packet, from any place, within its bytes and the room for it; it ends, and is
// printable.
// Bounds: packets of up to 40 bytes, any content; any place up to 100
// Unwind: 42
// Ci: yes
// Mutant: firmware/arcos/configpac.c | length < ARGUS_NAME_MAX - 1 | length < ARGUS_NAME_MAX + 1
// Mutant: firmware/arcos/configpac.c | at < packet->count; at++ | at <= packet->count; at++
#include "proof.h"

#include "arcos/configpac.c"

void proof(void) {
    const uint8_t count = nondet_u8();
    ASSUME(count <= 40);
    uint8_t data[count];
    const argus_packet_t packet = {.data = data, .count = count};
    size_t offset = nondet_size();
    ASSUME(offset <= 100);
    const size_t before = offset;
    char text[ARGUS_NAME_MAX];
    const bool found = argus_packet_string(&packet, &offset, text);
    PROVE(found ? offset > before && offset <= count : offset == before, "behind its end");
    const size_t at = nondet_size();
    ASSUME(at < ARGUS_NAME_MAX);
    size_t end = 0;
    while (end < ARGUS_NAME_MAX && text[end] != 0) {
        PROVE(text[end] >= 0x20 && text[end] < 0x7F, "printable");
        end++;
    }
    PROVE(end < ARGUS_NAME_MAX, "it ends");
}
