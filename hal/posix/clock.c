// SPDX-License-Identifier: MIT
// The monotonic clock of POSIX.
#include "hal/clock.h"

#include <time.h>

static uint32_t now_ms(void *context) {
    (void)context;
    struct timespec now = {0};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint32_t)((uint64_t)now.tv_sec * 1000u + (uint64_t)now.tv_nsec / 1000000u);
}

hal_clock_t hal_clock_monotonic(void) {
    return (hal_clock_t){.now_ms = now_ms, .context = NULL};
}
