// SPDX-License-Identifier: MIT
// The standard server information packet, decoded by the length that is there (SPEC.md, SIP).
#ifndef ARGUS_SIP_H
#define ARGUS_SIP_H

#include "arcos/frame.h"

// Where a field lies in the data of a SIP: the table counts from the header, data from the type.
#define ARGUS_SIP_AT(name) (ARCOS_SIP_OFFSET_##name - ARCOS_SIP_OFFSET_TYPE)

#define ARGUS_SIP_SONARS_MAX 84 // what fits into the longest packet

typedef struct {
    uint8_t number; // 0..31 as sent; others are passed through
    uint16_t range_mm;
} argus_sip_sonar_t;

typedef struct {
    bool moving;        // type 0x33
    uint8_t battery_dv; // decivolts
    bool stall_left;
    bool stall_right;
    uint8_t bumpers_front; // bits 1..7 (a P3-DX has 1..5), bit 1 leftmost; bit 0 clear
    uint8_t bumpers_rear;  // bits 1..7, bit 1 rightmost; bit 0 clear
    uint8_t sonar_count;   // entries of `sonar` used
    bool has_anport;
    uint8_t anport; // the analog port that ADSEL has chosen
    bool has_battery_x10;
    bool has_rotvel;
    bool has_faultflags;
    uint16_t x_raw; // position, raw: 15 or 16 bits, in units of the robot's distance factor
    uint16_t y_raw;
    int16_t heading_raw; // 4096 per turn
    int16_t vel_left_mm_s;
    int16_t vel_right_mm_s;
    uint16_t flags; // ARCOS_FLAG_*
    uint16_t battery_x10_dv;
    int16_t rotvel_ddeg_s; // 0.1 deg/s, CCW positive
    uint16_t faultflags;
    argus_sip_sonar_t sonar[ARGUS_SIP_SONARS_MAX];
} argus_sip_t;

// False when the packet is no SIP (type 0x32 or 0x33) or is shorter than its own sonar count says. Tails may
// be absent at any group boundary or longer than known. `sip` is whole on true, unspecified on false. Cost:
// one pass.
bool argus_sip_decode(argus_sip_t *sip, const argus_packet_t *packet);

#endif
