// SPDX-License-Identifier: MIT
// A packet is sealed within its room or refused, and the parser's own test of the checksum holds for what was
// sealed.
// Bounds: 0 to 24 bytes of any content, room of 0 to 30 bytes
// Unwind: 16
// Ci: yes
// Mutant: firmware/arcos/frame.c | total <= capacity; | total <= capacity + 1;
// Mutant: firmware/arcos/frame.c | (uint8_t)(checksum & 0xFF) | (uint8_t)(checksum & 0x7F)
#include "proof.h"

#include "arcos/frame.c"

void proof(void) {
    const size_t capacity = nondet_size();
    const size_t count = nondet_size();
    ASSUME(capacity <= 30 && count <= 24);
    uint8_t packet[capacity];
    const size_t total = argus_frame_seal(packet, capacity, count);
    PROVE(total == 0 || (total == count + 5 && total <= capacity), "its length");
    PROVE(total != 0 || count == 0 || count + 5 > capacity, "refused only where it does not fit");
    PROVE(total == 0 || checksum_holds(packet), "the checksum holds");
    PROVE(total == 0 || starts_packet(packet, total), "it starts a packet");
}
