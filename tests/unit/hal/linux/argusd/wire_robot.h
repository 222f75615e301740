// SPDX-License-Identifier: MIT
// A robot for tests: answers SYNC, sends SIPs when open, remembers which commands it got.
#ifndef TEST_WIRE_ROBOT_H
#define TEST_WIRE_ROBOT_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "arcos/frame.h"

#define ROBOT_OUT 1024

typedef struct {
    argus_parser_t parser;
    bool open;
    uint16_t reading_mm[16];
    uint8_t next;           // sonar listed next
    uint8_t vel_mm_s;       // of both wheels
    uint32_t commands[256]; // how often each came
    uint8_t last[8];        // the last commands, newest first
    uint8_t out[ROBOT_OUT]; // what it wants to send
    size_t used;
} robot_t;

static inline void robot_init(robot_t *self) {
    memset(self, 0, sizeof *self);
    argus_parser_init(&self->parser);
    for (int i = 0; i < 16; i++) {
        self->reading_mm[i] = 2000;
    }
}

static inline void robot_send(robot_t *self, const uint8_t *data, size_t count) {
    self->used += argus_frame_encode(self->out + self->used, sizeof self->out - self->used, data, count);
}

static inline void robot_obey(robot_t *self, const argus_packet_t *packet) {
    static const uint8_t identity[] = "\x02Robot\0Pioneer\0p3dx-sh";
    const uint8_t command = packet->data[0];
    self->commands[command]++;
    memmove(self->last + 1, self->last, sizeof self->last - 1);
    self->last[0] = command;
    if (self->open) {
        self->open = command != ARCOS_CMD_CLOSE;
        return;
    }
    if (command == ARCOS_SYNC_SYNC2) {
        robot_send(self, identity, sizeof identity);
    } else if (command <= ARCOS_SYNC_SYNC1 && (command == 0 || self->commands[2] == 0 || packet->count > 3)) {
        robot_send(self, packet->data, packet->count);
    }
    if (command == ARCOS_CMD_OPEN && self->commands[ARCOS_SYNC_SYNC2] > 0) {
        self->open = true;
        self->used = 0;
    }
}

static inline void robot_take(robot_t *self, uint32_t now_ms, const uint8_t *bytes, size_t count) {
    argus_packet_t packet;
    size_t taken = 0;
    while (taken < count) {
        taken += argus_parser_push(&self->parser, now_ms, bytes + taken, count - taken);
        while (argus_parser_next(&self->parser, now_ms, &packet)) {
            robot_obey(self, &packet);
        }
    }
}

// One SIP with the next five sonars.
static inline void robot_sip(robot_t *self) {
    uint8_t data[64] = {ARCOS_TYPE_SIP_STATIONARY};
    size_t at = 11;
    if (!self->open) {
        return;
    }
    data[7] = data[9] = self->vel_mm_s;
    data[at] = 127;      // decivolts
    data[at + 5] = 0x07; // motors and both sonar arrays on
    at += 8;
    data[at++] = 5;
    for (int i = 0; i < 5; i++) {
        data[at++] = self->next;
        data[at++] = (uint8_t)(self->reading_mm[self->next] & 0xFF);
        data[at++] = (uint8_t)(self->reading_mm[self->next] >> 8);
        self->next = (uint8_t)((self->next + 1) % 16);
    }
    robot_send(self, data, at);
}

#endif
