// SPDX-License-Identifier: MIT
// Packets of a guard port, to the robot and to the client.
#ifndef ARGUS_SEND_H
#define ARGUS_SEND_H

#include "guardian/client.h"

// To the client; false, and counted, when it has no room. At most ARCOS_FRAME_COUNT_MAX - 2 bytes of data.
bool argus_send_client(argus_port_t *port, const uint8_t *data, size_t count);

// To the robot as it is; false: what waits for it leaves no room.
bool argus_send_robot(const argus_grant_t *grant, const argus_packet_t *packet);

// A run-time parameter of the client as it passes: S5 and S7 count on the brakes and the speed of a turn.
int32_t argus_send_limited(const argus_t *core, uint8_t command, int32_t argument);

// All of them, kept as they pass: what the client has said, and 0 as CONFIGpac tells, is filled in and sent;
// and the manager's own again.
void argus_send_note(argus_port_settings_t *settings, uint8_t command, int32_t argument);
void argus_send_settings(const argus_grant_t *grant, argus_port_settings_t *settings);
void argus_send_own_settings(const argus_grant_t *grant);

// The bit of a stream of packets that a command begins, 0: of none. All of these end.
uint8_t argus_send_stream(uint8_t command, int32_t argument);
void argus_send_streams_off(const argus_grant_t *grant, uint8_t streams);

#endif
