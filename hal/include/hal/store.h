// SPDX-License-Identifier: MIT
// A store for one small record that survives a power cut at any byte: two slots, the newest valid one counts.
//
// A slot is a header and the record (SPEC.md, Store). The header is "ARG1", sequence number, length, and the
// CRC-32 over sequence number, length and record. Numbers are little-endian, 4 bytes each. A save goes to the
// slot that does not hold the newest record.
#ifndef HAL_STORE_H
#define HAL_STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// The longest record; a port with little memory may say less.
#ifndef HAL_STORE_RECORD_MAX
#define HAL_STORE_RECORD_MAX 4096
#endif
#define HAL_STORE_HEADER 16
#define HAL_STORE_SLOT_MAX (HAL_STORE_HEADER + HAL_STORE_RECORD_MAX)
#define HAL_STORE_SLOTS 2

typedef enum {
    HAL_STORE_OK = 0,
    HAL_STORE_EMPTY = -1,   // nothing was ever saved
    HAL_STORE_DAMAGED = -2, // something is there, but no slot is valid
    HAL_STORE_TOO_LONG = -3,
    HAL_STORE_DENIED = -4,
    HAL_STORE_NO_PLACE = -5, // the folder is missing or the disk is full
    HAL_STORE_IO = -6
} hal_store_error_t;

const char *hal_store_error_text(int error); // of any medium

// Where slots are kept: files, flash, or the fake.
typedef struct {
    // Bytes read from `offset` on: as many as were asked for, or fewer where the slot ends. HAL_STORE_EMPTY
    // when the slot does not exist, or another error.
    int (*read)(void *context, int slot, size_t offset, uint8_t *bytes, size_t count);
    // Replaces a slot by header and record. HAL_STORE_OK only when both will outlast a power cut.
    int (*write)(void *context, int slot, const uint8_t header[HAL_STORE_HEADER], const uint8_t *record,
                 size_t count);
} hal_medium_ops_t;

typedef struct {
    const hal_medium_ops_t *ops;
    void *context;
} hal_medium_t;

typedef struct {
    hal_medium_t medium;
    bool scanned;
    int8_t newest;   // slot of the newest valid record, -1: none
    uint16_t length; // of that
    uint32_t sequence;
    bool damaged[HAL_STORE_SLOTS]; // found by the last load: a slot that exists and is not valid
} hal_store_t;

void hal_store_init(hal_store_t *self, hal_medium_t medium);

// Looks for the newest valid record: its slot and length. Otherwise as hal_store_load().
hal_store_error_t hal_store_find(hal_store_t *self, int *slot, size_t *count);

// Copies the newest valid record; `*count` is its length. With HAL_STORE_OK look at `damaged`: the other slot
// may have been lost. HAL_STORE_TOO_LONG when `capacity` is too small.
hal_store_error_t hal_store_load(hal_store_t *self, void *record, size_t capacity, size_t *count);

// Saves; after an error the record saved before is still there.
hal_store_error_t hal_store_save(hal_store_t *self, const void *record, size_t count);

#define HAL_STORE_PATH_MAX 240

// Slots as files PATH.a and PATH.b, written as PATH.tmp, synced, renamed, and the folder synced.
typedef struct {
    char path[HAL_STORE_PATH_MAX];
    char scratch[HAL_STORE_PATH_MAX + 8];
    char target[HAL_STORE_PATH_MAX + 8];
} hal_file_medium_t;

// False when the path is empty or too long.
bool hal_file_medium_init(hal_file_medium_t *self, const char *path);
const char *hal_file_error_text(int error); // of slots that are files
hal_medium_t hal_file_medium(hal_file_medium_t *self);

#endif
