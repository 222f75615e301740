// SPDX-License-Identifier: MIT
// What a port need not give: each of these yields to one of the same name that it does give.
#include "board/board.h"
#include "board/bus.h"
#include "board/flash.h"

#define OPTIONAL __attribute__((weak))

OPTIONAL void board_feed(void) {
}

OPTIONAL board_ring_t *board_console_out(void) {
    return NULL;
}

OPTIONAL void board_console_kick(void) {
}

// NOLINTNEXTLINE(readability-non-const-parameter): who has such a UART writes there
OPTIONAL size_t board_console_read(uint8_t *bytes, size_t capacity) {
    (void)bytes;
    (void)capacity;
    return 0;
}

OPTIONAL board_reset_t board_reset_reason(void) {
    return BOARD_RESET_POWER;
}

OPTIONAL board_note_t board_last_note(void) {
    return (board_note_t){0};
}

OPTIONAL void board_keep_invariant(int32_t number) {
    (void)number;
}

OPTIONAL void board_restart(void) {
}

OPTIONAL uint32_t board_stack_left(void) {
    return 0;
}

OPTIONAL const char *board_name(void) {
    return "unnamed";
}

OPTIONAL void board_bus_open(const argus_config_t *config, uint32_t now_ms) {
    (void)config;
    (void)now_ms;
}

OPTIONAL void board_bus_event(const argus_t *core, const argus_event_t *event) {
    (void)core;
    (void)event;
}

OPTIONAL void board_bus_process(argus_t *core, uint32_t now_ms) {
    (void)core;
    (void)now_ms;
}

OPTIONAL bool board_flash_erase(int slot) {
    (void)slot;
    return false;
}

OPTIONAL bool board_flash_program(int slot, uint32_t offset, uint32_t word) {
    (void)slot;
    (void)offset;
    (void)word;
    return false;
}

OPTIONAL const uint8_t *board_flash_base(int slot) {
    (void)slot;
    return NULL;
}
