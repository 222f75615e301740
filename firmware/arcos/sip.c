// SPDX-License-Identifier: MIT
// Decodes the standard SIP, whichever of its tail groups are there.
#include "arcos/sip.h"

#include "argus/argus.h"

#define AFTER_SONAR(name) ((size_t)ARCOS_SIP_AFTER_SONAR_##name)

static uint16_t u16_at(const uint8_t *data, size_t offset) {
    return argus_u16_at(data + offset);
}

static int16_t i16_at(const uint8_t *data, size_t offset) {
    const int32_t value = u16_at(data, offset);
    return (int16_t)(value < 0x8000 ? value : value - 0x10000);
}

static void decode_fixed(argus_sip_t *sip, const uint8_t *data) {
    const uint8_t left = data[ARGUS_SIP_AT(STALL_LEFT)];
    const uint8_t right = data[ARGUS_SIP_AT(STALL_RIGHT)];
    sip->moving = data[0] == ARCOS_TYPE_SIP_MOVING;
    sip->x_raw = u16_at(data, ARGUS_SIP_AT(X));
    sip->y_raw = u16_at(data, ARGUS_SIP_AT(Y));
    sip->heading_raw = i16_at(data, ARGUS_SIP_AT(TH));
    sip->vel_left_mm_s = i16_at(data, ARGUS_SIP_AT(L_VEL));
    sip->vel_right_mm_s = i16_at(data, ARGUS_SIP_AT(R_VEL));
    sip->battery_dv = data[ARGUS_SIP_AT(BATTERY)];
    sip->stall_left = (left & ARCOS_SIP_STALL_BIT) != 0;
    sip->stall_right = (right & ARCOS_SIP_STALL_BIT) != 0;
    sip->bumpers_rear = left & ARCOS_SIP_BUMPER_MASK;
    sip->bumpers_front = right & ARCOS_SIP_BUMPER_MASK;
    sip->flags = u16_at(data, ARGUS_SIP_AT(FLAGS));
}

static void decode_sonar(argus_sip_t *sip, const uint8_t *data) {
    ARGUS_ASSERT(sip->sonar_count <= sizeof sip->sonar / sizeof sip->sonar[0]);
    for (size_t i = 0; i < sip->sonar_count; i++) {
        const uint8_t *reading = data + i * ARCOS_SIP_SONAR_BYTES;
        sip->sonar[i].number = reading[0];
        sip->sonar[i].range_mm = u16_at(reading, 1);
    }
}

static void decode_tail(argus_sip_t *sip, const uint8_t *tail, size_t count) {
    sip->has_anport = count >= AFTER_SONAR(ANPORT) + 1;
    sip->anport = sip->has_anport ? tail[AFTER_SONAR(ANPORT)] : 0;
    sip->has_battery_x10 = count >= AFTER_SONAR(BATTERYX10) + 2;
    sip->battery_x10_dv = sip->has_battery_x10 ? u16_at(tail, AFTER_SONAR(BATTERYX10)) : 0;
    sip->has_rotvel = count >= AFTER_SONAR(ROTVEL) + 2;
    sip->rotvel_ddeg_s = sip->has_rotvel ? i16_at(tail, AFTER_SONAR(ROTVEL)) : 0;
    sip->has_faultflags = count >= AFTER_SONAR(FAULTFLAGS) + 2;
    sip->faultflags = sip->has_faultflags ? u16_at(tail, AFTER_SONAR(FAULTFLAGS)) : 0;
}

bool argus_sip_decode(argus_sip_t *sip, const argus_packet_t *packet) {
    const uint8_t *data = packet->data;
    const size_t sonar_offset = ARGUS_SIP_AT(SONAR);
    if (packet->count < sonar_offset ||
        (data[0] != ARCOS_TYPE_SIP_STATIONARY && data[0] != ARCOS_TYPE_SIP_MOVING)) {
        return false;
    }
    sip->sonar_count = data[ARGUS_SIP_AT(SONAR_COUNT)];
    const size_t tail_offset = sonar_offset + (size_t)sip->sonar_count * ARCOS_SIP_SONAR_BYTES;
    if (tail_offset > packet->count) {
        return false;
    }
    decode_fixed(sip, data);
    decode_sonar(sip, data + sonar_offset);
    decode_tail(sip, data + tail_offset, packet->count - tail_offset);
    return true;
}
