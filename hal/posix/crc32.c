// SPDX-License-Identifier: MIT
// CRC-32, bit by bit: records are small and rare, so a table would buy nothing.
#include "hal/crc32.h"

#define POLYNOMIAL 0xEDB88320u

uint32_t hal_crc32(uint32_t crc, const void *bytes, size_t count) {
    const uint8_t *const data = bytes;
    crc = ~crc;
    for (size_t i = 0; i < count; i++) {
        crc ^= data[i];
        for (int bit = 0; bit < 8; bit++) {
            crc = (crc >> 1) ^ ((crc & 1u) != 0 ? POLYNOMIAL : 0u);
        }
    }
    return ~crc;
}
