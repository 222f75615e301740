// SPDX-License-Identifier: MIT
// Reads the recorded streams out of tests/data/captures.
#include "captures.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const captures_names[] = {"a_idle",     "c_commands", "d_ram",    "m_p3dx",
                                      "m_powerbot", "m_seekur",   "p10_badck"};
const size_t captures_count = sizeof captures_names / sizeof captures_names[0];

static void give_up(const char *path, const char *why) {
    fprintf(stderr, "%s: %s\n", path, why);
    exit(2);
}

static int digit(char c) {
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    c |= 0x20;
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

size_t captures_hex(const char *text, uint8_t *out, size_t capacity) {
    size_t count = 0;
    while (count < capacity) {
        while (*text == ' ') {
            text++;
        }
        const int high = digit(text[0]);
        const int low = high < 0 ? -1 : digit(text[1]);
        if (low < 0) {
            break;
        }
        out[count++] = (uint8_t)(high << 4 | low);
        text += 2;
    }
    return count;
}

void captures_add(captures_t *stream, const uint8_t *packet, size_t total) {
    if (stream->packets >= CAPTURES_PACKETS_MAX || stream->length + total > CAPTURES_BYTES_MAX) {
        give_up("captures", "does not fit, raise CAPTURES_BYTES_MAX or CAPTURES_PACKETS_MAX");
    }
    memmove(stream->bytes + stream->length, packet, total);
    stream->at[stream->packets] = stream->length;
    stream->total[stream->packets++] = total;
    stream->length += total;
}

static void frame(captures_t *stream, const char *path, size_t from) {
    for (size_t at = from; at < stream->length;) {
        const uint8_t *packet = stream->bytes + at;
        const size_t left = stream->length - at;
        if (left < 6 || packet[0] != 0xFA || packet[1] != 0xFB || packet[2] + (size_t)3 > left) {
            give_up(path, "does not frame cleanly");
        }
        if (stream->packets >= CAPTURES_PACKETS_MAX) {
            give_up(path, "too many packets, raise CAPTURES_PACKETS_MAX");
        }
        stream->at[stream->packets] = at;
        stream->total[stream->packets++] = packet[2] + (size_t)3;
        at += packet[2] + (size_t)3;
    }
}

typedef void (*take_line_t)(void *context, const char *line, const char *hex);

static void read_lines(const char *name, take_line_t take, void *context) {
    static char line[4096];
    char path[512];
    snprintf(path, sizeof path, "%s/captures/%s.jsonl", ARGUS_TEST_DATA, name);
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        give_up(path, "cannot be read");
    }
    while (fgets(line, sizeof line, file) != NULL) {
        const char *hex = strstr(line, "\"hex\": \"");
        if (strchr(line, '\n') == NULL) {
            give_up(path, "line too long, raise the buffer");
        }
        if (hex != NULL) {
            take(context, line, hex + 8);
        }
    }
    fclose(file);
}

typedef struct {
    captures_t *stream;
    char mark[32];
} one_way_t;

static void take_bytes(void *context, const char *line, const char *hex) {
    const one_way_t *wanted = context;
    captures_t *stream = wanted->stream;
    if (strstr(line, wanted->mark) != NULL) {
        stream->length +=
            captures_hex(hex, stream->bytes + stream->length, CAPTURES_BYTES_MAX - stream->length);
    }
}

size_t captures_load_bytes(captures_t *stream, const char *name, const char *direction) {
    one_way_t wanted = {stream, ""};
    const size_t from = stream->length;
    snprintf(wanted.mark, sizeof wanted.mark, "\"dir\": \"%s\"", direction);
    read_lines(name, take_bytes, &wanted);
    return from;
}

static void take_chunk(void *context, const char *line, const char *hex) {
    captures_tape_t *tape = context;
    const char *time = strstr(line, "\"t\": ");
    if (time == NULL || tape->chunks >= CAPTURES_CHUNKS_MAX) {
        give_up(line, "has no time, or raise CAPTURES_CHUNKS_MAX");
    }
    captures_chunk_t *chunk = &tape->chunk[tape->chunks++];
    chunk->t_ms = (uint32_t)(strtod(time + 5, NULL) * 1000);
    chunk->from_robot = strstr(line, "\"dir\": \"r2c\"") != NULL;
    chunk->at = tape->length;
    chunk->count = captures_hex(hex, tape->bytes + tape->length, CAPTURES_BYTES_MAX - tape->length);
    tape->length += chunk->count;
}

void captures_load_tape(captures_tape_t *tape, const char *name) {
    memset(tape, 0, sizeof *tape);
    read_lines(name, take_chunk, tape);
}

void captures_load(captures_t *stream, const char *name, const char *direction) {
    frame(stream, name, captures_load_bytes(stream, name, direction));
}

void captures_load_sips(captures_t *stream) {
    static captures_t all;
    memset(&all, 0, sizeof all);
    for (size_t i = 0; i < captures_count; i++) {
        captures_load(&all, captures_names[i], "r2c");
    }
    for (size_t i = 0; i < all.packets; i++) {
        const uint8_t *packet = all.bytes + all.at[i];
        if (packet[3] == 0x32 || packet[3] == 0x33) {
            captures_add(stream, packet, all.total[i]);
        }
    }
}

random_t random_seed(uint64_t seed) {
    const random_t generator = {seed * UINT64_C(0x9E3779B97F4A7C15) + UINT64_C(0xD1B54A32D192ED03)};
    return generator;
}

uint32_t random_below(random_t *self, uint32_t limit) {
    self->state ^= self->state << 13;
    self->state ^= self->state >> 7;
    self->state ^= self->state << 17;
    return limit == 0 ? 0 : (uint32_t)((self->state >> 32) % limit);
}
