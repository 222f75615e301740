// SPDX-License-Identifier: MIT
// Recorded ARCOS streams for tests, and the small tools that every byte-level test needs.
#ifndef ARGUS_TEST_CAPTURES_H
#define ARGUS_TEST_CAPTURES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define CAPTURES_BYTES_MAX 200000
#define CAPTURES_PACKETS_MAX 2500

// A stream and where its packets lie. The packets are found by their COUNT alone, not by the parser under
// test.
typedef struct {
    uint8_t bytes[CAPTURES_BYTES_MAX];
    size_t length;
    size_t at[CAPTURES_PACKETS_MAX];
    size_t total[CAPTURES_PACKETS_MAX];
    size_t packets;
} captures_t;

extern const char *const captures_names[];
extern const size_t captures_count;

// Appends one packet.
void captures_add(captures_t *stream, const uint8_t *packet, size_t total);
// Appends the bytes that ARGUS_TEST_DATA/captures/`name`.jsonl recorded in `direction` ("r2c", "c2r") and
// returns where they begin; ends the program with a message when the file cannot be read.
size_t captures_load_bytes(captures_t *stream, const char *name, const char *direction);
// The same and finds the packets; ends the program with a message when they do not frame cleanly.
void captures_load(captures_t *stream, const char *name, const char *direction);
// Every SIP of every capture, in order.
void captures_load_sips(captures_t *stream);

// A recording with its times: chunks of `bytes` as they were received.
#define CAPTURES_CHUNKS_MAX 2500
typedef struct {
    uint32_t t_ms;
    bool from_robot;
    size_t at;
    size_t count;
} captures_chunk_t;
typedef struct {
    uint8_t bytes[CAPTURES_BYTES_MAX];
    size_t length;
    captures_chunk_t chunk[CAPTURES_CHUNKS_MAX];
    size_t chunks;
} captures_tape_t;
void captures_load_tape(captures_tape_t *tape, const char *name);

// "FA FB 03 ..." to bytes; returns how many.
size_t captures_hex(const char *text, uint8_t *out, size_t capacity);

// A seeded generator: the same numbers everywhere.
typedef struct {
    uint64_t state;
} random_t;
random_t random_seed(uint64_t seed);
uint32_t random_below(random_t *self, uint32_t limit);

#endif
