// SPDX-License-Identifier: MIT
// A client at a guard port, for the tests: says commands, keeps what comes back.
#ifndef TEST_CLIENT_H
#define TEST_CLIENT_H

#include "guardian/client.h"
#include "robot.h"

typedef struct {
    robot_t *robot;
    argus_port_storage_t storage;
    argus_readings_t readings;
    bool there;
    size_t room; // that it takes at a time, 0: all
    argus_parser_t parser;
    uint32_t packets;  // that came
    uint32_t sips;     // ... of these
    argus_sip_t sip;   // the last one
    uint8_t data[256]; // of the last packet that is no SIP
    size_t count;
    uint32_t others;
} client_t;

// Sits at the robot's port from now on: one at a time.
void client_init(client_t *client, robot_t *robot);
argus_port_t *client_port(client_t *client);
void client_bytes(client_t *client, const uint8_t *bytes, size_t count); // as they are
void client_plain(client_t *client, uint8_t command);
void client_say(client_t *client, uint8_t command, int32_t argument);
void client_open(client_t *client);                          // the three SYNCs, OPEN, ENABLE 1
void client_leave(client_t *client);                         // its connection closes
void client_run(client_t *client, uint32_t ms, bool pulses); // time passes; a PULSE each 500 ms

#endif
