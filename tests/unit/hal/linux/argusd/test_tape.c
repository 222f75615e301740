// SPDX-License-Identifier: MIT
// Attacks: the tape has every byte of the link in the order of the wire, a STOP after the SIP that called for
// it; a file that cannot be used is refused in one line; a disk that refuses is said once.
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "argusd.h"
#include "driver.h"
#include "hal/fake_clock.h"
#include "hal/fake_link.h"
#include "tape.h"
#include "unity.h"
#include "wire_robot.h"

static tape_t tape;
static driver_t driver;
static robot_t robot;
static hal_fake_clock_t time_;
static hal_fake_link_t fake;
static char path[64];
static char message[ARGUSD_MESSAGE_MAX];

// What the tap saw and what the wire carried.
typedef struct {
    uint8_t byte[65536];
    size_t used;
} heap_t;
static heap_t seen[2];
static heap_t carried[2];
static bool last_from_robot;

static void add(heap_t *heap, const uint8_t *bytes, size_t count) {
    TEST_ASSERT_LESS_OR_EQUAL_size_t(sizeof heap->byte - heap->used, count);
    memcpy(heap->byte + heap->used, bytes, count);
    heap->used += count;
}

static void see(void *context, bool from_robot, const uint8_t *bytes, size_t count) {
    TEST_ASSERT_EQUAL_PTR(&seen, context);
    add(&seen[from_robot ? 1 : 0], bytes, count);
    last_from_robot = from_robot;
}

void setUp(void) {
    strcpy(path, "/tmp/argus-tape-XXXXXX");
    close(mkstemp(path));
    message[0] = '\0';
}

void tearDown(void) {
    tape_close(&tape, message, sizeof message);
    unlink(path);
}

static void exchange(void) {
    uint8_t bytes[512];
    const size_t count = hal_fake_link_take(&fake, bytes, sizeof bytes);
    add(&carried[0], bytes, count);
    robot_take(&robot, time_.now_ms, bytes, count);
    add(&carried[1], robot.out, robot.used);
    hal_fake_link_put(&fake, robot.out, robot.used);
    robot.used = 0;
}

static void run(uint32_t ms) {
    for (uint32_t passed = 0; passed < ms; passed += 10) {
        time_.now_ms += 10;
        if (passed % 100 == 0) {
            robot_sip(&robot);
        }
        exchange();
        driver_receive(&driver);
        driver_process(&driver);
        exchange();
    }
}

void test_the_tap_sees_every_byte(void) {
    argus_config_t config;
    const hal_link_spec_t spec = {.scheme = &hal_serial_scheme};
    const hal_clock_t clock = hal_fake_clock(&time_);
    argus_config_default(&config);
    hal_fake_link_init(&fake, 1, &clock);
    fake.would_block_permille = 300;
    driver_init(&driver, &config, clock, &spec, NULL);
    robot_init(&robot);
    driver.tap = (driver_tap_t){.see = see, .context = &seen};
    driver_attach(&driver, hal_fake_link(&fake));
    run(3000);
    TEST_ASSERT_TRUE(robot.open);
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_GREATER_THAN_size_t(100, seen[i].used);
        TEST_ASSERT_LESS_OR_EQUAL_size_t(carried[i].used, seen[i].used);
        TEST_ASSERT_EQUAL_MEMORY(carried[i].byte, seen[i].byte, seen[i].used);
    }
    TEST_ASSERT_EQUAL_size_t(carried[0].used, seen[0].used);
    fake.would_block_permille = 0;
    last_from_robot = true;
    argus_operator(driver.core, time_.now_ms, ARGUS_OP_STOP, 0);
    driver_transmit(&driver);
    TEST_ASSERT_FALSE(last_from_robot);
}

void test_no_tap_without_a_tape(void) {
    TEST_ASSERT_NULL(tape_tap(&tape).see);
    TEST_ASSERT_FALSE(tape_problem(&tape, message, sizeof message));
    TEST_ASSERT_FALSE(tape_close(&tape, message, sizeof message));
}

static const char *find(const char *content, size_t size, const char *text) {
    const size_t length = strlen(text);
    for (size_t at = 0; at + length <= size; at++) {
        if (memcmp(content + at, text, length) == 0) {
            return content + at;
        }
    }
    return NULL;
}

void test_a_tape_holds_what_the_tap_shows(void) {
    TEST_ASSERT_TRUE_MESSAGE(tape_open(&tape, path, "/dev/x", 0, message, sizeof message), message);
    const driver_tap_t tap = tape_tap(&tape);
    tap.see(tap.context, true, (const uint8_t *)"from the robot", 14);
    tape_injected(&tape, 3, ARGUS_KIND_STUCK, 0x01020304);
    tap.see(tap.context, false, (const uint8_t *)"to the robot", 12);
    TEST_ASSERT_FALSE_MESSAGE(tape_close(&tape, message, sizeof message), message);
    char content[512];
    FILE *const file = fopen(path, "rb");
    const size_t size = fread(content, 1, sizeof content, file);
    fclose(file);
    TEST_ASSERT_NOT_NULL(find(content, size, "ARGUSREC\1argusd " ARGUS_VERSION " /dev/x"));
    const char *const first = find(content, size, "from the robot");
    const char *const second = find(content, size, "to the robot");
    TEST_ASSERT_NOT_NULL(first);
    TEST_ASSERT_NOT_NULL(second);
    TEST_ASSERT_TRUE(first < second);
    const char *const between = find(content, size, "\3\3\4\3\2\1");
    TEST_ASSERT_TRUE(first < between && between < second);
    TEST_ASSERT_EQUAL_UINT8(HAL_RECORD_INJECTED, between[-7]);
    TEST_ASSERT_EQUAL_UINT8(HAL_RECORD_FROM_ROBOT, first[-7]);
    TEST_ASSERT_EQUAL_UINT8(HAL_RECORD_TO_ROBOT, second[-7]);
}

static void refused(const char *file, const char *part) {
    TEST_ASSERT_FALSE(tape_open(&tape, file, "/dev/x", 0, message, sizeof message));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, part), message);
    TEST_ASSERT_NULL(strchr(message, '\n'));
}

void test_refusals(void) {
    refused("/no/such/folder/x", "No such file or directory; give a file in a folder");
    refused("/dev/null", "no regular file");
    refused("", "empty or too long");
    FILE *const file = fopen(path, "wb");
    fputs("something else", file);
    fclose(file);
    refused(path, "exists and is no recording; name another file");
}

void test_a_refusing_disk_is_said_once(void) {
    TEST_ASSERT_TRUE(tape_open(&tape, path, "/dev/x", 0, message, sizeof message));
    TEST_ASSERT_FALSE(tape_problem(&tape, message, sizeof message));
    hal_recorder_close(&tape.recorder); // its thread would say that all is well again
    atomic_store(&tape.recorder.problem, ENOSPC);
    tape.recorder.lost = 5;
    TEST_ASSERT_TRUE(tape_problem(&tape, message, sizeof message));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, "No space left on device; going on without"), message);
    TEST_ASSERT_FALSE(tape_problem(&tape, message, sizeof message));
    TEST_ASSERT_TRUE(tape_close(&tape, message, sizeof message));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, "5 bytes are missing"), message);
}
