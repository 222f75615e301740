// SPDX-License-Identifier: MIT
// Records both directions of a link into a file that a power cut at any byte leaves readable (SPEC.md,
// Recording).
//
// The caller's side never waits: records go into a ring of fixed size, and a thread of their own takes them
// to the disk. When the disk is full or stuck, the ring has no room. What is lost then is counted, and the
// file says so as soon as it can.
#ifndef HAL_RECORDER_H
#define HAL_RECORDER_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

#define HAL_RECORD_VERSION 1
#define HAL_RECORD_OVERHEAD 13     // sync, kind, length, time, CRC
#define HAL_RECORD_PAYLOAD_MAX 512 // longer runs of bytes become several records
#define HAL_RECORDER_RING 262144   // a power of 2; 22 s of a full line at 115200 bit/s
#define HAL_RECORDER_BLOCK 8192
#define HAL_RECORDER_KEPT 4 // FILE.1 .. FILE.4
#define HAL_RECORDER_PATH_MAX 240
#define HAL_RECORDER_SOURCE_MAX 200

typedef enum {
    HAL_RECORD_HEADER = 0,
    HAL_RECORD_FROM_ROBOT = 1,
    HAL_RECORD_TO_ROBOT = 2,
    HAL_RECORD_CLOCK = 3,
    HAL_RECORD_LOST = 4,
    HAL_RECORD_INJECTED = 5
} hal_record_kind_t;

typedef struct {
    int64_t mono_us;
    int64_t wall_us; // since 1970, UTC
} hal_stamp_t;

// What the recorder asks of the system, so that a test can be a full disk.
typedef struct {
    ssize_t (*write)(int fd, const void *bytes, size_t count);
    int (*sync)(int fd);
    hal_stamp_t (*now)(void);
} hal_recorder_ops_t;

typedef struct {
    hal_recorder_ops_t ops;
    char path[HAL_RECORDER_PATH_MAX];
    char source[HAL_RECORDER_SOURCE_MAX];
    uint64_t max_bytes; // of one file
    // The caller's side.
    int64_t clock_us; // last clock record
    bool has_clock;
    uint32_t unsaid; // bytes lost and not yet said in the file
    uint64_t lost;   // bytes lost, monotonic
    // Between the two.
    _Atomic uint32_t head;
    _Atomic uint32_t tail;
    _Atomic int problem; // errno of what went wrong on the disk last, 0: all well
    _Atomic bool ending;
    uint8_t ring[HAL_RECORDER_RING];
    // The disk's side.
    int fd; // -1: not open
    uint64_t size;
    int64_t synced_us;
    bool unsynced;
    bool begun; // a part of the block is in the file
    size_t block_at;
    size_t block_used;
    uint8_t block[HAL_RECORDER_BLOCK];
    pthread_t thread;
    bool running;
} hal_recorder_t;

// The system's own.
hal_recorder_ops_t hal_recorder_ops(void);

// Opens FILE to append to it; a file that holds something else than a recording is not touched. 0, or an
// errno: EEXIST for such a file, EBUSY when another program records there, EINVAL when it is no regular file.
// `source` is written into the file: what records what.
int hal_recorder_open(hal_recorder_t *self, const char *path, const char *source, uint64_t max_bytes,
                      hal_recorder_ops_t ops);

// Starts the thread; 0 or an errno.
int hal_recorder_start(hal_recorder_t *self);

// Takes bytes that have just passed. Never waits.
void hal_recorder_note(hal_recorder_t *self, hal_record_kind_t kind, const uint8_t *bytes, size_t count);

// Writes what the ring holds; false when the disk would not take all. For the thread, and for tests without
// one.
bool hal_recorder_pump(hal_recorder_t *self);

// Ends the thread, writes the rest as far as it goes, closes. May be called twice.
void hal_recorder_close(hal_recorder_t *self);

#endif
