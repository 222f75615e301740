// SPDX-License-Identifier: MIT
// Attacks: of a SIP nothing changes for the client but the readings of sonars that are out, and the length
// and count that follow from that; a reading given instead of one was heard by a trusted sonar on that
// bearing.
#include "guardian/rewrite.h"

#include <math.h>
#include <string.h>

#include "client.h"
#include "unity.h"

static robot_t robot;
static uint8_t out[256];

static const uint8_t sip[] = {0x32, 1,    2,    3, 4,    5,    6, 7, 8,  9,    10, 127,  0,
                              0,    0,    0,    7, 0,    0,    4, 2, 10, 0x01, 3,  0x88, 0x13,
                              11,   0x88, 0x13, 4, 0x20, 0x03, 9, 8, 7,  6,    5};

static void begin(uint32_t start_ms) {
    const argus_config_t settings = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &settings, start_ms);
    robot.world = robot_world_segments;
    robot.noise_mm = 6;
    robot_box(&robot, -1500, -1500, 1200, 1500);
    robot_run(&robot, 4000);
}

void setUp(void) {
    begin(1000);
}

static size_t rewrite(argus_readings_t readings, uint8_t arrays) {
    const argus_rewrite_t how = {.readings = readings, .arrays = arrays};
    return argus_rewrite_sip(&robot.argus, &how, sip, sizeof sip, out);
}

static void take_out(int sonar) {
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_DISABLE, sonar));
}

void test_nothing_changes_while_all_are_in_use(void) {
    for (int readings = ARGUS_READINGS_WITHHOLD; readings <= ARGUS_READINGS_PASS; readings++) {
        TEST_ASSERT_EQUAL_size_t(sizeof sip, rewrite((argus_readings_t)readings, 15));
        TEST_ASSERT_EQUAL_MEMORY(sip, out, sizeof sip);
    }
}

void test_one_that_is_out_is_left_out_of_the_list(void) {
    take_out(3);
    TEST_ASSERT_EQUAL_size_t(sizeof sip - 3, rewrite(ARGUS_READINGS_WITHHOLD, 15));
    TEST_ASSERT_EQUAL_UINT8(3, out[19]);
    TEST_ASSERT_EQUAL_MEMORY(sip, out, 19);
    TEST_ASSERT_EQUAL_MEMORY(sip + 20, out + 20, 3);
    TEST_ASSERT_EQUAL_MEMORY(sip + 26, out + 23, sizeof sip - 26);
    TEST_ASSERT_EQUAL_size_t(sizeof sip, rewrite(ARGUS_READINGS_PASS, 15));
    TEST_ASSERT_EQUAL_MEMORY(sip, out, sizeof sip);
}

void test_an_array_that_the_client_put_off(void) {
    TEST_ASSERT_EQUAL_size_t(sizeof sip - 9, rewrite(ARGUS_READINGS_PASS, 2));
    TEST_ASSERT_EQUAL_UINT8(1, out[19]);
    TEST_ASSERT_EQUAL_UINT8(11, out[20]);
    TEST_ASSERT_EQUAL_UINT8(7 & ~2, out[16]);
    TEST_ASSERT_EQUAL_size_t(sizeof sip - 12, rewrite(ARGUS_READINGS_PASS, 0));
    TEST_ASSERT_EQUAL_UINT8(1, out[16]);
}

void test_a_list_that_is_longer_than_the_packet_is_no_sip(void) {
    const argus_rewrite_t how = {.readings = ARGUS_READINGS_WITHHOLD, .arrays = 15};
    for (size_t count = 0; count < 32; count++) {
        TEST_ASSERT_EQUAL_size_t(0, argus_rewrite_sip(&robot.argus, &how, sip, count, out));
    }
    TEST_ASSERT_TRUE(argus_rewrite_sip(&robot.argus, &how, sip, 32, out) > 0);
}

// Then 2 looks along the bearing that 3 has when the robot has turned back.
static void turn_to(double deg) {
    const double to = deg * 3.14159265358979 / 180;
    while (fabs(robot.th - to) > 1e-9) { // in steps that no wheel speed need show
        robot.th += fmax(-0.03, fmin(0.03, to - robot.th));
        robot_run(&robot, 100);
    }
}

static void turn_away_and_back(void) {
    for (int deg = 0; deg >= -20; deg -= 10) {
        turn_to(deg);
        robot_run(&robot, 600);
    }
    turn_to(0);
    robot_run(&robot, 200);
}

void test_covered_by_what_a_neighbour_heard_there(void) {
    take_out(3);
    TEST_ASSERT_EQUAL_size_t(sizeof sip - 3, rewrite(ARGUS_READINGS_COVER, 15)); // none looks there
    turn_away_and_back();
    const int32_t cover_mm = argus_rewrite_cover_mm(&robot.argus, 3);
    TEST_ASSERT_INT32_WITHIN(60, robot_world_segments(&robot, 3), cover_mm);
    TEST_ASSERT_EQUAL_size_t(sizeof sip, rewrite(ARGUS_READINGS_COVER, 15));
    TEST_ASSERT_EQUAL_INT32(cover_mm, out[24] | out[25] << 8);
    TEST_ASSERT_EQUAL_UINT8(3, out[23]);
    robot_run(&robot, 3000); // too long ago
    TEST_ASSERT_EQUAL_INT32(0, argus_rewrite_cover_mm(&robot.argus, 3));
}

// However long it has been running, and over the wrap of the clock.
void test_covered_at_any_time(void) {
    static const uint32_t starts_ms[] = {62000, 70000, 3600000, UINT32_MAX - 6000};
    for (size_t i = 0; i < sizeof starts_ms / sizeof starts_ms[0]; i++) {
        begin(starts_ms[i]);
        take_out(3);
        turn_away_and_back();
        TEST_ASSERT_INT32_WITHIN(60, robot_world_segments(&robot, 3),
                                 argus_rewrite_cover_mm(&robot.argus, 3));
        robot_run(&robot, 3000); // too long ago
        TEST_ASSERT_EQUAL_INT32(0, argus_rewrite_cover_mm(&robot.argus, 3));
    }
}

void test_what_was_heard_by_one_that_is_out_too_covers_nothing(void) {
    take_out(3);
    turn_away_and_back();
    TEST_ASSERT_TRUE(argus_rewrite_cover_mm(&robot.argus, 3) > 0);
    for (int i = 0; i < 16; i++) {
        if (i != 3) {
            take_out(i);
        }
    }
    TEST_ASSERT_EQUAL_INT32(0, argus_rewrite_cover_mm(&robot.argus, 3));
}

// ... though what it heard before it went out is kept for other questions.
void test_only_who_is_relied_on_covers(void) {
    take_out(3);
    turn_away_and_back();
    TEST_ASSERT_TRUE(argus_rewrite_cover_mm(&robot.argus, 3) > 0);
    for (int i = 0; i < robot.argus.knowledge.sonars; i++) {
        robot.argus.knowledge.sonar[i].health = ARGUS_DISABLED;
    }
    TEST_ASSERT_EQUAL_INT32(0, argus_rewrite_cover_mm(&robot.argus, 3));
}

// ---- analog ports: a client sees the one that it has chosen

static argus_analog_t analog;

static void shows(uint8_t robots_port, uint8_t port, uint8_t value) {
    const argus_rewrite_t how = {.readings = ARGUS_READINGS_PASS, .arrays = 15, .analog = &analog};
    uint8_t data[sizeof sip];
    memcpy(data, sip, sizeof sip);
    data[33] = robots_port;
    TEST_ASSERT_EQUAL_size_t(sizeof sip, argus_rewrite_sip(&robot.argus, &how, data, sizeof data, out));
    TEST_ASSERT_EQUAL_UINT8(port, out[33]);
    TEST_ASSERT_EQUAL_UINT8(value, out[34]);
}

static void robot_shows(uint8_t port, uint8_t value) {
    uint8_t data[sizeof sip];
    memcpy(data, sip, sizeof sip);
    data[33] = port;
    data[34] = value;
    argus_rewrite_note_analog(&analog, data, sizeof data);
}

void test_a_client_sees_the_port_that_it_chose_once_it_is_known(void) {
    memset(&analog, 0, sizeof analog);
    shows(4, 4, 7); // none is known: as the robot has it
    robot_shows(2, 40);
    shows(2, 2, 40);
    analog.wants = 5; // the robot has not shown it yet
    robot_shows(2, 41);
    shows(2, 2, 41);
    robot_shows(5, 90);
    shows(2, 5, 90);
    robot_shows(2, 42); // for the manager, or another client
    shows(2, 5, 90);
}

void test_a_port_that_no_robot_has_changes_nothing(void) {
    memset(&analog, 0, sizeof analog);
    robot_shows(3, 30);
    robot_shows(ARGUS_ANALOG_PORTS, 99);
    robot_shows(255, 99);
    TEST_ASSERT_EQUAL_HEX8(1u << 3, analog.known);
    shows(2, 3, 30);
    shows(ARGUS_ANALOG_PORTS, ARGUS_ANALOG_PORTS, 7); // as the robot has it
}

void test_a_sip_that_ends_before_its_port_is_left_as_it_is(void) {
    memset(&analog, 0, sizeof analog);
    for (size_t count = 0; count <= 34; count++) {
        argus_rewrite_note_analog(&analog, sip, count);
        TEST_ASSERT_EQUAL_HEX8(0, analog.known);
    }
    robot_shows(3, 30);
    const argus_rewrite_t how = {.readings = ARGUS_READINGS_PASS, .arrays = 15, .analog = &analog};
    for (size_t count = 32; count <= 34; count++) {
        TEST_ASSERT_EQUAL_size_t(count, argus_rewrite_sip(&robot.argus, &how, sip, count, out));
        TEST_ASSERT_EQUAL_MEMORY(sip, out, count);
    }
}

// Arrays that no client can put off are passed: there are four switches, the last of which is bit 3.
void test_a_sonar_beyond_the_four_arrays_is_passed(void) {
    uint8_t data[sizeof sip];
    memcpy(data, sip, sizeof sip);
    data[20] = 32;
    const argus_rewrite_t how = {.readings = ARGUS_READINGS_PASS, .arrays = 0};
    TEST_ASSERT_EQUAL_size_t(sizeof sip - 9, argus_rewrite_sip(&robot.argus, &how, data, sizeof data, out));
    TEST_ASSERT_EQUAL_UINT8(32, out[20]);
}

// A ray tells its time modulo 65.536 s: one of a minute ago is not one of now.
void test_what_was_heard_a_minute_ago_covers_nothing(void) {
    take_out(3);
    turn_away_and_back();
    TEST_ASSERT_TRUE(argus_rewrite_cover_mm(&robot.argus, 3) > 0);
    robot.argus.knowledge.sip_ms += 65536;
    TEST_ASSERT_EQUAL_INT32(0, argus_rewrite_cover_mm(&robot.argus, 3));
    robot.argus.knowledge.sip_ms -= 65536;
    TEST_ASSERT_TRUE(argus_rewrite_cover_mm(&robot.argus, 3) > 0);
}

// Only an echo covers: a ray that ends in the open, or one that says nothing, is none.
void test_only_an_echo_covers(void) {
    take_out(3);
    turn_away_and_back();
    const int32_t cover_mm = argus_rewrite_cover_mm(&robot.argus, 3);
    TEST_ASSERT_TRUE(cover_mm > 0);
    for (int open = 0; open < 2; open++) {
        for (int i = 0; i < ARGUS_RAYS_MAX; i++) {
            robot.argus.rays.at[i].free_mm = open != 0 ? ARGUS_RAY_TRUST_MM : 0;
        }
        TEST_ASSERT_EQUAL_INT32(0, argus_rewrite_cover_mm(&robot.argus, 3));
    }
}

void test_a_port_that_no_robot_has_is_not_shown(void) {
    memset(&analog, 0, sizeof analog);
    robot_shows(2, 40);
    analog.wants = ARGUS_ANALOG_PORTS;
    robot_shows(3, 41);
    shows(2, 2, 40);
}
