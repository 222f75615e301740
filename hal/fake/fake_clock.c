// SPDX-License-Identifier: MIT
// The clock that stands.
#include "hal/fake_clock.h"

static uint32_t now_ms(void *context) {
    hal_fake_clock_t *const self = context;
    self->calls++;
    return self->now_ms;
}

hal_clock_t hal_fake_clock(hal_fake_clock_t *self) {
    return (hal_clock_t){.now_ms = now_ms, .context = self};
}
