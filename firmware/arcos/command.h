// SPDX-License-Identifier: MIT
// Client commands as ARCOS packets, and the queue they wait in (SPEC.md, Commands).
#ifndef ARGUS_COMMAND_H
#define ARGUS_COMMAND_H

#include "arcos/frame.h"

// Each returns the packet's length, or 0 when it does not fit `capacity`.
size_t argus_command_plain(uint8_t *packet, size_t capacity, uint8_t command);
// `argument` is limited to -32767..32767; its sign travels in the argument type, not in two's complement.
size_t argus_command_int(uint8_t *packet, size_t capacity, uint8_t command, int32_t argument);
// A string with its length byte and no NUL; at most 190 bytes.
size_t argus_command_string(uint8_t *packet, size_t capacity, uint8_t command, const uint8_t *text,
                            size_t count);

#define ARGUS_OUTBOX_BYTES 512
#define ARGUS_OUTBOX_RESERVE 16 // kept free for STOP and E_STOP, which are therefore never refused

// Whole packets, first in first out. STOP and E_STOP overtake: they go first and drop every waiting motion
// command.
typedef struct {
    uint16_t head;                     // where the next packet starts
    uint16_t length;                   // bytes waiting
    uint32_t sent;                     // packets fetched, monotonic
    uint32_t refused;                  // packets that did not fit, monotonic
    uint8_t bytes[ARGUS_OUTBOX_BYTES]; // a ring
} argus_outbox_t;

// Drops what waits; the counters go on.
void argus_outbox_clear(argus_outbox_t *self);
// Drops waiting MOVE, VEL, VEL2, RVEL, ROTATE, HEAD, DHEAD, DCHEAD.
void argus_outbox_drop_motion(argus_outbox_t *self);
// False (and counted) when the packet does not fit; the queue is unchanged then.
bool argus_outbox_plain(argus_outbox_t *self, uint8_t command);
bool argus_outbox_int(argus_outbox_t *self, uint8_t command, int32_t argument);
bool argus_outbox_string(argus_outbox_t *self, uint8_t command, const uint8_t *text, size_t count);
// A packet of another program; at most 195 bytes of data.
bool argus_outbox_packet(argus_outbox_t *self, const uint8_t *data, size_t count);
// Drops the motion commands and an older `command` that wait, then puts `command` (STOP or E_STOP, nothing
// else) first.
void argus_outbox_urgent(argus_outbox_t *self, uint8_t command);
// Command number of the next packet, or -1.
int argus_outbox_first(const argus_outbox_t *self);
// Next whole packet; 0 when empty or `capacity` is too small for it.
size_t argus_outbox_fetch(argus_outbox_t *self, uint8_t *packet, size_t capacity);

#endif
