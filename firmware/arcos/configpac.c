// SPDX-License-Identifier: MIT
// Decodes the CONFIGpac, field after field, with 0 for what a short one lacks.
#include "arcos/configpac.h"

#include <string.h>

typedef struct {
    const argus_packet_t *packet;
    size_t offset;
} cursor_t;

static uint8_t printable(uint8_t byte) {
    return byte >= 0x20 && byte < 0x7F ? byte : (uint8_t)'?';
}

bool argus_packet_string(const argus_packet_t *packet, size_t *offset, char out[ARGUS_NAME_MAX]) {
    size_t length = 0;
    for (size_t at = *offset; at < packet->count; at++) {
        if (packet->data[at] == 0) {
            out[length] = '\0';
            *offset = at + 1;
            return true;
        }
        if (length < ARGUS_NAME_MAX - 1) {
            out[length++] = (char)printable(packet->data[at]);
        }
    }
    out[0] = '\0';
    return false;
}

static uint8_t take_u8(cursor_t *cursor) {
    const size_t at = cursor->offset++;
    return at < cursor->packet->count ? cursor->packet->data[at] : 0;
}

// Half a field at the end of a cut packet is as good as none.
static uint16_t take_u16(cursor_t *cursor) {
    const size_t at = cursor->offset;
    cursor->offset += 2;
    if (cursor->offset > cursor->packet->count) {
        return 0;
    }
    return (uint16_t)(cursor->packet->data[at] | cursor->packet->data[at + 1] << 8);
}

static bool take_string(cursor_t *cursor, char out[ARGUS_NAME_MAX]) {
    return argus_packet_string(cursor->packet, &cursor->offset, out);
}

static void pass(cursor_t *cursor, size_t bytes) {
    cursor->offset += bytes;
}

static bool take_identity(argus_configpac_t *config, cursor_t *cursor) {
    return take_string(cursor, config->robot_class) && take_string(cursor, config->robot_subclass) &&
           take_string(cursor, config->serial);
}

static void take_ceilings(argus_configpac_t *config, cursor_t *cursor) {
    pass(cursor, 1); // 4MOTS
    config->rotvel_top_deg_s = take_u16(cursor);
    config->vel_top_mm_s = take_u16(cursor);
    config->rotaccel_top_deg_s2 = take_u16(cursor);
    config->accel_top_mm_s2 = take_u16(cursor);
    pass(cursor, 2); // PWMMAX
}

static void take_equipment(argus_configpac_t *config, cursor_t *cursor) {
    config->sip_cycle_ms = take_u8(cursor);
    config->host_baud = take_u8(cursor);
    pass(cursor, 1 + 2); // AUX1BAUD, GRIPPER
    config->front_sonar = take_u16(cursor) != 0;
    config->rear_sonar = take_u8(cursor) != 0; // one byte, unlike FRONTSONAR: so it is on the wire
    config->low_battery_dv = take_u16(cursor);
    pass(cursor, 2); // REVCOUNT
    config->watchdog_ms = take_u16(cursor);
}

static void take_motion(argus_configpac_t *config, cursor_t *cursor) {
    pass(cursor, 1 + 2 + 2 + 2 + 2); // P2MPACS, STALLVAL, STALLCOUNT, JOYVEL, JOYRVEL
    config->rotvel_max_deg_s = take_u16(cursor);
    config->vel_max_mm_s = take_u16(cursor);
    pass(cursor, 2 + 2 + 3 * 2); // ROTACC, ROTDECEL, ROTKP, ROTKV, ROTKI
    config->accel_mm_s2 = take_u16(cursor);
    config->decel_mm_s2 = take_u16(cursor);
    pass(cursor, 3 * 2); // TRANSKP, TRANSKV, TRANSKI
}

static void take_rest(argus_configpac_t *config, cursor_t *cursor) {
    config->front_bumpers = take_u8(cursor);
    config->rear_bumpers = take_u8(cursor);
    pass(cursor, 1); // CHARGER
    config->sonar_cycle_ms = take_u8(cursor);
    config->auto_baud = take_u8(cursor);
    pass(cursor, 1 + 2 + 1 + 1 + 2 + 2); // HASGYRO, DRIFTFACTOR, AUX2BAUD, AUX3BAUD, TICKSMM, SHUTDOWNVOLTS
    config->complete = take_string(cursor, config->version);
}

bool argus_configpac_decode(argus_configpac_t *config, const argus_packet_t *packet) {
    cursor_t cursor = {packet, 1};
    memset(config, 0, sizeof *config);
    if (packet->count == 0 || packet->data[0] != ARCOS_TYPE_CONFIGPAC || !take_identity(config, &cursor)) {
        return false;
    }
    take_ceilings(config, &cursor);
    if (!take_string(&cursor, config->name)) {
        return true; // cut inside NAME: what follows cannot be found
    }
    take_equipment(config, &cursor);
    take_motion(config, &cursor);
    take_rest(config, &cursor);
    return true;
}
