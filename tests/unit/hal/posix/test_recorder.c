// SPDX-License-Identifier: MIT
// Attacks: whatever is cut off, the rest stays readable; a full or stuck disk holds nobody up and its losses
// are counted to the byte; files are parted between records; nobody else's file is touched.
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hal/crc32.h"
#include "hal/recorder.h"
#include "unity.h"

#define FILE_MAX 4000000

static hal_recorder_t recorder;
static hal_recorder_ops_t ops;
static char folder[64];
static char path[128];
static uint8_t content[FILE_MAX];
static size_t content_size;
static int64_t mono_us;
static size_t disk_left;
static size_t write_most;
static int syncs;

static hal_stamp_t fake_now(void) {
    return (hal_stamp_t){.mono_us = mono_us, .wall_us = mono_us + 1700000000000000};
}

static ssize_t fake_write(int fd, const void *bytes, size_t count) {
    const size_t most = count < write_most ? count : write_most;
    const size_t part = most < disk_left ? most : disk_left;
    if (part == 0) {
        errno = ENOSPC;
        return -1;
    }
    disk_left -= part;
    return write(fd, bytes, part);
}

static int fake_sync(int fd) {
    (void)fd;
    syncs++;
    return 0;
}

void setUp(void) {
    strcpy(folder, "/tmp/argus-recorder-XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/drive.rec", folder);
    mono_us = INT64_C(4294967296) * 3 - 2000000; // the short time wraps in every test
    disk_left = SIZE_MAX;
    write_most = SIZE_MAX;
    syncs = 0;
    ops = (hal_recorder_ops_t){.write = fake_write, .sync = fake_sync, .now = fake_now};
}

static void remove_file(int number) {
    char name[160];
    snprintf(name, sizeof name, number > 0 ? "%s.%d" : "%s", path, number);
    unlink(name);
}

void tearDown(void) {
    hal_recorder_close(&recorder);
    for (int i = 0; i <= HAL_RECORDER_KEPT + 1; i++) {
        remove_file(i);
    }
    rmdir(folder);
}

static void load(int number) {
    char name[160];
    snprintf(name, sizeof name, number > 0 ? "%s.%d" : "%s", path, number);
    FILE *const file = fopen(name, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, name);
    content_size = fread(content, 1, sizeof content, file);
    fclose(file);
}

static uint64_t le(const uint8_t *at, size_t bytes) {
    uint64_t value = 0;
    for (size_t i = bytes; i-- > 0;) {
        value = value << 8 | at[i];
    }
    return value;
}

// What the file says, by a reader of its own.
typedef struct {
    size_t records;
    size_t junk; // bytes that are in no record
    size_t headers;
    size_t clocks;
    size_t data; // bytes of the link
    uint64_t lost;
    uint32_t next; // the number that the last data record carries, plus 1
    bool in_order;
    int64_t widest_us; // between two clocks
} told_t;

static size_t record_at(size_t at, size_t size) {
    const uint8_t *const bytes = content + at;
    if (size - at < HAL_RECORD_OVERHEAD || bytes[0] != 0xA5 || bytes[1] != 0xC3) {
        return 0;
    }
    const size_t total = HAL_RECORD_OVERHEAD + (size_t)le(bytes + 3, 2);
    if (total > size - at || le(bytes + total - 4, 4) != hal_crc32(0, bytes + 2, total - 6)) {
        return 0;
    }
    return total;
}

static void hear(told_t *told, const uint8_t *bytes, size_t total, int64_t *clock_us) {
    const uint8_t *const payload = bytes + 9;
    const size_t length = total - HAL_RECORD_OVERHEAD;
    switch (bytes[2]) {
    case HAL_RECORD_HEADER:
        TEST_ASSERT_EQUAL_MEMORY("ARGUSREC\1test", payload, length);
        told->headers++;
        break;
    case HAL_RECORD_CLOCK:
        if (told->clocks++ > 0 && (int64_t)le(payload, 8) - *clock_us > told->widest_us) {
            told->widest_us = (int64_t)le(payload, 8) - *clock_us;
        }
        *clock_us = (int64_t)le(payload, 8);
        TEST_ASSERT_TRUE(*clock_us + 1700000000000000 == (int64_t)le(payload + 8, 8));
        break;
    case HAL_RECORD_LOST:
        told->lost += le(payload, 4);
        break;
    default:
        told->data += length;
        told->in_order = told->in_order && le(payload, 4) >= told->next;
        told->next = (uint32_t)le(payload, 4) + 1;
        break;
    }
}

static told_t listen_to(size_t size) {
    told_t told = {.in_order = true};
    int64_t clock_us = 0;
    for (size_t at = 0; at < size;) {
        const size_t total = record_at(at, size);
        if (total > 0) {
            hear(&told, content + at, total, &clock_us);
            told.records++;
        } else {
            told.junk++;
        }
        at += total > 0 ? total : 1;
    }
    return told;
}

static void open_recorder(uint64_t max_bytes) {
    TEST_ASSERT_EQUAL_INT(0, hal_recorder_open(&recorder, path, "test", max_bytes, ops));
}

// `count` packets of 40 bytes, each with its number, 50 ms apart.
static void note(uint32_t first, uint32_t count) {
    for (uint32_t i = first; i < first + count; i++) {
        uint8_t bytes[40] = {(uint8_t)i, (uint8_t)(i >> 8), (uint8_t)(i >> 16), 0, 0xA5, 0xC3, 1, 2, 0};
        mono_us += 50000;
        hal_recorder_note(&recorder, i % 3 == 0 ? HAL_RECORD_TO_ROBOT : HAL_RECORD_FROM_ROBOT, bytes,
                          sizeof bytes);
    }
}

void test_all_is_there(void) {
    open_recorder(1000000);
    note(0, 100);
    TEST_ASSERT_TRUE(hal_recorder_pump(&recorder));
    hal_recorder_close(&recorder);
    load(0);
    const told_t told = listen_to(content_size);
    TEST_ASSERT_EQUAL_size_t(0, told.junk);
    TEST_ASSERT_EQUAL_size_t(1, told.headers);
    TEST_ASSERT_EQUAL_size_t(4000, told.data);
    TEST_ASSERT_EQUAL_UINT32(100, told.next);
    TEST_ASSERT_TRUE(told.in_order);
    TEST_ASSERT_LESS_OR_EQUAL_INT32(1050000, (int32_t)told.widest_us);
    TEST_ASSERT_GREATER_THAN_size_t(4, told.clocks);
}

void test_cut_at_every_byte_and_gone_on_with(void) {
    static uint8_t whole[4000];
    open_recorder(1000000);
    note(0, 30);
    hal_recorder_close(&recorder);
    load(0);
    const size_t size = content_size;
    TEST_ASSERT_LESS_THAN_size_t(sizeof whole, size);
    memcpy(whole, content, size);
    size_t records = 0;
    size_t end = 0; // of the records that lie before the cut
    for (size_t cut = 0; cut <= size; cut++) {
        memcpy(content, whole, size);
        const size_t total = record_at(end, cut);
        records += total > 0 ? 1 : 0;
        end += total;
        const int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
        TEST_ASSERT_EQUAL_INT((int)cut, (int)write(fd, whole, cut));
        close(fd);
        open_recorder(1000000);
        note(1000, 1);
        hal_recorder_close(&recorder);
        load(0);
        const told_t told = listen_to(content_size);
        TEST_ASSERT_EQUAL_size_t_MESSAGE(cut - end, told.junk, "bytes of the torn record");
        TEST_ASSERT_GREATER_OR_EQUAL_size_t(records + 3, told.records);
        TEST_ASSERT_EQUAL_UINT32(1001, told.next);
    }
    TEST_ASSERT_GREATER_THAN_size_t(30, records);
}

void test_a_full_disk_loses_counted_bytes_and_is_said(void) {
    open_recorder(100000000);
    note(0, 10);
    TEST_ASSERT_TRUE(hal_recorder_pump(&recorder));
    disk_left = 777; // in the middle of a record
    note(10, 20000);
    TEST_ASSERT_FALSE(hal_recorder_pump(&recorder));
    TEST_ASSERT_EQUAL_INT(ENOSPC, atomic_load(&recorder.problem));
    note(20010, 5);
    TEST_ASSERT_FALSE(hal_recorder_pump(&recorder));
    TEST_ASSERT_GREATER_THAN_UINT32(100000, (uint32_t)recorder.lost);
    disk_left = SIZE_MAX;
    TEST_ASSERT_TRUE(hal_recorder_pump(&recorder));
    TEST_ASSERT_EQUAL_INT(0, atomic_load(&recorder.problem));
    note(20015, 5);
    const uint32_t lost = (uint32_t)recorder.lost;
    hal_recorder_close(&recorder);
    load(0);
    const told_t told = listen_to(content_size);
    TEST_ASSERT_EQUAL_size_t(0, told.junk);
    TEST_ASSERT_EQUAL_UINT32(lost, (uint32_t)told.lost);
    TEST_ASSERT_EQUAL_UINT32(20020 * 40, (uint32_t)(told.data + told.lost));
    TEST_ASSERT_EQUAL_UINT32(20020, told.next);
}

void test_a_disk_full_to_the_end_leaves_a_readable_file(void) {
    open_recorder(1000000);
    disk_left = 333;
    note(0, 50);
    hal_recorder_close(&recorder);
    load(0);
    const told_t told = listen_to(content_size);
    TEST_ASSERT_EQUAL_size_t(333, content_size);
    TEST_ASSERT_LESS_THAN_size_t(53, told.junk);
    TEST_ASSERT_GREATER_THAN_size_t(3, told.records);
}

void test_short_writes_change_nothing(void) {
    write_most = 7;
    open_recorder(1000000);
    note(0, 100);
    hal_recorder_close(&recorder);
    load(0);
    const told_t told = listen_to(content_size);
    TEST_ASSERT_EQUAL_size_t(0, told.junk);
    TEST_ASSERT_EQUAL_size_t(4000, told.data);
}

void test_files_are_parted_between_records(void) {
    open_recorder(20000);
    for (uint32_t i = 0; i < 4000; i += 50) {
        note(i, 50);
        TEST_ASSERT_TRUE(hal_recorder_pump(&recorder));
    }
    hal_recorder_close(&recorder);
    uint32_t next = 4000;
    for (int number = 0; number <= HAL_RECORDER_KEPT; number++) {
        load(number);
        const told_t told = listen_to(content_size);
        TEST_ASSERT_LESS_OR_EQUAL_size_t(20000, content_size);
        TEST_ASSERT_EQUAL_size_t(0, told.junk);
        TEST_ASSERT_EQUAL_size_t(1, told.headers);
        TEST_ASSERT_TRUE(told.in_order);
        TEST_ASSERT_EQUAL_UINT32(next, told.next);
        next -= (uint32_t)(told.data / 40);
    }
    char beyond[160];
    snprintf(beyond, sizeof beyond, "%s.%d", path, HAL_RECORDER_KEPT + 1);
    TEST_ASSERT_NOT_EQUAL_INT(0, access(beyond, F_OK));
}

void test_long_runs_become_several_records(void) {
    static uint8_t bytes[2000];
    open_recorder(1000000);
    hal_recorder_note(&recorder, HAL_RECORD_FROM_ROBOT, bytes, sizeof bytes);
    hal_recorder_close(&recorder);
    load(0);
    const told_t told = listen_to(content_size);
    TEST_ASSERT_EQUAL_size_t(0, told.junk);
    TEST_ASSERT_EQUAL_size_t(2000, told.data);
}

void test_the_disk_is_synced_twice_a_second(void) {
    open_recorder(1000000);
    for (uint32_t i = 0; i < 100; i++) { // 5 s
        note(i, 1);
        TEST_ASSERT_TRUE(hal_recorder_pump(&recorder));
    }
    TEST_ASSERT_GREATER_OR_EQUAL_INT(9, syncs);
    TEST_ASSERT_LESS_OR_EQUAL_INT(11, syncs);
}

// File systems may keep the length of a file and not yet what was in it.
void test_zeros_that_a_power_cut_left_are_gone_on_with(void) {
    static const uint8_t zeros[100];
    const int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    TEST_ASSERT_EQUAL_INT(sizeof zeros, (int)write(fd, zeros, sizeof zeros));
    close(fd);
    open_recorder(1000000);
    note(0, 5);
    hal_recorder_close(&recorder);
    load(0);
    const told_t told = listen_to(content_size);
    TEST_ASSERT_EQUAL_size_t(sizeof zeros, told.junk);
    TEST_ASSERT_EQUAL_UINT32(5, told.next);
}

static int open_on(const char *text) {
    const int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    TEST_ASSERT_EQUAL_INT((int)strlen(text), (int)write(fd, text, strlen(text)));
    close(fd);
    return hal_recorder_open(&recorder, path, "test", 1000000, ops);
}

void test_what_is_no_recording_is_not_touched(void) {
    TEST_ASSERT_EQUAL_INT(EEXIST, open_on("a letter to my mother"));
    TEST_ASSERT_EQUAL_INT(EEXIST, open_on("x"));
    load(0);
    TEST_ASSERT_EQUAL_size_t(1, content_size);
    remove_file(0);
    TEST_ASSERT_EQUAL_INT(0, mkfifo(path, 0600));
    TEST_ASSERT_EQUAL_INT(EINVAL, hal_recorder_open(&recorder, path, "test", 1000000, ops));
    TEST_ASSERT_EQUAL_INT(EISDIR, hal_recorder_open(&recorder, folder, "test", 1000000, ops));
    TEST_ASSERT_EQUAL_INT(ENAMETOOLONG, hal_recorder_open(&recorder, "", "test", 1000000, ops));
    TEST_ASSERT_EQUAL_INT(ENOENT, hal_recorder_open(&recorder, "/nowhere/x", "test", 1000000, ops));
}

void test_one_program_at_a_time(void) {
    static hal_recorder_t other;
    open_recorder(1000000);
    TEST_ASSERT_EQUAL_INT(EBUSY, hal_recorder_open(&other, path, "test", 1000000, ops));
    hal_recorder_close(&recorder);
    TEST_ASSERT_EQUAL_INT(0, hal_recorder_open(&other, path, "test", 1000000, ops));
    hal_recorder_close(&other);
}

static pthread_mutex_t stuck = PTHREAD_MUTEX_INITIALIZER;

static ssize_t stuck_write(int fd, const void *bytes, size_t count) {
    pthread_mutex_lock(&stuck);
    const ssize_t written = write(fd, bytes, count);
    pthread_mutex_unlock(&stuck);
    return written;
}

// It would hang here, not fail, if anybody waited for the disk.
void test_a_stuck_disk_holds_nobody_up(void) {
    ops.write = stuck_write;
    pthread_mutex_lock(&stuck);
    open_recorder(100000000);
    TEST_ASSERT_EQUAL_INT(0, hal_recorder_start(&recorder));
    note(0, 20000);
    TEST_ASSERT_GREATER_THAN_UINT32(0, (uint32_t)recorder.lost);
    pthread_mutex_unlock(&stuck);
    hal_recorder_close(&recorder);
    load(0);
    const told_t told = listen_to(content_size);
    TEST_ASSERT_EQUAL_size_t(0, told.junk);
    TEST_ASSERT_EQUAL_UINT32(20000 * 40, (uint32_t)(told.data + recorder.lost));
}
