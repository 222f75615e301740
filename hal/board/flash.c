// SPDX-License-Identifier: MIT
// Slots in flash, by the words that a port can program.
#include "board/flash.h"

#include <string.h>

#define WORD 4u
#define ERASED 0xFFu

static int slot_read(void *context, int slot, size_t offset, uint8_t *bytes, size_t count) {
    const uint8_t *const base = board_flash_base(slot);
    (void)context;
    if (base == NULL) {
        return HAL_STORE_NO_PLACE;
    }
    memcpy(bytes, base + offset, count);
    if (offset == 0 && count > 0 && bytes[0] == ERASED) {
        return HAL_STORE_EMPTY;
    }
    return (int)count;
}

// The last word is filled up as flash is when it is erased.
static bool program(int slot, uint32_t offset, const uint8_t *bytes, size_t count) {
    for (size_t at = 0; at < count; at += WORD) {
        const size_t left = count - at < WORD ? count - at : WORD;
        uint32_t word = UINT32_MAX;
        memcpy(&word, bytes + at, left);
        if (!board_flash_program(slot, offset + (uint32_t)at, word)) {
            return false;
        }
    }
    return true;
}

static int slot_write(void *context, int slot, const uint8_t *header, const uint8_t *record, size_t count) {
    (void)context;
    const bool good = board_flash_erase(slot) && program(slot, HAL_STORE_HEADER, record, count) &&
                      program(slot, 0, header, HAL_STORE_HEADER);
    return good ? HAL_STORE_OK : HAL_STORE_IO;
}

hal_medium_t board_flash_medium(void) {
    static const hal_medium_ops_t ops = {.read = slot_read, .write = slot_write};
    return (hal_medium_t){.ops = &ops, .context = NULL};
}
