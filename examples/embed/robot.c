// SPDX-License-Identifier: MIT
// ARCOS packets by hand: 0xFA 0xFB, count, data, checksum.
#include "robot.h"

#include <string.h>

#define SYNC2 2
#define CMD_OPEN 1
#define CMD_CLOSE 2
#define SIP_STANDING 0x32
#define SIP_MS 100
#define SONARS 16
#define DEAD 3
#define RANGE_MM 1500

static void send(robot_t *self, const uint8_t *data, size_t count) {
    uint8_t *const out = self->waiting + self->used;
    uint32_t sum = 0;
    for (size_t i = 0; i + 1 < count; i += 2) {
        sum = (sum + ((uint32_t)data[i] << 8 | data[i + 1])) & 0xFFFF;
    }
    if (count % 2 == 1) {
        sum ^= data[count - 1];
    }
    if (self->used + count + 5 > sizeof self->waiting) {
        return;
    }
    memcpy(out, (uint8_t[]){0xFA, 0xFB, (uint8_t)(count + 2)}, 3);
    memcpy(out + 3, data, count);
    out[3 + count] = (uint8_t)(sum >> 8);
    out[4 + count] = (uint8_t)sum;
    self->used += count + 5;
}

void robot_take(robot_t *self, const uint8_t *packet, size_t count) {
    static const uint8_t identity[] = "\2Robot\0Pioneer\0p3dx-sh"; // SYNC2, then three strings
    const uint8_t command = packet[3];
    (void)count;
    if (!self->open && command < SYNC2) {
        send(self, &command, 1); // SYNC0 and SYNC1 come back as they are
    } else if (!self->open && command == SYNC2) {
        send(self, identity, sizeof identity);
        self->open = -1; // what follows are commands
    } else if (command == CMD_OPEN) {
        self->open = 1;
    } else if (command == CMD_CLOSE) {
        self->open = 0;
    }
}

static void send_sip(robot_t *self) {
    uint8_t sip[] = {
        SIP_STANDING, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 127, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 0, 0, 0};
    for (size_t i = 0; i < 2; i++) {
        self->next = (uint8_t)(self->next == DEAD ? DEAD + 1 : self->next);
        sip[20 + 3 * i] = self->next;
        sip[21 + 3 * i] = (uint8_t)(RANGE_MM & 0xFF);
        sip[22 + 3 * i] = (uint8_t)(RANGE_MM >> 8);
        self->next = (uint8_t)((self->next + 1) % SONARS);
    }
    send(self, sip, sizeof sip);
}

size_t robot_give(robot_t *self, uint32_t now_ms, uint8_t *bytes, size_t capacity) {
    if (self->open > 0 && now_ms - self->sip_ms >= SIP_MS) {
        self->sip_ms = now_ms;
        send_sip(self);
    }
    const size_t count = self->used < capacity ? self->used : capacity;
    memcpy(bytes, self->waiting, count);
    memmove(self->waiting, self->waiting + count, self->used - count);
    self->used -= count;
    return count;
}
