// SPDX-License-Identifier: MIT
// ARCOS framing: bytes to packets and back (SPEC.md, Framing).
#ifndef ARGUS_FRAME_H
#define ARGUS_FRAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "arcos/arithmetic.h"
#include "arcos/gen_arcos.h"
#include "argus/argus.h"

// Largest packet on the wire: header, COUNT and 255 bytes.
#define ARGUS_FRAME_TOTAL_MAX (ARCOS_FRAME_COUNT_MAX + 3)

// The 16-bit ARCOS checksum of `count` data bytes. Cost: one pass.
uint16_t argus_frame_checksum(const uint8_t *data, size_t count);

// Wraps `count` data bytes (1..195) into a packet; returns its length, or 0 when it does not fit `capacity`
// or would be longer than ARCOS_FRAME_SEND_TOTAL_MAX.
size_t argus_frame_encode(uint8_t *packet, size_t capacity, const uint8_t *data, size_t count);

// The same for data that stand in the packet already, from ARCOS_FRAME_OVERHEAD on: no copy of them on the
// stack.
size_t argus_frame_seal(uint8_t *packet, size_t capacity, size_t count);

// A received packet: its data bytes (type first), valid until the next call on the parser.
typedef struct {
    const uint8_t *data;
    uint8_t count; // data bytes, 1..253
} argus_packet_t;

// Two of the longest packets: room to leave a packet where it is while the next one is received.
#define ARGUS_PARSER_BYTES (2 * ARGUS_FRAME_TOTAL_MAX)

// Finds packets in a stream of any bytes. After a bad checksum or an impossible COUNT it goes on one byte
// after the rejected header. So an intact packet behind a damaged one is never lost. A packet that is
// incomplete and doubtful loses to a complete one with a good checksum inside it. So a false COUNT delays the
// next SIP by at most one. A SIP is doubtful when its COUNT does not fit its sonar count. Any other packet is
// when it is longer than its type ever is, or broken off for 30 ms. A SIP in which both counts agree is never
// doubted, for a position may look like a packet (x = -1030 mm is FA FB). What is owed longer than its COUNT
// takes at 9600 baud + 100 ms is given up once the line is silent.
typedef struct {
    uint16_t first;    // the bytes held begin here
    uint16_t length;   // bytes held
    uint16_t searched; // every packet inside the first one that ends up to here has been found bad
    bool broken_off;   // 30 ms went by without a byte while a packet was incomplete
    uint8_t ahead;     // so many bytes more bring nothing to decide, if no silence comes between
    uint32_t last_byte_ms;
    uint32_t since_ms; // the first byte held arrived then at the latest
    uint32_t packets;  // monotonic counters
    uint32_t bad_checksums;
    uint32_t bad_counts;
    uint32_t skipped_bytes; // bytes that belong to no accepted packet
    uint32_t timeouts;
    uint8_t held[ARGUS_PARSER_BYTES];
} argus_parser_t;

void argus_parser_init(argus_parser_t *self);
// Drops what is held; the counters go on.
void argus_parser_flush(argus_parser_t *self);

// Whether bytes of a packet are under way that bring nothing to decide yet.
static inline bool argus_parser_waits(const argus_parser_t *const self, const uint32_t now_ms) {
    return self->ahead > 0 &&
           argus_elapsed_ms(now_ms, self->last_byte_ms) < (uint32_t)ARCOS_FRAME_RESYNC_QUIET_MS;
}

// The same as the two functions below, for any bytes and at any time.
size_t argus_parser_take(argus_parser_t *self, uint32_t now_ms, const uint8_t *bytes, size_t count);
bool argus_parser_decide(argus_parser_t *self, uint32_t now_ms, argus_packet_t *packet);

// Offers bytes. It takes as many as it can use before a packet is complete, and returns how many. That is 0
// when a packet waits to be fetched first. Loop: push, then fetch with argus_parser_next() until false, until
// all bytes are taken. A single byte, as an interrupt brings it, costs a few instructions.
static inline size_t argus_parser_push(argus_parser_t *const self, const uint32_t now_ms,
                                       const uint8_t *const bytes, const size_t count) {
    if (count != 1 || !argus_parser_waits(self, now_ms)) {
        return argus_parser_take(self, now_ms, bytes, count);
    }
    ARGUS_ASSERT((size_t)self->first + self->length < ARGUS_PARSER_BYTES);
    self->held[self->first + self->length] = *bytes;
    self->length++;
    self->ahead--;
    self->last_byte_ms = now_ms;
    return 1;
}

// The next complete packet, or false. Also applies the time rules: call it from the periodic process too.
static inline bool argus_parser_next(argus_parser_t *const self, const uint32_t now_ms,
                                     argus_packet_t *const packet) {
    return !argus_parser_waits(self, now_ms) && argus_parser_decide(self, now_ms, packet);
}

#endif
