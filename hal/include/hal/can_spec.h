// SPDX-License-Identifier: MIT
// The text form of what is on a CAN bus: IFACE[,key=value...], for the link and for the telemetry.
#ifndef HAL_CAN_SPEC_H
#define HAL_CAN_SPEC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal/gen_argus_dbc.h"

#define HAL_CAN_NAME_MAX 16 // as IFNAMSIZ, the final 0 included
#define HAL_CAN_ID_MAX 0x7FFu
#define HAL_CAN_TO_ROBOT_ID 0x640u // + robot
#define HAL_CAN_TO_HOST_ID 0x648u  // + robot
#define HAL_CAN_PADDING 0xCCu

// One end of an ISO-TP connection (ISO 15765-2, normal addressing with 11-bit ids).
typedef struct {
    char interface[HAL_CAN_NAME_MAX];
    uint8_t robot;     // 0..HAL_DBC_ROBOTS - 1
    uint16_t tx_id;    // we send with this id; default HAL_CAN_TO_ROBOT_ID + robot
    uint16_t rx_id;    // and take this one; default HAL_CAN_TO_HOST_ID + robot
    bool pads;         // short frames are filled up to 8 bytes
    uint8_t padding;   // with this
    uint8_t stmin;     // what we ask of the other end: ms between two frames, 0..127
    uint8_t blocksize; // and frames between two of our flow controls; 0: all
    bool fd;           // CAN FD frames of up to 64 bytes, with bit rate switch
} hal_can_spec_t;

// Reads IFACE[,robot=K][,tx=ID][,rx=ID][,pad=BYTE|none][,stmin=MS][,bs=N][,fd]; numbers are decimal or 0x...
// False: `message` says on one line what is wrong and what to write instead.
bool hal_can_spec_parse(hal_can_spec_t *spec, const char *text, char *message, size_t capacity);

// Reads IFACE[,robot=K] for the telemetry.
bool hal_can_spec_parse_telemetry(hal_can_spec_t *spec, const char *text, char *message, size_t capacity);

#endif
