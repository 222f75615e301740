// SPDX-License-Identifier: MIT
// Attacks: a record outlives a power cut at every byte of a save, damage of any byte, and a sequence number
// that wraps.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hal/fake_store.h"
#include "hal/store.h"
#include "unity.h"

static hal_fake_store_t medium;
static hal_store_t store;
static char record[HAL_STORE_RECORD_MAX];
static size_t count;

static void open_anew(void) {
    hal_store_init(&store, hal_fake_store_medium(&medium));
}

void setUp(void) {
    hal_fake_store_init(&medium);
    open_anew();
}

static hal_store_error_t load(void) {
    memset(record, 0, sizeof record);
    count = 0;
    return hal_store_load(&store, record, sizeof record, &count);
}

static void assert_holds(const char *text) {
    open_anew();
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, load());
    TEST_ASSERT_EQUAL_size_t(strlen(text), count);
    TEST_ASSERT_EQUAL_STRING(text, record);
}

static void save(const char *text) {
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, hal_store_save(&store, text, strlen(text)));
}

void test_empty_at_first(void) {
    TEST_ASSERT_EQUAL_INT(HAL_STORE_EMPTY, load());
}

void test_the_newest_of_many_saves_counts(void) {
    char text[32];
    for (int i = 0; i < 300; i++) {
        snprintf(text, sizeof text, "record %d", i);
        if (i % 7 == 0) {
            open_anew();
        }
        save(text);
        assert_holds(text);
    }
}

void test_lengths_from_nothing_to_the_most(void) {
    char big[HAL_STORE_RECORD_MAX + 1];
    memset(big, 'z', sizeof big);
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, hal_store_save(&store, big, 0));
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, load());
    TEST_ASSERT_EQUAL_size_t(0, count);
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, hal_store_save(&store, big, HAL_STORE_RECORD_MAX));
    TEST_ASSERT_EQUAL_INT(HAL_STORE_OK, load());
    TEST_ASSERT_EQUAL_size_t(HAL_STORE_RECORD_MAX, count);
    TEST_ASSERT_EQUAL_INT(HAL_STORE_TOO_LONG, hal_store_save(&store, big, sizeof big));
    TEST_ASSERT_EQUAL_INT(HAL_STORE_TOO_LONG, hal_store_load(&store, record, 10, &count));
}

void test_power_cut_at_every_byte_leaves_the_old_or_the_new_record(void) {
    const uint32_t slot = HAL_STORE_HEADER + 9;
    for (uint32_t cut = 0; cut <= slot; cut++) {
        hal_fake_store_init(&medium);
        open_anew();
        save("record 1");
        save("record 2");
        medium.cut_after = medium.written + cut;
        const hal_store_error_t result = hal_store_save(&store, "record 33", 9);
        TEST_ASSERT_EQUAL_INT(cut < slot ? HAL_STORE_IO : HAL_STORE_OK, result);
        hal_fake_store_power_on(&medium);
        assert_holds(cut < slot ? "record 2" : "record 33");
        // The store goes on working with the same object and the slot that was left half written.
        save("record 4");
        assert_holds("record 4");
        save("record 5");
        assert_holds("record 5");
    }
}

void test_first_save_cut_is_damage_not_emptiness(void) {
    medium.cut_after = 10;
    TEST_ASSERT_EQUAL_INT(HAL_STORE_IO, hal_store_save(&store, "abc", 3));
    hal_fake_store_power_on(&medium);
    open_anew();
    TEST_ASSERT_EQUAL_INT(HAL_STORE_DAMAGED, load());
    save("def");
    assert_holds("def");
}

void test_any_flipped_bit_is_found_and_the_other_slot_is_used(void) {
    save("older");
    save("newer");
    for (uint32_t bit = 0; bit < 8u * (HAL_STORE_HEADER + 5); bit++) {
        medium.bytes[1][bit / 8] ^= (uint8_t)(1u << bit % 8);
        assert_holds("older");
        TEST_ASSERT_TRUE(store.damaged[1]);
        TEST_ASSERT_FALSE(store.damaged[0]);
        medium.bytes[1][bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    assert_holds("newer");
    TEST_ASSERT_FALSE(store.damaged[1]);
}

void test_both_slots_damaged(void) {
    save("older");
    save("newer");
    medium.bytes[0][0] ^= 1;
    medium.bytes[1][20] ^= 1;
    open_anew();
    TEST_ASSERT_EQUAL_INT(HAL_STORE_DAMAGED, load());
}

void test_sequence_numbers_wrap(void) {
    // As if many saves had gone before; the slots themselves are empty.
    store.scanned = true;
    store.newest = 1;
    store.sequence = UINT32_MAX - 2;
    for (int i = 0; i < 6; i++) {
        const char text[2] = {(char)('b' + i), '\0'};
        save(text);
        assert_holds(text);
    }
}

void test_rubbish_slots_are_survived(void) {
    srand(11);
    for (int round = 0; round < 2000; round++) {
        for (int slot = 0; slot < HAL_STORE_SLOTS; slot++) {
            medium.exists[slot] = true;
            medium.length[slot] = (uint16_t)(rand() % (HAL_STORE_SLOT_MAX + 1));
            for (int i = 0; i < 64; i++) {
                medium.bytes[slot][i] = (uint8_t)rand();
            }
            memcpy(medium.bytes[slot], "ARG1", 4);
        }
        open_anew();
        TEST_ASSERT_EQUAL_INT(HAL_STORE_DAMAGED, load());
    }
}

void test_a_medium_that_cannot_be_read_is_not_overwritten(void) {
    save("precious");
    const uint32_t written = medium.written;
    medium.off = true;
    open_anew();
    TEST_ASSERT_EQUAL_INT(HAL_STORE_IO, load());
    TEST_ASSERT_EQUAL_INT(HAL_STORE_IO, hal_store_save(&store, "x", 1));
    TEST_ASSERT_EQUAL_UINT32(written, medium.written);
}

void test_every_error_has_a_text(void) {
    for (int error = HAL_STORE_IO; error <= HAL_STORE_OK; error++) {
        TEST_ASSERT_GREATER_THAN_size_t(1, strlen(hal_store_error_text(error)));
        TEST_ASSERT_GREATER_THAN_size_t(1, strlen(hal_file_error_text(error)));
    }
}
