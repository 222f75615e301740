// SPDX-License-Identifier: MIT
// A clock that stands until it is moved on.
#ifndef HAL_FAKE_CLOCK_H
#define HAL_FAKE_CLOCK_H

#include "hal/clock.h"

typedef struct {
    uint32_t now_ms;
    uint32_t calls; // how often it was read
} hal_fake_clock_t;

hal_clock_t hal_fake_clock(hal_fake_clock_t *self);

#endif
