// SPDX-License-Identifier: MIT
// Keeps what the client's commands ask for.
#include "guardian/wish.h"

#include "knowledge/angle.h"

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

void argus_wish_take(argus_wish_t *const self, const argus_said_t *const said, const uint32_t odometer_mm,
                     const int32_t raw_deg) {
    if (said->topic == ARGUS_TOPIC_BOTH) {
        take_pair(self, said->argument);
        return;
    }
    part(self);
    if (said->command == ARCOS_CMD_VEL) {
        self->way = said->argument != 0 ? ARGUS_WISH_VEL : ARGUS_WISH_REST;
        self->mm_s = said->argument;
    } else if (said->command == ARCOS_CMD_MOVE) {
        self->way = ARGUS_WISH_MOVE;
        self->left_mm = said->argument;
        self->odometer_mm = odometer_mm;
    } else {
        take_turn(self, said->command, said->argument, raw_deg);
    }
}

bool argus_wish_moves(const argus_said_t *const said) {
    return said->command == ARCOS_CMD_HEAD || said->argument != 0;
}
