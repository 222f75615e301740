// SPDX-License-Identifier: MIT
// Rule under attack: every field used of a CONFIGpac is read from its place, and what a short one lacks reads
// as 0.
#include "arcos/configpac.h"

#include <string.h>

#include "captures.h"
#include "unity.h"

#define EXAMPLE                                                                                              \
    "FA FB 77 20 50 69 6F 6E 65 65 72 00 70 33 64 78 2D 73 68 00 50 33 44 58 30 30 30 31 00 00 68 01 DC 05 " \
    "2C 01 D0 "                                                                                              \
    "07 F4 01 50 33 44 58 5F 30 30 30 31 00 64 00 00 00 00 01 00 01 73 00 BA 40 D0 07 00 C8 00 64 00 EE 02 " \
    "32 00 64 "                                                                                              \
    "00 EE 02 64 00 64 00 28 00 14 00 00 00 2C 01 2C 01 28 00 1E 00 00 00 00 00 00 28 02 00 00 00 00 00 80 " \
    "00 6E 00 "                                                                                              \
    "32 2E 36 00 00 00 00 00 00 4C 38"

static uint8_t bytes[ARGUS_FRAME_TOTAL_MAX];
static argus_configpac_t config;

static argus_packet_t example(void) {
    const size_t total = captures_hex(EXAMPLE, bytes, sizeof bytes);
    const argus_packet_t packet = {bytes + 3, (uint8_t)(total - 5)};
    memset(&config, 0xA5, sizeof config);
    return packet;
}

void test_the_worked_example(void) {
    const argus_packet_t packet = example();
    TEST_ASSERT_EQUAL(117, packet.count);
    TEST_ASSERT_TRUE(argus_configpac_decode(&config, &packet));
    TEST_ASSERT_EQUAL_STRING("Pioneer", config.robot_class);
    TEST_ASSERT_EQUAL_STRING("p3dx-sh", config.robot_subclass);
    TEST_ASSERT_EQUAL_STRING("P3DX0001", config.serial);
    TEST_ASSERT_EQUAL_STRING("P3DX_0001", config.name);
    TEST_ASSERT_EQUAL_STRING("2.6", config.version);
    TEST_ASSERT_EQUAL(40, config.sonar_cycle_ms);
    TEST_ASSERT_TRUE(config.rear_sonar);
    TEST_ASSERT_EQUAL(115, config.low_battery_dv);
    TEST_ASSERT_EQUAL(2000, config.watchdog_ms);
    TEST_ASSERT_EQUAL(100, config.rotvel_max_deg_s);
    TEST_ASSERT_EQUAL(750, config.vel_max_mm_s);
    TEST_ASSERT_EQUAL(300, config.accel_mm_s2);
    TEST_ASSERT_EQUAL(300, config.decel_mm_s2);
    TEST_ASSERT_EQUAL(0, config.front_bumpers);
    TEST_ASSERT_EQUAL(0, config.rear_bumpers);
}

// Offsets as in the table of the specification, from the first header byte.
void test_each_field_is_read_from_its_own_bytes(void) {
    const argus_packet_t packet = example();
    for (size_t at = 30; at <= 37; at++) {
        bytes[at] = (uint8_t)at;
    }
    bytes[51] = 3;
    bytes[53] = 9; // GRIPPER must not be taken for FRONTSONAR
    bytes[55] = 0;
    bytes[56] = 1;
    bytes[57] = 0;
    bytes[87] = 0x11;
    bytes[88] = 0x22;
    bytes[89] = 0x33;
    bytes[90] = 0x44;
    bytes[97] = 5;
    bytes[98] = 6;
    bytes[100] = 17;
    bytes[101] = 1;
    TEST_ASSERT_TRUE(argus_configpac_decode(&config, &packet));
    TEST_ASSERT_FALSE(config.rear_sonar);
    TEST_ASSERT_EQUAL_HEX16(0x2211, config.accel_mm_s2);
    TEST_ASSERT_EQUAL_HEX16(0x4433, config.decel_mm_s2);
    TEST_ASSERT_EQUAL(5, config.front_bumpers);
    TEST_ASSERT_EQUAL(6, config.rear_bumpers);
    TEST_ASSERT_EQUAL(17, config.sonar_cycle_ms);
}

void test_a_short_one_reads_zero_where_it_ends(void) {
    for (unsigned count = 0; count <= 117; count++) {
        argus_packet_t packet = example();
        uint8_t exact[117];
        memcpy(exact, packet.data, sizeof exact);
        memset(exact + count, 0xEE, sizeof exact - count); // bytes behind the end must not matter
        packet.data = exact;
        packet.count = (uint8_t)count;
        const bool whole = argus_configpac_decode(&config, &packet);
        TEST_ASSERT_EQUAL(count >= 26, whole); // three strings end at offset 28
        if (whole) {
            TEST_ASSERT_EQUAL_STRING(count >= 47 ? "P3DX_0001" : "", config.name);
            TEST_ASSERT_EQUAL(count >= 61 ? 2000 : 0, config.watchdog_ms);
            TEST_ASSERT_EQUAL(count >= 98 ? 40 : 0, config.sonar_cycle_ms);
            TEST_ASSERT_EQUAL_STRING(count >= 112 ? "2.6" : "", config.version);
        }
    }
}

void test_other_types_are_refused(void) {
    const argus_packet_t packet = example();
    for (unsigned type = 0; type < 256; type++) {
        bytes[3] = (uint8_t)type;
        TEST_ASSERT_EQUAL(type == 0x20, argus_configpac_decode(&config, &packet));
    }
}

void test_a_string_is_cut_and_made_printable(void) {
    uint8_t data[60];
    char out[ARGUS_NAME_MAX];
    size_t offset = 2;
    memset(data, 'a', sizeof data);
    data[3] = 0x1B; // an escape sequence must not reach a terminal
    data[4] = 0xFF;
    data[5] = 0x7F;
    data[50] = 0;
    const argus_packet_t packet = {data, sizeof data};
    TEST_ASSERT_TRUE(argus_packet_string(&packet, &offset, out));
    TEST_ASSERT_EQUAL(51, offset);
    TEST_ASSERT_EQUAL(ARGUS_NAME_MAX - 1, strlen(out));
    TEST_ASSERT_EQUAL_MEMORY("a???a", out, 5);
    TEST_ASSERT_FALSE(argus_packet_string(&packet, &offset, out));
    TEST_ASSERT_EQUAL_STRING("", out);
    TEST_ASSERT_EQUAL(51, offset);
    offset = 60;
    TEST_ASSERT_FALSE(argus_packet_string(&packet, &offset, out));
    offset = SIZE_MAX;
    TEST_ASSERT_FALSE(argus_packet_string(&packet, &offset, out));
}

void test_the_recorded_ones(void) {
    static captures_t stream;
    size_t seen = 0;
    captures_load(&stream, "a_idle", "r2c");
    for (size_t i = 0; i < stream.packets; i++) {
        const uint8_t *frame = stream.bytes + stream.at[i];
        const argus_packet_t packet = {frame + 3, (uint8_t)(frame[2] - 2)};
        if (argus_configpac_decode(&config, &packet)) {
            seen++;
            TEST_ASSERT_EQUAL_STRING("p3dx", config.robot_subclass);
            TEST_ASSERT_EQUAL_STRING("SIM", config.serial);
            TEST_ASSERT_EQUAL_STRING("MobileSim", config.name);
            TEST_ASSERT_EQUAL_STRING("S.0", config.version);
        }
    }
    TEST_ASSERT_EQUAL(2, seen);
}
