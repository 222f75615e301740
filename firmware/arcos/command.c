// SPDX-License-Identifier: MIT
// Builds client commands and keeps them in order until they are sent.
#include "arcos/command.h"

#include <string.h>

#define ARGUMENT_MAX 32767
#define STRING_MAX 190
#define STRING_HEAD 3 // command, type, length
#define PLAIN_TOTAL (ARCOS_FRAME_OVERHEAD + 1 + 2)
#define INT_TOTAL (ARCOS_FRAME_OVERHEAD + 4 + 2)
#define COMMAND_OFFSET ARCOS_FRAME_OVERHEAD

size_t argus_command_plain(uint8_t *packet, size_t capacity, uint8_t command) {
    return argus_frame_encode(packet, capacity, &command, 1);
}

static uint16_t magnitude(int32_t argument) {
    if (argument > ARGUMENT_MAX || argument < -ARGUMENT_MAX) {
        return ARGUMENT_MAX;
    }
    return (uint16_t)(argument < 0 ? -argument : argument);
}

size_t argus_command_int(uint8_t *packet, size_t capacity, uint8_t command, int32_t argument) {
    const uint16_t value = magnitude(argument);
    const uint8_t data[] = {command, argument < 0 ? ARCOS_ARG_NEGATIVE : ARCOS_ARG_POSITIVE,
                            (uint8_t)(value & 0xFF), (uint8_t)(value >> 8)};
    return argus_frame_encode(packet, capacity, data, sizeof data);
}

size_t argus_command_string(uint8_t *packet, size_t capacity, uint8_t command, const uint8_t *text,
                            size_t count) {
    if (count > STRING_MAX || capacity < ARCOS_FRAME_OVERHEAD + STRING_HEAD + count) {
        return 0;
    }
    uint8_t *const data = packet + ARCOS_FRAME_OVERHEAD;
    data[0] = command;
    data[1] = ARCOS_ARG_STRING;
    data[2] = (uint8_t)count;
    if (count > 0) {
        memcpy(data + STRING_HEAD, text, count);
    }
    return argus_frame_seal(packet, capacity, STRING_HEAD + count);
}

void argus_outbox_clear(argus_outbox_t *self) {
    self->head = 0;
    self->length = 0;
}

static size_t ring(size_t index) {
    return index % ARGUS_OUTBOX_BYTES;
}

static uint8_t byte_at(const argus_outbox_t *self, size_t offset) {
    return self->bytes[ring(self->head + offset)];
}

static size_t packet_total(const argus_outbox_t *self, size_t offset) {
    return (size_t)byte_at(self, offset + 2) + ARCOS_FRAME_OVERHEAD;
}

static void store(argus_outbox_t *self, size_t offset, const uint8_t *packet, size_t total) {
    for (size_t i = 0; i < total; i++) {
        self->bytes[ring(self->head + offset + i)] = packet[i];
    }
}

static bool put(argus_outbox_t *self, const uint8_t *packet, size_t total) {
    if (total == 0 || self->length + total > ARGUS_OUTBOX_BYTES - ARGUS_OUTBOX_RESERVE) {
        self->refused++;
        return false;
    }
    store(self, self->length, packet, total);
    self->length = (uint16_t)(self->length + total);
    return true;
}

bool argus_outbox_plain(argus_outbox_t *self, uint8_t command) {
    uint8_t packet[PLAIN_TOTAL];
    return put(self, packet, argus_command_plain(packet, sizeof packet, command));
}

bool argus_outbox_int(argus_outbox_t *self, uint8_t command, int32_t argument) {
    uint8_t packet[INT_TOTAL];
    return put(self, packet, argus_command_int(packet, sizeof packet, command, argument));
}

bool argus_outbox_string(argus_outbox_t *self, uint8_t command, const uint8_t *text, size_t count) {
    uint8_t packet[ARCOS_FRAME_SEND_TOTAL_MAX];
    return put(self, packet, argus_command_string(packet, sizeof packet, command, text, count));
}

bool argus_outbox_packet(argus_outbox_t *self, const uint8_t *data, size_t count) {
    uint8_t packet[ARCOS_FRAME_SEND_TOTAL_MAX];
    return put(self, packet, argus_frame_encode(packet, sizeof packet, data, count));
}

static bool is_motion(uint8_t command) {
    static const uint8_t motion[] = {ARCOS_CMD_MOVE,   ARCOS_CMD_VEL,  ARCOS_CMD_VEL2,  ARCOS_CMD_RVEL,
                                     ARCOS_CMD_ROTATE, ARCOS_CMD_HEAD, ARCOS_CMD_DHEAD, ARCOS_CMD_DCHEAD};
    for (size_t i = 0; i < sizeof motion; i++) {
        if (motion[i] == command) {
            return true;
        }
    }
    return false;
}

static void keep(argus_outbox_t *self, size_t to, size_t from, size_t total) {
    for (size_t i = 0; i < total; i++) {
        self->bytes[ring(self->head + to + i)] = byte_at(self, from + i);
    }
}

static void drop_motion_and(argus_outbox_t *self, uint8_t command) {
    size_t kept = 0;
    size_t total = 0;
    for (size_t at = 0; at < self->length; at += total) {
        const uint8_t waiting = byte_at(self, at + COMMAND_OFFSET);
        total = packet_total(self, at);
        if (!is_motion(waiting) && waiting != command) {
            keep(self, kept, at, total);
            kept += total;
        }
    }
    self->length = (uint16_t)kept;
}

void argus_outbox_drop_motion(argus_outbox_t *self) {
    drop_motion_and(self, ARCOS_CMD_MOVE);
}

void argus_outbox_urgent(argus_outbox_t *self, uint8_t command) {
    uint8_t packet[ARGUS_OUTBOX_RESERVE];
    const size_t total = argus_command_plain(packet, sizeof packet, command);
    drop_motion_and(self, command);
    if (self->length + total > ARGUS_OUTBOX_BYTES) {
        self->refused++; // only when called with other commands than the two it is for
        return;
    }
    self->head = (uint16_t)ring(self->head + ARGUS_OUTBOX_BYTES - total);
    self->length = (uint16_t)(self->length + total);
    store(self, 0, packet, total);
}

int argus_outbox_first(const argus_outbox_t *self) {
    return self->length > 0 ? byte_at(self, COMMAND_OFFSET) : -1;
}

size_t argus_outbox_fetch(argus_outbox_t *self, uint8_t *packet, size_t capacity) {
    const size_t total = self->length > 0 ? packet_total(self, 0) : 0;
    if (total == 0 || total > capacity) {
        return 0;
    }
    for (size_t i = 0; i < total; i++) {
        packet[i] = byte_at(self, i);
    }
    self->head = (uint16_t)ring(self->head + total);
    self->length = (uint16_t)(self->length - total);
    self->sent++;
    return total;
}
