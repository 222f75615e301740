// SPDX-License-Identifier: MIT
// Plays a tape of calls to the fault manager: says what came of it, so that two machines can be compared, and
// on a board in QEMU how many instructions each call took at most.
//
// A tape (tools/board_time.py) is lines of text, "set KEY VALUE", "point X Y" and at last "calls", then for
// each call a letter, 4 bytes of time and 2 of length, little-endian, and bytes: R received, P time passed.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "argus/argus.h"
#include "board/config.h"
#include "hal/crc32.h"

#ifdef __arm__
// QEMU's -icount shift=7: an instruction takes 128 ns; timer 0 of the MPS2 board counts down every 40 ns.
#define TIMER ((volatile uint32_t *)0x40000000u)
#define NS_PER_TICK 40u
#define SHIFT 7u
static void clock_begin(void) {
    TIMER[2] = UINT32_MAX;
    TIMER[1] = UINT32_MAX;
    TIMER[0] = 1;
}
static uint32_t ticks(void) {
    return UINT32_MAX - TIMER[1];
}
#else
#define NS_PER_TICK 0u
#define SHIFT 0u
static void clock_begin(void) {
}
static uint32_t ticks(void) {
    return 0;
}
#endif

// A call that is measured is a call, whatever the optimiser thinks.
#define APART __attribute__((noipa))

typedef enum {
    NOTHING,
    INIT,
    CONFIG_CHECK,
    SET_COURSE,
    SIP,
    OTHER_BYTES,
    PROCESS,
    TRANSMIT,
    NEXT_EVENT,
    STATUS,
    INVARIANTS,
    OPERATOR,
    RECORD_SAVE,
    RECORD_LOAD,
    CALLS
} call_t;

static const char *const call_names[CALLS] = {
    [NOTHING] = "nothing",           [INIT] = "init",
    [CONFIG_CHECK] = "config_check", [SET_COURSE] = "set_course",
    [SIP] = "receive_sip",           [OTHER_BYTES] = "receive_other",
    [PROCESS] = "process",           [TRANSMIT] = "transmit",
    [NEXT_EVENT] = "next_event",     [STATUS] = "status",
    [INVARIANTS] = "invariants",     [OPERATOR] = "operator",
    [RECORD_SAVE] = "record_save",   [RECORD_LOAD] = "record_load",
};

static argus_storage_t storage;
static argus_storage_t other;
static argus_config_t config;
static argus_point_t points[ARGUS_WAYPOINTS_MAX];
static uint16_t point_count;
static uint8_t bytes[4096];
static size_t byte_count;
static uint8_t out[ARGUS_PACKET_MAX];
static uint8_t record[ARGUS_RECORD_MAX];
static size_t record_length;
static argus_event_t event;
static argus_status_t status;
static uint32_t now_ms;
static int result; // of the last call, for whoever asked
static uint32_t most[CALLS];
static uint32_t packets;
static uint32_t packet_crc;
static uint32_t events;
static uint32_t event_crc;
static argus_t *core;

static APART void call(call_t what) {
    switch (what) {
    case INIT:
        core = argus_init(&storage, &config, 0);
        break;
    case CONFIG_CHECK:
        result = argus_config_check(&config).fault;
        break;
    case SET_COURSE:
        result = argus_set_course(core, points, point_count);
        break;
    case SIP:
    case OTHER_BYTES:
        argus_receive(core, now_ms, bytes, byte_count);
        break;
    case PROCESS:
        result = (int)argus_process(core, now_ms);
        break;
    case TRANSMIT:
        result = (int)argus_transmit(core, out, sizeof out);
        break;
    case NEXT_EVENT:
        result = argus_next_event(core, &event);
        break;
    case STATUS:
        argus_status(core, &status);
        break;
    case INVARIANTS:
        result = argus_invariants_broken(core);
        break;
    case OPERATOR:
        result = argus_operator(core, now_ms, ARGUS_OP_STOP, 0);
        break;
    case RECORD_SAVE:
        record_length = argus_record_save(core, record, sizeof record);
        break;
    case RECORD_LOAD:
        result = argus_record_load(argus_init(&other, &config, now_ms), record, record_length);
        break;
    case NOTHING:
    case CALLS:
    default:
        break;
    }
}

static int measure(call_t what) {
    const uint32_t before = ticks();
    call(what);
    const uint32_t passed = ticks() - before;
    const uint32_t instructions = (uint32_t)((uint64_t)passed * NS_PER_TICK >> SHIFT);
    most[what] = instructions > most[what] ? instructions : most[what];
    return result;
}

static void take_out(void) {
    for (int length = measure(TRANSMIT); length > 0; length = measure(TRANSMIT)) {
        packets++;
        packet_crc = hal_crc32(packet_crc, out, (size_t)length);
    }
    while (measure(NEXT_EVENT) != 0) {
        char text[80];
        const int length = snprintf(text, sizeof text, "%u %u %d %u %d\n", (unsigned)event.t_ms, event.id,
                                    event.sonar, event.state, (int)event.value);
        events++;
        event_crc = hal_crc32(event_crc, text, (size_t)length);
    }
}

static void fail(const char *why) {
    fprintf(stderr, "replay: %s\n", why);
    exit(1);
}

static void take_text(const char *line) {
    char key[64];
    char value[64];
    int x = 0;
    int y = 0;
    if (sscanf(line, "set %63s %63s", key, value) == 2) {
        if (board_config_set(&config, (board_word_t){key, strlen(key)},
                             (board_word_t){value, strlen(value)}) != BOARD_CONFIG_TAKEN) {
            fail(line);
        }
    } else if (sscanf(line, "point %d %d", &x, &y) == 2 && point_count < ARGUS_WAYPOINTS_MAX) {
        points[point_count++] = (argus_point_t){x, y};
    } else {
        fail(line);
    }
}

static void read_text(FILE *file) {
    char line[160];
    for (;;) {
        if (fgets(line, sizeof line, file) == NULL) {
            fail("the tape has no calls");
        }
        if (strcmp(line, "calls\n") == 0) {
            return;
        }
        take_text(line);
    }
}

static bool read_call(FILE *file, char *letter) {
    uint8_t head[7];
    if (fread(head, 1, sizeof head, file) != sizeof head) {
        return false;
    }
    *letter = (char)head[0];
    now_ms = (uint32_t)head[1] | (uint32_t)head[2] << 8 | (uint32_t)head[3] << 16 | (uint32_t)head[4] << 24;
    byte_count = (size_t)head[5] | (size_t)head[6] << 8;
    if (byte_count > sizeof bytes || fread(bytes, 1, byte_count, file) != byte_count) {
        fail("the tape is cut");
    }
    return true;
}

// Packets of motion have types 0x30 to 0x3F (SPEC.md, SIP).
static bool is_sip(void) {
    return byte_count > 3 && (bytes[3] & 0xF0u) == 0x30u;
}

static void play(FILE *file) {
    char letter = '\0';
    uint32_t count = 0;
    measure(NOTHING);
    measure(CONFIG_CHECK);
    measure(INIT);
    if (point_count > 0 && measure(SET_COURSE) == 0) {
        fail("the course is refused");
    }
    argus_link_up(core, 0);
    while (read_call(file, &letter)) {
        if (letter == 'R') {
            measure(is_sip() ? SIP : OTHER_BYTES);
            continue;
        }
        measure(PROCESS);
        take_out();
        if (count++ % 16 == 0) {
            measure(STATUS);
            measure(INVARIANTS);
        }
    }
    measure(RECORD_SAVE);
    measure(RECORD_LOAD);
    measure(OPERATOR);
}

static void tell(void) {
    printf("packets %u %08x\nevents %u %08x\n", (unsigned)packets, (unsigned)packet_crc, (unsigned)events,
           (unsigned)event_crc);
    printf("record %u %08x\nbroken %d\n", (unsigned)record_length,
           (unsigned)hal_crc32(0, record, record_length), argus_invariants_broken(core));
    for (int i = 0; NS_PER_TICK > 0 && i < CALLS; i++) {
        printf("instructions %s %u\n", call_names[i], (unsigned)(most[i] - most[NOTHING]));
    }
}

int main(int argc, char **argv) {
    if (argc != 2) {
        fail("usage: replay TAPE");
    }
    FILE *const file = fopen(argv[1], "rb");
    if (file == NULL) {
        fail("the tape cannot be opened");
    }
    argus_config_default(&config);
    clock_begin();
    read_text(file);
    play(file);
    fclose(file);
    tell();
    return 0;
}
