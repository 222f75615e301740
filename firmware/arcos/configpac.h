// SPDX-License-Identifier: MIT
// CONFIGpac: what the robot says about itself (SPEC.md, CONFIGpac).
#ifndef ARGUS_CONFIGPAC_H
#define ARGUS_CONFIGPAC_H

#include "arcos/frame.h"
#include "argus/argus.h"

// What Argus uses of it. Fields missing at the end of a short packet read as 0.
typedef struct {
    uint8_t sonar_cycle_ms;
    bool rear_sonar;
    uint16_t low_battery_dv;
    uint16_t watchdog_ms;
    uint16_t rotvel_max_deg_s;
    uint16_t rotaccel_deg_s2;
    uint16_t rotdecel_deg_s2;
    uint16_t vel_max_mm_s;
    uint16_t accel_mm_s2;
    uint16_t decel_mm_s2;
    uint8_t front_bumpers; // segments
    uint8_t rear_bumpers;
    char robot_class[ARGUS_NAME_MAX];
    char robot_subclass[ARGUS_NAME_MAX];
    char serial[ARGUS_NAME_MAX];
    char name[ARGUS_NAME_MAX];
    char version[ARGUS_NAME_MAX];
} argus_configpac_t;

// False when the type is not 0x20 or the packet ends inside its first three strings.
bool argus_configpac_decode(argus_configpac_t *config, const argus_packet_t *packet);

// Copies a NUL-terminated string out of a packet from `*offset`, cut to ARGUS_NAME_MAX - 1, unprintable bytes
// as '?', and moves `*offset` behind its NUL. False when there is no NUL left.
bool argus_packet_string(const argus_packet_t *packet, size_t *offset, char out[ARGUS_NAME_MAX]);

#endif
