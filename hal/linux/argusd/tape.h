// SPDX-License-Identifier: MIT
// argusd's own recording of its link: the driver's tap into a recorder, and what is said about its disk.
#ifndef ARGUSD_TAPE_H
#define ARGUSD_TAPE_H

#include "driver.h"
#include "hal/recorder.h"

#define TAPE_MAX_BYTES 64000000u

typedef struct {
    bool on;
    bool said; // that the disk refuses
    hal_recorder_t recorder;
} tape_t;

// Opens FILE and starts recording. `link` says what is recorded, `max_bytes` 0 takes TAPE_MAX_BYTES. False:
// `message` says why not.
bool tape_open(tape_t *self, const char *path, const char *link, uint64_t max_bytes, char *message,
               size_t capacity);

// What the driver is to show its bytes to; none when the tape is not open.
driver_tap_t tape_tap(tape_t *self);

// A sonar's reports are altered from here on; kind NONE: no more.
void tape_injected(tape_t *self, int sonar, argus_fault_kind_t kind, uint32_t for_ms);

// True when there is something to tell: the disk refuses, said once until it takes everything again.
bool tape_problem(tape_t *self, char *message, size_t capacity);

// Ends it. True: `message` tells what was lost.
bool tape_close(tape_t *self, char *message, size_t capacity);

#endif
