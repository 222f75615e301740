// SPDX-License-Identifier: MIT
// Attacks: a client at a guard port finds what it would find at the robot: the handshake, the identity, every
// SIP, every other packet; what it must not do ends there; and when it goes, or goes silent, the robot
// stands.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "client.h"
#include "unity.h"

static const uint8_t config[] = "\x20"
                                "Pioneer\0p3dx-sh\0SERIAL-1";
static robot_t robot;
static client_t client;

void setUp(void) {
    const argus_config_t settings = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &settings, UINT32_MAX - 9000); // the clock wraps
    robot.world = robot_world_segments;
    robot_box(&robot, -4000, -3000, 4000, 3000);
    robot.config = config;
    robot.config_count = sizeof config;
    client_init(&client, &robot);
    client_run(&client, 4000, false);
}

static int count(int event) {
    return robot_count_events(&robot, event, 0);
}

static int sent(uint8_t command) {
    return robot_count_commands(&robot, command, 0);
}

void test_the_handshake_is_the_robots(void) {
    client_plain(&client, ARCOS_SYNC_SYNC0);
    TEST_ASSERT_EQUAL_UINT8(0, client.data[0]);
    TEST_ASSERT_EQUAL_UINT32(1, client.others);
    client_plain(&client, ARCOS_SYNC_SYNC1);
    TEST_ASSERT_EQUAL_UINT8(1, client.data[0]);
    client_plain(&client, ARCOS_SYNC_SYNC2);
    static const uint8_t identity[] = "\x02"
                                      "P3DX_0001\0Pioneer\0p3dx-sh";
    TEST_ASSERT_EQUAL_size_t(strlen(robot.argus.session.name) + 17 + 1, client.count);
    TEST_ASSERT_EQUAL_STRING(robot.argus.session.name, (const char *)client.data + 1);
    TEST_ASSERT_EQUAL_MEMORY(identity + 11, client.data + 2 + strlen(robot.argus.session.name), 16);
    TEST_ASSERT_EQUAL_UINT32(0, client.sips);
    client_plain(&client, ARCOS_CMD_OPEN);
    client_run(&client, 1000, true);
    TEST_ASSERT_EQUAL_UINT32(10, client.sips);
    TEST_ASSERT_EQUAL_INT(1, count(ARGUS_EV_GUARD_OPEN));
}

void test_a_sync_out_of_its_order_begins_anew(void) {
    client_plain(&client, ARCOS_SYNC_SYNC0);
    client_plain(&client, ARCOS_SYNC_SYNC2);
    client_plain(&client, ARCOS_SYNC_SYNC1);
    TEST_ASSERT_EQUAL_UINT32(1, client.others);
    client_plain(&client, ARCOS_SYNC_SYNC0);
    client_plain(&client, ARCOS_SYNC_SYNC0);
    TEST_ASSERT_EQUAL_UINT32(3, client.others);
}

void test_a_client_before_the_robot_finds_nobody(void) {
    argus_link_lost(&robot.argus, robot.start_ms + robot.t_ms);
    client_plain(&client, ARCOS_SYNC_SYNC0);
    TEST_ASSERT_EQUAL_UINT32(0, client.packets);
}

void test_every_sip_comes_in_the_pass_that_brings_it(void) {
    client_open(&client);
    const uint32_t before = robot.argus.session.sips;
    const uint32_t had = client.sips;
    for (int i = 0; i < 50; i++) {
        robot_next_sip(&robot);
        TEST_ASSERT_EQUAL_UINT32(robot.argus.session.sips - before, client.sips - had);
    }
}

void test_a_packet_in_pieces_with_garbage_about_it(void) {
    client_open(&client);
    uint8_t packet[16];
    const size_t length = argus_command_int(packet, sizeof packet, ARCOS_CMD_VEL, 100);
    static const uint8_t garbage[] = {0x57, 0x4D, 0x53, 0x32, 0x0D, 0xFA, 0xFA, 0x00};
    client_bytes(&client, garbage, sizeof garbage);
    for (size_t i = 0; i < length; i++) {
        TEST_ASSERT_EQUAL_INT(0, client_port(&client)->hold.given.mm_s);
        client_bytes(&client, packet + i, 1);
    }
    TEST_ASSERT_EQUAL_INT(100, client_port(&client)->hold.given.mm_s);
}

void test_a_wrong_checksum_moves_nothing(void) {
    client_open(&client);
    uint8_t packet[16];
    const size_t length = argus_command_int(packet, sizeof packet, ARCOS_CMD_VEL, 100);
    const int before = sent(ARCOS_CMD_VEL);
    packet[length - 1] ^= 1;
    client_bytes(&client, packet, length);
    client_run(&client, 500, true);
    TEST_ASSERT_EQUAL_INT(before, sent(ARCOS_CMD_VEL));
    TEST_ASSERT_EQUAL_UINT32(1, client_port(&client)->from_client.bad_checksums);
}

void test_noise_never_moves_it(void) {
    client_open(&client);
    for (int i = 0; i < 2000; i++) {
        uint8_t noise[64];
        for (size_t k = 0; k < sizeof noise; k++) {
            noise[k] = (uint8_t)robot_random(&robot, 256);
        }
        client_bytes(&client, noise, sizeof noise);
    }
    client_run(&client, 200, false);
    TEST_ASSERT_FALSE(client_port(&client)->hold.given.rolls);
    TEST_ASSERT_TRUE(robot.x < 1 && robot.x > -1);
    TEST_ASSERT_EQUAL_INT(0, argus_invariants_broken(&robot.argus));
}

void test_other_commands_and_packets_pass(void) {
    client_open(&client);
    client_say(&client, ARCOS_CMD_GRIPPER, 15);
    client_say(&client, ARCOS_CMD_ENCODER, 2);
    client_plain(&client, ARCOS_CMD_CONFIG);
    TEST_ASSERT_EQUAL_INT(1, sent(ARCOS_CMD_GRIPPER));
    TEST_ASSERT_EQUAL_INT(15, robot_last_command(&robot, ARCOS_CMD_GRIPPER)->argument);
    TEST_ASSERT_EQUAL_INT(2, robot_last_command(&robot, ARCOS_CMD_ENCODER)->argument);
    TEST_ASSERT_EQUAL_UINT8(ARCOS_TYPE_CONFIGPAC, client.data[0]);
    TEST_ASSERT_EQUAL_MEMORY(config, client.data, client.count);
    static const uint8_t encoder[] = {ARCOS_TYPE_ENCODERPAC, 1, 2, 3, 4, 5, 6, 7, 8};
    robot_say(&robot, encoder, sizeof encoder);
    TEST_ASSERT_EQUAL_MEMORY(encoder, client.data, sizeof encoder);
    client_plain(&client, ARCOS_CMD_CLOSE);
    TEST_ASSERT_EQUAL_INT(0, robot_last_command(&robot, ARCOS_CMD_ENCODER)->argument);
}

void test_what_would_take_the_robot_away_ends_here(void) {
    client_open(&client);
    static const uint8_t kept[] = {ARCOS_CMD_HOSTBAUD, ARCOS_CMD_SONAR_CYCLE, ARCOS_CMD_MAINTENANCE,
                                   ARCOS_CMD_POLLING};
    for (size_t i = 0; i < sizeof kept; i++) {
        const int before = sent(kept[i]);
        client_say(&client, kept[i], 3);
        TEST_ASSERT_EQUAL_INT(before, sent(kept[i]));
        TEST_ASSERT_EQUAL_INT(kept[i], robot_last_event(&robot, ARGUS_EV_GUARD_REFUSED)->value);
    }
    const int closes = sent(ARCOS_CMD_CLOSE); // SYNC2 has its number
    client_say(&client, ARCOS_CMD_CLOSE, 1);
    TEST_ASSERT_EQUAL_INT(closes, sent(ARCOS_CMD_CLOSE));
    TEST_ASSERT_TRUE(argus_session_is_open(&robot.argus.session));
}

void test_sonar_0_is_for_the_client_alone(void) {
    client_open(&client);
    client_say(&client, ARCOS_CMD_SONAR, 0);
    const int before = sent(ARCOS_CMD_SONAR);
    client_run(&client, 300, true);
    TEST_ASSERT_EQUAL_UINT8(0, client.sip.sonar_count);
    TEST_ASSERT_EQUAL_UINT16(0, client.sip.flags & 0x1E);
    client_say(&client, ARCOS_CMD_SONAR, 5); // array 2 on
    client_run(&client, 400, true);
    for (int i = 0; i < client.sip.sonar_count; i++) {
        TEST_ASSERT_TRUE(client.sip.sonar[i].number >= 8);
    }
    TEST_ASSERT_TRUE(client.sip.sonar_count > 0);
    TEST_ASSERT_EQUAL_INT(before, sent(ARCOS_CMD_SONAR));
    TEST_ASSERT_EQUAL_INT(0, count(ARGUS_EV_SONAR_SILENT));
}

void test_listening_disturbs_nobody(void) {
    TEST_ASSERT_TRUE(robot_goal(&robot, 20000, 0));
    client_plain(&client, ARCOS_SYNC_SYNC0);
    client_plain(&client, ARCOS_SYNC_SYNC1);
    client_plain(&client, ARCOS_SYNC_SYNC2);
    client_plain(&client, ARCOS_CMD_OPEN);
    client_say(&client, ARCOS_CMD_VEL, 0);
    client_say(&client, ARCOS_CMD_SETV, 100);
    const int setv = sent(ARCOS_CMD_SETV);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 12000));
    client_run(&client, 3000, true);
    TEST_ASSERT_TRUE(robot.v > 100);
    TEST_ASSERT_EQUAL_INT(0, count(ARGUS_EV_GUARD_DRIVES));
    TEST_ASSERT_TRUE(sent(ARCOS_CMD_SETV) <= setv + 2);
    client_plain(&client, ARCOS_CMD_STOP); // who sees that it must stand is heard
    client_run(&client, 3000, true);
    TEST_ASSERT_TRUE(robot.v == 0.0);
    TEST_ASSERT_TRUE(robot.argus.orders.paused);
}

void test_a_client_that_drives_ends_the_managers_own_course(void) {
    TEST_ASSERT_TRUE(robot_goal(&robot, 20000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 12000));
    client_open(&client);
    TEST_ASSERT_TRUE(robot.argus.orders.passive);
    TEST_ASSERT_EQUAL_INT(1, count(ARGUS_EV_GUARD_DRIVES));
    client_run(&client, 3000, true);
    TEST_ASSERT_TRUE(robot.v == 0.0);
    client_leave(&client);
    client_run(&client, 3000, false);
    TEST_ASSERT_TRUE(robot.v == 0.0); // it does not start by itself either
}

static void drive(void) {
    client_open(&client);
    client_say(&client, ARCOS_CMD_VEL, 300);
    client_run(&client, 2000, true);
    TEST_ASSERT_TRUE(robot.v > 290);
}

void test_a_connection_that_closes_stops_it_at_once(void) {
    drive();
    const int before = sent(ARCOS_CMD_STOP);
    client_leave(&client);
    TEST_ASSERT_EQUAL_INT(before + 1, sent(ARCOS_CMD_STOP));
    TEST_ASSERT_EQUAL_INT32(1, robot_last_event(&robot, ARGUS_EV_GUARD_LOST)->value);
    client_run(&client, 2000, false);
    TEST_ASSERT_TRUE(robot.v == 0.0);
    TEST_ASSERT_FALSE(robot.motors); // as at the end of a robot's own session
}

void test_close_stops_it_too(void) {
    drive();
    const int before = sent(ARCOS_CMD_STOP);
    client_say(&client, ARCOS_CMD_CLOSE, 1);
    TEST_ASSERT_EQUAL_INT(before + 1, sent(ARCOS_CMD_STOP));
    TEST_ASSERT_EQUAL_INT(1, count(ARGUS_EV_GUARD_CLOSED));
    const uint32_t sips = client.sips;
    client_run(&client, 2000, false);
    TEST_ASSERT_TRUE(robot.v == 0.0);
    TEST_ASSERT_EQUAL_UINT32(sips, client.sips);
}

void test_silence_beyond_the_watchdog_stops_it(void) {
    drive();
    const int before = sent(ARCOS_CMD_STOP);
    client_run(&client, 1450, false); // its last PULSE is at most 500 ms old
    TEST_ASSERT_EQUAL_INT(before, sent(ARCOS_CMD_STOP));
    client_run(&client, 700, false);
    TEST_ASSERT_EQUAL_INT(before + 1, sent(ARCOS_CMD_STOP));
    TEST_ASSERT_EQUAL_INT32(2, robot_last_event(&robot, ARGUS_EV_GUARD_LOST)->value);
    client_run(&client, 3000, true); // it speaks again: nothing moves until it says so
    TEST_ASSERT_TRUE(robot.v == 0.0);
    client_say(&client, ARCOS_CMD_VEL, 100);
    client_run(&client, 1000, true);
    TEST_ASSERT_TRUE(robot.v > 90);
}

void test_an_operators_stop_holds_until_he_says_go(void) {
    drive();
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_STOP, 0));
    client_run(&client, 2000, true);
    TEST_ASSERT_TRUE(robot.v == 0.0);
    client_say(&client, ARCOS_CMD_VEL, 300);
    client_run(&client, 1000, true);
    TEST_ASSERT_TRUE(robot.v == 0.0);
    TEST_ASSERT_EQUAL_INT32(ARGUS_BOUND_HALTED, robot_last_event(&robot, ARGUS_EV_GUARD_HELD)->value);
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_GO, 0));
    client_run(&client, 1000, true);
    TEST_ASSERT_TRUE(robot.v > 200);
}

// Nothing else that an operator orders lets the client go.
void test_an_operators_stop_holds_whatever_else_he_orders(void) {
    static const argus_op_t orders[] = {ARGUS_OP_RECHECK, ARGUS_OP_RETEST, ARGUS_OP_PIN, ARGUS_OP_UNPIN,
                                        ARGUS_OP_PASSIVE};
    drive();
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_STOP, 0));
    for (size_t i = 0; i < sizeof orders / sizeof orders[0]; i++) {
        TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, orders[i], 3));
        client_say(&client, ARCOS_CMD_VEL, 300);
        client_say(&client, ARCOS_CMD_RVEL, 30);
        client_run(&client, 2000, true);
        TEST_ASSERT_TRUE_MESSAGE(robot.v == 0.0 && robot.w == 0.0,
                                 argus_name(ARGUS_NAME_OP, (int32_t)orders[i]));
    }
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_GO, 0));
    client_run(&client, 2000, true);
    TEST_ASSERT_TRUE(robot.v > 200);
}

// With no ENABLE: it only listens.
static void open_client(void) {
    client_plain(&client, ARCOS_SYNC_SYNC0);
    client_plain(&client, ARCOS_SYNC_SYNC1);
    client_plain(&client, ARCOS_SYNC_SYNC2);
    client_say(&client, ARCOS_CMD_OPEN, 1);
}

// Also against a client that has not driven yet: with its first motion the manager becomes passive.
void test_an_operators_stop_holds_against_a_clients_first_motion(void) {
    open_client();
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_STOP, 0));
    client_say(&client, ARCOS_CMD_VEL, 300);
    client_say(&client, ARCOS_CMD_RVEL, 30);
    client_run(&client, 2000, true);
    TEST_ASSERT_TRUE(robot.v == 0.0 && robot.w == 0.0);
    TEST_ASSERT_EQUAL_INT32(ARGUS_BOUND_HALTED, robot_last_event(&robot, ARGUS_EV_GUARD_HELD)->value);
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_GO, 0));
    client_run(&client, 2000, true);
    TEST_ASSERT_TRUE(robot.v > 200);
}

// What a client stopped it may start again.
void test_a_clients_own_stop_does_not_hold_it(void) {
    open_client();
    client_plain(&client, ARCOS_CMD_STOP);
    client_say(&client, ARCOS_CMD_VEL, 300);
    client_run(&client, 2000, true);
    TEST_ASSERT_TRUE(robot.v > 200);
}

// S2: a stall ends what the client wanted, once.
void test_a_stall_stops_a_client(void) {
    drive();
    const int before = sent(ARCOS_CMD_STOP);
    robot.stall = true;
    client_run(&client, 500, true);
    TEST_ASSERT_EQUAL_INT(before + 1, sent(ARCOS_CMD_STOP));
    robot.stall = false;
    client_run(&client, 2000, true);
    TEST_ASSERT_TRUE(robot.v == 0.0);
    client_say(&client, ARCOS_CMD_VEL, 100);
    client_run(&client, 1000, true);
    TEST_ASSERT_TRUE(robot.v > 90);
}

// S2: at once, not with the next PULSE.
void test_no_sip_stops_a_client(void) {
    drive();
    const int before = sent(ARCOS_CMD_STOP);
    robot.mute = true;
    client_run(&client, 740, true); // 600 ms, and what is left of a SIP's period
    TEST_ASSERT_EQUAL_INT(before + 1, sent(ARCOS_CMD_STOP));
}

void test_an_operator_takes_the_robot_back(void) {
    drive();
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_ACTIVE, 0));
    client_run(&client, 3000, true);
    client_say(&client, ARCOS_CMD_VEL, 300);
    client_run(&client, 2000, true);
    TEST_ASSERT_TRUE(robot.v == 0.0);
    TEST_ASSERT_EQUAL_INT32(ARCOS_CMD_VEL, robot_last_event(&robot, ARGUS_EV_GUARD_REFUSED)->value);
}

void test_a_lost_robot_ends_the_clients_session(void) {
    drive();
    argus_link_lost(&robot.argus, robot.start_ms + robot.t_ms);
    client_bytes(&client, NULL, 0);
    TEST_ASSERT_EQUAL_INT32(3, robot_last_event(&robot, ARGUS_EV_GUARD_LOST)->value);
    TEST_ASSERT_EQUAL_UINT8(ARGUS_PORT_WAIT, client_port(&client)->phase);
}

void test_seto_counts_from_here_and_the_pose_goes_on(void) {
    drive();
    client_say(&client, ARCOS_CMD_VEL, 0);
    client_run(&client, 2000, true);
    const int32_t x_mm = robot.argus.knowledge.pose.x_mm;
    client_plain(&client, ARCOS_CMD_SETO);
    client_run(&client, 1000, true);
    TEST_ASSERT_EQUAL_UINT16(0, client.sip.x_raw);
    TEST_ASSERT_INT32_WITHIN(3, x_mm, robot.argus.knowledge.pose.x_mm);
    TEST_ASSERT_EQUAL_INT(0, count(ARGUS_EV_POSE_LEAP));
    TEST_ASSERT_FALSE(robot.argus.knowledge.origin_due);
}

void test_a_client_that_takes_nothing_loses_whole_packets_only(void) {
    client_open(&client);
    client.room = 1;
    client_run(&client, 5000, true);
    TEST_ASSERT_TRUE(client_port(&client)->lost > 0);
    client.room = 0;
    const uint32_t bad = client.parser.bad_checksums;
    const uint32_t had = client.sips;
    client_run(&client, 1000, true);
    TEST_ASSERT_TRUE(client.sips >= had + 10);
    TEST_ASSERT_EQUAL_UINT32(bad, client.parser.bad_checksums);
    TEST_ASSERT_EQUAL_UINT32(0, client.parser.skipped_bytes);
}

// No stop of a client is taken for done because it was sent: what gets lost on its way is given again.
static void check_lost(uint8_t command, int32_t argument, bool turns) {
    char text[80];
    drive();
    client_say(&client, turns ? ARCOS_CMD_RVEL : ARCOS_CMD_VEL, turns ? 30 : 200);
    client_run(&client, 1500, true);
    TEST_ASSERT_TRUE(turns ? fabs(robot.w) > 0.3 : robot.v > 150);
    robot.ignores[command] = true; // this one gets lost,
    client_say(&client, command, argument);
    client_run(&client, 50, true);
    robot.ignores[command] = false;
    client_run(&client, 2500, true);
    snprintf(text, sizeof text, "command %d lost: %.0f mm/s, %.2f rad/s", command, robot.v, robot.w);
    TEST_ASSERT_TRUE_MESSAGE(fabs(turns ? robot.w : robot.v) < 0.02, text);
}

void test_a_stop_of_a_client_that_is_lost_is_given_again(void) {
    check_lost(ARCOS_CMD_VEL, 0, false);
    setUp();
    check_lost(ARCOS_CMD_RVEL, 0, true);
    setUp();
    check_lost(ARCOS_CMD_STOP, 0, false);
    setUp();
    check_lost(ARCOS_CMD_E_STOP, 0, false);
    setUp();
    check_lost(ARCOS_CMD_VEL2, 0, false);
}

// A lower speed likewise: the robot would be as fast as before.
void test_a_lower_speed_that_is_lost_is_given_again(void) {
    drive();
    client_say(&client, ARCOS_CMD_VEL, 300);
    client_run(&client, 1500, true);
    robot.ignores[ARCOS_CMD_VEL] = true;
    client_say(&client, ARCOS_CMD_VEL, 100);
    client_run(&client, 50, true);
    robot.ignores[ARCOS_CMD_VEL] = false;
    client_run(&client, 2000, true);
    TEST_ASSERT_TRUE(robot.v < 120 && robot.v > 80);
}

// The robot's analog port is the manager's: the client reads the one that it has chosen, all the time.
void test_adsel_is_the_clients_own(void) {
    client_open(&client);
    client_run(&client, 2000, true);
    for (int port = 0; port < 8; port++) {
        client_say(&client, ARCOS_CMD_ADSEL, port);
        for (int sip = 0; sip < 12; sip++) {
            robot_next_sip(&robot);
            TEST_ASSERT_EQUAL_UINT8(port, client.sip.anport);
        }
    }
    client_say(&client, ARCOS_CMD_ADSEL, 200); // there is none
    robot_next_sip(&robot);
    TEST_ASSERT_EQUAL_UINT8(7, client.sip.anport);
}
