// SPDX-License-Identifier: MIT
// Rule under attack: whatever word of a save the power goes off at, the store holds the old record or the new
// one, never neither, and it can be saved to again.
#include "board/flash.h"

#include <stdio.h>
#include <string.h>

#include "unity.h"

#define SLOT_BYTES (HAL_STORE_HEADER + HAL_STORE_RECORD_MAX)
#define SAVES 1000
#define RECORD_MAX 96

static uint8_t flash[HAL_STORE_SLOTS][SLOT_BYTES];
static uint32_t steps;  // erasures and words, over all saves
static uint32_t cut_at; // the power goes off in this step
static bool is_off;     // nothing works until the power is on again
static uint32_t noise;  // what a word or a slot that was cut is left as
static hal_store_t store;

static uint32_t chance(void) {
    noise = noise * 1664525u + 1013904223u;
    return noise;
}

// True: the power goes off now.
static bool is_cut(void) {
    is_off = is_off || steps == cut_at;
    steps++;
    return is_off;
}

// An erasure that is cut leaves any bits set that were not.
bool board_flash_erase(int slot) {
    if (is_off) {
        return false;
    }
    const bool cut = is_cut();
    for (size_t i = 0; i < SLOT_BYTES; i++) {
        flash[slot][i] = (uint8_t)(cut ? flash[slot][i] | chance() >> 24 : 0xFF);
    }
    return !cut;
}

// Programming clears bits; one that is cut clears some of them.
bool board_flash_program(int slot, uint32_t offset, uint32_t word) {
    uint8_t bytes[4];
    if (is_off) {
        return false;
    }
    const bool cut = is_cut();
    const uint32_t kept = cut ? chance() : 0;
    word |= kept;
    memcpy(bytes, &word, sizeof bytes);
    for (size_t i = 0; i < sizeof bytes; i++) {
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(0xFF, flash[slot][offset + i], "a word is programmed twice");
        flash[slot][offset + i] &= bytes[i];
    }
    return !cut;
}

const uint8_t *board_flash_base(int slot) {
    return flash[slot];
}

static void power_on(void) {
    is_off = false;
    cut_at = UINT32_MAX;
    hal_store_init(&store, board_flash_medium());
}

void setUp(void) {
    memset(flash, 0xFF, sizeof flash);
    steps = 0;
    noise = 1;
    power_on();
}

// A record that says which it is, of a length of its own.
static size_t record_of(uint32_t number, uint8_t record[RECORD_MAX]) {
    const size_t count = 4 + number * 7 % (RECORD_MAX - 4);
    for (size_t i = 0; i < count; i++) {
        record[i] = (uint8_t)(number >> 8 * (i % 4));
    }
    return count;
}

static bool holds(uint32_t number) {
    uint8_t wanted[RECORD_MAX];
    uint8_t record[RECORD_MAX];
    size_t count = 0;
    const size_t length = record_of(number, wanted);
    hal_store_init(&store, board_flash_medium());
    return hal_store_load(&store, record, sizeof record, &count) == HAL_STORE_OK && count == length &&
           memcmp(record, wanted, length) == 0;
}

static bool save(uint32_t number) {
    uint8_t record[RECORD_MAX];
    const size_t count = record_of(number, record);
    return hal_store_save(&store, record, count) == HAL_STORE_OK;
}

static uint32_t steps_of(uint32_t number) {
    uint8_t record[RECORD_MAX];
    return 1 + HAL_STORE_HEADER / 4 + (uint32_t)(record_of(number, record) + 3) / 4;
}

void test_nothing_is_there_at_first(void) {
    uint8_t record[8];
    size_t count = 0;
    TEST_ASSERT_EQUAL_INT(HAL_STORE_EMPTY, hal_store_load(&store, record, sizeof record, &count));
}

void test_the_longest_record_comes_back(void) {
    static uint8_t record[HAL_STORE_RECORD_MAX];
    static uint8_t back[HAL_STORE_RECORD_MAX];
    size_t count = 0;
    for (size_t i = 0; i < sizeof record; i++) {
        record[i] = (uint8_t)(i * 31);
    }
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, hal_store_save(&store, record, sizeof record));
    power_on();
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, hal_store_load(&store, back, sizeof back, &count));
    TEST_ASSERT_EQUAL_size_t(sizeof record, count);
    TEST_ASSERT_EQUAL_MEMORY(record, back, sizeof record);
}

void test_a_cut_at_any_word_of_a_thousand_saves_leaves_the_old_or_the_new_record(void) {
    char place[64];
    static uint8_t before[HAL_STORE_SLOTS][SLOT_BYTES];
    TEST_ASSERT_TRUE(save(0));
    for (uint32_t number = 1; number <= SAVES; number++) {
        memcpy(before, flash, sizeof flash);
        for (uint32_t step = 0; step < steps_of(number); step++) {
            snprintf(place, sizeof place, "save %u cut in step %u", (unsigned)number, (unsigned)step);
            memcpy(flash, before, sizeof flash);
            power_on();
            cut_at = steps + step;
            TEST_ASSERT_FALSE_MESSAGE(save(number), place);
            power_on();
            const bool is_new = holds(number);
            TEST_ASSERT_TRUE_MESSAGE(is_new || holds(number - 1), place);
        }
        // What the last cut left is saved over.
        TEST_ASSERT_TRUE(save(number));
        TEST_ASSERT_TRUE(holds(number));
    }
}

void test_it_is_saved_to_again_after_each_cut(void) {
    TEST_ASSERT_TRUE(save(1));
    for (uint32_t step = 0; step < steps_of(2); step++) {
        cut_at = steps + step;
        TEST_ASSERT_FALSE(save(2));
        power_on();
        TEST_ASSERT_TRUE(save(3));
        TEST_ASSERT_TRUE(holds(3));
        TEST_ASSERT_TRUE(save(1));
        TEST_ASSERT_TRUE(holds(1));
    }
}
