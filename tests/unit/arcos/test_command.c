// SPDX-License-Identifier: MIT
// Rule under attack: commands carry their sign in the argument type, leave whole and in order, and STOP
// overtakes.
#include "arcos/command.h"

#include <stdio.h>
#include <string.h>

#include "captures.h"
#include "unity.h"

static uint8_t packet[ARGUS_FRAME_TOTAL_MAX];
static argus_outbox_t outbox;
static char message[120];

static void assert_bytes(const char *hex, size_t total) {
    uint8_t wanted[ARGUS_FRAME_TOTAL_MAX];
    TEST_ASSERT_EQUAL_MESSAGE(captures_hex(hex, wanted, sizeof wanted), total, hex);
    TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(wanted, packet, total, hex);
}

void test_golden_commands_without_argument(void) {
    static const struct {
        uint8_t command;
        const char *hex;
    } golden[] = {{ARCOS_CMD_PULSE, "FA FB 03 00 00 00"},  {ARCOS_CMD_OPEN, "FA FB 03 01 00 01"},
                  {ARCOS_CMD_CLOSE, "FA FB 03 02 00 02"},  {ARCOS_CMD_SETO, "FA FB 03 07 00 07"},
                  {ARCOS_CMD_CONFIG, "FA FB 03 12 00 12"}, {ARCOS_CMD_STOP, "FA FB 03 1D 00 1D"},
                  {ARCOS_CMD_E_STOP, "FA FB 03 37 00 37"}, {ARCOS_CMD_RESET, "FA FB 03 FD 00 FD"}};
    for (size_t i = 0; i < sizeof golden / sizeof golden[0]; i++) {
        assert_bytes(golden[i].hex, argus_command_plain(packet, sizeof packet, golden[i].command));
    }
}

void test_golden_commands_with_an_integer(void) {
    static const struct {
        uint8_t command;
        int32_t argument;
        const char *hex;
    } golden[] = {{ARCOS_CMD_OPEN, 1, "FA FB 06 01 3B 01 00 02 3B"},
                  {ARCOS_CMD_CLOSE, 1, "FA FB 06 02 3B 01 00 03 3B"},
                  {ARCOS_CMD_ENABLE, 1, "FA FB 06 04 3B 01 00 05 3B"},
                  {ARCOS_CMD_ENABLE, 0, "FA FB 06 04 3B 00 00 04 3B"},
                  {ARCOS_CMD_SETA, 300, "FA FB 06 05 3B 2C 01 31 3C"},
                  {ARCOS_CMD_SETA, -300, "FA FB 06 05 1B 2C 01 31 1C"},
                  {ARCOS_CMD_SETV, 750, "FA FB 06 06 3B EE 02 F4 3D"},
                  {ARCOS_CMD_MOVE, -500, "FA FB 06 08 1B F4 01 FC 1C"},
                  {ARCOS_CMD_ROTATE, -20, "FA FB 06 09 1B 14 00 1D 1B"},
                  {ARCOS_CMD_SETRV, 100, "FA FB 06 0A 3B 64 00 6E 3B"},
                  {ARCOS_CMD_VEL, 300, "FA FB 06 0B 3B 2C 01 37 3C"},
                  {ARCOS_CMD_VEL, -300, "FA FB 06 0B 1B 2C 01 37 1C"},
                  {ARCOS_CMD_VEL, 0, "FA FB 06 0B 3B 00 00 0B 3B"},
                  {ARCOS_CMD_HEAD, 90, "FA FB 06 0C 3B 5A 00 66 3B"},
                  {ARCOS_CMD_DHEAD, 45, "FA FB 06 0D 3B 2D 00 3A 3B"},
                  {ARCOS_CMD_DHEAD, -90, "FA FB 06 0D 1B 5A 00 67 1B"},
                  {ARCOS_CMD_RVEL, -20, "FA FB 06 15 1B 14 00 29 1B"},
                  {ARCOS_CMD_RVEL, 30, "FA FB 06 15 3B 1E 00 33 3B"},
                  {ARCOS_CMD_SETRA, 100, "FA FB 06 17 3B 64 00 7B 3B"},
                  {ARCOS_CMD_SETRA, -100, "FA FB 06 17 1B 64 00 7B 1B"},
                  {ARCOS_CMD_ENCODER, 2, "FA FB 06 13 3B 02 00 15 3B"},
                  {ARCOS_CMD_SONAR, 1, "FA FB 06 1C 3B 01 00 1D 3B"},
                  {ARCOS_CMD_SONAR, 0, "FA FB 06 1C 3B 00 00 1C 3B"},
                  {ARCOS_CMD_SONAR, 5, "FA FB 06 1C 3B 05 00 21 3B"},
                  {ARCOS_CMD_IOREQUEST, 2, "FA FB 06 28 3B 02 00 2A 3B"},
                  {ARCOS_CMD_BUMPSTALL, 3, "FA FB 06 2C 3B 03 00 2F 3B"},
                  {ARCOS_CMD_HOSTBAUD, 2, "FA FB 06 32 3B 02 00 34 3B"},
                  {ARCOS_CMD_BATTERYINFO, 1, "FA FB 06 3E 3B 01 00 3F 3B"}};
    for (size_t i = 0; i < sizeof golden / sizeof golden[0]; i++) {
        assert_bytes(golden[i].hex,
                     argus_command_int(packet, sizeof packet, golden[i].command, golden[i].argument));
    }
}

void test_golden_string(void) {
    const uint8_t order[] = {1, 2, 3, 4, 5, 6, 7, 8};
    assert_bytes("FA FB 0D 03 2B 08 01 02 03 04 05 06 07 08 17 33",
                 argus_command_string(packet, sizeof packet, ARCOS_CMD_POLLING, order, sizeof order));
    assert_bytes("FA FB 05 03 2B 00 03 2B",
                 argus_command_string(packet, sizeof packet, ARCOS_CMD_POLLING, NULL, 0));
}

// Decodes as the robot does: the type byte carries the sign, the rest is a magnitude.
void test_every_argument_decodes_to_itself_limited_to_15_bits(void) {
    for (int32_t argument = -70000; argument <= 70000; argument++) {
        const int32_t wanted = argument > 32767 ? 32767 : argument < -32767 ? -32767 : argument;
        TEST_ASSERT_EQUAL(9, argus_command_int(packet, sizeof packet, ARCOS_CMD_VEL, argument));
        const int32_t magnitude = packet[5] | packet[6] << 8;
        TEST_ASSERT_EQUAL(wanted, packet[4] == 0x1B ? -magnitude : magnitude);
        TEST_ASSERT_EQUAL_HEX8(argument < 0 ? 0x1B : 0x3B, packet[4]);
    }
    argus_command_int(packet, sizeof packet, ARCOS_CMD_VEL, INT32_MIN);
    TEST_ASSERT_EQUAL_HEX8(0x1B, packet[4]);
    TEST_ASSERT_EQUAL_HEX16(32767, packet[5] | packet[6] << 8);
}

void test_what_does_not_fit_is_refused(void) {
    static uint8_t text[300];
    TEST_ASSERT_EQUAL(0, argus_command_plain(packet, 5, ARCOS_CMD_STOP));
    TEST_ASSERT_EQUAL(0, argus_command_int(packet, 8, ARCOS_CMD_VEL, 1));
    TEST_ASSERT_EQUAL(198, argus_command_string(packet, sizeof packet, ARCOS_CMD_SAY, text, 190));
    TEST_ASSERT_EQUAL(0, argus_command_string(packet, sizeof packet, ARCOS_CMD_SAY, text, 191));
    TEST_ASSERT_EQUAL(0, argus_command_string(packet, sizeof packet, ARCOS_CMD_SAY, text, SIZE_MAX));
}

// ------------------------------------------------------------------------------------------------ outbox

static int fetch(void) {
    return argus_outbox_fetch(&outbox, packet, sizeof packet) > 0 ? packet[3] : -1;
}

void test_the_first_command_can_be_asked_for(void) {
    memset(&outbox, 0, sizeof outbox);
    TEST_ASSERT_EQUAL(-1, argus_outbox_first(&outbox));
    argus_outbox_int(&outbox, ARCOS_CMD_SETV, 1);
    argus_outbox_plain(&outbox, ARCOS_CMD_PULSE);
    TEST_ASSERT_EQUAL(ARCOS_CMD_SETV, argus_outbox_first(&outbox));
    argus_outbox_urgent(&outbox, ARCOS_CMD_E_STOP);
    TEST_ASSERT_EQUAL(ARCOS_CMD_E_STOP, argus_outbox_first(&outbox));
    TEST_ASSERT_EQUAL(ARCOS_CMD_E_STOP, fetch());
}

void test_packets_leave_whole_and_in_order_round_the_ring(void) {
    uint32_t fetched = 0;
    memset(&outbox, 0, sizeof outbox);
    for (int round = 0; round < 300; round++) {
        for (int i = 0; i < 7; i++) {
            TEST_ASSERT_TRUE(argus_outbox_int(&outbox, ARCOS_CMD_VEL, round * 7 + i));
        }
        for (int i = 0; i < 7; i++) {
            TEST_ASSERT_EQUAL(ARCOS_CMD_VEL, fetch());
            TEST_ASSERT_EQUAL(round * 7 + i, packet[5] | packet[6] << 8);
            TEST_ASSERT_EQUAL(++fetched, outbox.sent);
        }
        TEST_ASSERT_EQUAL(-1, fetch());
    }
}

void test_a_buffer_too_small_leaves_the_packet_waiting(void) {
    memset(&outbox, 0, sizeof outbox);
    argus_outbox_int(&outbox, ARCOS_CMD_SETV, 5);
    TEST_ASSERT_EQUAL(0, argus_outbox_fetch(&outbox, packet, 8));
    TEST_ASSERT_EQUAL(0, outbox.sent);
    TEST_ASSERT_EQUAL(9, argus_outbox_fetch(&outbox, packet, 9));
}

static void fill(uint8_t command) {
    memset(&outbox, 0, sizeof outbox);
    while (argus_outbox_int(&outbox, command, 1)) {
    }
}

void test_a_full_outbox_refuses_counts_and_stays_as_it_was(void) {
    fill(ARCOS_CMD_SETV);
    const uint16_t before = outbox.length;
    TEST_ASSERT_EQUAL(1, outbox.refused);
    TEST_ASSERT_FALSE(argus_outbox_int(&outbox, ARCOS_CMD_SETV, 2));
    TEST_ASSERT_FALSE(argus_outbox_string(&outbox, ARCOS_CMD_SAY, packet, 191));
    TEST_ASSERT_EQUAL(3, outbox.refused);
    TEST_ASSERT_EQUAL(before, outbox.length);
    TEST_ASSERT_GREATER_OR_EQUAL(ARGUS_OUTBOX_BYTES - ARGUS_OUTBOX_RESERVE - 8, before);
}

void test_stop_and_e_stop_always_fit_and_go_first(void) {
    fill(ARCOS_CMD_SETV);
    while (argus_outbox_plain(&outbox, ARCOS_CMD_PULSE)) {
    }
    const uint32_t refused = outbox.refused;
    for (int i = 0; i < 5; i++) {
        argus_outbox_urgent(&outbox, ARCOS_CMD_STOP);
        argus_outbox_urgent(&outbox, ARCOS_CMD_E_STOP);
    }
    TEST_ASSERT_EQUAL(refused, outbox.refused);
    TEST_ASSERT_EQUAL(ARCOS_CMD_E_STOP, fetch());
    TEST_ASSERT_EQUAL(ARCOS_CMD_STOP, fetch());
    TEST_ASSERT_EQUAL(ARCOS_CMD_SETV, fetch());
    TEST_ASSERT_EQUAL(1, packet[5]);
}

void test_an_urgent_stop_drops_every_waiting_motion_and_nothing_else(void) {
    static const uint8_t motion[] = {ARCOS_CMD_MOVE,   ARCOS_CMD_VEL,  ARCOS_CMD_VEL2,  ARCOS_CMD_RVEL,
                                     ARCOS_CMD_ROTATE, ARCOS_CMD_HEAD, ARCOS_CMD_DHEAD, ARCOS_CMD_DCHEAD};
    for (unsigned turn = 0; turn < 600; turn++) { // the ring's start at every place
        memset(&outbox, 0, sizeof outbox);
        outbox.head = (uint16_t)(turn % ARGUS_OUTBOX_BYTES);
        for (size_t i = 0; i < sizeof motion; i++) {
            argus_outbox_int(&outbox, motion[i], -100);
            argus_outbox_int(&outbox, ARCOS_CMD_SETV, (int32_t)i);
        }
        argus_outbox_urgent(&outbox, ARCOS_CMD_STOP);
        TEST_ASSERT_EQUAL(ARCOS_CMD_STOP, fetch());
        for (size_t i = 0; i < sizeof motion; i++) {
            snprintf(message, sizeof message, "head %u, SETV %zu", turn, i);
            TEST_ASSERT_EQUAL_MESSAGE(ARCOS_CMD_SETV, fetch(), message);
            TEST_ASSERT_EQUAL_MESSAGE(i, packet[5], message);
        }
        TEST_ASSERT_EQUAL(-1, fetch());
    }
}

void test_what_is_not_motion_survives_an_urgent_stop(void) {
    static const uint8_t motion[] = {ARCOS_CMD_MOVE,   ARCOS_CMD_VEL,  ARCOS_CMD_VEL2,  ARCOS_CMD_RVEL,
                                     ARCOS_CMD_ROTATE, ARCOS_CMD_HEAD, ARCOS_CMD_DHEAD, ARCOS_CMD_DCHEAD};
    for (unsigned command = 0; command < 256; command++) {
        memset(&outbox, 0, sizeof outbox);
        argus_outbox_int(&outbox, (uint8_t)command, 1);
        argus_outbox_urgent(&outbox, ARCOS_CMD_STOP);
        const bool dropped = memchr(motion, (int)command, sizeof motion) != NULL || command == ARCOS_CMD_STOP;
        TEST_ASSERT_EQUAL(ARCOS_CMD_STOP, fetch());
        TEST_ASSERT_EQUAL_MESSAGE(dropped ? -1 : (int)command, fetch(), "dropped or kept wrongly");
    }
}

void test_clear_keeps_the_counters(void) {
    fill(ARCOS_CMD_SETV);
    fetch();
    argus_outbox_clear(&outbox);
    TEST_ASSERT_EQUAL(-1, fetch());
    TEST_ASSERT_EQUAL(1, outbox.sent);
    TEST_ASSERT_EQUAL(1, outbox.refused);
}

// Against a plain model: a list of commands.
void test_random_use_matches_a_list(void) {
    for (uint64_t seed = 1; seed <= 30; seed++) {
        random_t random = random_seed(seed);
        uint8_t model[ARGUS_OUTBOX_BYTES];
        size_t count = 0;
        memset(&outbox, 0, sizeof outbox);
        for (int step = 0; step < 3000; step++) {
            const uint8_t command = (uint8_t)(100 + random_below(&random, 100)); // none of them is a motion
            const uint32_t what = random_below(&random, 3);
            if (what == 0 && count > 0) {
                snprintf(message, sizeof message, "seed %llu step %d", (unsigned long long)seed, step);
                TEST_ASSERT_EQUAL_MESSAGE(model[0], fetch(), message);
                memmove(model, model + 1, --count);
            } else if (what == 1 ? argus_outbox_plain(&outbox, command)
                                 : argus_outbox_string(&outbox, command, model, random_below(&random, 60))) {
                model[count++] = command;
            }
        }
    }
}

// Room is kept for both stops; where others have taken it, nothing is overwritten.
void test_what_has_no_room_is_refused_whole(void) {
    argus_outbox_clear(&outbox);
    while (argus_outbox_plain(&outbox, ARCOS_CMD_PULSE)) {
    }
    argus_outbox_urgent(&outbox, ARCOS_CMD_STOP);
    argus_outbox_urgent(&outbox, ARCOS_CMD_E_STOP);
    const uint32_t refused = outbox.refused;
    int more = 0;
    for (uint16_t before = 0; before != outbox.length && more < 100; more++) {
        before = outbox.length;
        argus_outbox_urgent(&outbox, (uint8_t)(ARCOS_CMD_E_STOP + 1 + more));
    }
    TEST_ASSERT_EQUAL(refused + 1, outbox.refused);
    TEST_ASSERT_TRUE(outbox.length <= ARGUS_OUTBOX_BYTES);
    TEST_ASSERT_NOT_EQUAL(ARCOS_CMD_E_STOP + more, argus_outbox_first(&outbox)); // the last one
}

// Each room that is too small by itself.
void test_a_text_takes_its_length_and_eight_bytes(void) {
    for (size_t count = 0; count <= 24; count++) {
        const uint8_t text[24] = {0};
        for (size_t capacity = 0; capacity <= 40; capacity++) {
            const size_t wanted = capacity >= count + 8 ? count + 8 : 0;
            TEST_ASSERT_EQUAL(wanted, argus_command_string(packet, capacity, ARCOS_CMD_POLLING, text, count));
        }
    }
}
