// SPDX-License-Identifier: MIT
// A raw socket beside an ISO-TP link, for frames of the other format.
#include "hal/can_ear.h"

#include <linux/can/raw.h>
#include <sys/socket.h>

#define READS_MAX 16

void hal_can_ear_init(hal_can_ear_t *self, const hal_can_sys_t *sys) {
    self->sys = sys;
    self->fd = -1;
    self->other = 0;
}

static int set_up(const hal_can_ear_t *self, const hal_can_spec_t *spec, int index) {
    const int both = 1;
    const struct sockaddr_can address = {.can_family = AF_CAN, .can_ifindex = index};
    int failed = hal_can_filter(self->sys, self->fd, spec->rx_id);
    if (failed == 0) {
        failed = self->sys->set(self->fd, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &both, sizeof both);
    }
    return failed == 0 ? self->sys->bind(self->fd, &address) : failed;
}

void hal_can_ear_open(hal_can_ear_t *self, const hal_can_spec_t *spec, int index) {
    hal_can_ear_close(self);
    const int fd = self->sys->socket(SOCK_RAW, CAN_RAW);
    if (fd < 0) {
        return;
    }
    self->fd = fd;
    self->other = spec->fd ? (int)CAN_MTU : (int)CANFD_MTU;
    if (set_up(self, spec, index) != 0) {
        hal_can_ear_close(self);
    }
}

uint32_t hal_can_ear_hear(hal_can_ear_t *self) {
    uint32_t heard = 0;
    for (int i = 0; i < READS_MAX && self->fd >= 0; i++) {
        struct canfd_frame frame;
        const ssize_t got = self->sys->recv(self->fd, &frame, sizeof frame);
        if (got < 0) {
            break;
        }
        heard += got == self->other;
    }
    return heard;
}

void hal_can_ear_close(hal_can_ear_t *self) {
    if (self->fd >= 0) {
        self->sys->close(self->fd);
    }
    self->fd = -1;
}
