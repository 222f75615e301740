// SPDX-License-Identifier: MIT
// Two slots with sequence numbers and CRCs over any medium.
#include "hal/store.h"

#include <string.h>

#include "hal/crc32.h"

static const uint8_t magic[4] = {'A', 'R', 'G', '1'};

const char *hal_store_error_text(int error) {
    switch (error) {
    case HAL_STORE_OK:
        return "ok";
    case HAL_STORE_EMPTY:
        return "nothing is stored";
    case HAL_STORE_DAMAGED:
        return "what is stored is damaged";
    case HAL_STORE_TOO_LONG:
        return "the record is too long";
    case HAL_STORE_DENIED:
        return "no permission";
    case HAL_STORE_NO_PLACE:
        return "the folder is missing or the disk is full";
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
static uint32_t slot_crc(const uint8_t *slot, uint32_t length) {
    return hal_crc32(hal_crc32(0, slot + 4, 8), slot + HAL_STORE_HEADER, length);
}

static bool slot_is_valid(const uint8_t *slot, int size, uint32_t *length) {
    if (size < HAL_STORE_HEADER || memcmp(slot, magic, sizeof magic) != 0) {
        return false;
    }
    *length = get32(slot + 8);
    if (*length > HAL_STORE_RECORD_MAX || (int)*length + HAL_STORE_HEADER != size) {
        return false;
    }
    return get32(slot + 12) == slot_crc(slot, *length);
}

void hal_store_init(hal_store_t *self, hal_medium_t medium) {
    memset(self, 0, sizeof *self);
    self->medium = medium;
    self->newest = -1;
}

// Reads a slot into the buffer; its record's length, or an error.
static int fetch(hal_store_t *self, int slot) {
    uint32_t length = 0;
    const int size = self->medium.ops->read(self->medium.context, slot, self->slot, sizeof self->slot);
    if (size < 0) {
        return size;
    }
    return slot_is_valid(self->slot, size, &length) ? (int)length : HAL_STORE_DAMAGED;
}

// Finds the newest valid slot; a medium that cannot be read at all is the error returned.
static hal_store_error_t scan(hal_store_t *self) {
    hal_store_error_t worst = HAL_STORE_EMPTY;
    self->newest = -1;
    for (int slot = 0; slot < HAL_STORE_SLOTS; slot++) {
        const int length = fetch(self, slot);
        self->damaged[slot] = length == HAL_STORE_DAMAGED;
        if (length < 0) {
            worst = length < (int)worst ? (hal_store_error_t)length : worst;
            continue;
        }
        const uint32_t sequence = get32(self->slot + 4);
        if (self->newest < 0 || (int32_t)(sequence - self->sequence) > 0) {
            self->newest = (int8_t)slot;
            self->sequence = sequence;
        }
    }
    self->scanned = self->newest >= 0 || worst >= HAL_STORE_DAMAGED;
    return self->newest >= 0 ? HAL_STORE_OK : worst;
}

hal_store_error_t hal_store_load(hal_store_t *self, void *record, size_t capacity, size_t *count) {
    const hal_store_error_t found = scan(self);
    if (found != HAL_STORE_OK) {
        return found;
    }
    const int length = fetch(self, self->newest);
    if (length < 0) {
        return (hal_store_error_t)length;
    }
    if ((size_t)length > capacity) {
        return HAL_STORE_TOO_LONG;
    }
    memcpy(record, self->slot + HAL_STORE_HEADER, (size_t)length);
    *count = (size_t)length;
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
    memcpy(self->slot, magic, sizeof magic);
    put32(self->slot + 4, sequence);
    put32(self->slot + 8, (uint32_t)count);
    memcpy(self->slot + HAL_STORE_HEADER, record, count);
    put32(self->slot + 12, slot_crc(self->slot, (uint32_t)count));
    const int result =
        self->medium.ops->write(self->medium.context, slot, self->slot, HAL_STORE_HEADER + count);
    if (result != HAL_STORE_OK) {
        self->scanned = false;
        return (hal_store_error_t)result;
    }
    self->newest = (int8_t)slot;
    self->sequence = sequence;
    return HAL_STORE_OK;
}
