// SPDX-License-Identifier: MIT
// Frames and sends what a guard port has to say.
#include "guardian/send.h"

#include <string.h>

#include "knowledge/angle.h"

#define ROOM_BYTES 320 // of the outbox: the rest is for what stops the robot
#define SETV_MM_S 750  // a robot's own, where CONFIGpac has not come
#define ACCEL_MM_S2 300
#define SETRV_DEG_S 100
#define TURN_ACCEL_DEG_S2 100

static const uint8_t streams_of[] = {ARCOS_CMD_ENCODER, ARCOS_CMD_IOREQUEST,  ARCOS_CMD_JOYREQUEST,
                                     ARCOS_CMD_GYRO,    ARCOS_CMD_IMUREQUEST, ARCOS_CMD_GRIPREQUEST};

bool argus_send_client(argus_port_t *const port, const uint8_t *const data, const size_t count) {
    const size_t total = ARCOS_FRAME_OVERHEAD + count + 2;
    if (port->out_length + total > sizeof port->out || count + 2 > ARCOS_FRAME_COUNT_MAX) {
        port->lost++;
        return false;
    }
    uint8_t *const packet = port->out + port->out_length;
    const uint16_t checksum = argus_frame_checksum(data, count);
    packet[0] = ARCOS_FRAME_HEADER0;
    packet[1] = ARCOS_FRAME_HEADER1;
    packet[2] = (uint8_t)(count + 2);
    memcpy(packet + ARCOS_FRAME_OVERHEAD, data, count);
    packet[total - 2] = (uint8_t)(checksum >> 8);
    packet[total - 1] = (uint8_t)(checksum & 0xFF);
    port->out_length = (uint16_t)(port->out_length + total);
    return true;
}

bool argus_send_robot(const argus_grant_t *const grant, const argus_packet_t *const packet) {
    argus_outbox_t *const out = grant->out;
    const size_t total = (size_t)ARCOS_FRAME_OVERHEAD + packet->count + 2;
    if (out->length + total > ROOM_BYTES) {
        return false;
    }
    return argus_outbox_packet(out, packet->data, packet->count);
}

void argus_send_note(argus_port_settings_t *const settings, const uint8_t command, const int32_t argument) {
    switch (command) {
    case ARCOS_CMD_SETV:
        settings->setv_mm_s = argus_abs(argument);
        break;
    case ARCOS_CMD_SETRV:
        settings->setrv_deg_s = argus_abs(argument);
        break;
    case ARCOS_CMD_SETA:
        *(argument < 0 ? &settings->decel_mm_s2 : &settings->accel_mm_s2) = argus_abs(argument);
        break;
    default:
        *(argument < 0 ? &settings->turn_decel_deg_s2 : &settings->turn_accel_deg_s2) = argus_abs(argument);
        break;
    }
}

// At least the given deceleration; at most the acceleration with which the robot starts, or the manager
// would, which 0 stands for: a robot may take it for both.
static int32_t limited_accel(const int32_t argument, const int32_t least_brake, const int32_t most_accel) {
    if (argument == 0) {
        return most_accel;
    }
    return argument < 0 ? argus_min(argument, -least_brake) : argus_min(argument, most_accel);
}

int32_t argus_send_limited(const argus_t *const core, const uint8_t command, const int32_t argument) {
    const argus_configpac_t *const robot = &core->session.robot; // zero until it has come
    const argus_config_t *const config = &core->config;
    switch (command) {
    case ARCOS_CMD_SETA:
        return limited_accel(argument, core->knowledge.robot->decel_mm_s2,
                             argus_max(config->accel_mm_s2, argus_max(robot->accel_mm_s2, ACCEL_MM_S2)));
    case ARCOS_CMD_SETRA:
        return limited_accel(argument, ARGUS_CLIENT_TURN_DECEL,
                             argus_max(config->turn_accel_deg_s2, TURN_ACCEL_DEG_S2));
    case ARCOS_CMD_SETRV:
        return argus_min(argus_abs(argument), ARGUS_CLIENT_TURN_DEG_S);
    case ARCOS_CMD_SETV:
        return argus_abs(argument);
    default:
        return argument;
    }
}

static void fill(int32_t *const value, const int32_t configured, const int32_t usual) {
    if (*value == 0) {
        *value = configured > 0 ? configured : usual;
    }
}

static void send_all(const argus_grant_t *const grant, const argus_port_settings_t *const settings) {
    argus_outbox_t *const out = grant->out;
    argus_outbox_int(out, ARCOS_CMD_SETV, settings->setv_mm_s);
    argus_outbox_int(out, ARCOS_CMD_SETA, settings->accel_mm_s2);
    argus_outbox_int(out, ARCOS_CMD_SETA, -settings->decel_mm_s2);
    argus_outbox_int(out, ARCOS_CMD_SETRV, settings->setrv_deg_s);
    argus_outbox_int(out, ARCOS_CMD_SETRA, settings->turn_accel_deg_s2);
    argus_outbox_int(out, ARCOS_CMD_SETRA, -settings->turn_decel_deg_s2);
}

void argus_send_settings(const argus_grant_t *const grant, argus_port_settings_t *const settings) {
    const argus_configpac_t *const robot = &grant->core->session.robot; // zero until it has come
    fill(&settings->setv_mm_s, robot->vel_max_mm_s, SETV_MM_S);
    fill(&settings->accel_mm_s2, robot->accel_mm_s2, ACCEL_MM_S2);
    fill(&settings->decel_mm_s2, robot->decel_mm_s2, ACCEL_MM_S2);
    fill(&settings->setrv_deg_s, robot->rotvel_max_deg_s, SETRV_DEG_S);
    fill(&settings->turn_accel_deg_s2, 0, TURN_ACCEL_DEG_S2);
    fill(&settings->turn_decel_deg_s2, 0, TURN_ACCEL_DEG_S2);
    settings->decel_mm_s2 = -argus_send_limited(grant->core, ARCOS_CMD_SETA, -settings->decel_mm_s2);
    settings->setrv_deg_s = argus_send_limited(grant->core, ARCOS_CMD_SETRV, settings->setrv_deg_s);
    send_all(grant, settings);
}

void argus_send_own_settings(const argus_grant_t *const grant) {
    const argus_config_t *const config = &grant->core->config;
    const argus_port_settings_t own = {.setv_mm_s = config->speed_mm_s,
                                       .accel_mm_s2 = config->accel_mm_s2,
                                       .decel_mm_s2 = config->decel_mm_s2,
                                       .setrv_deg_s = config->turn_speed_deg_s,
                                       .turn_accel_deg_s2 = config->turn_accel_deg_s2,
                                       .turn_decel_deg_s2 = config->turn_accel_deg_s2};
    send_all(grant, &own);
    grant->motion->speed_mm_s = config->speed_mm_s;
}

uint8_t argus_send_stream(const uint8_t command, const int32_t argument) {
    for (size_t i = 0; i < sizeof streams_of; i++) {
        if (streams_of[i] == command && argument != 0) {
            return (uint8_t)(1u << i);
        }
    }
    return 0;
}

void argus_send_streams_off(const argus_grant_t *const grant, const uint8_t streams) {
    for (size_t i = 0; i < sizeof streams_of; i++) {
        if ((streams >> i & 1u) != 0) {
            argus_outbox_int(grant->out, streams_of[i], 0);
        }
    }
}
