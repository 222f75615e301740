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
// Also while no SIP tells what became of it: a stop may have gone out since.
void test_what_sets_the_robot_off_is_said_once(void) {
    static const struct {
        uint8_t command;
        int16_t value;
    } motions[] = {{ARCOS_CMD_VEL, 300}, {ARCOS_CMD_VEL, -1}, {ARCOS_CMD_RVEL, 119}, {ARCOS_CMD_RVEL, -1}};
    for (unsigned i = 0; i < sizeof motions / sizeof motions[0]; i++) {
        setUp();
        send(motions[i].command, motions[i].value);
        send(ARCOS_CMD_STOP, 0);
        for (uint32_t t = 0; t < 20000; t += 10) {
            uint8_t packet[ARGUS_PACKET_MAX];
            now_ms += 10;
            argus_setup_resend(&setup, &outbox, now_ms, ALL_ROWS);
            for (size_t size; (size = argus_outbox_fetch(&outbox, packet, sizeof packet)) > 0;) {
                argus_setup_sent(&setup, now_ms, packet, size);
                TEST_ASSERT_NOT_EQUAL(motions[i].command, packet[3]);
            }
        }
        TEST_ASSERT_TRUE(argus_setup_is_open(&setup, ARGUS_SETUP_STOP));
    }
}

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

// An order of any length and content that a client may send is read within what there is of sonars.
void test_a_polling_order_of_anything_is_taken_within_its_bounds(void) {
    static const uint8_t order[] = {0, 1, 32, 33, 200, 1};
    uint8_t packet[ARGUS_PACKET_MAX];
    const size_t size = argus_command_string(packet, sizeof packet, ARCOS_CMD_POLLING, order, sizeof order);
    argus_setup_sent(&setup, now_ms, packet, size);
    TEST_ASSERT_EQUAL(6, setup.polling_count);
    for (int i = 0; i < ARGUS_SETUP_SONARS; i++) {
        TEST_ASSERT_EQUAL(i == 0 ? 2 : i == 31 ? 1 : 0, setup.share[i]);
    }
    uint8_t longest[ARGUS_SETUP_POLLING_MAX + 1];
    memset(longest, 3, sizeof longest);
    const size_t more =
        argus_command_string(packet, sizeof packet, ARCOS_CMD_POLLING, longest, sizeof longest);
    TEST_ASSERT_GREATER_THAN(0, more);
    argus_setup_sent(&setup, now_ms, packet, more);
    TEST_ASSERT_EQUAL(6, setup.polling_count); // longer than any: it is not the order at work
}

// As long as an order with a number: its bytes are no number all the same.
void test_an_order_of_one_sonar_is_no_number(void) {
    static const uint8_t order[] = {5};
    uint8_t packet[ARGUS_PACKET_MAX];
    argus_setup_sent(&setup, now_ms, packet,
                     argus_command_string(packet, sizeof packet, ARCOS_CMD_POLLING, order, 1));
    TEST_ASSERT_EQUAL(0, setup.order[ARGUS_SETUP_POLLING].value);
    TEST_ASSERT_EQUAL(1, setup.share[4]);
}

// Each sign of sonars that are on, by itself; off takes none.
void test_sonars_are_on_by_a_flag_or_by_a_reading(void) {
    static const struct {
        int32_t value;
        uint16_t flags;
        uint8_t listed;
        bool open;
    } rows[] = {{0, 0, 0, false},
                {1, 0, 0, true},
                {1, ARCOS_FLAG_SONAR1, 0, false},
                {1, ARCOS_FLAG_SONAR4, 0, false},
                {1, 0, 1, false}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        send(ARCOS_CMD_SONAR, rows[i].value);
        sip.flags = rows[i].flags;
        sip.sonar_count = rows[i].listed;
        argus_setup_sip(&setup, now_ms, &sip);
        TEST_ASSERT_EQUAL(rows[i].open, argus_setup_is_open(&setup, ARGUS_SETUP_SONAR));
    }
}

// However long an order stays away, what is counted of it does not come round to 0.
void test_counts_end_at_their_most(void) {
    static const uint8_t order[] = {1, 2};
    uint8_t packet[ARGUS_PACKET_MAX];
    argus_setup_sent(&setup, now_ms, packet,
                     argus_command_string(packet, sizeof packet, ARCOS_CMD_POLLING, order, 2));
    sip.sonar_count = 1;
    sip.sonar[0].number = 9; // of an array that the order does not name
    for (int i = 0; i < 300; i++) {
        now_ms += 200;
        setup.order[ARGUS_SETUP_POLLING].open = true;
        argus_setup_sip(&setup, now_ms, &sip);
    }
    TEST_ASSERT_EQUAL(UINT8_MAX, setup.listed[9]);
    setUp();
    send(ARCOS_CMD_ENABLE, 1);
    again(ARCOS_CMD_ENABLE, 300 * 8000);
    TEST_ASSERT_EQUAL(UINT8_MAX, setup.order[ARGUS_SETUP_ENABLE].again);
}

// A clock that was set back is no reason to wait for seven weeks, nor to send on each call.
void test_what_was_sent_in_the_future_is_not_due(void) {
    send(ARCOS_CMD_ENABLE, 1);
    TEST_ASSERT_EQUAL(-1, argus_setup_resend(&setup, &outbox, now_ms - 1, ALL_ROWS));
    TEST_ASSERT_EQUAL(0, outbox.length);
    TEST_ASSERT_EQUAL(-1, argus_setup_resend(&setup, &outbox, now_ms + 299, ALL_ROWS));
    TEST_ASSERT_EQUAL(0, outbox.length);
    argus_setup_resend(&setup, &outbox, now_ms + 300, ALL_ROWS);
    TEST_ASSERT_GREATER_THAN(0, outbox.length);
}
