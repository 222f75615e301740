// SPDX-License-Identifier: MIT
// Rule under attack: the loop of a board: silent at first, the robot's bytes and time before anything else,
// one answer to each order, whole lines or none, nothing saved in motion, and no watchdog fed by a pass that
// is late.
#include "board/board.h"

#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "board/config.h"
#include "board/flash.h"
#include "hal/linux/argusd/wire_robot.h"
#include "unity.h"

#define SLOT_BYTES (HAL_STORE_HEADER + HAL_STORE_RECORD_MAX)
#define RING_BYTES 4096
#define QUIET_MS 2500u

const char board_built_config[] = "[argus]\nactive = on\n";

static uint8_t flash[HAL_STORE_SLOTS][SLOT_BYTES];
static uint8_t ring_bytes[RING_BYTES];
static board_ring_t ring = BOARD_RING(ring_bytes);
static robot_t robot;
static char said[400000]; // all lines
static size_t said_length;
static bool has_console;
static bool drains; // a reader takes the lines
static char input[256];
static size_t input_at;
static uint32_t now_ms, end_ms, began_ms, baud;
static uint32_t typed_ms; // after the start, the orders
static uint32_t late_ms;  // the next read takes so long
static int noise;         // bytes that are no packets, before those of the robot
static unsigned sent, fed, restarts;
static bool restart_ends; // as a processor does
static jmp_buf off;

// ---- the port

void board_open(uint32_t with_baud) {
    baud = with_baud;
}

uint32_t board_now_ms(void) {
    return now_ms;
}

size_t board_receive(uint8_t *bytes, size_t capacity) {
    now_ms += late_ms;
    late_ms = 0;
    if (noise > 0) {
        const size_t count = noise < (int)capacity ? (size_t)noise : capacity;
        memset(bytes, 0x55, count);
        noise -= (int)count;
        return count;
    }
    const size_t count = robot.used < capacity ? robot.used : capacity;
    memcpy(bytes, robot.out, count);
    robot.used -= count;
    memmove(robot.out, robot.out + count, robot.used);
    return count;
}

size_t board_room(void) {
    return 256;
}

void board_send(const uint8_t *packet, size_t count) {
    sent++;
    robot_take(&robot, now_ms, packet, count);
}

void board_wait(uint32_t ms) {
    const uint32_t step_ms = ms == 0 ? 1 : ms < 10 ? ms : 10;
    const uint32_t before_ms = now_ms;
    now_ms += step_ms;
    if (before_ms / 100 != now_ms / 100) {
        robot_sip(&robot);
    }
    if (now_ms - began_ms >= end_ms) {
        longjmp(off, 1);
    }
}

void board_feed(void) {
    fed++;
}

board_ring_t *board_console_out(void) {
    return has_console ? &ring : NULL;
}

void board_console_kick(void) {
    for (int byte = 0; drains && (byte = board_ring_take(&ring)) >= 0;) {
        TEST_ASSERT_TRUE(said_length + 1 < sizeof said);
        said[said_length++] = (char)byte;
        said[said_length] = '\0';
    }
}

size_t board_console_read(uint8_t *bytes, size_t capacity) {
    if (capacity == 0 || input[input_at] == '\0' || now_ms - began_ms < typed_ms) {
        return 0;
    }
    *bytes = (uint8_t)input[input_at++];
    return 1;
}

void board_restart(void) {
    restarts++;
    if (restart_ends) {
        longjmp(off, 1);
    }
}

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

// ---- lives of the board

void setUp(void) {
    memset(flash, 0xFF, sizeof flash);
    robot_init(&robot);
    has_console = drains = restart_ends = true;
    now_ms = UINT32_MAX - 20000; // the clock wraps
    noise = 0;
    late_ms = typed_ms = 0;
    input[input_at = 0] = '\0';
    sent = fed = restarts = 0;
}

// From the supply on.
static void live(uint32_t ms, const char *orders) {
    while (board_ring_take(&ring) >= 0) {
    }
    said[said_length = 0] = '\0';
    snprintf(input, sizeof input, "%s", orders);
    input_at = 0;
    began_ms = now_ms;
    end_ms = ms;
    if (setjmp(off) == 0) {
        board_run();
    }
    board_console_kick();
}

static int count_of(const char *text) {
    int count = 0;
    for (const char *at = strstr(said, text); at != NULL; at = strstr(at + 1, text)) {
        count++;
    }
    return count;
}

static void expect_said(const char *text) {
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, text), text);
}

void test_the_robot_is_not_spoken_to_at_first(void) {
    noise = 5000;
    live(QUIET_MS - 50, "");
    TEST_ASSERT_EQUAL(0, sent);
    TEST_ASSERT_EQUAL(9600, baud);
    live(8000, "");
    TEST_ASSERT_TRUE(robot.open);
    expect_said("\"event\":\"START\"");
    expect_said("\"settings\":\"built\"");
    expect_said("\"reset\":\"power\"");
    expect_said("\"board\":\"unnamed\"");
    expect_said("\"event\":\"SESSION_OPEN\"");
}

void test_status_comes_each_second_and_when_it_is_asked_for(void) {
    live(10000, "");
    const int own = count_of("\"event\":\"STATUS\"");
    TEST_ASSERT_INT_WITHIN(1, 10, own);
    typed_ms = 5500;
    robot_init(&robot);
    live(10000, "status\n");
    TEST_ASSERT_INT_WITHIN(1, own + 1, count_of("\"event\":\"STATUS\""));
    expect_said("\"online\":true");
}

void test_each_line_is_whole(void) {
    live(6000, "settings\n");
    TEST_ASSERT_EQUAL(BOARD_CONFIG_COUNT, count_of("\"event\":\"SETTING\""));
    int lines = 0;
    for (const char *at = said; *at != '\0'; lines++) {
        const char *const end = strchr(at, '\n');
        TEST_ASSERT_NOT_NULL(end);
        TEST_ASSERT_TRUE(end == at || (*at == '{' && end[-1] == '}'));
        at = end + 1;
    }
    TEST_ASSERT_GREATER_THAN(BOARD_CONFIG_COUNT, lines);
}

void test_each_order_has_one_answer(void) {
    live(6000, "nonsense\nstop\nset step_mm 100\nset step_mm 100\nmove\n");
    TEST_ASSERT_EQUAL(5, count_of("\"event\":\"ORDER\""));
    expect_said("\"what\":\"nonsense\"");
    expect_said("from the next start, if it is saved");
    expect_said("it is so already");
    expect_said("give one whole number");
}

void test_settings_are_kept_once_they_are_saved(void) {
    live(6000, "set step_mm 100\n");
    live(6000, "settings\n");
    expect_said("\"key\":\"step_mm\",\"value\":200");
    live(6000, "set step_mm 100\nsave\nsave\n");
    expect_said("nothing is new");
    live(6000, "settings\n");
    expect_said("\"settings\":\"stored\"");
    expect_said("\"key\":\"step_mm\",\"value\":100");
}

void test_unsafe_settings_are_not_saved(void) {
    live(6000, "set speed_mm_s 750\nset object_range_mm 150\nsave\n");
    live(6000, "");
    expect_said("\"settings\":\"built\"");
}

void test_nothing_is_saved_and_nothing_restarts_in_motion(void) {
    restart_ends = false;
    typed_ms = 7000;
    for (int moves = 0; moves < 2; moves++) {
        robot_init(&robot);
        robot.vel_mm_s = (uint8_t)(moves * 100);
        live(8000, "save\nrestart\n");
        TEST_ASSERT_TRUE(robot.open);
        TEST_ASSERT_EQUAL(moves * 2, count_of("not while it moves"));
        TEST_ASSERT_EQUAL(1, restarts);
    }
}

void test_a_restart_is_one(void) {
    live(6000, "restart\n");
    TEST_ASSERT_EQUAL(1, restarts);
    expect_said("\"event\":\"START\"");
}

void test_a_shutdown_closes_the_session_and_saves(void) {
    typed_ms = 7000;
    live(12000, "shutdown\n");
    expect_said("\"event\":\"SESSION_CLOSED\"");
    expect_said("restart begins anew");
    expect_said("\"event\":\"STORE\"");
    TEST_ASSERT_FALSE(robot.open);
    TEST_ASSERT_GREATER_THAN_UINT32(0, robot.commands[ARCOS_CMD_CLOSE]);
}

// Flash bears so many erasures: of its own accord once a minute, at rest, if there is news.
void test_it_saves_once_a_minute(void) {
    uint8_t before[sizeof flash];
    live(59000, "");
    memcpy(before, flash, sizeof flash);
    for (size_t i = 0; i < sizeof before; i++) {
        TEST_ASSERT_EQUAL_HEX8(0xFF, before[i]);
    }
    live(64000, "");
    TEST_ASSERT_EQUAL(1, count_of("\"event\":\"STORE\""));
    TEST_ASSERT_NOT_EQUAL(0, memcmp(before, flash, sizeof flash));
}

void test_a_flood_does_not_keep_time_from_passing(void) {
    noise = 1000000;
    live(8000, "status\n");
    TEST_ASSERT_GREATER_THAN(5, count_of("\"event\":\"STATUS\""));
    TEST_ASSERT_TRUE(noise > 0);
}

void test_a_pass_that_is_late_does_not_feed_the_watchdog(void) {
    live(1, "");
    const unsigned once = fed;
    TEST_ASSERT_EQUAL(1, once);
    late_ms = 201;
    live(1, "");
    TEST_ASSERT_EQUAL(once, fed);
    late_ms = 200;
    live(1, "");
    TEST_ASSERT_EQUAL(once + 1, fed);
}

void test_without_a_second_uart_it_runs_all_the_same(void) {
    has_console = false;
    live(8000, "");
    TEST_ASSERT_TRUE(robot.open);
    TEST_ASSERT_EQUAL_STRING("", said);
}

void test_where_nobody_reads_lines_are_lost_whole(void) {
    drains = false;
    const uint32_t lost = ring.lost;
    live(20000, "nonsense\nnonsense\nnonsense\nnonsense\n");
    drains = true;
    board_console_kick();
    TEST_ASSERT_TRUE(robot.open);
    TEST_ASSERT_TRUE(ring.lost >= lost);
    TEST_ASSERT_TRUE(said_length > 0 && said[said_length - 1] == '\n');
}
