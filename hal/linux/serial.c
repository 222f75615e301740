// SPDX-License-Identifier: MIT
// Serial links.
#include "hal/serial.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

const uint32_t hal_baud_table[] = {
#define BAUD_ENTRY(baud) baud,
    HAL_BAUD_TABLE(BAUD_ENTRY)
#undef BAUD_ENTRY
};
const uint8_t hal_baud_count = sizeof hal_baud_table / sizeof hal_baud_table[0];

static bool speed_of(uint32_t baud, speed_t *speed) {
    switch (baud) {
#define BAUD_CASE(rate)   \
    case rate:            \
        *speed = B##rate; \
        return true;
        HAL_BAUD_TABLE(BAUD_CASE)
#undef BAUD_CASE
    default:
        return false;
    }
}

bool hal_baud_is_known(uint32_t baud) {
    speed_t speed = 0;
    return speed_of(baud, &speed);
}

void hal_serial_init(hal_serial_t *self) {
    memset(self, 0, sizeof *self);
    hal_fd_link_init(&self->port);
}

static void describe(hal_serial_t *self) {
    snprintf(self->text, sizeof self->text, "serial:%s@%u", self->path, (unsigned)self->baud);
}

static hal_link_error_t apply(const hal_serial_t *self, uint32_t baud) {
    speed_t speed = 0;
    struct termios raw;
    if (!speed_of(baud, &speed)) {
        return HAL_LINK_BAD_BAUD;
    }
    if (tcgetattr(self->port.fd, &raw) != 0) {
        return hal_link_error_of(errno);
    }
    cfmakeraw(&raw);
    // No HUPCL: closing must not drop DTR, which resets some controllers.
    raw.c_cflag &= ~(tcflag_t)(PARENB | CSTOPB | CRTSCTS | HUPCL);
    raw.c_cflag |= CLOCAL | CREAD;
    // VMIN 1 tells silence (EAGAIN) from a hung-up line (0 bytes).
    raw.c_cc[VMIN] = 1;
    raw.c_cc[VTIME] = 0;
    cfsetispeed(&raw, speed);
    cfsetospeed(&raw, speed);
    if (tcsetattr(self->port.fd, TCSANOW, &raw) != 0) {
        return hal_link_error_of(errno);
    }
    // tcsetattr is content when it could do a part.
    struct termios set;
    if (tcgetattr(self->port.fd, &set) != 0) {
        return hal_link_error_of(errno);
    }
    return cfgetospeed(&set) == speed ? HAL_LINK_OK : HAL_LINK_BAD_BAUD;
}

// A pty keeps TIOCEXCL after its holder was killed, as long as its master lives, and would lock everybody
// out.
static bool is_pty(int fd) {
    struct stat about;
    return fstat(fd, &about) == 0 && major(about.st_rdev) >= 136 && major(about.st_rdev) <= 143;
}

static hal_link_error_t claim(hal_serial_t *self) {
    if (flock(self->port.fd, LOCK_EX | LOCK_NB) != 0) {
        return errno == EWOULDBLOCK ? HAL_LINK_BUSY : HAL_LINK_IO;
    }
    self->exclusive = !is_pty(self->port.fd) && ioctl(self->port.fd, TIOCEXCL) == 0;
    return HAL_LINK_OK;
}

static void serial_close(void *context) {
    hal_serial_t *const self = context;
    if (self->port.fd < 0) {
        return;
    }
    if (self->has_saved) {
        tcsetattr(self->port.fd, TCSANOW, &self->saved);
    }
    if (self->exclusive) {
        ioctl(self->port.fd, TIOCNXCL);
    }
    close(self->port.fd);
    self->port.fd = -1;
    self->has_saved = false;
    self->exclusive = false;
}

static hal_link_error_t set_up(hal_serial_t *self, uint32_t baud) {
    if (tcgetattr(self->port.fd, &self->saved) != 0) {
        return hal_link_error_of(errno);
    }
    // Claim before touching the settings: they may be another program's.
    const hal_link_error_t claimed = claim(self);
    if (claimed != HAL_LINK_OK) {
        return claimed;
    }
    self->has_saved = true;
    const hal_link_error_t applied = apply(self, baud);
    if (applied == HAL_LINK_OK) {
        tcflush(self->port.fd, TCIOFLUSH);
    }
    return applied;
}

hal_link_error_t hal_serial_open(hal_serial_t *self, const char *path, uint32_t baud) {
    if (path == NULL || path[0] == '\0' || strlen(path) >= sizeof self->path) {
        return HAL_LINK_BAD_ARGUMENT;
    }
    if (!hal_baud_is_known(baud)) {
        return HAL_LINK_BAD_BAUD;
    }
    serial_close(self);
    if (path != self->path) {
        snprintf(self->path, sizeof self->path, "%s", path);
    }
    self->port.kept = 0;
    self->port.fd = open(self->path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (self->port.fd < 0) {
        return hal_link_error_of(errno);
    }
    const hal_link_error_t error = set_up(self, baud);
    if (error != HAL_LINK_OK) {
        serial_close(self);
        return error;
    }
    self->baud = baud;
    describe(self);
    return HAL_LINK_OK;
}

hal_link_error_t hal_serial_set_baud(hal_serial_t *self, uint32_t baud) {
    if (self->port.fd < 0) {
        return HAL_LINK_NOT_OPEN;
    }
    const hal_link_error_t error = apply(self, baud);
    if (error != HAL_LINK_OK) {
        return error;
    }
    tcflush(self->port.fd, TCIOFLUSH);
    self->port.kept = 0;
    self->baud = baud;
    describe(self);
    return HAL_LINK_OK;
}

bool hal_serial_moved(const hal_serial_t *self) {
    struct stat opened;
    struct stat named;
    if (self->port.fd < 0 || fstat(self->port.fd, &opened) != 0 || stat(self->path, &named) != 0) {
        return false;
    }
    return opened.st_rdev != named.st_rdev;
}

static int serial_read(void *context, uint8_t *bytes, size_t capacity) {
    hal_serial_t *const self = context;
    const int got = hal_fd_link_read(&self->port, bytes, capacity);
    return got == HAL_LINK_CLOSED ? (int)HAL_LINK_GONE : got;
}

static int serial_write(void *context, const uint8_t *packet, size_t count) {
    hal_serial_t *const self = context;
    return hal_fd_link_write(&self->port, packet, count);
}

static int serial_flush(void *context) {
    hal_serial_t *const self = context;
    return hal_fd_link_flush(&self->port);
}

static int serial_fd(const void *context) {
    const hal_serial_t *const self = context;
    return self->port.fd;
}

static const char *serial_describe(const void *context) {
    const hal_serial_t *const self = context;
    return self->text;
}

static const hal_link_counters_t *serial_counters(const void *context) {
    const hal_serial_t *const self = context;
    return &self->port.counters;
}

hal_link_t hal_serial_link(hal_serial_t *self) {
    static const hal_link_ops_t ops = {.read = serial_read,
                                       .write = serial_write,
                                       .flush = serial_flush,
                                       .fd = serial_fd,
                                       .describe = serial_describe,
                                       .counters = serial_counters,
                                       .close = serial_close};
    return (hal_link_t){.ops = &ops, .context = self};
}
