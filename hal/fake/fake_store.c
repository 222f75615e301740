// SPDX-License-Identifier: MIT
// Slots in memory. Writes go in place, which is harsher than the files' atomic rename.
#include "hal/fake_store.h"

#include <string.h>

void hal_fake_store_init(hal_fake_store_t *self) {
    memset(self, 0, sizeof *self);
    self->cut_after = UINT32_MAX;
}

void hal_fake_store_power_on(hal_fake_store_t *self) {
    self->off = false;
    self->cut_after = UINT32_MAX;
}

static int slot_read(void *context, int slot, size_t offset, uint8_t *bytes, size_t count) {
    const hal_fake_store_t *const self = context;
    if (self->off) {
        return HAL_STORE_IO;
    }
    if (!self->exists[slot]) {
        return HAL_STORE_EMPTY;
    }
    const size_t left = offset < self->length[slot] ? self->length[slot] - offset : 0;
    const size_t got = left < count ? left : count;
    memcpy(bytes, self->bytes[slot] + offset, got);
    return (int)got;
}

static bool put(hal_fake_store_t *self, uint8_t *to, const uint8_t *bytes, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (self->written >= self->cut_after) {
            self->off = true;
            return false;
        }
        to[i] = bytes[i];
        self->written++;
    }
    return true;
}

static int slot_write(void *context, int slot, const uint8_t *header, const uint8_t *record, size_t count) {
    hal_fake_store_t *const self = context;
    if (self->off || count > HAL_STORE_RECORD_MAX) {
        return HAL_STORE_IO;
    }
    self->exists[slot] = true;
    if (!put(self, self->bytes[slot], header, HAL_STORE_HEADER) ||
        !put(self, self->bytes[slot] + HAL_STORE_HEADER, record, count)) {
        return HAL_STORE_IO;
    }
    self->length[slot] = (uint16_t)(HAL_STORE_HEADER + count);
    return HAL_STORE_OK;
}

hal_medium_t hal_fake_store_medium(hal_fake_store_t *self) {
    static const hal_medium_ops_t ops = {.read = slot_read, .write = slot_write};
    return (hal_medium_t){.ops = &ops, .context = self};
}
