// SPDX-License-Identifier: MIT
// A link in memory with faults by seed: what goes in at the far end comes out here, less what the faults
// take.
#ifndef HAL_FAKE_LINK_H
#define HAL_FAKE_LINK_H

#include <stdbool.h>

#include "hal/clock.h"
#include "hal/link.h"

#define HAL_FAKE_BYTES 4096

// Faults of one direction. All zero: a perfect wire. A rate is in thousandths, per byte.
typedef struct {
    uint16_t drop_permille;
    uint16_t corrupt_permille; // one bit of the byte is flipped
    uint32_t delay_ms;         // of every byte; needs a clock
    bool cut;                  // nothing passes, and neither end learns of it
} hal_fake_faults_t;

typedef struct {
    uint8_t byte[HAL_FAKE_BYTES];
    uint32_t due_ms[HAL_FAKE_BYTES];
    uint16_t first;
    uint16_t count;
    uint32_t dropped; // monotonic counters
    uint32_t corrupted;
    uint32_t overflowed;
} hal_fake_pipe_t;

typedef struct {
    hal_fake_faults_t to_robot;
    hal_fake_faults_t from_robot;
    uint16_t read_max;             // short reads: at most this many bytes; 0: no limit
    uint16_t would_block_permille; // per write
    uint32_t fail_read_at; // this call of read (1: the first) gives `failure`, and every later one; 0: never
    uint32_t fail_write_at;
    hal_link_error_t failure;
    const hal_clock_t *clock; // NULL: no delays
    uint32_t random;          // state of the generator; the seed at the start
    uint32_t reads;
    uint32_t writes;
    bool closed;
    hal_fake_pipe_t out; // towards the robot
    hal_fake_pipe_t in;  // from the robot
    hal_link_counters_t counters;
} hal_fake_link_t;

// Same seed, same calls: same faults.
void hal_fake_link_init(hal_fake_link_t *self, uint32_t seed, const hal_clock_t *clock);
hal_link_t hal_fake_link(hal_fake_link_t *self);

// The far end. put returns how many bytes fitted; take returns how many bytes had arrived.
size_t hal_fake_link_put(hal_fake_link_t *self, const uint8_t *bytes, size_t count);
size_t hal_fake_link_take(hal_fake_link_t *self, uint8_t *bytes, size_t capacity);

#endif
