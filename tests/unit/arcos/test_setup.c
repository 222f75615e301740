// SPDX-License-Identifier: MIT
// Rule: an order is done once the robot reports it, never because it was sent: unconfirmed it goes out again
// and again, and confirmed never.
#include "arcos/setup.h"

#include <stdio.h>
#include <string.h>

#include "unity.h"

#define ALL_ROWS ((1u << ARGUS_SETUP_ROWS) - 1)

static argus_setup_t setup;
static argus_outbox_t outbox;
static argus_sip_t sip;
static uint32_t now_ms;
static int away; // the last command that stays away

void setUp(void) {
    argus_setup_init(&setup);
    memset(&outbox, 0, sizeof outbox);
    memset(&sip, 0, sizeof sip);
    now_ms = UINT32_MAX - 700; // the clock wraps
    away = -1;
}

static void send(uint8_t command, int32_t value) {
    uint8_t packet[16];
    argus_setup_sent(&setup, now_ms, packet, argus_command_int(packet, sizeof packet, command, value));
}

// How often the command goes out in so long, with a SIP each 100 ms.
static int again(uint8_t command, uint32_t ms) {
    uint8_t packet[ARGUS_PACKET_MAX];
    int times = 0;
    for (uint32_t t = 0; t < ms; t += 10) {
        now_ms += 10;
        if (t % 100 == 0) {
            argus_setup_sip(&setup, now_ms, &sip);
        }
        const int one = argus_setup_resend(&setup, &outbox, now_ms, ALL_ROWS);
        away = one >= 0 ? one : away;
        for (size_t size; (size = argus_outbox_fetch(&outbox, packet, sizeof packet)) > 0;) {
            argus_setup_sent(&setup, now_ms, packet, size);
            times += packet[3] == command;
        }
    }
    return times;
}

void test_enable_is_sent_until_the_motors_are_on(void) {
    send(ARCOS_CMD_ENABLE, 1);
    TEST_ASSERT_TRUE(again(ARCOS_CMD_ENABLE, 10000) >= 4);
    TEST_ASSERT_EQUAL_INT(ARCOS_CMD_ENABLE, away);
    sip.flags |= ARCOS_FLAG_MOTORS;
    again(ARCOS_CMD_ENABLE, 200);
    TEST_ASSERT_EQUAL_INT(0, again(ARCOS_CMD_ENABLE, 30000));
    TEST_ASSERT_FALSE(argus_setup_is_open(&setup, ARGUS_SETUP_ENABLE));
}

// A person has pressed the button.
void test_a_stop_button_is_not_an_order_that_got_lost(void) {
    send(ARCOS_CMD_ENABLE, 1);
    sip.flags |= ARCOS_FLAG_ESTOP;
    TEST_ASSERT_EQUAL_INT(0, again(ARCOS_CMD_ENABLE, 10000));
}

void test_stop_is_sent_until_the_wheels_slow_down(void) {
    static const uint8_t stops[] = {ARCOS_CMD_STOP, ARCOS_CMD_E_STOP};
    for (unsigned i = 0; i < sizeof stops; i++) {
        setUp();
        sip.vel_left_mm_s = sip.vel_right_mm_s = 300;
        argus_setup_sip(&setup, now_ms, &sip);
        send(stops[i], 0);
        const int times = again(stops[i], 1000);
        TEST_ASSERT_TRUE(times >= 8 && times <= 11);
        sip.vel_left_mm_s = sip.vel_right_mm_s = 0;
        again(stops[i], 100);
        TEST_ASSERT_EQUAL_INT(0, again(stops[i], 5000));
    }
}

// On the spot the wheels are as fast, whatever their mean is.
void test_a_turn_is_no_rest(void) {
    sip.vel_left_mm_s = -200;
    sip.vel_right_mm_s = 200;
    argus_setup_sip(&setup, now_ms, &sip);
    send(ARCOS_CMD_STOP, 0);
    TEST_ASSERT_TRUE(again(ARCOS_CMD_STOP, 1000) >= 8);
}

void test_a_motion_ordered_since_ends_a_stop(void) {
    sip.vel_left_mm_s = sip.vel_right_mm_s = 300;
    argus_setup_sip(&setup, now_ms, &sip);
    send(ARCOS_CMD_STOP, 0);
    send(ARCOS_CMD_MOVE, 200);
    TEST_ASSERT_EQUAL_INT(0, again(ARCOS_CMD_STOP, 3000));
}

// One that tells of no settings is not asked for ever.
void test_what_the_robot_tells_nothing_of_is_sent_twice_more(void) {
    send(ARCOS_CMD_SETV, 300);
    TEST_ASSERT_EQUAL_INT(2, again(ARCOS_CMD_SETV, 60000));
    TEST_ASSERT_EQUAL_INT(-1, away);
}

void test_wheels_at_the_speed_confirm_setv(void) {
    send(ARCOS_CMD_SETV, 300);
    sip.vel_left_mm_s = sip.vel_right_mm_s = 290;
    TEST_ASSERT_EQUAL_INT(0, again(ARCOS_CMD_SETV, 20000));
}

void test_an_order_is_doubted_once_it_is_done_and_dropped_again(void) {
    argus_setup_doubt(&setup, ARGUS_SETUP_ENABLE); // it was never sent
    TEST_ASSERT_FALSE(argus_setup_is_open(&setup, ARGUS_SETUP_ENABLE));
    send(ARCOS_CMD_ENABLE, 1);
    sip.flags |= ARCOS_FLAG_MOTORS;
    again(ARCOS_CMD_ENABLE, 300);
    TEST_ASSERT_FALSE(argus_setup_is_open(&setup, ARGUS_SETUP_ENABLE));
    argus_setup_doubt(&setup, ARGUS_SETUP_ENABLE);
    TEST_ASSERT_TRUE(argus_setup_is_open(&setup, ARGUS_SETUP_ENABLE));
    argus_setup_drop(&setup, ARGUS_SETUP_ENABLE);
    TEST_ASSERT_FALSE(argus_setup_is_open(&setup, ARGUS_SETUP_ENABLE));
}
