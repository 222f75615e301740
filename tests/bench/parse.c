// SPDX-License-Identifier: MIT
// Prints how long it takes to turn the bytes of a recorded SIP into its decoded fields.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../unit/support/captures.c"
#include "argus/sip.h"

#define ROUNDS 300
#define READ_BYTES 4096

static captures_t stream;

static double now_ns(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

// The sum keeps the compiler from leaving anything out.
static size_t decode_all(argus_parser_t *parser, size_t read_bytes, uint32_t *sum) {
    static argus_sip_t sip;
    argus_packet_t packet;
    size_t decoded = 0;
    for (size_t at = 0; at < stream.length;) {
        const size_t left = stream.length - at;
        at += argus_parser_push(parser, 0, stream.bytes + at, left < read_bytes ? left : read_bytes);
        while (argus_parser_next(parser, 0, &packet)) {
            if (argus_sip_decode(&sip, &packet)) {
                *sum += sip.sonar_count > 0 ? sip.sonar[sip.sonar_count - 1].range_mm : sip.x_raw;
                decoded++;
            }
        }
    }
    return decoded;
}

static int compare_ns(const void *a, const void *b) {
    const double difference = *(const double *)a - *(const double *)b;
    return difference < 0 ? -1 : difference > 0;
}

static void report(const char *name, size_t read_bytes) {
    static double round_ns[ROUNDS];
    argus_parser_t parser;
    uint32_t sum = 0;
    argus_parser_init(&parser);
    for (int i = 0; i < ROUNDS; i++) {
        const double start = now_ns();
        const size_t decoded = decode_all(&parser, read_bytes, &sum);
        if (decoded != stream.packets) {
            fprintf(stderr, "parse: decoded %zu of %zu SIPs\n", decoded, stream.packets);
            exit(1);
        }
        round_ns[i] = (now_ns() - start) / (double)decoded;
    }
    qsort(round_ns, ROUNDS, sizeof round_ns[0], compare_ns);
    printf(
        "%-28s median %6.1f  p99 %6.1f  best %6.1f ns per SIP (%zu SIPs of %zu bytes on average, sum %08x)\n",
        name, round_ns[ROUNDS / 2], round_ns[ROUNDS * 99 / 100], round_ns[0], stream.packets,
        stream.length / stream.packets, (unsigned)sum);
}

int main(void) {
    captures_load_sips(&stream);
    report("decode, reads of 4096 bytes", READ_BYTES);
    report("decode, byte by byte", 1);
    return 0;
}
