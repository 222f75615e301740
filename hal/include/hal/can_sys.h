// SPDX-License-Identifier: MIT
// What the CAN parts ask of the system, so that a test can be a kernel without CAN, or a bus that fails.
#ifndef HAL_CAN_SYS_H
#define HAL_CAN_SYS_H

#include <linux/can.h>
#include <net/if.h>
#include <stdint.h>
#include <sys/types.h>

#include "hal/link.h"

// Each returns -errno when it fails.
typedef struct {
    int (*socket)(int type, int protocol); // PF_CAN, non-blocking, closed on exec
    int (*control)(int fd, unsigned long request, struct ifreq *about);
    int (*set)(int fd, int level, int option, const void *value, uint32_t length);
    int (*bind)(int fd, const struct sockaddr_can *address);
    ssize_t (*send)(int fd, const void *bytes, size_t count);
    ssize_t (*recv)(int fd, void *bytes, size_t capacity);
    int (*close)(int fd);
} hal_can_sys_t;

extern const hal_can_sys_t hal_can_sys;

// Index of a CAN interface that is up, or a negative link error: NOT_FOUND, NOT_CAN, DOWN or NO_FD. NO_FD:
// `wants_fd` is set and the interface is not set up for CAN FD.
int hal_can_interface(const hal_can_sys_t *sys, int fd, const char *name, int wants_fd);

// Lets a CAN_RAW socket hear data frames with this 11-bit id alone: others of the same number are no orders.
// -errno when it fails.
int hal_can_filter(const hal_can_sys_t *sys, int fd, uint16_t rx_id);

// The link error that -errno of socket() or bind() means.
hal_link_error_t hal_can_error_of(int negative_errno);

#endif
