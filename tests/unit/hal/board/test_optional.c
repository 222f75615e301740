// SPDX-License-Identifier: MIT
// Rule under attack: what a port does not give is there all the same, and does nothing.
#include "board/board.h"
#include "board/bus.h"
#include "board/flash.h"
#include "unity.h"

void test_without_a_second_uart_there_are_no_lines_and_no_orders(void) {
    uint8_t byte = 0xA5;
    TEST_ASSERT_NULL(board_console_out());
    board_console_kick();
    TEST_ASSERT_EQUAL_size_t(0, board_console_read(&byte, 1));
    TEST_ASSERT_EQUAL_HEX8(0xA5, byte);
}

void test_without_a_memory_of_the_life_before_nothing_is_known_of_it(void) {
    const board_note_t note = board_last_note();
    TEST_ASSERT_EQUAL(BOARD_RESET_POWER, board_reset_reason());
    TEST_ASSERT_EQUAL_HEX32(0, note.pc | note.lr | note.cause);
    TEST_ASSERT_EQUAL_INT32(0, note.invariant);
    board_keep_invariant(3);
    TEST_ASSERT_EQUAL_INT32(0, board_last_note().invariant);
    board_feed();
    board_restart();
    TEST_ASSERT_EQUAL_UINT32(0, board_stack_left());
    TEST_ASSERT_EQUAL_STRING("unnamed", board_name());
}

void test_without_a_bus_nothing_is_sent_on_one(void) {
    const argus_event_t event = {.id = ARGUS_EV_LINK_UP};
    argus_config_t config;
    argus_config_default(&config);
    board_bus_open(&config, 0);
    board_bus_event(NULL, &event);
    board_bus_process(NULL, 0);
}

void test_without_flash_there_is_no_store(void) {
    hal_store_t store;
    uint8_t record[4] = {1, 2, 3, 4};
    TEST_ASSERT_FALSE(board_flash_erase(0));
    TEST_ASSERT_FALSE(board_flash_program(0, 0, 0));
    TEST_ASSERT_NULL(board_flash_base(0));
    hal_store_init(&store, board_flash_medium());
    TEST_ASSERT_NOT_EQUAL(HAL_STORE_OK, hal_store_save(&store, record, sizeof record));
}
