// SPDX-License-Identifier: MIT
// Reads the client's commands.
#include "guardian/wish.h"

#include "knowledge/angle.h"

typedef struct {
    uint8_t command;
    uint8_t topic;
} row_t;

argus_topic_t argus_topic(const uint8_t command) {
    static const row_t rows[] = {
        {ARCOS_CMD_PULSE, ARGUS_TOPIC_SESSION},
        {ARCOS_CMD_OPEN, ARGUS_TOPIC_SESSION},
        {ARCOS_CMD_CLOSE, ARGUS_TOPIC_SESSION},
        {ARCOS_CMD_RESET, ARGUS_TOPIC_SESSION},
        {ARCOS_CMD_VEL, ARGUS_TOPIC_WAY},
        {ARCOS_CMD_MOVE, ARGUS_TOPIC_WAY},
        {ARCOS_CMD_RVEL, ARGUS_TOPIC_TURN},
        {ARCOS_CMD_ROTATE, ARGUS_TOPIC_TURN},
        {ARCOS_CMD_HEAD, ARGUS_TOPIC_TURN},
        {ARCOS_CMD_DHEAD, ARGUS_TOPIC_TURN},
        {ARCOS_CMD_DCHEAD, ARGUS_TOPIC_TURN},
        {ARCOS_CMD_VEL2, ARGUS_TOPIC_BOTH},
        {ARCOS_CMD_STOP, ARGUS_TOPIC_STOP},
        {ARCOS_CMD_E_STOP, ARGUS_TOPIC_STOP},
        {ARCOS_CMD_QSTOP, ARGUS_TOPIC_STOP},
        {ARCOS_CMD_ENABLE, ARGUS_TOPIC_ENABLE},
        {ARCOS_CMD_SETV, ARGUS_TOPIC_SETTING},
        {ARCOS_CMD_SETA, ARGUS_TOPIC_SETTING},
        {ARCOS_CMD_SETRV, ARGUS_TOPIC_SETTING},
        {ARCOS_CMD_SETRA, ARGUS_TOPIC_SETTING},
        {ARCOS_CMD_SETO, ARGUS_TOPIC_ORIGIN},
        {ARCOS_CMD_SONAR, ARGUS_TOPIC_SONAR},
        {ARCOS_CMD_ENCODER, ARGUS_TOPIC_STREAM},
        {ARCOS_CMD_IOREQUEST, ARGUS_TOPIC_STREAM},
        {ARCOS_CMD_JOYREQUEST, ARGUS_TOPIC_STREAM},
        {ARCOS_CMD_GYRO, ARGUS_TOPIC_STREAM},
        {ARCOS_CMD_GRIPREQUEST, ARGUS_TOPIC_STREAM},
        {ARCOS_CMD_IMUREQUEST, ARGUS_TOPIC_STREAM},
        {ARCOS_CMD_POLLING, ARGUS_TOPIC_KEPT},
        {ARCOS_CMD_SONAR_CYCLE, ARGUS_TOPIC_KEPT},
        {ARCOS_CMD_HOSTBAUD, ARGUS_TOPIC_KEPT},
        {ARCOS_CMD_MAINTENANCE, ARGUS_TOPIC_KEPT},
        {ARCOS_CMD_LATVEL, ARGUS_TOPIC_KEPT},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if (rows[i].command == command) {
            return (argus_topic_t)rows[i].topic;
        }
    }
    return ARGUS_TOPIC_OTHER;
}

static uint8_t byte_at(const argus_packet_t *const packet, const unsigned index) {
    return index < packet->count ? packet->data[index] : 0;
}

int32_t argus_wish_argument(const argus_packet_t *const packet) {
    const int32_t magnitude = byte_at(packet, 2) | byte_at(packet, 3) << 8;
    return byte_at(packet, 1) == ARCOS_ARG_NEGATIVE ? -magnitude : magnitude;
}

static int32_t signed_byte(const uint32_t byte) {
    return (int32_t)(byte & 0xFFu) - ((byte & 0x80u) != 0 ? 0x100 : 0);
}

// Low byte right, high byte left.
static void take_pair(argus_wish_t *const self, const int32_t argument) {
    const uint32_t word = (uint32_t)argument & 0xFFFFu;
    const int32_t right_mm_s = signed_byte(word) * ARGUS_VEL2_UNIT_MM_S;
    const int32_t left_mm_s = signed_byte(word >> 8) * ARGUS_VEL2_UNIT_MM_S;
    self->way = ARGUS_WISH_VEL;
    self->turn = ARGUS_WISH_STRAIGHT;
    self->paired = true;
    self->mm_s = (left_mm_s + right_mm_s) / 2;
    self->half_mm_s = (right_mm_s - left_mm_s) / 2;
}

static void take_heading(argus_wish_t *const self, const int32_t degrees) {
    self->turn = ARGUS_WISH_HEAD;
    self->heading_deg = argus_angle_wrap(degrees % 360 * 100) / 100;
    self->heading_taken = true;
}

static void take_turn(argus_wish_t *const self, const uint8_t command, const int32_t argument,
                      const int32_t raw_deg) {
    switch (command) {
    case ARCOS_CMD_HEAD:
        take_heading(self, argument);
        break;
    case ARCOS_CMD_DHEAD:
        take_heading(self, raw_deg + argument);
        break;
    case ARCOS_CMD_DCHEAD:
        take_heading(self, (self->heading_taken ? self->heading_deg : raw_deg) + argument);
        break;
    default:
        self->turn = argument != 0 ? ARGUS_WISH_RVEL : ARGUS_WISH_STRAIGHT;
        self->deg_s = argument;
        self->heading_taken = false;
        break;
    }
}

// Of what VEL2 asked for, what the next command does not change goes on.
static void part(argus_wish_t *const self) {
    self->paired = false;
    self->half_mm_s = 0;
}

void argus_wish_take(argus_wish_t *const self, const argus_packet_t *const packet, const uint32_t odometer_mm,
                     const int32_t raw_deg) {
    const uint8_t command = packet->data[0];
    const int32_t argument = argus_wish_argument(packet);
    if (command == ARCOS_CMD_VEL2) {
        take_pair(self, argument);
        return;
    }
    part(self);
    if (command == ARCOS_CMD_VEL) {
        self->way = argument != 0 ? ARGUS_WISH_VEL : ARGUS_WISH_REST;
        self->mm_s = argument;
    } else if (command == ARCOS_CMD_MOVE) {
        self->way = ARGUS_WISH_MOVE;
        self->left_mm = argument;
        self->odometer_mm = odometer_mm;
    } else {
        take_turn(self, command, argument, raw_deg);
    }
}

bool argus_wish_moves(const argus_packet_t *const packet) {
    const uint8_t command = packet->data[0];
    return command == ARCOS_CMD_HEAD || argus_wish_argument(packet) != 0;
}
