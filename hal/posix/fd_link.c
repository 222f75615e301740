// SPDX-License-Identifier: MIT
// Reading and writing packets on a non-blocking file descriptor.
#include "hal/fd_link.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

void hal_fd_link_init(hal_fd_link_t *self) {
    memset(self, 0, sizeof *self);
    self->fd = -1;
}

hal_link_error_t hal_link_error_of(int error_number) {
    static const struct {
        int number;
        hal_link_error_t error;
    } table[] = {
        {ENOENT, HAL_LINK_NOT_FOUND},
        {ENOTDIR, HAL_LINK_NOT_FOUND},
        {ELOOP, HAL_LINK_NOT_FOUND},
        {EACCES, HAL_LINK_DENIED},
        {EPERM, HAL_LINK_DENIED},
        {EBUSY, HAL_LINK_BUSY},
        {EWOULDBLOCK, HAL_LINK_BUSY},
        {ENOTTY, HAL_LINK_NOT_SERIAL},
        {EISDIR, HAL_LINK_NOT_SERIAL},
        {EINVAL, HAL_LINK_NOT_SERIAL},
        {EIO, HAL_LINK_GONE},
        {ENXIO, HAL_LINK_GONE},
        {ENODEV, HAL_LINK_GONE},
        {EPIPE, HAL_LINK_CLOSED},
        {ECONNRESET, HAL_LINK_CLOSED},
        {ECONNABORTED, HAL_LINK_CLOSED},
        {ECONNREFUSED, HAL_LINK_REFUSED},
        {ENETUNREACH, HAL_LINK_UNREACHABLE},
        {EHOSTUNREACH, HAL_LINK_UNREACHABLE},
        {ENETDOWN, HAL_LINK_UNREACHABLE},
        {EADDRNOTAVAIL, HAL_LINK_UNREACHABLE},
        {EAFNOSUPPORT, HAL_LINK_UNREACHABLE},
        {ETIMEDOUT, HAL_LINK_TIMEOUT},
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        if (table[i].number == error_number) {
            return table[i].error;
        }
    }
    return HAL_LINK_IO;
}

static int not_now(int error_number) {
    return error_number == EAGAIN || error_number == EWOULDBLOCK || error_number == EINTR;
}

int hal_fd_link_read(hal_fd_link_t *self, uint8_t *bytes, size_t capacity) {
    if (self->fd < 0) {
        return HAL_LINK_NOT_OPEN;
    }
    if (bytes == NULL || capacity == 0) {
        return HAL_LINK_BAD_ARGUMENT;
    }
    const ssize_t got = read(self->fd, bytes, capacity);
    if (got == 0) {
        // With VMIN 1 a terminal gives 0 only when it has hung up; a socket when the other end has closed.
        return HAL_LINK_CLOSED;
    }
    if (got < 0) {
        return not_now(errno) ? 0 : (int)hal_link_error_of(errno);
    }
    self->counters.bytes_in += (uint32_t)got;
    return (int)got;
}

// Bytes written, 0 when the transport is full, or an error.
static int put(hal_fd_link_t *self, const uint8_t *bytes, size_t count) {
    const ssize_t written = write(self->fd, bytes, count);
    if (written < 0) {
        return not_now(errno) ? 0 : (int)hal_link_error_of(errno);
    }
    self->counters.bytes_out += (uint32_t)written;
    return (int)written;
}

int hal_fd_link_flush(hal_fd_link_t *self) {
    if (self->fd < 0) {
        return HAL_LINK_NOT_OPEN;
    }
    if (self->kept == 0) {
        return 0;
    }
    const int written = put(self, self->rest, self->kept);
    if (written < 0) {
        return written;
    }
    self->kept = (uint16_t)(self->kept - written);
    memmove(self->rest, self->rest + written, self->kept);
    return self->kept;
}

int hal_fd_link_write(hal_fd_link_t *self, const uint8_t *packet, size_t count) {
    if (packet == NULL || count == 0) {
        return HAL_LINK_BAD_ARGUMENT;
    }
    if (count > HAL_LINK_PACKET_MAX) {
        return HAL_LINK_TOO_LONG;
    }
    const int kept = hal_fd_link_flush(self);
    if (kept < 0) {
        return kept;
    }
    const int written = kept > 0 ? 0 : put(self, packet, count);
    if (written < 0) {
        return written;
    }
    if (written == 0) {
        self->counters.would_block++;
        return 0;
    }
    self->kept = (uint16_t)(count - (size_t)written);
    memcpy(self->rest, packet + written, self->kept);
    self->counters.writes++;
    return (int)count;
}
