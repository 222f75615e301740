// SPDX-License-Identifier: MIT
// Rule under attack: what a board stored means the same to a later build, or is refused, once, and the board
// is passive then.
#include "board/memory.h"

#include <string.h>

#include "board/config.h"
#include "board/flash.h"
#include "hal/crc32.h"
#include "unity.h"

#define SLOT_BYTES (HAL_STORE_HEADER + HAL_STORE_RECORD_MAX)

const char board_built_config[] = "[argus]\nactive = on\nstep_mm = 150\n";

static uint8_t flash[HAL_STORE_SLOTS][SLOT_BYTES];
static argus_storage_t storage;
static argus_config_t config;
static board_memory_t memory;

bool board_flash_erase(int slot) {
    memset(flash[slot], 0xFF, SLOT_BYTES);
    return true;
}

bool board_flash_program(int slot, uint32_t offset, uint32_t word) {
    memcpy(flash[slot] + offset, &word, sizeof word);
    return true;
}

const uint8_t *board_flash_base(int slot) {
    return flash[slot];
}

void setUp(void) {
    memset(flash, 0xFF, sizeof flash);
}

static board_settings_t start(void) {
    board_memory_init(&memory);
    return board_memory_settings(&memory, &config);
}

static void save(void) {
    argus_t *const core = argus_init(&storage, &config, 0);
    TEST_ASSERT_EQUAL(HAL_STORE_OK, board_memory_save(&memory, core, &config));
}

static void put32(uint8_t *at, uint32_t value) {
    for (int i = 0; i < 4; i++) {
        at[i] = (uint8_t)(value >> 8 * i);
    }
}

static void store_pair(const char *key, const char *more, uint32_t value) {
    uint8_t record[10] = {1, 0};
    hal_store_t store;
    put32(record + 2, hal_crc32(hal_crc32(0, key, strlen(key)), more, strlen(more)));
    put32(record + 6, value);
    hal_store_init(&store, board_flash_medium());
    TEST_ASSERT_EQUAL(HAL_STORE_OK, hal_store_save(&store, record, sizeof record));
}

void test_settings_come_back(void) {
    TEST_ASSERT_EQUAL(BOARD_SETTINGS_BUILT, start());
    TEST_ASSERT_EQUAL_INT32(1, config.active);
    config.robot = 3;
    config.active = 0;
    save();
    TEST_ASSERT_EQUAL(BOARD_SETTINGS_STORED, start());
    TEST_ASSERT_EQUAL_INT32(3, config.robot);
    TEST_ASSERT_EQUAL_INT32(0, config.active);
}

// The place in the alphabet, as older builds stored it.
void test_a_robot_by_its_place_is_refused_once(void) {
    store_pair("robot", "", 3);
    TEST_ASSERT_EQUAL(BOARD_SETTINGS_OUTDATED, start());
    TEST_ASSERT_EQUAL_INT32(0, config.robot);
    TEST_ASSERT_EQUAL_INT32(0, config.active); // though the text compiled in says on
    TEST_ASSERT_EQUAL_INT32(150, config.step_mm);
    save(); // by itself after a minute
    TEST_ASSERT_EQUAL(BOARD_SETTINGS_STORED, start());
    TEST_ASSERT_EQUAL_INT32(0, config.robot);
    TEST_ASSERT_EQUAL_INT32(0, config.active); // until somebody says otherwise
}

void test_a_robot_that_there_is_no_more_is_refused(void) {
    store_pair("robot", "=", hal_crc32(0, "p2dx", 4));
    TEST_ASSERT_EQUAL(BOARD_SETTINGS_OUTDATED, start());
    TEST_ASSERT_EQUAL_INT32(0, config.active);
    store_pair("robot", "=", hal_crc32(0, "p3at-sh", 7));
    TEST_ASSERT_EQUAL(BOARD_SETTINGS_STORED, start());
    TEST_ASSERT_EQUAL_INT32(3, config.robot);
    TEST_ASSERT_EQUAL_INT32(1, config.active);
}
