// SPDX-License-Identifier: MIT
// Attacks: a command is read as the robot reads it, whichever form its argument has: sign in the type,
// missing bytes, both ways of sending a word; one channel does not disturb the other.
#include "guardian/wish.h"

#include <string.h>

#include "unity.h"

static argus_wish_t wish;

void setUp(void) {
    memset(&wish, 0, sizeof wish);
}

static void take(const uint8_t *data, uint8_t count) {
    const argus_packet_t packet = {.data = data, .count = count};
    argus_said_t said;
    TEST_ASSERT_TRUE(argus_admit(&packet, &said));
    argus_wish_take(&wish, &said, 7, 30);
}

static void say(uint8_t command, int32_t argument) {
    const int32_t size = argument < 0 ? -argument : argument;
    const uint8_t data[] = {command, argument < 0 ? 0x1B : 0x3B, (uint8_t)(size & 0xFF),
                            (uint8_t)(size >> 8)};
    take(data, sizeof data);
}

void test_the_sign_travels_in_the_type(void) {
    say(ARCOS_CMD_VEL, 300);
    TEST_ASSERT_EQUAL_INT32(300, wish.mm_s);
    say(ARCOS_CMD_VEL, -300);
    TEST_ASSERT_EQUAL_INT32(-300, wish.mm_s);
    say(ARCOS_CMD_MOVE, -500);
    TEST_ASSERT_EQUAL_INT32(-500, wish.left_mm);
    TEST_ASSERT_EQUAL_UINT32(7, wish.odometer_mm);
}

void test_missing_bytes_are_0(void) {
    static const uint8_t bare[] = {ARCOS_CMD_VEL};
    static const uint8_t half[] = {ARCOS_CMD_VEL, 0x3B, 0x20};
    say(ARCOS_CMD_VEL, 300);
    take(half, sizeof half);
    TEST_ASSERT_EQUAL_INT32(0x20, wish.mm_s);
    take(bare, sizeof bare);
    TEST_ASSERT_EQUAL_UINT8(ARGUS_WISH_REST, wish.way);
}

void test_vel2_in_both_forms(void) {
    static const uint8_t raw[] = {ARCOS_CMD_VEL2, 0x3B, 0x03, 0xFB};     // left -5, right +3
    static const uint8_t negated[] = {ARCOS_CMD_VEL2, 0x1B, 0xFD, 0x04}; // the same
    take(raw, sizeof raw);
    TEST_ASSERT_EQUAL_INT32(-20, wish.mm_s);
    TEST_ASSERT_EQUAL_INT32(80, wish.half_mm_s);
    setUp();
    take(negated, sizeof negated);
    TEST_ASSERT_EQUAL_INT32(-20, wish.mm_s);
    TEST_ASSERT_EQUAL_INT32(80, wish.half_mm_s);
    TEST_ASSERT_TRUE(wish.paired);
    say(ARCOS_CMD_RVEL, 10);
    TEST_ASSERT_FALSE(wish.paired);
    TEST_ASSERT_EQUAL_INT32(-20, wish.mm_s);
}

void test_headings(void) {
    say(ARCOS_CMD_DHEAD, -90); // from 30
    TEST_ASSERT_EQUAL_INT32(-60, wish.heading_deg);
    say(ARCOS_CMD_DCHEAD, -150); // from what was asked for
    TEST_ASSERT_EQUAL_INT32(150, wish.heading_deg);
    say(ARCOS_CMD_HEAD, 370);
    TEST_ASSERT_EQUAL_INT32(10, wish.heading_deg);
    say(ARCOS_CMD_RVEL, 0);
    TEST_ASSERT_EQUAL_UINT8(ARGUS_WISH_STRAIGHT, wish.turn);
    say(ARCOS_CMD_DCHEAD, 5);
    TEST_ASSERT_EQUAL_INT32(35, wish.heading_deg);
}

void test_a_turn_leaves_the_way_and_the_way_the_turn(void) {
    say(ARCOS_CMD_VEL, 300);
    say(ARCOS_CMD_ROTATE, -20);
    TEST_ASSERT_EQUAL_INT32(300, wish.mm_s);
    say(ARCOS_CMD_MOVE, 100);
    TEST_ASSERT_EQUAL_INT32(-20, wish.deg_s);
    TEST_ASSERT_EQUAL_UINT8(ARGUS_WISH_RVEL, wish.turn);
}

void test_a_heading_is_a_motion_whichever_it_is_and_a_speed_of_nothing_is_none(void) {
    const argus_said_t north = {.topic = ARGUS_TOPIC_TURN, .command = ARCOS_CMD_HEAD, .argument = 0};
    const argus_said_t stand = {.topic = ARGUS_TOPIC_WAY, .command = ARCOS_CMD_VEL, .argument = 0};
    const argus_said_t drive = {.topic = ARGUS_TOPIC_WAY, .command = ARCOS_CMD_VEL, .argument = -1};
    TEST_ASSERT_TRUE(argus_wish_moves(&north));
    TEST_ASSERT_FALSE(argus_wish_moves(&stand));
    TEST_ASSERT_TRUE(argus_wish_moves(&drive));
}
