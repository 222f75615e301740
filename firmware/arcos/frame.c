// SPDX-License-Identifier: MIT
// ARCOS framing: the checksum, building packets, and finding them in any stream of bytes.
#include "arcos/frame.h"

#include <string.h>

#include "arcos/arithmetic.h"
#include "argus/argus.h"

#define HEADER_BYTES ARCOS_FRAME_OVERHEAD // FA FB COUNT
#define PACKET_MIN (ARCOS_FRAME_COUNT_MIN + ARCOS_FRAME_OVERHEAD)
#define CHECKSUM_BYTES 2

#define SLOWEST_BAUD ARCOS_BAUD_B9600

uint16_t argus_frame_checksum(const uint8_t *data, size_t count) {
    uint32_t high = 0; // two sums cost less than putting each pair together
    uint32_t low = 0;
    size_t i = 0;
    for (; i + 1 < count; i += 2) {
        high += data[i];
        low += data[i + 1];
    }
    uint32_t sum = (high << 8) + low;
    if (i < count) {
        sum ^= data[i];
    }
    return (uint16_t)sum;
}

static bool fits(size_t capacity, size_t count) {
    const size_t total = HEADER_BYTES + count + CHECKSUM_BYTES;
    return count > 0 && count <= ARCOS_FRAME_SEND_TOTAL_MAX && total <= ARCOS_FRAME_SEND_TOTAL_MAX &&
           total <= capacity;
}

size_t argus_frame_seal(uint8_t *packet, size_t capacity, size_t count) {
    if (!fits(capacity, count)) {
        return 0;
    }
    const size_t total = HEADER_BYTES + count + CHECKSUM_BYTES;
    const uint16_t checksum = argus_frame_checksum(packet + HEADER_BYTES, count);
    ARGUS_ASSERT(total <= capacity && total <= ARCOS_FRAME_SEND_TOTAL_MAX);
    packet[0] = ARCOS_FRAME_HEADER0;
    packet[1] = ARCOS_FRAME_HEADER1;
    packet[2] = (uint8_t)(count + CHECKSUM_BYTES);
    packet[total - 2] = (uint8_t)(checksum >> 8);
    packet[total - 1] = (uint8_t)(checksum & 0xFF);
    return total;
}

size_t argus_frame_encode(uint8_t *packet, size_t capacity, const uint8_t *data, size_t count) {
    if (!fits(capacity, count)) {
        return 0;
    }
    memcpy(packet + HEADER_BYTES, data, count);
    return argus_frame_seal(packet, capacity, count);
}

void argus_parser_init(argus_parser_t *self) {
    memset(self, 0, sizeof *self);
}

static size_t end_of(const argus_parser_t *self) {
    ARGUS_ASSERT(self->first + self->length <= ARGUS_PARSER_BYTES);
    return (size_t)self->first + self->length;
}

static void advance(argus_parser_t *self, size_t count) {
    ARGUS_ASSERT(count <= self->length);
    self->first = (uint16_t)(self->first + count);
    self->length = (uint16_t)(self->length - count);
    self->since_ms = self->last_byte_ms;
    if (self->length == 0) {
        self->broken_off = false;
    }
}

static void skip(argus_parser_t *self, size_t count) {
    self->skipped_bytes += (uint32_t)count;
    advance(self, count);
}

void argus_parser_flush(argus_parser_t *self) {
    self->ahead = 0;
    skip(self, self->length);
}

static bool starts_packet(const uint8_t *at, size_t available) {
    ARGUS_ASSERT(available > 0);
    return at[0] == ARCOS_FRAME_HEADER0 && (available < 2 || at[1] == ARCOS_FRAME_HEADER1);
}

static bool checksum_holds(const uint8_t *packet) {
    ARGUS_ASSERT(packet[2] >= ARCOS_FRAME_COUNT_MIN);
    const size_t count = (size_t)packet[2] - CHECKSUM_BYTES;
    const uint8_t *sent = packet + HEADER_BYTES + count;
    return argus_frame_checksum(packet + HEADER_BYTES, count) == (uint16_t)(sent[0] << 8 | sent[1]);
}

// Bytes that the first packet still lacks; 0 when it is complete or no packet at all.
static size_t owed(const argus_parser_t *self) {
    const size_t held = self->length;
    if (held < HEADER_BYTES) {
        return HEADER_BYTES - held;
    }
    const size_t total = (size_t)self->held[self->first + 2] + ARCOS_FRAME_OVERHEAD;
    return total > held ? total - held : 0;
}

static size_t least(size_t a, size_t b) {
    return a < b ? a : b;
}

static bool is_quiet(const argus_parser_t *self, uint32_t now_ms) {
    return argus_elapsed_ms(now_ms, self->last_byte_ms) >= ARCOS_FRAME_RESYNC_QUIET_MS;
}

static void note_silence(argus_parser_t *self, uint32_t now_ms) {
    if (self->length > 0 && is_quiet(self, now_ms)) {
        self->broken_off = true;
    }
}

static void make_room(argus_parser_t *self) {
    if (self->first < ARGUS_FRAME_TOTAL_MAX && self->length > 0) {
        return;
    }
    memcpy(self->held, self->held + self->first, self->length);
    self->searched = (uint16_t)(self->searched > self->first ? self->searched - self->first : 0);
    self->first = 0;
    ARGUS_ASSERT(self->searched <= self->length);
}

static size_t skip_noise(argus_parser_t *self, const uint8_t *bytes, size_t count) {
    size_t noise = 0;
    while (noise < count && bytes[noise] != ARCOS_FRAME_HEADER0) {
        noise++;
    }
    self->skipped_bytes += (uint32_t)noise;
    return noise;
}

static size_t append(argus_parser_t *self, const uint8_t *bytes, size_t count) {
    const size_t wanted = owed(self);
    const size_t taken = count < wanted ? count : wanted;
    ARGUS_ASSERT(end_of(self) + taken <= ARGUS_PARSER_BYTES);
    memcpy(self->held + end_of(self), bytes, taken);
    self->length = (uint16_t)(self->length + taken);
    return taken;
}

// Bytes of a packet that is under way and in no doubt.
static size_t append_ahead(argus_parser_t *self, uint32_t now_ms, const uint8_t *bytes, size_t count) {
    ARGUS_ASSERT(self->length >= HEADER_BYTES && end_of(self) + count <= ARGUS_PARSER_BYTES);
    memcpy(self->held + end_of(self), bytes, count);
    self->length = (uint16_t)(self->length + count);
    self->ahead = (uint8_t)(self->ahead - count);
    self->last_byte_ms = now_ms;
    return count;
}

size_t argus_parser_take(argus_parser_t *self, uint32_t now_ms, const uint8_t *bytes, size_t count) {
    if (count == 0) {
        return 0;
    }
    if (count <= self->ahead && argus_parser_waits(self, now_ms)) {
        return append_ahead(self, now_ms, bytes, count);
    }
    self->ahead = 0;
    note_silence(self, now_ms);
    make_room(self);
    size_t taken = 0;
    self->last_byte_ms = now_ms;
    if (self->length == 0) {
        taken = skip_noise(self, bytes, count);
        self->since_ms = now_ms;
    }
    taken += append(self, bytes + taken, count - taken);
    taken += append(self, bytes + taken, count - taken); // once COUNT is known, the rest
    return taken;
}

// Goes to the first byte that can start a packet.
static void seek(argus_parser_t *self) {
    size_t at = 0;
    while (at < self->length && !starts_packet(self->held + self->first + at, self->length - at)) {
        at++;
    }
    if (at > 0) {
        skip(self, at);
    }
}

static bool hand_out(argus_parser_t *self, argus_packet_t *packet) {
    ARGUS_ASSERT(self->held[self->first + 2] + ARCOS_FRAME_OVERHEAD <= self->length);
    const uint8_t *frame = self->held + self->first;
    packet->data = frame + HEADER_BYTES;
    packet->count = (uint8_t)(frame[2] - CHECKSUM_BYTES);
    self->packets++;
    self->broken_off = false;
    advance(self, (size_t)frame[2] + ARCOS_FRAME_OVERHEAD);
    return true;
}

static bool is_sip(uint8_t type) {
    return type == ARCOS_TYPE_SIP_STATIONARY || type == ARCOS_TYPE_SIP_MOVING;
}

// A SIP says its length twice. Before its sonar count has arrived nothing can be said against it.
static bool sip_is_doubtful(const uint8_t *frame, size_t held) {
    if (held <= ARCOS_SIP_OFFSET_SONAR_COUNT) {
        return false;
    }
    const int sonars = frame[ARCOS_SIP_OFFSET_SONAR_COUNT];
    const int total = frame[2] + ARCOS_FRAME_OVERHEAD;
    const int tail = total - CHECKSUM_BYTES - ARCOS_SIP_OFFSET_SONAR - sonars * ARCOS_SIP_SONAR_BYTES;
    return tail < 0 || tail > ARCOS_FRAME_RESYNC_SIP_TAIL_MAX;
}

static bool is_doubtful(const argus_parser_t *self) {
    const uint8_t *frame = self->held + self->first;
    const size_t held = self->length;
    if (held < PACKET_MIN) {
        return false;
    }
    if (is_sip(frame[HEADER_BYTES])) {
        return sip_is_doubtful(frame, held);
    }
    const bool config = frame[HEADER_BYTES] == ARCOS_TYPE_CONFIGPAC;
    const int longest = config ? ARCOS_FRAME_RESYNC_CONFIG_COUNT_MAX : ARCOS_FRAME_RESYNC_OTHER_COUNT_MAX;
    return self->broken_off || frame[2] > longest;
}

// True when a whole, good packet starts at `at`, unless an earlier search has seen it fail.
static bool is_whole_at(const argus_parser_t *self, size_t at) {
    const uint8_t *frame = self->held + at;
    if (!starts_packet(frame, PACKET_MIN) || frame[2] < ARCOS_FRAME_COUNT_MIN) {
        return false;
    }
    const size_t after = at + frame[2] + ARCOS_FRAME_OVERHEAD;
    return after <= end_of(self) && after > self->searched && checksum_holds(frame);
}

static bool find_inside(argus_parser_t *self, argus_packet_t *packet) {
    ARGUS_ASSERT(self->length > 0);
    for (size_t at = (size_t)self->first + 1; at + PACKET_MIN <= end_of(self); at++) {
        if (is_whole_at(self, at)) {
            skip(self, at - self->first);
            return hand_out(self, packet);
        }
    }
    self->searched = (uint16_t)end_of(self);
    return false;
}

static bool is_overdue(const argus_parser_t *self, uint32_t now_ms) {
    const uint32_t count = self->length < HEADER_BYTES ? 0 : self->held[self->first + 2];
    const uint32_t wire_ms = count * ARCOS_TIMING_BITS_PER_BYTE * 1000 / SLOWEST_BAUD;
    return is_quiet(self, now_ms) &&
           argus_elapsed_ms(now_ms, self->since_ms) > wire_ms + ARCOS_FRAME_RESYNC_EXTRA_MS;
}

// A complete packet's fate; its header is skipped when it is bad.
static bool accept_head(argus_parser_t *self) {
    const uint8_t *frame = self->held + self->first;
    if (frame[2] < ARCOS_FRAME_COUNT_MIN) {
        self->bad_counts++;
    } else if (checksum_holds(frame)) {
        return true;
    } else {
        self->bad_checksums++;
    }
    skip(self, 1);
    return false;
}

// How many bytes may follow until the packet is whole, or can be doubted. A SIP is by its sonar count, so
// from then on or never.
static size_t undecided(const argus_parser_t *self) {
    const size_t held = self->length;
    if (held < HEADER_BYTES || self->first >= ARGUS_FRAME_TOTAL_MAX || is_doubtful(self)) {
        return 0;
    }
    size_t last = held + owed(self) - 1;
    if (held < PACKET_MIN) {
        last = least(last, PACKET_MIN - 1);
    } else if (held <= ARCOS_SIP_OFFSET_SONAR_COUNT && is_sip(self->held[self->first + HEADER_BYTES])) {
        last = least(last, ARCOS_SIP_OFFSET_SONAR_COUNT);
    }
    return least(last - held, UINT8_MAX);
}

bool argus_parser_decide(argus_parser_t *self, uint32_t now_ms, argus_packet_t *packet) {
    if (argus_parser_waits(self, now_ms)) {
        return false;
    }
    self->ahead = 0;
    note_silence(self, now_ms);
    for (seek(self); self->length > 0; seek(self)) {
        if (owed(self) == 0) {
            if (accept_head(self)) {
                return hand_out(self, packet);
            }
        } else if (is_doubtful(self) && find_inside(self, packet)) {
            return true;
        } else if (is_overdue(self, now_ms)) {
            self->timeouts++;
            skip(self, 1);
        } else {
            self->ahead = (uint8_t)undecided(self);
            return false;
        }
    }
    return false;
}
