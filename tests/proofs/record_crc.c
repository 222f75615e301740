// SPDX-License-Identifier: MIT
// A record in which up to 16 bits in a row are damaged has another checksum, wherever they lie.
// Bounds: any content of 8 bytes, each place and each damage of up to 16 bits; a CRC is linear, so what comes before and behind changes nothing of it
// Sources: firmware/awareness/evidence.c
// Unwind: 10
// Ci: no
// Mutant: firmware/analysis/record.c | (crc << 1 ^ 0x1021u) & 0xFFFFu : | (crc << 1 ^ 0x1020u) & 0xFFFFu :
// Mutant: firmware/analysis/record.c | : crc << 1 & 0xFFFFu; | : crc << 1 & 0x7FFFu;
#include "proof.h"

#include "analysis/record.c"

#define BYTES 8

void proof(void) {
    uint8_t sound[BYTES];
    uint8_t damaged[BYTES];
    const uint16_t damage = nondet_u16();
    const unsigned place = nondet_u8();
    ASSUME(damage != 0 && place <= 8 * BYTES - 16);
    const uint64_t bits = (uint64_t)damage << place;
    for (int i = 0; i < BYTES; i++) {
        damaged[i] = (uint8_t)(sound[i] ^ (bits >> 8 * (BYTES - 1 - i) & 0xFF));
    }
    PROVE(crc16(sound, BYTES) != crc16(damaged, BYTES), "it is found");
}
