// SPDX-License-Identifier: MIT
// Attacks: a client that only listens leaves nothing behind, one that has driven leaves the motors off, and
// what the robot's line has no room for is given later or counted, never half done.
#include <string.h>

#include "client.h"
#include "unity.h"

static robot_t robot;
static client_t client;

void setUp(void) {
    const argus_config_t settings = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &settings, UINT32_MAX - 9000); // the clock wraps
    robot.world = robot_world_segments;
    robot_box(&robot, -4000, -3000, 4000, 3000);
    client_init(&client, &robot);
    client_run(&client, 4000, false);
}

static int count(int event) {
    return robot_count_events(&robot, event, 0);
}

static int sent(uint8_t command) {
    return robot_count_commands(&robot, command, 0);
}

static uint32_t now_ms(void) {
    return robot.start_ms + robot.t_ms;
}

// With no ENABLE.
static void listen(void) {
    client_plain(&client, ARCOS_SYNC_SYNC0);
    client_plain(&client, ARCOS_SYNC_SYNC1);
    client_plain(&client, ARCOS_SYNC_SYNC2);
    client_say(&client, ARCOS_CMD_OPEN, 1);
}

static void drive(void) {
    client_open(&client);
    client_say(&client, ARCOS_CMD_VEL, 300);
    client_run(&client, 2000, true);
    TEST_ASSERT_TRUE(robot.v > 290);
}

// Nothing goes out to the robot any more, as where its line is slow.
static void fill_outbox(size_t room) {
    robot.argus.session.outbox.length = (uint16_t)(ARGUS_OUTBOX_BYTES - room);
}

static void empty_outbox(void) {
    robot.argus.session.outbox.length = 0;
}

// With so much room left in the outbox.
static void pass_with(size_t room, uint8_t command, int32_t argument) {
    uint8_t packet[16];
    uint8_t out[256];
    const argus_port_io_t io = {.there = true,
                                .client = packet,
                                .client_count = argus_command_int(packet, sizeof packet, command, argument),
                                .out = out,
                                .capacity = sizeof out};
    fill_outbox(room);
    argus_guard_port(&robot.argus, &client.storage, now_ms(), &io);
    empty_outbox();
}

static void pass_full(uint8_t command, int32_t argument) {
    pass_with(0, command, argument);
}

void test_who_only_listened_leaves_nothing_behind(void) {
    for (int how = 0; how < 3; how++) {
        setUp();
        listen();
        client_say(&client, ARCOS_CMD_ENABLE, 0); // it has nothing to give back
        const int stops = sent(ARCOS_CMD_STOP);
        const int enables = sent(ARCOS_CMD_ENABLE);
        if (how == 0) {
            client_say(&client, ARCOS_CMD_CLOSE, 1);
        } else if (how == 1) {
            client_plain(&client, ARCOS_CMD_RESET);
        } else {
            client_leave(&client);
        }
        TEST_ASSERT_EQUAL_INT(how < 2 ? 1 : 0, count(ARGUS_EV_GUARD_CLOSED));
        TEST_ASSERT_EQUAL_INT(how < 2 ? 0 : 1, count(ARGUS_EV_GUARD_LOST));
        client_run(&client, 4000, false);
        TEST_ASSERT_EQUAL_INT(stops, sent(ARCOS_CMD_STOP));
        TEST_ASSERT_EQUAL_INT(enables, sent(ARCOS_CMD_ENABLE));
        TEST_ASSERT_EQUAL_INT(0, count(ARGUS_EV_GUARD_DRIVES));
    }
}

void test_who_goes_before_its_session_is_not_missed(void) {
    client_plain(&client, ARCOS_SYNC_SYNC0);
    client_plain(&client, ARCOS_SYNC_SYNC1);
    client_leave(&client);
    TEST_ASSERT_EQUAL_INT(0, count(ARGUS_EV_GUARD_LOST));
    TEST_ASSERT_EQUAL_UINT8(ARGUS_PORT_WAIT, client_port(&client)->phase);
    client.there = true;
    client_plain(&client, ARCOS_SYNC_SYNC2); // of a session that is not its own
    TEST_ASSERT_EQUAL_UINT8(ARGUS_PORT_WAIT, client_port(&client)->phase);
}

void test_each_sync_may_come_again(void) {
    client_plain(&client, ARCOS_SYNC_SYNC0);
    client_plain(&client, ARCOS_SYNC_SYNC1);
    client_plain(&client, ARCOS_SYNC_SYNC1);
    TEST_ASSERT_EQUAL_UINT32(3, client.others);
    TEST_ASSERT_EQUAL_UINT8(ARGUS_PORT_SYNC1, client_port(&client)->phase);
    client_plain(&client, ARCOS_SYNC_SYNC2);
    client_plain(&client, ARCOS_SYNC_SYNC2);
    TEST_ASSERT_EQUAL_UINT32(5, client.others);
    TEST_ASSERT_EQUAL_UINT8(ARGUS_PORT_SYNC2, client_port(&client)->phase);
    client_say(&client, ARCOS_CMD_OPEN, 1);
    TEST_ASSERT_EQUAL_UINT8(ARGUS_PORT_OPEN, client_port(&client)->phase);
}

void test_a_session_a_moment_is_too_many(void) {
    int opened = 0;
    for (int i = 0; i < 20; i++) {
        listen();
        opened += client_port(&client)->phase == ARGUS_PORT_OPEN ? 1 : 0;
        client_say(&client, ARCOS_CMD_CLOSE, 1);
    }
    TEST_ASSERT_EQUAL_INT(opened, count(ARGUS_EV_GUARD_OPEN));
    TEST_ASSERT_LESS_THAN_INT(20, opened);
    TEST_ASSERT_GREATER_THAN_UINT32(0, client_port(&client)->refused);
    client_run(&client, 3000, false);
    listen();
    TEST_ASSERT_EQUAL_UINT8(ARGUS_PORT_OPEN, client_port(&client)->phase);
}

// A robot that rolls on gets its motors cut all the same, three seconds later.
void test_motors_go_off_behind_a_client_though_the_robot_rolls(void) {
    drive();
    robot.ignores[ARCOS_CMD_STOP] = true;
    robot.ignores[ARCOS_CMD_VEL] = robot.ignores[ARCOS_CMD_E_STOP] = true;
    robot.moving = false;
    robot.vel = 300; // of its own
    client_leave(&client);
    client_run(&client, 2500, false);
    TEST_ASSERT_TRUE(robot.motors);
    client_run(&client, 1000, false);
    TEST_ASSERT_FALSE(robot.motors);
}

void test_motors_stay_on_where_the_manager_drives_again(void) {
    drive();
    client_leave(&client);
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, now_ms(), ARGUS_OP_ACTIVE, 0));
    client_run(&client, 4000, false);
    TEST_ASSERT_FALSE(client_port(&client)->parting);
    TEST_ASSERT_TRUE(robot.motors);
}

void test_who_was_denied_gets_neither_motors_nor_origin(void) {
    drive();
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, now_ms(), ARGUS_OP_ACTIVE, 0));
    client_run(&client, 1000, true);
    const int origins = sent(ARCOS_CMD_SETO);
    client_say(&client, ARCOS_CMD_ENABLE, 1);
    TEST_ASSERT_EQUAL_INT32(ARCOS_CMD_ENABLE, robot_last_event(&robot, ARGUS_EV_GUARD_REFUSED)->value);
    client_plain(&client, ARCOS_CMD_SETO);
    TEST_ASSERT_EQUAL_INT32(ARCOS_CMD_SETO, robot_last_event(&robot, ARGUS_EV_GUARD_REFUSED)->value);
    TEST_ASSERT_EQUAL_INT(origins, sent(ARCOS_CMD_SETO));
    TEST_ASSERT_FALSE(robot.argus.orders.passive);
}

static void say_both(int units) {
    const uint8_t data[] = {ARCOS_CMD_VEL2, ARCOS_ARG_POSITIVE, (uint8_t)units, (uint8_t)units};
    uint8_t packet[16];
    client_bytes(&client, packet, argus_frame_encode(packet, sizeof packet, data, sizeof data));
}

void test_both_wheels_may_be_the_first_motion(void) {
    listen();
    say_both(0); // it stands as it is
    TEST_ASSERT_FALSE(robot.argus.orders.passive);
    say_both(10);
    TEST_ASSERT_TRUE(robot.argus.orders.passive);
    TEST_ASSERT_EQUAL_INT(1, count(ARGUS_EV_GUARD_DRIVES));
    client_run(&client, 2000, true);
    TEST_ASSERT_TRUE(robot.v > 150);
}

void test_a_turn_may_be_the_first_motion(void) {
    listen();
    client_say(&client, ARCOS_CMD_RVEL, 0); // it stands as it is
    TEST_ASSERT_FALSE(robot.argus.orders.passive);
    client_say(&client, ARCOS_CMD_HEAD, 40);
    TEST_ASSERT_TRUE(robot.argus.orders.passive);
    TEST_ASSERT_EQUAL_INT(1, count(ARGUS_EV_GUARD_DRIVES));
}

// Whoever only listens may stop the robot, too: once, and the same again is no other stop.
void test_a_listeners_stop_again_is_the_same_stop(void) {
    listen();
    const int stops = sent(ARCOS_CMD_STOP);
    uint8_t packets[32];
    size_t length = 0;
    for (int i = 0; i < 2; i++) {
        length += argus_command_plain(packets + length, sizeof packets - length, ARCOS_CMD_STOP);
    }
    client_bytes(&client, packets, length);
    TEST_ASSERT_EQUAL_INT(stops + 1, sent(ARCOS_CMD_STOP));
}

// An operator has taken the robot back, and what its client says in the same pass comes too late.
void test_what_a_client_says_while_it_is_taken_back_moves_nothing(void) {
    drive();
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, now_ms(), ARGUS_OP_ACTIVE, 0));
    client_say(&client, ARCOS_CMD_VEL, 300);
    TEST_ASSERT_FALSE(robot.argus.orders.passive);
    TEST_ASSERT_FALSE(client_port(&client)->drives);
    client_run(&client, 2000, true);
    TEST_ASSERT_TRUE(robot.v < 1);
}

void test_other_settings_leave_the_speed(void) {
    drive();
    client_say(&client, ARCOS_CMD_SETV, 250);
    client_say(&client, ARCOS_CMD_SETA, -500);
    TEST_ASSERT_EQUAL_INT32(-500, robot_last_command(&robot, ARCOS_CMD_SETA)->argument);
    client_run(&client, 1500, true);
    TEST_ASSERT_TRUE(robot.v > 240 && robot.v < 260);
}

// The heading that it was turning to counts from another place now.
void test_an_origin_takes_its_heading_back(void) {
    client_open(&client);
    client_say(&client, ARCOS_CMD_HEAD, 40);
    TEST_ASSERT_TRUE(client_port(&client)->hold.wish.heading_taken);
    client_plain(&client, ARCOS_CMD_SETO);
    TEST_ASSERT_FALSE(client_port(&client)->hold.wish.heading_taken);
}

void test_motors_for_which_there_is_no_room_are_given_with_the_next_sip(void) {
    for (size_t room = 0; room <= ARGUS_OUTBOX_RESERVE + 14; room++) { // at the end for ENABLE, but no STOP
        setUp();
        client_open(&client);
        client_run(&client, 500, true);
        pass_with(room, ARCOS_CMD_ENABLE, 0);
        TEST_ASSERT_EQUAL_UINT8(ARGUS_PORT_MOTORS_OFF, client_port(&client)->motors);
        client_run(&client, 300, true);
        TEST_ASSERT_FALSE(robot.motors);
        TEST_ASSERT_EQUAL_UINT8(ARGUS_PORT_MOTORS_AS_THEY_ARE, client_port(&client)->motors);
    }
}

void test_what_there_is_no_room_for_is_counted_and_has_no_effect(void) {
    client_open(&client);
    client_run(&client, 500, true);
    const uint32_t refused = client_port(&client)->refused;
    pass_full(ARCOS_CMD_SETO, 0);
    TEST_ASSERT_FALSE(client_port(&client)->origin);
    TEST_ASSERT_FALSE(robot.argus.knowledge.origin_due);
    pass_full(ARCOS_CMD_ENCODER, 2);
    TEST_ASSERT_EQUAL_UINT8(0, client_port(&client)->streams);
    TEST_ASSERT_EQUAL_UINT32(refused + 2, client_port(&client)->refused);
}

// More ENABLEs than fit between two SIPs: off is off at once, by a STOP.
void test_motors_off_in_a_flood_stop_it(void) {
    drive();
    for (int i = 0; i < 10; i++) {
        client_say(&client, ARCOS_CMD_ENABLE, 1);
    }
    const int stops = sent(ARCOS_CMD_STOP);
    const int enables = sent(ARCOS_CMD_ENABLE);
    client_say(&client, ARCOS_CMD_ENABLE, 1);
    TEST_ASSERT_EQUAL_INT(stops, sent(ARCOS_CMD_STOP));
    client_say(&client, ARCOS_CMD_ENABLE, 0);
    TEST_ASSERT_EQUAL_INT(stops + 1, sent(ARCOS_CMD_STOP));
    TEST_ASSERT_EQUAL_INT(enables, sent(ARCOS_CMD_ENABLE));
    client_run(&client, 300, true);
    TEST_ASSERT_FALSE(robot.motors);
}

void test_a_port_below_the_first_is_none(void) {
    client_open(&client);
    client_run(&client, 2000, true);
    client_say(&client, ARCOS_CMD_ADSEL, 3);
    client_say(&client, ARCOS_CMD_ADSEL, -1);
    robot_next_sip(&robot);
    TEST_ASSERT_EQUAL_UINT8(3, client.sip.anport);
}

void test_nobody_is_answered_while_the_manager_ends(void) {
    drive();
    argus_shutdown(&robot.argus, now_ms());
    client_bytes(&client, NULL, 0);
    TEST_ASSERT_EQUAL_INT32(3, robot_last_event(&robot, ARGUS_EV_GUARD_LOST)->value);
    const uint32_t packets = client.packets;
    client_plain(&client, ARCOS_SYNC_SYNC0);
    TEST_ASSERT_EQUAL_UINT32(packets, client.packets);
}

// What the robot says of its own session is not of the client's.
void test_what_is_said_of_the_robots_own_session_does_not_pass(void) {
    static const uint8_t own[] = {ARCOS_SYNC_SYNC0, ARCOS_SYNC_SYNC2, ARCOS_TYPE_RESET_NOTICE,
                                  ARCOS_TYPE_RESET_NOTICE2};
    client_open(&client);
    uint8_t packet[64];
    uint8_t out[512];
    for (size_t i = 0; i < sizeof own; i++) {
        const uint8_t data[] = {own[i], 1, 2, 3};
        const argus_port_io_t io = {.there = true,
                                    .robot = packet,
                                    .robot_count =
                                        argus_frame_encode(packet, sizeof packet, data, sizeof data),
                                    .out = out,
                                    .capacity = sizeof out};
        TEST_ASSERT_EQUAL_size_t(0, argus_guard_port(&robot.argus, &client.storage, now_ms(), &io));
    }
}

// One that states more readings than it has is damaged: the client gets none rather than that.
void test_a_sip_that_is_none_does_not_pass(void) {
    client_open(&client);
    uint8_t packet[64];
    uint8_t out[512];
    uint8_t data[24] = {ARCOS_TYPE_SIP_STATIONARY};
    data[sizeof data - 1] = 0xFF; // so many sonars, whatever stands there
    memset(data + 1, 0xFF, sizeof data - 1);
    const uint32_t sips = client_port(&client)->sips;
    const argus_port_io_t io = {.there = true,
                                .robot = packet,
                                .robot_count = argus_frame_encode(packet, sizeof packet, data, sizeof data),
                                .out = out,
                                .capacity = sizeof out};
    TEST_ASSERT_EQUAL_size_t(0, argus_guard_port(&robot.argus, &client.storage, now_ms(), &io));
    TEST_ASSERT_EQUAL_UINT32(sips, client_port(&client)->sips);
}

// Much at once: all of it is taken, in its order, though the parser holds less.
void test_much_at_once_is_taken_in_its_order(void) {
    uint8_t bytes[40 * 9];
    size_t count_bytes = 0;
    client_open(&client);
    const uint32_t packets = client_port(&client)->packets;
    for (int i = 0; i < 40; i++) {
        count_bytes +=
            argus_command_int(bytes + count_bytes, sizeof bytes - count_bytes, ARCOS_CMD_ADSEL, i % 8);
    }
    client_bytes(&client, bytes, count_bytes);
    TEST_ASSERT_EQUAL_UINT32(packets + 40, client_port(&client)->packets);
    TEST_ASSERT_EQUAL_UINT8(7, client_port(&client)->analog.wants);
}
