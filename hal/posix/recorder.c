// SPDX-License-Identifier: MIT
// The recorder: a ring between the caller and a thread that writes, syncs and rotates.
#include "hal/recorder.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "hal/crc32.h"

#define RING_MASK (HAL_RECORDER_RING - 1u)
#define SYNC_FIRST 0xA5
#define SYNC_SECOND 0xC3
#define HEAD_BYTES 9 // before the payload
#define CLOCK_US 1000000
#define SYNC_US 500000
#define NAP_NS 100000000L
#define RECORD_MAX (HAL_RECORD_OVERHEAD + HAL_RECORD_PAYLOAD_MAX)

static const char magic[] = "ARGUSREC";
#define MAGIC_BYTES (sizeof magic - 1)

static hal_stamp_t system_now(void) {
    struct timespec mono = {0};
    struct timespec wall = {0};
    clock_gettime(CLOCK_MONOTONIC, &mono);
    clock_gettime(CLOCK_REALTIME, &wall);
    return (hal_stamp_t){.mono_us = (int64_t)mono.tv_sec * 1000000 + mono.tv_nsec / 1000,
                         .wall_us = (int64_t)wall.tv_sec * 1000000 + wall.tv_nsec / 1000};
}

hal_recorder_ops_t hal_recorder_ops(void) {
    return (hal_recorder_ops_t){.write = write, .sync = fdatasync, .now = system_now};
}

// records
// ----------------------------------------------------------------------------------------------------

static void put_le(uint8_t *at, uint64_t value, size_t bytes) {
    for (size_t i = 0; i < bytes; i++) {
        at[i] = (uint8_t)(value >> (8 * i));
    }
}

static size_t make_record(uint8_t *out, hal_record_kind_t kind, int64_t mono_us, const uint8_t *payload,
                          size_t count) {
    out[0] = SYNC_FIRST;
    out[1] = SYNC_SECOND;
    out[2] = (uint8_t)kind;
    put_le(out + 3, count, 2);
    put_le(out + 5, (uint64_t)mono_us, 4);
    memcpy(out + HEAD_BYTES, payload, count);
    put_le(out + HEAD_BYTES + count, hal_crc32(0, out + 2, HEAD_BYTES - 2 + count), 4);
    return HAL_RECORD_OVERHEAD + count;
}

static size_t make_clock(uint8_t *out, hal_stamp_t now) {
    uint8_t payload[16];
    put_le(payload, (uint64_t)now.mono_us, 8);
    put_le(payload + 8, (uint64_t)now.wall_us, 8);
    return make_record(out, HAL_RECORD_CLOCK, now.mono_us, payload, sizeof payload);
}

// What a file begins with, and what each start of recording puts into it.
static size_t make_start(const hal_recorder_t *self, uint8_t *out) {
    uint8_t payload[MAGIC_BYTES + 1 + HAL_RECORDER_SOURCE_MAX];
    const hal_stamp_t now = self->ops.now();
    const size_t length = strlen(self->source);
    memcpy(payload, magic, MAGIC_BYTES);
    payload[MAGIC_BYTES] = HAL_RECORD_VERSION;
    memcpy(payload + MAGIC_BYTES + 1, self->source, length);
    const size_t header = make_record(out, HAL_RECORD_HEADER, now.mono_us, payload, MAGIC_BYTES + 1 + length);
    return header + make_clock(out + header, now);
}

// the caller's side
// ------------------------------------------------------------------------------------------

static void ring_copy_in(hal_recorder_t *self, uint32_t head, const uint8_t *bytes, size_t count) {
    const size_t at = head & RING_MASK;
    const size_t first = count < HAL_RECORDER_RING - at ? count : HAL_RECORDER_RING - at;
    memcpy(self->ring + at, bytes, first);
    memcpy(self->ring, bytes + first, count - first);
}

static bool ring_put(hal_recorder_t *self, const uint8_t *record, size_t count) {
    const uint32_t head = atomic_load_explicit(&self->head, memory_order_relaxed);
    const uint32_t tail = atomic_load_explicit(&self->tail, memory_order_acquire);
    if (count > HAL_RECORDER_RING - (head - tail)) {
        return false;
    }
    ring_copy_in(self, head, record, count);
    atomic_store_explicit(&self->head, head + (uint32_t)count, memory_order_release);
    return true;
}

// True when nothing is left unsaid.
static bool say_lost(hal_recorder_t *self, int64_t mono_us) {
    uint8_t payload[4];
    uint8_t record[HAL_RECORD_OVERHEAD + sizeof payload];
    if (self->unsaid == 0) {
        return true;
    }
    put_le(payload, self->unsaid, sizeof payload);
    if (!ring_put(self, record, make_record(record, HAL_RECORD_LOST, mono_us, payload, sizeof payload))) {
        return false;
    }
    self->unsaid = 0;
    return true;
}

static void keep_clock(hal_recorder_t *self, hal_stamp_t now) {
    uint8_t record[HAL_RECORD_OVERHEAD + 16];
    if (self->has_clock && now.mono_us - self->clock_us < CLOCK_US) {
        return;
    }
    if (ring_put(self, record, make_clock(record, now))) {
        self->clock_us = now.mono_us;
        self->has_clock = true;
    }
}

static void lose(hal_recorder_t *self, size_t count) {
    self->lost += count;
    self->unsaid = count < UINT32_MAX - self->unsaid ? self->unsaid + (uint32_t)count : UINT32_MAX;
}

void hal_recorder_note(hal_recorder_t *self, hal_record_kind_t kind, const uint8_t *bytes, size_t count) {
    uint8_t record[RECORD_MAX];
    const hal_stamp_t now = self->ops.now();
    keep_clock(self, now);
    while (count > 0) {
        const size_t part = count < HAL_RECORD_PAYLOAD_MAX ? count : HAL_RECORD_PAYLOAD_MAX;
        if (!say_lost(self, now.mono_us) ||
            !ring_put(self, record, make_record(record, kind, now.mono_us, bytes, part))) {
            lose(self, part);
        }
        bytes += part;
        count -= part;
    }
}

// the disk's side
// --------------------------------------------------------------------------------------------

static void sync_folder(const char *path) {
    char folder[HAL_RECORDER_PATH_MAX];
    const char *const slash = strrchr(path, '/');
    const size_t length = slash != NULL ? (size_t)(slash - path) + 1 : 0;
    memcpy(folder, path, length);
    folder[length] = '\0';
    const int fd = open(length > 0 ? folder : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd >= 0) {
        fsync(fd);
        close(fd);
    }
}

static bool is_zero(const uint8_t *bytes, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (bytes[i] != 0) {
            return false;
        }
    }
    return true;
}

// An empty file, a recording, or what a power cut left of one: cut off within its first record, or zeros.
static bool is_ours(int fd, uint64_t size) {
    uint8_t found[HEAD_BYTES + MAGIC_BYTES];
    const uint8_t sync[3] = {SYNC_FIRST, SYNC_SECOND, HAL_RECORD_HEADER};
    const ssize_t got = pread(fd, found, sizeof found, 0);
    const size_t count = got > 0 ? (size_t)got : 0;
    if (size > 0 && count == 0) {
        return false;
    }
    const size_t tail = count > HEAD_BYTES ? count - HEAD_BYTES : 0;
    return is_zero(found, count) || (memcmp(found, sync, count < sizeof sync ? count : sizeof sync) == 0 &&
                                     memcmp(found + HEAD_BYTES, magic, tail) == 0);
}

static int check_file(int fd, uint64_t *size) {
    struct stat about;
    if (fstat(fd, &about) != 0) {
        return errno;
    }
    if (!S_ISREG(about.st_mode)) {
        return EINVAL;
    }
    *size = (uint64_t)about.st_size;
    if (!is_ours(fd, *size)) {
        return EEXIST;
    }
    return flock(fd, LOCK_EX | LOCK_NB) == 0 ? 0 : EBUSY;
}

static int open_file(hal_recorder_t *self) {
    // O_NONBLOCK: a fifo or a device of that name must not hold us up.
    const int flags = O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC | O_NOCTTY | O_NONBLOCK;
    const int fd = open(self->path, flags, 0666);
    if (fd < 0) {
        return errno;
    }
    const int problem = check_file(fd, &self->size);
    if (problem != 0) {
        close(fd);
        return problem;
    }
    if (self->size == 0) {
        sync_folder(self->path);
    }
    self->fd = fd;
    return 0;
}

static void close_file(hal_recorder_t *self) {
    if (self->fd >= 0) {
        close(self->fd);
        self->fd = -1;
    }
}

// FILE.3 becomes FILE.4, ..., FILE becomes FILE.1.
static int shift_files(const hal_recorder_t *self) {
    char from[HAL_RECORDER_PATH_MAX + 16];
    char into[HAL_RECORDER_PATH_MAX + 16];
    for (int i = HAL_RECORDER_KEPT - 1; i > 0; i--) {
        snprintf(from, sizeof from, "%s.%d", self->path, i);
        snprintf(into, sizeof into, "%s.%d", self->path, i + 1);
        if (rename(from, into) != 0 && errno != ENOENT) {
            return errno;
        }
    }
    snprintf(into, sizeof into, "%s.1", self->path);
    return rename(self->path, into) == 0 || errno == ENOENT ? 0 : errno;
}

static int sync_now(hal_recorder_t *self) {
    self->synced_us = self->ops.now().mono_us;
    if (!self->unsynced || self->fd < 0) {
        return 0;
    }
    self->unsynced = false;
    return self->ops.sync(self->fd) == 0 || errno == EINVAL ? 0 : errno;
}

// Puts the start in front of what the block holds; the block leaves room for that.
static void start_block(hal_recorder_t *self) {
    uint8_t start[RECORD_MAX];
    const size_t length = make_start(self, start);
    memmove(self->block + self->block_at + length, self->block + self->block_at, self->block_used);
    memcpy(self->block + self->block_at, start, length);
    self->block_used += length;
}

static int rotate(hal_recorder_t *self) {
    const int problem = shift_files(self);
    if (problem != 0) {
        return problem;
    }
    sync_now(self);
    close_file(self);
    return 0;
}

// The next block may not make FILE longer than allowed; called between records only.
static int make_room(hal_recorder_t *self) {
    if (self->fd >= 0 && self->size > 0 && self->size + self->block_used > self->max_bytes) {
        const int problem = rotate(self);
        if (problem != 0) {
            return problem;
        }
    }
    if (self->fd >= 0) {
        return 0;
    }
    const int problem = open_file(self);
    if (problem == 0) {
        start_block(self);
    }
    return problem;
}

static void ring_copy_out(const hal_recorder_t *self, uint32_t tail, uint8_t *bytes, size_t count) {
    const size_t at = tail & RING_MASK;
    const size_t first = count < HAL_RECORDER_RING - at ? count : HAL_RECORDER_RING - at;
    memcpy(bytes, self->ring + at, first);
    memcpy(bytes + first, self->ring, count - first);
}

// Whole records, so that files are parted between them.
static void take_block(hal_recorder_t *self) {
    uint32_t tail = atomic_load_explicit(&self->tail, memory_order_relaxed);
    const uint32_t head = atomic_load_explicit(&self->head, memory_order_acquire);
    self->block_at = 0;
    self->block_used = 0;
    while (tail != head && self->block_used < sizeof self->block - 2 * RECORD_MAX) {
        uint8_t length[2];
        ring_copy_out(self, tail + 3, length, sizeof length);
        const size_t count = HAL_RECORD_OVERHEAD + (size_t)length[0] + ((size_t)length[1] << 8);
        ring_copy_out(self, tail, self->block + self->block_used, count);
        self->block_used += count;
        tail += (uint32_t)count;
    }
    atomic_store_explicit(&self->tail, tail, memory_order_release);
}

static int write_block(hal_recorder_t *self) {
    while (self->block_used > 0) {
        const ssize_t written = self->ops.write(self->fd, self->block + self->block_at, self->block_used);
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written <= 0) {
            return written < 0 ? errno : ENOSPC;
        }
        self->block_at += (size_t)written;
        self->block_used -= (size_t)written;
        self->size += (uint64_t)written;
        self->begun = true;
        self->unsynced = true;
    }
    return 0;
}

// True when a block was written, false when there is none or the disk would not take it.
static bool pump_block(hal_recorder_t *self, int *problem) {
    if (self->block_used == 0) {
        take_block(self);
        self->begun = false;
    }
    if (self->block_used == 0) {
        return false;
    }
    *problem = self->begun ? 0 : make_room(self);
    if (*problem == 0) {
        *problem = write_block(self);
    }
    return *problem == 0;
}

bool hal_recorder_pump(hal_recorder_t *self) {
    int problem = 0;
    while (pump_block(self, &problem)) {
    }
    if (problem == 0 && self->ops.now().mono_us - self->synced_us >= SYNC_US) {
        problem = sync_now(self);
    }
    atomic_store(&self->problem, problem);
    return problem == 0;
}

// life
// -------------------------------------------------------------------------------------------------------

int hal_recorder_open(hal_recorder_t *self, const char *path, const char *source, uint64_t max_bytes,
                      hal_recorder_ops_t ops) {
    memset(self, 0, sizeof *self);
    self->fd = -1;
    self->ops = ops;
    self->max_bytes = max_bytes;
    if (path[0] == '\0' || strlen(path) >= sizeof self->path) {
        return ENAMETOOLONG;
    }
    snprintf(self->path, sizeof self->path, "%s", path);
    snprintf(self->source, sizeof self->source, "%s", source);
    const int problem = open_file(self);
    if (problem != 0) {
        return problem;
    }
    start_block(self);
    return 0;
}

static void *work(void *context) {
    hal_recorder_t *const self = context;
    const struct timespec nap = {.tv_nsec = NAP_NS};
    while (!atomic_load(&self->ending)) {
        hal_recorder_pump(self);
        nanosleep(&nap, NULL);
    }
    return NULL;
}

int hal_recorder_start(hal_recorder_t *self) {
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before); // signals are for the main thread
    const int problem = pthread_create(&self->thread, NULL, work, self);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    self->running = problem == 0;
    return problem;
}

void hal_recorder_close(hal_recorder_t *self) {
    if (self->running) {
        atomic_store(&self->ending, true);
        pthread_join(self->thread, NULL);
        self->running = false;
    }
    if (self->fd >= 0) {
        say_lost(self, self->ops.now().mono_us);
        hal_recorder_pump(self);
        sync_now(self);
        close_file(self);
    }
}
