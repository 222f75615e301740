// SPDX-License-Identifier: MIT
// CRC-32 as in IEEE 802.3 (reflected polynomial 0xEDB88320, start and final XOR 0xFFFFFFFF).
#ifndef HAL_CRC32_H
#define HAL_CRC32_H

#include <stddef.h>
#include <stdint.h>

// The CRC of `count` bytes that follow those whose CRC is `crc` (0 at the start).
uint32_t hal_crc32(uint32_t crc, const void *bytes, size_t count);

#endif
