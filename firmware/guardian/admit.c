// SPDX-License-Identifier: MIT
// Looks a command up, and reads its argument: the one place where that is done.
#include "guardian/admit.h"

#define INT_MOST 32767
#define TYPE 1
#define LOW 2
#define HIGH 3
#define INT_COUNT 4

typedef struct {
    uint8_t first;
    uint8_t last;
    uint8_t topic;
    uint8_t form;
    uint8_t answer;
} row_t;

static const row_t rows[] = {
#define ROW(first, last, topic, form, answer, meaning) \
    {ARCOS_CMD_##first, ARCOS_CMD_##last, ARGUS_TOPIC_##topic, ARGUS_FORM_##form, (answer)},
    ARGUS_CLIENT_TABLE(ROW)
#undef ROW
};

static const row_t *row_of(const uint8_t command) {
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if (command >= rows[i].first && command <= rows[i].last) {
            return &rows[i];
        }
    }
    return NULL;
}

static uint8_t byte_at(const argus_packet_t *const packet, const unsigned index) {
    return index < packet->count ? packet->data[index] : 0;
}

// The sign travels in the type. A number beyond 15 bits is one in two's complement, or none: the robot would
// turn it round.
static bool read_number(const argus_packet_t *const packet, const argus_form_t form, int32_t *const number) {
    const uint8_t type = byte_at(packet, TYPE);
    const int32_t magnitude = byte_at(packet, LOW) | byte_at(packet, HIGH) << 8;
    const bool typed = type == ARCOS_ARG_POSITIVE || type == ARCOS_ARG_NEGATIVE;
    *number = type == ARCOS_ARG_NEGATIVE ? -magnitude : magnitude;
    return packet->count <= INT_COUNT && (typed || packet->count == 1) &&
           (form == ARGUS_FORM_WORD || magnitude <= INT_MOST);
}

static bool is_string(const argus_packet_t *const packet) {
    return packet->count == 1 || (byte_at(packet, TYPE) == ARCOS_ARG_STRING &&
                                  byte_at(packet, LOW) + INT_COUNT - 1 <= packet->count);
}

static bool read_argument(const argus_packet_t *const packet, const argus_form_t form,
                          int32_t *const number) {
    *number = 0;
    switch (form) {
    case ARGUS_FORM_INT:
    case ARGUS_FORM_WORD:
        return read_number(packet, form, number);
    case ARGUS_FORM_STRING:
        return is_string(packet);
    default:
        return true;
    }
}

bool argus_admit(const argus_packet_t *const packet, argus_said_t *const said) {
    const row_t *const row = row_of(packet->data[0]);
    *said = (argus_said_t){.packet = packet, .command = packet->data[0], .topic = ARGUS_TOPIC_REFUSED};
    if (row == NULL || !read_argument(packet, (argus_form_t)row->form, &said->argument)) {
        return false;
    }
    said->topic = row->topic;
    said->cost = (uint16_t)(ARCOS_FRAME_OVERHEAD + packet->count + 2 + row->answer);
    return true;
}
