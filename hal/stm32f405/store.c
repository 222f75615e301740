// SPDX-License-Identifier: MIT
// The store's slots are sectors 1 and 2 of the flash, 16 KB each: of all sectors they are erased soonest.
//
// The processor stands still while flash is erased (0.25 s, at most 0.5 s: DS8626, table 40), since it runs
// from the same flash; bytes of the robot are lost meanwhile. The loop saves at rest only.
#include <string.h>

#include "board/flash.h"
#include "stm32f405/registers.h"

#ifndef STM32_FAKE
#define SLOT_AT(slot) ((volatile uint32_t *)(0x08004000u + 0x4000u * (uint32_t)(slot)))
#else
extern uint32_t stm32_fake_sector[2][0x1000];
#define SLOT_AT(slot) ((volatile uint32_t *)stm32_fake_sector[slot])
#endif
#define SECTOR_OF(slot) (1u + (uint32_t)(slot))
#define SLOT_WORDS 0x1000u

static void unlock(void) {
    if ((STM32_FLASH->cr & STM32_FLASH_CR_LOCK) != 0) {
        STM32_FLASH->keyr = STM32_FLASH_KEY_1;
        STM32_FLASH->keyr = STM32_FLASH_KEY_2;
    }
    STM32_FLASH->sr = STM32_FLASH_SR_ERRORS; // written 1 to clear
}

static void wait(void) {
    while ((STM32_FLASH->sr & STM32_FLASH_SR_BUSY) != 0) {
    }
}

static void lock(void) {
    wait();
    STM32_FLASH->cr = STM32_FLASH_CR_LOCK;
}

// What the cache holds of a sector is of before its erasure.
static void forget_cache(void) {
    const uint32_t before = STM32_FLASH->acr;
    STM32_FLASH->acr = before & ~STM32_FLASH_ACR_DATA_CACHE;
    STM32_FLASH->acr |= STM32_FLASH_ACR_DATA_RESET;
    STM32_FLASH->acr = before;
}

bool board_flash_erase(int slot) {
    unlock();
    STM32_FLASH->cr = STM32_FLASH_CR_WORDS | STM32_FLASH_CR_ERASE | STM32_FLASH_CR_SECTOR(SECTOR_OF(slot));
    STM32_FLASH->cr |= STM32_FLASH_CR_START;
    lock();
    forget_cache();
    for (uint32_t i = 0; i < SLOT_WORDS; i++) {
        if (SLOT_AT(slot)[i] != UINT32_MAX) {
            return false;
        }
    }
    return true;
}

bool board_flash_program(int slot, uint32_t offset, uint32_t word) {
    unlock();
    STM32_FLASH->cr = STM32_FLASH_CR_WORDS | STM32_FLASH_CR_PROGRAM;
    SLOT_AT(slot)[offset / 4u] = word;
    lock();
    return SLOT_AT(slot)[offset / 4u] == word;
}

const uint8_t *board_flash_base(int slot) {
    return (const uint8_t *)SLOT_AT(slot);
}
