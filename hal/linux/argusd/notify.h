// SPDX-License-Identifier: MIT
// Tells systemd (Type=notify) how argusd does, over the datagram socket that NOTIFY_SOCKET names.
#ifndef ARGUSD_NOTIFY_H
#define ARGUSD_NOTIFY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "argus/argus.h"

#define NOTIFY_STATUS_MAX 256

typedef struct {
    bool on; // a service manager wants to know
    int fd;
    bool ready;
    uint32_t period_ms; // between signs of life, 0: none are wanted
    uint32_t alive_ms;  // when the last one was sent
    char status[NOTIFY_STATUS_MAX];
} notify_t;

// Takes NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID from the environment. False: they are there and of no
// use, which `message` tells; argusd runs nonetheless.
bool notify_open(notify_t *self, char *message, size_t capacity);

// Up, and about this: call it when all that the operator gave is taken, whether or not a robot is there.
void notify_ready(notify_t *self, uint32_t now_ms, const char *status);

// One line for `systemctl status`; sent when it is another than the last. `injected`: a mask of sonars whose
// fault is made for a test.
void notify_status(notify_t *self, const char *status);
void notify_robot(notify_t *self, const argus_status_t *status, uint32_t injected);

// Says that the caller is alive, when that is due; returns the ms until it is due again. Only what shows that
// work is done may call it: that is the watchdog's use.
uint32_t notify_alive(notify_t *self, uint32_t now_ms);

// On the way out: no more of the above is told.
void notify_stopping(notify_t *self);

#endif
