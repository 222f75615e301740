// SPDX-License-Identifier: MIT
// Rule under attack: the flash interface is unlocked by its keys, told sector and width, waited for, locked
// again; and a sector that did not take what was written is found out.
#define STM32_FAKE 1
#include "stm32f405/store.c" // NOLINT(bugprone-suspicious-include): with registers that are the test's

#include <string.h>

#include "unity.h"

stm32_usart_t stm32_fake_usart[2];
stm32_flash_t stm32_fake_flash;
stm32_can_t stm32_fake_can;
stm32_register_t stm32_fake_sector[2][0x1000];

static unsigned keys;
static unsigned busy;     // reads of the status until it is done
static bool is_worn;      // a bit of the first word stays 0
static bool cache_is_old; // since an erasure
static unsigned erasures;

static bool is_in_a_sector(const stm32_register_t *at) {
    const stm32_register_t *const first = &stm32_fake_sector[0][0];
    return at >= first && at < first + sizeof stm32_fake_sector / sizeof stm32_fake_sector[0][0];
}

uint32_t stm32_get(const stm32_register_t *at) {
    if (at == &stm32_fake_flash.sr) {
        return busy > 0 ? busy--, STM32_FLASH_SR_BUSY : 0;
    }
    if (is_in_a_sector(at)) {
        TEST_ASSERT_EQUAL_MESSAGE(0, busy, "flash is read while it is busy");
        TEST_ASSERT_FALSE_MESSAGE(cache_is_old, "flash is read through an old cache");
    }
    return *at;
}

static void erase(uint32_t command) {
    const uint32_t sector = command >> 3 & 15u;
    TEST_ASSERT_EQUAL_HEX32(STM32_FLASH_CR_WORDS | STM32_FLASH_CR_ERASE | STM32_FLASH_CR_START,
                            command & ~(15u << 3));
    TEST_ASSERT_TRUE_MESSAGE(sector == 1 || sector == 2, "a sector of the program is erased");
    for (unsigned i = 0; i < 0x1000; i++) {
        stm32_fake_sector[sector - 1][i] = UINT32_MAX;
    }
    if (is_worn) {
        stm32_fake_sector[sector - 1][0] &= ~1u;
    }
    erasures++;
    busy = 3;
    cache_is_old = true;
}

static void command(uint32_t value) {
    const bool locked = (stm32_fake_flash.cr & STM32_FLASH_CR_LOCK) != 0;
    TEST_ASSERT_EQUAL_MESSAGE(0, busy, "a command comes while flash is busy");
    TEST_ASSERT_FALSE_MESSAGE(locked && keys != 2, "a command comes while flash is locked");
    if ((value & STM32_FLASH_CR_START) != 0) {
        erase(value);
    }
    keys = 0;
    stm32_fake_flash.cr = value & ~STM32_FLASH_CR_START;
}

void stm32_set(stm32_register_t *at, uint32_t value) {
    if (at == &stm32_fake_flash.keyr) {
        TEST_ASSERT_EQUAL_HEX32(keys == 0 ? 0x45670123u : 0xCDEF89ABu, value);
        keys++;
    } else if (at == &stm32_fake_flash.cr) {
        command(value);
    } else if (is_in_a_sector(at)) {
        TEST_ASSERT_EQUAL_HEX32(STM32_FLASH_CR_WORDS | STM32_FLASH_CR_PROGRAM, stm32_fake_flash.cr);
        *at &= value;
        busy = 2;
    } else if (at == &stm32_fake_flash.acr) {
        cache_is_old = cache_is_old && (value & STM32_FLASH_ACR_DATA_RESET) == 0;
        TEST_ASSERT_NOT_EQUAL_MESSAGE(STM32_FLASH_ACR_DATA_RESET | STM32_FLASH_ACR_DATA_CACHE,
                                      value & (STM32_FLASH_ACR_DATA_RESET | STM32_FLASH_ACR_DATA_CACHE),
                                      "the cache is emptied while it is on");
        *at = value;
    }
}

void setUp(void) {
    memset((void *)(uintptr_t)stm32_fake_sector, 0, sizeof stm32_fake_sector);
    stm32_fake_flash.cr = STM32_FLASH_CR_LOCK;
    stm32_fake_flash.acr = STM32_FLASH_ACR_5_WAITS | STM32_FLASH_ACR_CACHES;
    keys = busy = erasures = 0;
    is_worn = cache_is_old = false;
}

void test_a_slot_is_erased_and_programmed_and_locked_again(void) {
    for (int slot = 0; slot < 2; slot++) {
        TEST_ASSERT_TRUE(board_flash_erase(slot));
        TEST_ASSERT_TRUE(board_flash_program(slot, 8, 0x12345678u));
        TEST_ASSERT_EQUAL_HEX32(0x12345678u, ((const uint32_t *)(uintptr_t)board_flash_base(slot))[2]);
        TEST_ASSERT_BITS_HIGH(STM32_FLASH_CR_LOCK, stm32_fake_flash.cr);
    }
    TEST_ASSERT_EQUAL_UINT(2, erasures);
    TEST_ASSERT_EQUAL_HEX32(STM32_FLASH_ACR_5_WAITS | STM32_FLASH_ACR_CACHES, stm32_fake_flash.acr);
}

void test_what_the_flash_did_not_take_is_found(void) {
    TEST_ASSERT_FALSE(board_flash_program(0, 0, 1)); // it was not erased
    is_worn = true;
    TEST_ASSERT_FALSE(board_flash_erase(1));
}

void test_a_record_goes_through_the_store(void) {
    char back[16];
    size_t count = 0;
    hal_store_t store;
    hal_store_init(&store, board_flash_medium());
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, hal_store_save(&store, "on a board", 10));
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, hal_store_save(&store, "on a board too", 14));
    hal_store_init(&store, board_flash_medium());
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, hal_store_load(&store, back, sizeof back, &count));
    TEST_ASSERT_EQUAL_size_t(14, count);
    TEST_ASSERT_EQUAL_MEMORY("on a board too", back, 14);
}
