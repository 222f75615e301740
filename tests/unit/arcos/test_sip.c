// SPDX-License-Identifier: MIT
// Rule under attack: a SIP is decoded by the length that is there, field by field, and a lying sonar count is
// refused.
#include "arcos/sip.h"

#include <string.h>

#include "captures.h"
#include "unity.h"

#define STATIONARY                                                                                           \
    "FA FB 28 32 00 00 00 00 00 00 00 00 00 00 80 00 00 00 00 06 00 00 02 00 88 13 08 D2 04 00 00 00 FF 00 " \
    "80 00 00 "                                                                                              \
    "00 00 00 00 1F 95"
#define MOVING                                                                                               \
    "FA FB 34 33 DC 05 06 FF 00 04 2C 01 2C 01 7F 00 00 00 00 07 00 00 06 02 2C 03 03 16 03 0A 88 13 0B 88 " \
    "13 04 25 "                                                                                              \
    "03 0C 88 13 00 00 00 FF 00 7F 00 00 00 00 00 00 97 59"

static uint8_t bytes[ARGUS_FRAME_TOTAL_MAX];
static argus_sip_t sip;

static argus_packet_t packet_of(const char *hex) {
    const size_t total = captures_hex(hex, bytes, sizeof bytes);
    const argus_packet_t packet = {bytes + 3, (uint8_t)(total - 5)};
    memset(&sip, 0xA5, sizeof sip); // what is not written must show
    return packet;
}

static void assert_sonar(size_t i, unsigned number, unsigned range_mm) {
    TEST_ASSERT_EQUAL(number, sip.sonar[i].number);
    TEST_ASSERT_EQUAL(range_mm, sip.sonar[i].range_mm);
}

void test_the_worked_example_at_rest(void) {
    const argus_packet_t packet = packet_of(STATIONARY);
    TEST_ASSERT_TRUE(argus_sip_decode(&sip, &packet));
    TEST_ASSERT_FALSE(sip.moving);
    TEST_ASSERT_EQUAL(0, sip.x_raw | sip.y_raw | sip.heading_raw | sip.vel_left_mm_s | sip.vel_right_mm_s);
    TEST_ASSERT_EQUAL(128, sip.battery_dv);
    TEST_ASSERT_EQUAL(0x0006, sip.flags);
    TEST_ASSERT_EQUAL(2, sip.sonar_count);
    assert_sonar(0, 0, 5000);
    assert_sonar(1, 8, 1234);
    assert_sonar(2, 0xA5, 0xA5A5); // no more than are listed
    TEST_ASSERT_TRUE(sip.has_battery_x10 && sip.has_rotvel && sip.has_faultflags);
    TEST_ASSERT_EQUAL(128, sip.battery_x10_dv);
    TEST_ASSERT_EQUAL(0, sip.rotvel_ddeg_s);
    TEST_ASSERT_EQUAL(0, sip.faultflags);
}

void test_the_worked_example_in_motion(void) {
    const argus_packet_t packet = packet_of(MOVING);
    TEST_ASSERT_TRUE(argus_sip_decode(&sip, &packet));
    TEST_ASSERT_TRUE(sip.moving);
    TEST_ASSERT_EQUAL(1500, sip.x_raw);
    TEST_ASSERT_EQUAL(-250, (int16_t)sip.y_raw);
    TEST_ASSERT_EQUAL(1024, sip.heading_raw);
    TEST_ASSERT_EQUAL(300, sip.vel_left_mm_s);
    TEST_ASSERT_EQUAL(300, sip.vel_right_mm_s);
    TEST_ASSERT_EQUAL(127, sip.battery_dv);
    TEST_ASSERT_EQUAL(0x0007, sip.flags);
    TEST_ASSERT_EQUAL(6, sip.sonar_count);
    assert_sonar(0, 2, 812);
    assert_sonar(1, 3, 790);
    assert_sonar(4, 4, 805);
    assert_sonar(5, 12, 5000);
}

// Every multi-byte field with a different value in each byte, signs included.
void test_every_field_has_its_place(void) {
    argus_packet_t packet = packet_of(STATIONARY);
    const uint8_t fixed[] = {0x33, 0x01, 0x82, 0x03, 0x84, 0xFF, 0xF8, 0xFE, 0xFF, 0x0A,
                             0x80, 0x0B, 0x21, 0x0C, 0x0D, 0x0E, 0x11, 0x04, 0x0F, 0x00};
    const uint8_t tail[] = {0x31, 0x32, 0x33, 0x34, 0x35, 0x36, 0x01, 0x38, 0xC7, 0xFF, 0x10, 0x20};
    memcpy(bytes + 3, fixed, sizeof fixed);
    memcpy(bytes + 3 + sizeof fixed, tail, sizeof tail);
    packet.count = sizeof fixed + sizeof tail;
    TEST_ASSERT_TRUE(argus_sip_decode(&sip, &packet));
    TEST_ASSERT_EQUAL_HEX16(0x8201, sip.x_raw);
    TEST_ASSERT_EQUAL_HEX16(0x8403, sip.y_raw);
    TEST_ASSERT_EQUAL(-1793, sip.heading_raw);
    TEST_ASSERT_EQUAL(-2, sip.vel_left_mm_s);
    TEST_ASSERT_EQUAL(-32758, sip.vel_right_mm_s);
    TEST_ASSERT_EQUAL(0x0B, sip.battery_dv);
    TEST_ASSERT_TRUE(sip.stall_left);
    TEST_ASSERT_FALSE(sip.stall_right);
    TEST_ASSERT_EQUAL_HEX8(0x20, sip.bumpers_rear);
    TEST_ASSERT_EQUAL_HEX8(0x0C, sip.bumpers_front);
    TEST_ASSERT_EQUAL_HEX16(0x0411, sip.flags);
    TEST_ASSERT_EQUAL(0, sip.sonar_count);
    TEST_ASSERT_EQUAL(0x0136, sip.battery_x10_dv);
    TEST_ASSERT_EQUAL(-57, sip.rotvel_ddeg_s);
    TEST_ASSERT_EQUAL_HEX16(0x2010, sip.faultflags);
}

void test_stall_and_bumper_bits_are_kept_apart(void) {
    const argus_packet_t packet = packet_of(STATIONARY);
    for (unsigned left = 0; left < 256; left++) {
        for (unsigned right = 0; right < 256; right += 17) {
            bytes[15] = (uint8_t)left;
            bytes[16] = (uint8_t)right;
            TEST_ASSERT_TRUE(argus_sip_decode(&sip, &packet));
            TEST_ASSERT_EQUAL(left & 1, sip.stall_left);
            TEST_ASSERT_EQUAL(right & 1, sip.stall_right);
            TEST_ASSERT_EQUAL(left & 0xFE, sip.bumpers_rear);
            TEST_ASSERT_EQUAL(right & 0xFE, sip.bumpers_front);
        }
    }
}

// Cut at every length: refused while readings are missing, then group after group.
void test_a_sip_may_end_at_any_group(void) {
    argus_packet_t packet = packet_of(MOVING);
    for (unsigned count = 0; count <= 50; count++) {
        packet.count = (uint8_t)count;
        memset(&sip, 0xA5, sizeof sip);
        const bool whole = count >= 20 + 18;
        TEST_ASSERT_EQUAL_MESSAGE(whole, argus_sip_decode(&sip, &packet), "readings missing, or not");
        if (whole) {
            TEST_ASSERT_EQUAL(count >= 38 + 7, sip.has_battery_x10);
            TEST_ASSERT_EQUAL(count >= 38 + 10, sip.has_rotvel);
            TEST_ASSERT_EQUAL(count >= 38 + 12, sip.has_faultflags);
            TEST_ASSERT_EQUAL(count >= 38 + 7 ? 127 : 0, sip.battery_x10_dv);
            TEST_ASSERT_EQUAL(0, sip.rotvel_ddeg_s);
            TEST_ASSERT_EQUAL(0, sip.faultflags);
        }
    }
}

void test_a_longer_tail_changes_nothing(void) {
    argus_packet_t packet = packet_of(MOVING);
    argus_sip_t standard;
    memset(&standard, 0xA5, sizeof standard);
    TEST_ASSERT_TRUE(argus_sip_decode(&standard, &packet));
    for (unsigned extra = 1; extra < 100; extra++) {
        packet.count = (uint8_t)(50 + extra);
        memset(&sip, 0xA5, sizeof sip);
        TEST_ASSERT_TRUE(argus_sip_decode(&sip, &packet));
        TEST_ASSERT_EQUAL_MEMORY(&standard, &sip, sizeof sip);
    }
}

void test_only_the_two_sip_types_are_sips(void) {
    const argus_packet_t packet = packet_of(MOVING);
    for (unsigned type = 0; type < 256; type++) {
        bytes[3] = (uint8_t)type;
        TEST_ASSERT_EQUAL(type == 0x32 || type == 0x33, argus_sip_decode(&sip, &packet));
    }
}

// Any sonar count against any length; readings must never be taken from behind the packet.
void test_a_lying_sonar_count_is_refused(void) {
    argus_packet_t packet = packet_of(MOVING);
    for (unsigned count = 1; count <= 253; count++) {
        uint8_t exact[253] = {0x32};
        packet.data = exact;
        packet.count = (uint8_t)count;
        for (unsigned sonars = 0; sonars < 256 && count >= 20; sonars++) {
            exact[19] = (uint8_t)sonars;
            const bool fits = 20 + 3 * sonars <= count;
            TEST_ASSERT_EQUAL(fits, argus_sip_decode(&sip, &packet));
            TEST_ASSERT_TRUE(!fits || sip.sonar_count <= ARGUS_SIP_SONARS_MAX);
        }
    }
}

// What the recorder saw of the vendor's emulator: all sonars in each SIP, 61 SIPs with both wheels stalled in
// d_ram.
void test_recorded_sips_decode_to_what_was_recorded(void) {
    static captures_t stream;
    size_t stalled = 0;
    captures_load(&stream, "d_ram", "r2c");
    for (size_t i = 0; i < stream.packets; i++) {
        const uint8_t *frame = stream.bytes + stream.at[i];
        const argus_packet_t packet = {frame + 3, (uint8_t)(frame[2] - 2)};
        if (frame[3] == 0x32) {
            TEST_ASSERT_TRUE(argus_sip_decode(&sip, &packet));
            TEST_ASSERT_EQUAL(16, sip.sonar_count);
            assert_sonar(15, 15, (unsigned)(frame[3 + 20 + 46] | frame[3 + 20 + 47] << 8));
            stalled += sip.stall_left && sip.stall_right;
            TEST_ASSERT_EQUAL(0, sip.bumpers_front | sip.bumpers_rear);
        }
    }
    TEST_ASSERT_EQUAL(61, stalled);
}
