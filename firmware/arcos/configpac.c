// SPDX-License-Identifier: MIT
// Decodes what is used of the CONFIGpac, with 0 for what a short one lacks.
#include "arcos/configpac.h"

#include <string.h>

#define CEILINGS 11 // bytes between the three strings and NAME: 4MOTS to PWMMAX

// Offsets behind NAME.
enum {
    REARSONAR = 7, // one byte, unlike FRONTSONAR: so it is on the wire
    LOWBATTERY = 8,
    WATCHDOG = 12,
    ROTVELMAX = 23,
    TRANSVELMAX = 25,
    ROTACC = 27,
    ROTDECEL = 29,
    TRANSACC = 37,
    TRANSDECEL = 39,
    FRONTBUMPS = 47,
    REARBUMPS = 48,
    SONARCYCLE = 50,
    VERSION = 61
};

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

static uint8_t u8(const argus_packet_t *packet, size_t at) {
    return at < packet->count ? packet->data[at] : 0;
}

// Half a field at the end of a cut packet is as good as none.
static uint16_t u16(const argus_packet_t *packet, size_t at) {
    return (uint16_t)(at + 1 < packet->count ? packet->data[at] | packet->data[at + 1] << 8 : 0);
}

static void take_rest(argus_configpac_t *config, const argus_packet_t *packet, size_t from) {
    config->rear_sonar = u8(packet, from + REARSONAR) != 0;
    config->low_battery_dv = u16(packet, from + LOWBATTERY);
    config->watchdog_ms = u16(packet, from + WATCHDOG);
    config->rotvel_max_deg_s = u16(packet, from + ROTVELMAX);
    config->vel_max_mm_s = u16(packet, from + TRANSVELMAX);
    config->rotaccel_deg_s2 = u16(packet, from + ROTACC);
    config->rotdecel_deg_s2 = u16(packet, from + ROTDECEL);
    config->accel_mm_s2 = u16(packet, from + TRANSACC);
    config->decel_mm_s2 = u16(packet, from + TRANSDECEL);
    config->front_bumpers = u8(packet, from + FRONTBUMPS);
    config->rear_bumpers = u8(packet, from + REARBUMPS);
    config->sonar_cycle_ms = u8(packet, from + SONARCYCLE);
    from += VERSION;
    argus_packet_string(packet, &from, config->version);
}

bool argus_configpac_decode(argus_configpac_t *config, const argus_packet_t *packet) {
    size_t at = 1;
    memset(config, 0, sizeof *config);
    if (packet->count == 0 || packet->data[0] != ARCOS_TYPE_CONFIGPAC ||
        !argus_packet_string(packet, &at, config->robot_class) ||
        !argus_packet_string(packet, &at, config->robot_subclass) ||
        !argus_packet_string(packet, &at, config->serial)) {
        return false;
    }
    at += CEILINGS;
    if (argus_packet_string(packet, &at, config->name)) { // else what follows cannot be found
        take_rest(config, packet, at);
    }
    return true;
}
