// SPDX-License-Identifier: MIT
// The kernel that the CAN parts see in unit tests.
#include "fake_can.h"

#include <errno.h>
#include <net/if_arp.h>
#include <string.h>
#include <sys/ioctl.h>

#define FAKE_FD 77
#define EAR_FD 78

fake_can_t fake_can;

void fake_can_reset(void) {
    memset(&fake_can, 0, sizeof fake_can);
    fake_can.index = 3;
    fake_can.hardware = ARPHRD_CAN;
    fake_can.flags = IFF_UP;
    fake_can.mtu = CAN_MTU;
}

void fake_can_deliver(ssize_t result, const void *bytes, size_t count) {
    fake_can_step_t *const step = &fake_can.in[fake_can.in_count++];
    step->result = result;
    memcpy(step->bytes, bytes, count);
}

void fake_can_answer_send(int negative_errno) {
    fake_can.send_says[fake_can.send_count++] = negative_errno;
}

static int open_socket(int type, int protocol) {
    if (protocol == CAN_RAW && fake_can.protocol == CAN_ISOTP) {
        fake_can.ear_opened += fake_can.ear_says == 0;
        return fake_can.ear_says == 0 ? EAR_FD : fake_can.ear_says;
    }
    fake_can.type = type;
    fake_can.protocol = protocol;
    fake_can.opened += fake_can.socket_says == 0;
    return fake_can.socket_says == 0 ? FAKE_FD : fake_can.socket_says;
}

static int control(int fd, unsigned long request, struct ifreq *about) {
    if (fd != FAKE_FD || fake_can.index == 0) {
        return -ENODEV;
    }
    switch (request) {
    case SIOCGIFINDEX:
        about->ifr_ifindex = fake_can.index;
        return 0;
    case SIOCGIFHWADDR:
        about->ifr_hwaddr.sa_family = (sa_family_t)fake_can.hardware;
        return 0;
    case SIOCGIFFLAGS:
        about->ifr_flags = (short)fake_can.flags;
        return 0;
    case SIOCGIFMTU:
        about->ifr_mtu = fake_can.mtu;
        return 0;
    default:
        return -EINVAL;
    }
}

static int set(int fd, int level, int option, const void *value, uint32_t length) {
    (void)level;
    if (fd == EAR_FD) {
        return 0;
    }
    const int at = fake_can.options;
    if (fd != FAKE_FD || at == 8 || length > sizeof fake_can.value[0]) {
        return -EINVAL;
    }
    fake_can.option[at] = option;
    memcpy(fake_can.value[at], value, length);
    fake_can.options++;
    return fake_can.set_says;
}

static int bind_socket(int fd, const struct sockaddr_can *address) {
    if (fd == EAR_FD) {
        return 0;
    }
    fake_can.address = *address;
    return fd == FAKE_FD ? fake_can.bind_says : -EBADF;
}

static ssize_t send_bytes(int fd, const void *bytes, size_t count) {
    if (fd != FAKE_FD) {
        return -EBADF;
    }
    if (fake_can.send_next < fake_can.send_count) {
        const int says = fake_can.send_says[fake_can.send_next++];
        if (says < 0) {
            return says;
        }
    }
    const int at = fake_can.sends % FAKE_CAN_STEPS;
    memcpy(fake_can.sent[at], bytes, count);
    fake_can.sent_length[at] = count;
    fake_can.sends++;
    return (ssize_t)count;
}

static ssize_t hear(void) {
    if (fake_can.ear_classic > 0) {
        fake_can.ear_classic--;
        return CAN_MTU;
    }
    if (fake_can.ear_fd > 0) {
        fake_can.ear_fd--;
        return CANFD_MTU;
    }
    return -EAGAIN;
}

static ssize_t receive_bytes(int fd, void *bytes, size_t capacity) {
    if (fd == EAR_FD) {
        return hear();
    }
    if (fd != FAKE_FD) {
        return -EBADF;
    }
    if (fake_can.in_next == fake_can.in_count) {
        return -EAGAIN;
    }
    const fake_can_step_t *const step = &fake_can.in[fake_can.in_next++];
    if (step->result < 0) {
        return step->result;
    }
    const size_t count = (size_t)step->result < capacity ? (size_t)step->result : capacity;
    memcpy(bytes, step->bytes, count);
    return (ssize_t)count;
}

static int close_socket(int fd) {
    if (fd == EAR_FD) {
        fake_can.ear_closed++;
        return 0;
    }
    fake_can.closed++;
    return fd == FAKE_FD ? 0 : -EBADF;
}

const hal_can_sys_t fake_can_sys = {.socket = open_socket,
                                    .control = control,
                                    .set = set,
                                    .bind = bind_socket,
                                    .send = send_bytes,
                                    .recv = receive_bytes,
                                    .close = close_socket};
