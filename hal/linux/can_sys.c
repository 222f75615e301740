// SPDX-License-Identifier: MIT
// CAN sockets of the Linux kernel.
#include "hal/can_sys.h"

#include <errno.h>
#include <linux/can/raw.h>
#include <net/if_arp.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "hal/fd_link.h"

static int sys_socket(int type, int protocol) {
    const int fd = socket(PF_CAN, type | SOCK_NONBLOCK | SOCK_CLOEXEC, protocol);
    return fd < 0 ? -errno : fd;
}

static int sys_control(int fd, unsigned long request, struct ifreq *about) {
    return ioctl(fd, request, about) < 0 ? -errno : 0;
}

static int sys_set(int fd, int level, int option, const void *value, uint32_t length) {
    return setsockopt(fd, level, option, value, (socklen_t)length) < 0 ? -errno : 0;
}

static int sys_bind(int fd, const struct sockaddr_can *address) {
    return bind(fd, (const struct sockaddr *)address, sizeof *address) < 0 ? -errno : 0;
}

static ssize_t sys_send(int fd, const void *bytes, size_t count) {
    const ssize_t sent = send(fd, bytes, count, MSG_DONTWAIT);
    return sent < 0 ? -errno : sent;
}

static ssize_t sys_recv(int fd, void *bytes, size_t capacity) {
    const ssize_t got = recv(fd, bytes, capacity, MSG_DONTWAIT);
    return got < 0 ? -errno : got;
}

static int sys_close(int fd) {
    return close(fd) < 0 ? -errno : 0;
}

const hal_can_sys_t hal_can_sys = {.socket = sys_socket,
                                   .control = sys_control,
                                   .set = sys_set,
                                   .bind = sys_bind,
                                   .send = sys_send,
                                   .recv = sys_recv,
                                   .close = sys_close};

hal_link_error_t hal_can_error_of(int negative_errno) {
    switch (-negative_errno) {
    case EAFNOSUPPORT:
        return HAL_LINK_NO_CAN;
    case EPROTONOSUPPORT:
    case ESOCKTNOSUPPORT:
        return HAL_LINK_NO_PROTOCOL;
    case ENETDOWN:
        return HAL_LINK_DOWN;
    case ENODEV:
    case ENXIO:
    case EADDRNOTAVAIL:
        return HAL_LINK_GONE;
    default:
        return hal_link_error_of(-negative_errno);
    }
}

int hal_can_interface(const hal_can_sys_t *sys, int fd, const char *name, int wants_fd) {
    struct ifreq about;
    memset(&about, 0, sizeof about);
    snprintf(about.ifr_name, sizeof about.ifr_name, "%s", name);
    if (sys->control(fd, SIOCGIFINDEX, &about) < 0) {
        return HAL_LINK_NOT_FOUND;
    }
    const int index = about.ifr_ifindex;
    if (sys->control(fd, SIOCGIFHWADDR, &about) < 0 || about.ifr_hwaddr.sa_family != ARPHRD_CAN) {
        return HAL_LINK_NOT_CAN;
    }
    if (sys->control(fd, SIOCGIFFLAGS, &about) < 0 || ((unsigned)about.ifr_flags & IFF_UP) == 0) {
        return HAL_LINK_DOWN;
    }
    if (wants_fd && (sys->control(fd, SIOCGIFMTU, &about) < 0 || about.ifr_mtu < (int)CANFD_MTU)) {
        return HAL_LINK_NO_FD;
    }
    return index;
}

int hal_can_filter(const hal_can_sys_t *sys, int fd, uint16_t rx_id) {
    const struct can_filter filter = {.can_id = rx_id,
                                      .can_mask = CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG};
    return sys->set(fd, SOL_CAN_RAW, CAN_RAW_FILTER, &filter, sizeof filter);
}
