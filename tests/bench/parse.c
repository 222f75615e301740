// SPDX-License-Identifier: MIT
// Prints how long it takes to turn the bytes of a recorded SIP into its decoded fields, checksum included.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../unit/support/captures.c"
#include "arcos/sip.h"
#include "knowledge/knowledge.h"

#define ROUNDS 400
#define READ_BYTES 4096
#define SIP_BYTES 89 // the SIP of a robot with 16 sonars in each, as most of the recorded ones
#define SIP_REPEATS 1000
#define TARGET_NS 72.0

static captures_t stream;
static uint8_t one[SIP_BYTES];

static double now_ns(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

// Bytes made unknown to the compiler, so that no round may be left out or merged with another.
static const uint8_t *opaque(const uint8_t *bytes) {
    __asm__ volatile("" : "+r"(bytes) : : "memory");
    return bytes;
}

// Every sum returned keeps the compiler from leaving anything out.
typedef uint32_t (*work_t)(void);

static uint32_t sum_bytes(void) {
    uint32_t sum = 0;
    for (int i = 0; i < SIP_REPEATS; i++) {
        const uint8_t *bytes = opaque(one);
        for (size_t k = 0; k < SIP_BYTES; k++) {
            sum += bytes[k];
        }
    }
    return sum;
}

static argus_parser_t parser;
static argus_sip_t sip;
static argus_knowledge_t knowledge;

static bool decode_one(const uint8_t *bytes) {
    argus_packet_t packet;
    return argus_parser_push(&parser, 0, bytes, SIP_BYTES) == SIP_BYTES &&
           argus_parser_next(&parser, 0, &packet) && argus_sip_decode(&sip, &packet);
}

static void must(bool decoded) {
    if (!decoded) {
        fprintf(stderr, "parse: a recorded SIP is not accepted\n");
        exit(1);
    }
}

static uint32_t decode_sip(void) {
    uint32_t sum = 0;
    for (int i = 0; i < SIP_REPEATS; i++) {
        must(decode_one(opaque(one)));
        sum += sip.sonar[15].range_mm;
    }
    return sum;
}

static uint32_t decode_to_knowledge(void) {
    uint32_t sum = 0;
    for (int i = 0; i < SIP_REPEATS; i++) {
        must(decode_one(opaque(one)));
        argus_knowledge_sip(&knowledge, &sip, 1000, (uint32_t)i * 100);
        sum += (uint32_t)knowledge.sonar[15].reading_mm;
    }
    return sum;
}

static uint32_t decode_stream(size_t read_bytes) {
    argus_packet_t packet;
    uint32_t sum = 0;
    size_t decoded = 0;
    for (size_t at = 0; at < stream.length;) {
        const size_t left = stream.length - at;
        at += argus_parser_push(&parser, 0, stream.bytes + at, left < read_bytes ? left : read_bytes);
        while (argus_parser_next(&parser, 0, &packet)) {
            if (argus_sip_decode(&sip, &packet)) {
                sum += sip.sonar_count > 0 ? sip.sonar[sip.sonar_count - 1].range_mm : sip.x_raw;
                decoded++;
            }
        }
    }
    must(decoded == stream.packets);
    return sum;
}

static uint32_t decode_reads(void) {
    return decode_stream(READ_BYTES);
}

static uint32_t decode_bytewise(void) {
    return decode_stream(1);
}

typedef struct {
    const char *name;
    work_t work;
    size_t sips; // decoded by one call; 0: all of the stream
    double round_ns[ROUNDS];
    uint32_t sum;
} task_t;

static task_t tasks[] = {
    {.name = "reference: sum of its 89 bytes", .work = sum_bytes, .sips = SIP_REPEATS},
    {.name = "89-byte SIP to fields", .work = decode_sip, .sips = SIP_REPEATS},
    {.name = "89-byte SIP to knowledge", .work = decode_to_knowledge, .sips = SIP_REPEATS},
    {.name = "all SIPs, reads of 4096 bytes", .work = decode_reads},
    {.name = "all SIPs, byte by byte", .work = decode_bytewise}};
#define TASKS (sizeof tasks / sizeof tasks[0])

// The tasks take turns, so that what slows the machine down slows all of them.
static void measure(void) {
    for (int round = 0; round < ROUNDS; round++) {
        for (size_t i = 0; i < TASKS; i++) {
            const double start = now_ns();
            tasks[i].sum += tasks[i].work();
            const size_t sips = tasks[i].sips > 0 ? tasks[i].sips : stream.packets;
            tasks[i].round_ns[round] = (now_ns() - start) / (double)sips;
        }
    }
}

static int compare_ns(const void *a, const void *b) {
    const double difference = *(const double *)a - *(const double *)b;
    return difference < 0 ? -1 : difference > 0;
}

static double report(task_t *task, double reference_ns) {
    qsort(task->round_ns, ROUNDS, sizeof task->round_ns[0], compare_ns);
    const double median = task->round_ns[ROUNDS / 2];
    printf("%-32s median %6.1f  p99 %6.1f  best %6.1f ns per SIP", task->name, median,
           task->round_ns[ROUNDS * 99 / 100], task->round_ns[0]);
    if (reference_ns > 0) {
        printf("  %5.2f x reference", median / reference_ns);
    }
    printf("  (sum %08x)\n", (unsigned)task->sum);
    return median;
}

static void print_machine(void) {
    char line[256];
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file != NULL && fgets(line, sizeof line, file) != NULL) {
        const char *model = strchr(line, ':');
        if (strncmp(line, "model name", 10) == 0 && model != NULL) {
            printf("processor:%s", model + 1);
            break;
        }
    }
    if (file != NULL) {
        fclose(file);
    }
}

static void pick_one(void) {
    for (size_t i = 0; i < stream.packets; i++) {
        if (stream.total[i] == SIP_BYTES) {
            memcpy(one, stream.bytes + stream.at[i], SIP_BYTES);
            return;
        }
    }
    must(false);
}

int main(void) {
    print_machine();
    captures_load_sips(&stream);
    pick_one();
    argus_parser_init(&parser);
    argus_knowledge_init(&knowledge);
    measure();
    const double reference_ns = report(&tasks[0], 0);
    const double fields_ns = report(&tasks[1], reference_ns);
    for (size_t i = 2; i < TASKS; i++) {
        report(&tasks[i], reference_ns);
    }
    printf("%zu recorded SIPs of %zu bytes on average; 89-byte SIP to fields: %.1f ns, target %.0f ns\n",
           stream.packets, stream.length / stream.packets, fields_ns, TARGET_NS);
    return 0;
}
