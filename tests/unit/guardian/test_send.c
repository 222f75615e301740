// SPDX-License-Identifier: MIT
// Rule under attack: what a client asks of brakes and turns stays within what S5 and S7 count on; a packet
// that has no room is not sent in part; what a client began ends with it.
#include "guardian/send.h"

#include <string.h>

#include "client.h"
#include "unity.h"

static robot_t robot;
static argus_port_t port;

void setUp(void) {
    const argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &config, 1000);
    memset(&port, 0, sizeof port);
}

static int32_t limited(uint8_t command, int32_t argument) {
    return argus_send_limited(&robot.argus, command, argument);
}

void test_no_client_weakens_the_brakes(void) {
    const int32_t least = robot.argus.knowledge.robot->decel_mm_s2;
    TEST_ASSERT_EQUAL_INT32(-least, limited(ARCOS_CMD_SETA, -1));
    TEST_ASSERT_EQUAL_INT32(-least - 100, limited(ARCOS_CMD_SETA, -least - 100));
    TEST_ASSERT_EQUAL_INT32(-ARGUS_CLIENT_TURN_DECEL, limited(ARCOS_CMD_SETRA, -1));
}

// 0 is taken for both by a robot, so it is what it may be at most.
void test_acceleration_has_an_upper_bound_and_0_is_that(void) {
    const int32_t most = limited(ARCOS_CMD_SETA, INT16_MAX);
    TEST_ASSERT_TRUE(most > 0 && most < INT16_MAX);
    TEST_ASSERT_EQUAL_INT32(most, limited(ARCOS_CMD_SETA, 0));
    TEST_ASSERT_EQUAL_INT32(100, limited(ARCOS_CMD_SETA, 100));
}

void test_speeds_have_no_sign_and_a_turn_has_a_bound(void) {
    TEST_ASSERT_EQUAL_INT32(400, limited(ARCOS_CMD_SETV, -400));
    TEST_ASSERT_EQUAL_INT32(ARGUS_CLIENT_TURN_DEG_S, limited(ARCOS_CMD_SETRV, -3000));
    TEST_ASSERT_EQUAL_INT32(20, limited(ARCOS_CMD_SETRV, 20));
}

void test_what_is_no_parameter_of_motion_is_not_limited(void) {
    TEST_ASSERT_EQUAL_INT32(-30000, limited(ARCOS_CMD_GRIPPER, -30000));
}

void test_a_stream_is_known_by_its_command_and_ends_by_0(void) {
    static const uint8_t streams[] = {ARCOS_CMD_ENCODER, ARCOS_CMD_IOREQUEST,  ARCOS_CMD_JOYREQUEST,
                                      ARCOS_CMD_GYRO,    ARCOS_CMD_IMUREQUEST, ARCOS_CMD_GRIPREQUEST};
    unsigned all = 0;
    for (size_t i = 0; i < sizeof streams; i++) {
        const uint8_t bit = argus_send_stream(streams[i], 2);
        TEST_ASSERT_EQUAL_UINT8_MESSAGE(0, bit & (bit - 1u), "one bit");
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(0, all & bit, "of its own");
        TEST_ASSERT_EQUAL_HEX8(0, argus_send_stream(streams[i], 0));
        all |= bit;
    }
    TEST_ASSERT_EQUAL_HEX8(0x3F, all);
    TEST_ASSERT_EQUAL_HEX8(0, argus_send_stream(ARCOS_CMD_VEL, 100));
}

static bool to_client(size_t count) {
    static const uint8_t data[300];
    return argus_send_client(&port, data, count);
}

void test_what_has_no_room_is_counted_and_leaves_no_part(void) {
    TEST_ASSERT_FALSE(to_client(ARCOS_FRAME_COUNT_MAX - 1)); // no frame is so long
    TEST_ASSERT_EQUAL(0, port.out_length);
    TEST_ASSERT_EQUAL(1, port.lost);
    size_t sent = 0;
    while (to_client(100)) {
        sent++;
    }
    TEST_ASSERT_EQUAL(sent * (ARCOS_FRAME_OVERHEAD + 102), port.out_length);
    TEST_ASSERT_TRUE(port.out_length <= sizeof port.out);
    TEST_ASSERT_EQUAL(2, port.lost);
}

// The rest of the outbox is for what stops the robot.
void test_a_client_cannot_fill_the_outbox(void) {
    static const uint8_t data[100];
    argus_outbox_t out = {.length = 0};
    const argus_grant_t grant = {.core = &robot.argus, .out = &out};
    const argus_packet_t packet = {.data = data, .count = sizeof data};
    int passed = 0;
    while (argus_send_robot(&grant, &packet)) {
        passed++;
    }
    TEST_ASSERT_TRUE(passed > 0 && out.length <= 320);
    TEST_ASSERT_TRUE(argus_outbox_plain(&out, ARCOS_CMD_STOP));
}

// What a client has set stays; what it has not is the robot's own, or the usual where that has not come.
void test_a_clients_settings_are_filled_and_not_replaced(void) {
    static argus_outbox_t out;
    const argus_grant_t grant = {.core = &robot.argus, .out = &out, .motion = &robot.argus.motion};
    for (int told = 0; told < 2; told++) {
        setUp();
        out = (argus_outbox_t){0};
        robot.argus.session.robot.vel_max_mm_s = told != 0 ? 900 : 0;
        argus_port_settings_t settings = {.setrv_deg_s = 30, .turn_accel_deg_s2 = 55};
        argus_send_settings(&grant, &settings);
        TEST_ASSERT_EQUAL(told != 0 ? 900 : 750, settings.setv_mm_s);
        TEST_ASSERT_EQUAL(30, settings.setrv_deg_s);
        TEST_ASSERT_EQUAL(55, settings.turn_accel_deg_s2);
        settings.setv_mm_s = 123;
        argus_send_settings(&grant, &settings);
        TEST_ASSERT_EQUAL(123, settings.setv_mm_s);
    }
}

// Each setting is noted in its own place, without its sign, and in no other.
void test_a_setting_is_noted_in_its_place(void) {
    argus_port_settings_t settings = {0};
    argus_send_note(&settings, ARCOS_CMD_SETV, -210);
    argus_send_note(&settings, ARCOS_CMD_SETRV, 31);
    argus_send_note(&settings, ARCOS_CMD_SETA, 320);
    argus_send_note(&settings, ARCOS_CMD_SETA, -330);
    argus_send_note(&settings, ARCOS_CMD_SETRA, 41);
    argus_send_note(&settings, ARCOS_CMD_SETRA, -42);
    TEST_ASSERT_EQUAL_INT32(210, settings.setv_mm_s);
    TEST_ASSERT_EQUAL_INT32(31, settings.setrv_deg_s);
    TEST_ASSERT_EQUAL_INT32(320, settings.accel_mm_s2);
    TEST_ASSERT_EQUAL_INT32(330, settings.decel_mm_s2);
    TEST_ASSERT_EQUAL_INT32(41, settings.turn_accel_deg_s2);
    TEST_ASSERT_EQUAL_INT32(42, settings.turn_decel_deg_s2);
}
