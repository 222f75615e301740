// SPDX-License-Identifier: MIT
// The other end of the link: a robot that stands still, in as few lines as ARCOS allows. Its sonar 3 is
// dead.
#ifndef EMBED_ROBOT_H
#define EMBED_ROBOT_H

#include <stddef.h>
#include <stdint.h>

typedef struct {
    uint8_t waiting[512]; // bytes for the manager
    size_t used;
    uint32_t sip_ms;
    uint8_t next; // sonar of the next SIP
    int open;
} robot_t;

// Takes one packet of the manager.
void robot_take(robot_t *self, const uint8_t *packet, size_t count);

// What has arrived at the manager by now.
size_t robot_give(robot_t *self, uint32_t now_ms, uint8_t *bytes, size_t capacity);

#endif
