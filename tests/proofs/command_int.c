// SPDX-License-Identifier: MIT
// Each command with a number is one good packet: its magnitude is at most 32,767, its sign is the argument's.
// Bounds: each of the 256 commands and of the 2^32 numbers; room of 0 to 12 bytes
// Sources: firmware/arcos/command.c firmware/arcos/frame.c
// Unwind: 6
// Ci: yes
// Mutant: firmware/arcos/command.c | argument > ARGUMENT_MAX || | argument > ARGUMENT_MAX + 1 ||
// Mutant: firmware/arcos/frame.c | total <= capacity; | total <= capacity + 1;
#include "proof.h"

#include "arcos/command.h"

void proof(void) {
    uint8_t packet[12];
    const size_t capacity = nondet_size();
    ASSUME(capacity <= sizeof packet);
    const uint8_t command = nondet_u8();
    const int32_t argument = nondet_i32();
    uint8_t room[capacity];
    const size_t total = argus_command_int(room, capacity, command, argument);
    PROVE(total == 0 ? capacity < 9 : capacity >= 9, "refused only where it does not fit");
    if (total == 0) {
        return;
    }
    const int32_t magnitude = room[5] | room[6] << 8;
    PROVE(total == 9 && room[2] == 6 && room[3] == command, "a packet of nine bytes");
    PROVE(magnitude <= 32767, "15 bits");
    PROVE(argument < 0 ? room[4] == ARCOS_ARG_NEGATIVE : room[4] == ARCOS_ARG_POSITIVE, "the sign");
    PROVE(argument > 32767 || argument < -32767 || (argument < 0 ? -magnitude : magnitude) == argument,
          "the number, where it fits");
    PROVE((uint16_t)(room[7] << 8 | room[8]) == argus_frame_checksum(room + 3, 4), "the checksum");
}
