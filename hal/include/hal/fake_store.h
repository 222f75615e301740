// SPDX-License-Identifier: MIT
// Two slots in memory, whose power can be cut at any byte of a write.
#ifndef HAL_FAKE_STORE_H
#define HAL_FAKE_STORE_H

#include "hal/store.h"

typedef struct {
    uint8_t bytes[HAL_STORE_SLOTS][HAL_STORE_SLOT_MAX];
    uint16_t length[HAL_STORE_SLOTS];
    bool exists[HAL_STORE_SLOTS];
    uint32_t written;   // bytes, over all writes
    uint32_t cut_after; // power goes off once that many bytes are written; UINT32_MAX: never
    bool off;           // no power: reads and writes fail
} hal_fake_store_t;

void hal_fake_store_init(hal_fake_store_t *self);
// Power back on; what was half written stays so.
void hal_fake_store_power_on(hal_fake_store_t *self);
hal_medium_t hal_fake_store_medium(hal_fake_store_t *self);

#endif
