// SPDX-License-Identifier: MIT
// CAN_RAW sockets.
#include "hal/can_raw.h"

#include <errno.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>

#include "hal/isotp.h"

#define READS_MAX 16

void hal_can_raw_init(hal_can_raw_t *self, const hal_can_sys_t *sys) {
    memset(self, 0, sizeof *self);
    self->sys = sys;
    self->fd = -1;
    self->error = HAL_LINK_NOT_OPEN;
}

static void drop_socket(hal_can_raw_t *self) {
    if (self->fd >= 0) {
        self->sys->close(self->fd);
    }
    self->fd = -1;
    self->is_full = false;
}

static int set_up(hal_can_raw_t *self) {
    const can_err_mask_t errors = CAN_ERR_BUSOFF;
    const struct sockaddr_can address = {.can_family = AF_CAN, .can_ifindex = self->index};
    int failed = hal_can_filter(self->sys, self->fd, self->rx_id);
    if (failed == 0) {
        failed = self->sys->set(self->fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors);
    }
    return failed == 0 ? self->sys->bind(self->fd, &address) : failed;
}

static hal_link_error_t open_anew(hal_can_raw_t *self) {
    const int fd = self->sys->socket(SOCK_RAW, CAN_RAW);
    if (fd < 0) {
        return hal_can_error_of(fd);
    }
    self->fd = fd;
    self->index = hal_can_interface(self->sys, fd, self->interface, 0);
    const int failed = self->index < 0 ? 0 : set_up(self);
    if (self->index < 0 || failed != 0) {
        drop_socket(self);
        return self->index < 0 ? (hal_link_error_t)self->index : hal_can_error_of(failed);
    }
    return HAL_LINK_OK;
}

hal_link_error_t hal_can_raw_open(hal_can_raw_t *self, const char *interface, uint16_t rx_id,
                                  uint32_t now_ms) {
    snprintf(self->interface, sizeof self->interface, "%s", interface);
    self->rx_id = rx_id;
    self->tried_ms = now_ms;
    self->error = open_anew(self);
    return self->error;
}

// The socket of an interface that is only down works again by itself; that of one that was removed does not.
static void lose(hal_can_raw_t *self, int negative_errno, uint32_t now_ms) {
    self->failed++;
    self->error = hal_can_error_of(negative_errno);
    self->tried_ms = now_ms;
    if (self->error != HAL_LINK_DOWN) {
        drop_socket(self);
    }
}

static bool is_passing(ssize_t result) {
    return result == -EAGAIN || result == -EINTR || result == -ENOBUFS;
}

bool hal_can_raw_send(hal_can_raw_t *self, uint16_t id, const uint8_t *data, uint8_t length,
                      uint32_t now_ms) {
    struct can_frame frame = {.can_id = id, .len = length};
    if (self->fd < 0 || length > CAN_MAX_DLEN) {
        return false;
    }
    memcpy(frame.data, data, length);
    const ssize_t sent = self->sys->send(self->fd, &frame, sizeof frame);
    self->is_full = sent < 0 && is_passing(sent);
    if (sent == (ssize_t)sizeof frame) {
        self->error = HAL_LINK_OK;
        self->sent++;
        return true;
    }
    if (self->is_full) {
        self->tried_ms = now_ms;
        self->full++;
    } else {
        lose(self, sent < 0 ? (int)sent : -EIO, now_ms);
    }
    return false;
}

int hal_can_raw_receive(hal_can_raw_t *self, uint8_t data[8], uint32_t now_ms) {
    for (int i = 0; i < READS_MAX && self->fd >= 0; i++) {
        struct can_frame frame;
        const ssize_t got = self->sys->recv(self->fd, &frame, sizeof frame);
        if (got < 0) {
            if (!is_passing(got)) {
                lose(self, (int)got, now_ms);
            }
            return -1;
        }
        if (got == (ssize_t)sizeof frame && (frame.can_id & CAN_ERR_FLAG) != 0) {
            self->bus_off++;
        } else if (got == (ssize_t)sizeof frame && frame.can_id == self->rx_id && frame.len <= CAN_MAX_DLEN) {
            memcpy(data, frame.data, CAN_MAX_DLEN);
            return frame.len;
        }
    }
    return -1;
}

static hal_link_error_t look(hal_can_raw_t *self) {
    if (self->fd < 0) {
        return open_anew(self);
    }
    const int index = hal_can_interface(self->sys, self->fd, self->interface, 0);
    if (index == self->index) {
        return HAL_LINK_OK;
    }
    if (index == HAL_LINK_DOWN) {
        return HAL_LINK_DOWN;
    }
    drop_socket(self);
    return open_anew(self);
}

void hal_can_raw_process(hal_can_raw_t *self, uint32_t now_ms) {
    if (self->error == HAL_LINK_OK || now_ms - self->tried_ms < HAL_CAN_RAW_RETRY_MS) {
        return;
    }
    self->tried_ms = now_ms;
    self->error = look(self);
}

uint32_t hal_can_raw_wait_ms(const hal_can_raw_t *self, uint32_t now_ms) {
    const uint32_t passed_ms = now_ms - self->tried_ms;
    uint32_t wait_ms = 0;
    if (self->error != HAL_LINK_OK) {
        wait_ms = HAL_CAN_RAW_RETRY_MS;
    } else if (self->is_full) {
        wait_ms = HAL_CAN_RAW_HOLD_MS;
    }
    return wait_ms > passed_ms ? wait_ms - passed_ms : 0;
}

int hal_can_raw_fd(const hal_can_raw_t *self) {
    return self->fd;
}

void hal_can_raw_close(hal_can_raw_t *self) {
    drop_socket(self);
    self->error = HAL_LINK_NOT_OPEN;
}

void hal_can_raw_explain(hal_link_error_t error, const char *interface, char *text, size_t capacity) {
    if (error == HAL_LINK_NO_CAN || error == HAL_LINK_NO_PROTOCOL) {
        snprintf(text, capacity, "%s: %s: modprobe can-raw%s", interface,
                 error == HAL_LINK_NO_CAN ? "the kernel has no CAN, or its module is not loaded"
                                          : "the kernel module can-raw is not loaded",
                 error == HAL_LINK_NO_CAN ? " (a kernel built without CAN has no such module)" : "");
        return;
    }
    hal_can_spec_t spec = {.fd = false};
    snprintf(spec.interface, sizeof spec.interface, "%s", interface);
    hal_isotp_explain(error, &spec, text, capacity);
}
