// SPDX-License-Identifier: MIT
// What serial and TCP share: packets through a non-blocking file descriptor.
#ifndef HAL_FD_LINK_H
#define HAL_FD_LINK_H

#include "hal/link.h"

typedef struct {
    int fd; // -1: closed
    uint16_t kept;
    uint8_t rest[HAL_LINK_PACKET_MAX]; // the part of the last packet that the transport did not take
    hal_link_counters_t counters;
} hal_fd_link_t;

void hal_fd_link_init(hal_fd_link_t *self);
int hal_fd_link_read(hal_fd_link_t *self, uint8_t *bytes, size_t capacity);
int hal_fd_link_write(hal_fd_link_t *self, const uint8_t *packet, size_t count);
int hal_fd_link_flush(hal_fd_link_t *self);

// The link error that an errno value means.
hal_link_error_t hal_link_error_of(int error_number);

#endif
