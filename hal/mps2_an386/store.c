// SPDX-License-Identifier: MIT
// The board has no flash of its own: two slots in its static RAM behave as one, over a reset too.
#include "board/flash.h"

#define SLOT_BYTES 4096u
#define MARK 0x48534C46u // "FLSH": the slots are in use since the power came
#define MARK_AT ((volatile uint32_t *)0x001FFFFCu)
#define SLOT_AT(slot) ((volatile uint32_t *)(0x00200000u + (uint32_t)(slot) * SLOT_BYTES))

static void erase(int slot) {
    for (uint32_t i = 0; i < SLOT_BYTES / 4u; i++) {
        SLOT_AT(slot)[i] = UINT32_MAX;
    }
}

// RAM holds anything when the power comes, flash what it held.
static void make_flash(void) {
    if (*MARK_AT != MARK) {
        for (int slot = 0; slot < HAL_STORE_SLOTS; slot++) {
            erase(slot);
        }
        *MARK_AT = MARK;
    }
}

bool board_flash_erase(int slot) {
    make_flash();
    erase(slot);
    return true;
}

// As of flash: programming clears bits.
bool board_flash_program(int slot, uint32_t offset, uint32_t word) {
    volatile uint32_t *const at = SLOT_AT(slot) + offset / 4u;
    *at &= word;
    return *at == word;
}

const uint8_t *board_flash_base(int slot) {
    make_flash();
    return (const uint8_t *)SLOT_AT(slot);
}
