// SPDX-License-Identifier: MIT
// Two slots with sequence numbers and CRCs over any medium.
#include "hal/store.h"

#include <string.h>

#include "hal/crc32.h"

#define PIECE_BYTES 64

static const uint8_t magic[4] = {'A', 'R', 'G', '1'};

const char *hal_store_error_text(int error) {
    switch (error) {
    case HAL_STORE_OK:
        return "ok";
    case HAL_STORE_EMPTY:
        return "nothing is stored";
    case HAL_STORE_DAMAGED:
        return "the store is damaged";
    default:
        return "input/output error";
    }
}

static void put32(uint8_t *bytes, uint32_t value) {
    for (int i = 0; i < 4; i++) {
        bytes[i] = (uint8_t)(value >> (8 * i));
    }
}

static uint32_t get32(const uint8_t *bytes) {
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

// The CRC covers sequence number and length too: a damaged one must not win over the other slot.
static uint32_t header_crc(const uint8_t *header) {
    return hal_crc32(0, header + 4, 8);
}

static int read_slot(const hal_store_t *self, int slot, size_t offset, uint8_t *bytes, size_t count) {
    return self->medium.ops->read(self->medium.context, slot, offset, bytes, count);
}

// Whether the slot holds what its header says, no more, no less. It is read in pieces, so that no slot needs
// a place in memory.
static int check_record(const hal_store_t *self, int slot, const uint8_t *header, size_t length) {
    uint8_t piece[PIECE_BYTES];
    uint32_t crc = header_crc(header);
    for (size_t at = 0; at < length; at += sizeof piece) {
        const size_t count = length - at < sizeof piece ? length - at : sizeof piece;
        const int got = read_slot(self, slot, HAL_STORE_HEADER + at, piece, count);
        if (got != (int)count) {
            return got < 0 ? got : (int)HAL_STORE_DAMAGED;
        }
        crc = hal_crc32(crc, piece, count);
    }
    return get32(header + 12) == crc ? (int)length : (int)HAL_STORE_DAMAGED;
}

void hal_store_init(hal_store_t *self, hal_medium_t medium) {
    memset(self, 0, sizeof *self);
    self->medium = medium;
    self->newest = -1;
}

// Length of the slot's record, or an error; `*sequence` is its number.
static int check_slot(const hal_store_t *self, int slot, uint32_t *sequence) {
    uint8_t header[HAL_STORE_HEADER];
    const int got = read_slot(self, slot, 0, header, sizeof header);
    if (got < 0) {
        return got;
    }
    const uint32_t length = get32(header + 8);
    if (got != (int)sizeof header || memcmp(header, magic, sizeof magic) != 0 ||
        length > HAL_STORE_RECORD_MAX) {
        return HAL_STORE_DAMAGED;
    }
    *sequence = get32(header + 4);
    return check_record(self, slot, header, length);
}

// Finds the newest valid slot; a medium that cannot be read at all is the error returned.
static hal_store_error_t scan(hal_store_t *self) {
    hal_store_error_t worst = HAL_STORE_EMPTY;
    self->newest = -1;
    for (int slot = 0; slot < HAL_STORE_SLOTS; slot++) {
        uint32_t sequence = 0;
        const int length = check_slot(self, slot, &sequence);
        self->damaged[slot] = length == HAL_STORE_DAMAGED;
        if (length < 0) {
            worst = length < (int)worst ? (hal_store_error_t)length : worst;
            continue;
        }
        if (self->newest < 0 || (int32_t)(sequence - self->sequence) > 0) {
            self->newest = (int8_t)slot;
            self->sequence = sequence;
            self->length = (uint16_t)length;
        }
    }
    self->scanned = self->newest >= 0 || worst >= HAL_STORE_DAMAGED;
    return self->newest >= 0 ? HAL_STORE_OK : worst;
}

hal_store_error_t hal_store_find(hal_store_t *self, int *slot, size_t *count) {
    const hal_store_error_t found = scan(self);
    if (found == HAL_STORE_OK) {
        *slot = self->newest;
        *count = self->length;
    }
    return found;
}

hal_store_error_t hal_store_load(hal_store_t *self, void *record, size_t capacity, size_t *count) {
    int slot = 0;
    size_t length = 0;
    const hal_store_error_t found = hal_store_find(self, &slot, &length);
    if (found != HAL_STORE_OK) {
        return found;
    }
    if (length > capacity) {
        return HAL_STORE_TOO_LONG;
    }
    const int got = read_slot(self, slot, HAL_STORE_HEADER, record, length);
    if (got != (int)length) {
        return got < 0 ? (hal_store_error_t)got : HAL_STORE_DAMAGED;
    }
    *count = length;
    return HAL_STORE_OK;
}

hal_store_error_t hal_store_save(hal_store_t *self, const void *record, size_t count) {
    if (count > HAL_STORE_RECORD_MAX) {
        return HAL_STORE_TOO_LONG;
    }
    if (!self->scanned) {
        const hal_store_error_t found = scan(self);
        if (!self->scanned) {
            return found;
        }
    }
    const int slot = self->newest == 0 ? 1 : 0;
    const uint32_t sequence = self->newest < 0 ? 1 : self->sequence + 1;
    uint8_t header[HAL_STORE_HEADER];
    memcpy(header, magic, sizeof magic);
    put32(header + 4, sequence);
    put32(header + 8, (uint32_t)count);
    put32(header + 12, hal_crc32(header_crc(header), record, count));
    const int result = self->medium.ops->write(self->medium.context, slot, header, record, count);
    if (result != HAL_STORE_OK) {
        self->scanned = false;
        return (hal_store_error_t)result;
    }
    self->newest = (int8_t)slot;
    self->sequence = sequence;
    self->length = (uint16_t)count;
    return HAL_STORE_OK;
}
