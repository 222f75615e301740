// SPDX-License-Identifier: MIT
// What is kept of the client of a guard port: its session, its wishes, what waits for it.
#ifndef ARGUS_CLIENT_H
#define ARGUS_CLIENT_H

#include "guardian/hold.h"
#include "guardian/limit.h"
#include "guardian/rewrite.h"

#define ARGUS_PORT_OUT 1024 // bytes that wait for the client: some ten SIPs

typedef enum {
    ARGUS_PORT_WAIT,  // for SYNC0
    ARGUS_PORT_SYNC0, // which was answered, and so on
    ARGUS_PORT_SYNC1,
    ARGUS_PORT_SYNC2,
    ARGUS_PORT_OPEN // SIPs pass
} argus_port_phase_t;

typedef enum {
    ARGUS_PORT_MOTORS_AS_THEY_ARE,
    ARGUS_PORT_MOTORS_ON,
    ARGUS_PORT_MOTORS_OFF
} argus_port_motors_t;

// Run-time parameters of the robot, each 0: not said yet.
typedef struct {
    int32_t setv_mm_s;
    int32_t accel_mm_s2;
    int32_t decel_mm_s2;
    int32_t setrv_deg_s;
    int32_t turn_accel_deg_s2;
    int32_t turn_decel_deg_s2;
} argus_port_settings_t;

// All zero: no client was ever there.
typedef struct {
    argus_parser_t from_client;
    argus_parser_t from_robot;
    uint8_t out[ARGUS_PORT_OUT];
    uint16_t out_length;
    uint8_t phase; // argus_port_phase_t
    bool there;
    bool drives;  // it has commanded a motion, and the manager has none of its own
    bool denied;  // an operator took the robot from it: until its next session
    bool stayed;  // an operator's stop holds
    bool parting; // it is gone: the motors are cut at rest
    bool origin;  // it has sent SETO; SIPs since
    uint8_t origin_sips;
    uint8_t arrays;  // of sonars that it wants
    uint8_t streams; // that it asked for, in the order of the table in send.c
    uint8_t motors;  // ENABLE that is due, argus_port_motors_t
    argus_analog_t analog;
    uint8_t stopped; // the STOP or E_STOP that was sent, and nothing since
    argus_port_settings_t settings;
    argus_hold_client_t hold;
    argus_limit_t limit;
    uint32_t heard_ms; // the last packet of it
    uint32_t parted_ms;
    uint32_t packets; // of it, in this session
    uint32_t sips;    // to it; monotonic, like what follows
    uint32_t lost;    // packets that it had no room for
    uint32_t refused; // commands that ended at the manager
} argus_port_t;

#endif
