// SPDX-License-Identifier: MIT
// The store's slots are sectors 1 and 2 of the flash, 16 KB each: of all sectors they are erased soonest.
//
// The processor runs from the same flash, so it stands still while that is erased (0.25 s, at most 0.5 s:
// DS8626, table 40). Bytes of the robot are lost meanwhile. The loop saves at rest only.
#include "board/flash.h"
#include "stm32f405/registers.h"

#ifndef STM32_FAKE
#define SLOT_AT(slot) ((stm32_register_t *)(0x08004000u + 0x4000u * (uint32_t)(slot)))
#else
extern stm32_register_t stm32_fake_sector[2][0x1000];
#define SLOT_AT(slot) (stm32_fake_sector[slot])
#endif
#define SECTOR_OF(slot) (1u + (uint32_t)(slot))
#define SLOT_WORDS 0x1000u

static void unlock(void) {
    if ((stm32_get(&STM32_FLASH->cr) & STM32_FLASH_CR_LOCK) != 0) {
        stm32_set(&STM32_FLASH->keyr, STM32_FLASH_KEY_1);
        stm32_set(&STM32_FLASH->keyr, STM32_FLASH_KEY_2);
    }
    stm32_set(&STM32_FLASH->sr, STM32_FLASH_SR_ERRORS); // written 1 to clear
}

static void lock(void) {
    while ((stm32_get(&STM32_FLASH->sr) & STM32_FLASH_SR_BUSY) != 0) {
    }
    stm32_set(&STM32_FLASH->cr, STM32_FLASH_CR_LOCK);
}

// What the cache holds of a sector is of before its erasure.
static void forget_cache(void) {
    const uint32_t before = stm32_get(&STM32_FLASH->acr);
    stm32_set(&STM32_FLASH->acr, before & ~STM32_FLASH_ACR_DATA_CACHE);
    stm32_set(&STM32_FLASH->acr, (before & ~STM32_FLASH_ACR_DATA_CACHE) | STM32_FLASH_ACR_DATA_RESET);
    stm32_set(&STM32_FLASH->acr, before);
}

bool board_flash_erase(int slot) {
    const uint32_t what =
        STM32_FLASH_CR_WORDS | STM32_FLASH_CR_ERASE | STM32_FLASH_CR_SECTOR(SECTOR_OF(slot));
    unlock();
    stm32_set(&STM32_FLASH->cr, what);
    stm32_set(&STM32_FLASH->cr, what | STM32_FLASH_CR_START);
    lock();
    forget_cache();
    for (uint32_t i = 0; i < SLOT_WORDS; i++) {
        if (stm32_get(&SLOT_AT(slot)[i]) != UINT32_MAX) {
            return false;
        }
    }
    return true;
}

bool board_flash_program(int slot, uint32_t offset, uint32_t word) {
    stm32_register_t *const at = &SLOT_AT(slot)[offset / 4u];
    unlock();
    stm32_set(&STM32_FLASH->cr, STM32_FLASH_CR_WORDS | STM32_FLASH_CR_PROGRAM);
    stm32_set(at, word);
    lock();
    return stm32_get(at) == word;
}

const uint8_t *board_flash_base(int slot) {
    return (const uint8_t *)SLOT_AT(slot);
}
