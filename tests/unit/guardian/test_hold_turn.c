// SPDX-License-Identifier: MIT
// Attacks: no client turns the robot into what is seen, nor after an operator's stop, on an unknown body, or
// with a bumper pressed: by no command, in no step, at no rate, with no number.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "client.h"
#include "unity.h"

#define MOST_DEG 2.0 // of a turn that was under way

static robot_t robot;
static client_t client;

static void begin_with(double ahead_mm, double behind_mm, double beside_mm, const char *subclass) {
    const argus_config_t settings = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &settings, 1000);
    robot.subclass = subclass;
    robot.world = robot_world_segments;
    robot.noise_mm = 6;
    robot_box(&robot, -behind_mm, -beside_mm, ahead_mm, beside_mm);
    client_init(&client, &robot);
    client_run(&client, 4000, false);
    client_open(&client);
    client_run(&client, 500, true);
}

// 212.5 mm from its axis to its side: a wall stands 52 mm beside it.
static void begin_beside_wall(void) {
    begin_with(2500, 2500, 264, "p3dx-sh");
}

static void begin_free(void) {
    begin_with(2500, 2500, 2500, "p3dx-sh");
}

static void stop(void) {
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_STOP, 0));
}

static void say_pair(int right, int left) {
    const uint8_t data[] = {ARCOS_CMD_VEL2, ARCOS_ARG_POSITIVE, (uint8_t)right, (uint8_t)left};
    uint8_t packet[16];
    client_bytes(&client, packet, argus_frame_encode(packet, sizeof packet, data, sizeof data));
}

// As it is, beyond what argus_command_int() lets pass.
static void say_raw(uint8_t command, uint8_t type, unsigned magnitude) {
    const uint8_t data[] = {command, type, (uint8_t)(magnitude & 0xFF), (uint8_t)(magnitude >> 8)};
    uint8_t packet[16];
    client_bytes(&client, packet, argus_frame_encode(packet, sizeof packet, data, sizeof data));
}

// HEAD counts from the robot's origin, so it takes a step from where the robot is.
static void step(uint8_t command, int32_t by_deg) {
    const int32_t at = command == ARCOS_CMD_HEAD ? (int32_t)lround(robot_heading_deg(&robot)) : 0;
    if (command == ARCOS_CMD_VEL2) {
        say_pair(by_deg, -by_deg);
    } else {
        client_say(&client, command, at + by_deg);
    }
}

// The most that it turned away from where it stood.
static double turned_by_steps(uint8_t command, int32_t by_deg, uint32_t every_ms) {
    const double from = robot_heading_deg(&robot);
    double most = 0;
    for (uint32_t passed = 0; passed < 8000; passed += 10) {
        if (passed % every_ms == 0) {
            step(command, by_deg);
        }
        client_run(&client, 10, true);
        most = fmax(most, fabs(robot_heading_deg(&robot) - from));
    }
    return most;
}

static void expect_none(const char *where, uint8_t command, int32_t by_deg, uint32_t every_ms) {
    char text[120];
    const double turned = turned_by_steps(command, by_deg, every_ms);
    snprintf(text, sizeof text, "%s: command %d by %d each %u ms: %.1f deg", where, command, (int)by_deg,
             (unsigned)every_ms, turned);
    TEST_ASSERT_TRUE_MESSAGE(turned <= MOST_DEG, text);
    TEST_ASSERT_TRUE_MESSAGE(robot.closest_mm > 25, text);
}

static const uint8_t commands[] = {ARCOS_CMD_DHEAD, ARCOS_CMD_HEAD,   ARCOS_CMD_DCHEAD,
                                   ARCOS_CMD_RVEL,  ARCOS_CMD_ROTATE, ARCOS_CMD_VEL2};

static void in_every_step(const char *where, void (*begin)(void)) {
    static const uint32_t rates_ms[] = {20, 100, 250, 1000};
    for (size_t k = 0; k < sizeof commands; k++) {
        begin();
        for (int32_t by_deg = 1; by_deg <= 10; by_deg++) {
            const uint32_t every_ms = rates_ms[(size_t)by_deg % 4];
            expect_none(where, commands[k], by_deg, every_ms);
            expect_none(where, commands[k], -by_deg, every_ms);
        }
    }
}

void test_no_step_turns_it_into_a_wall_beside(void) {
    in_every_step("wall", begin_beside_wall);
}

static void begin_stopped(void) {
    begin_free();
    stop();
}

void test_no_step_turns_it_after_an_operators_stop(void) {
    in_every_step("stop", begin_stopped);
}

static void begin_unknown(void) {
    begin_with(2500, 2500, 2500, "hovercraft");
}

void test_no_step_turns_an_unknown_body(void) {
    in_every_step("body", begin_unknown);
    TEST_ASSERT_FALSE(robot.motors);
    TEST_ASSERT_EQUAL_INT(0, robot_count_commands(&robot, ARCOS_CMD_ENABLE, 0));
}

static void begin_pressed(void) {
    begin_free();
    robot.bumpers_front = 0x04;
    client_run(&client, 300, true);
}

void test_no_step_turns_it_with_a_bumper_pressed(void) {
    in_every_step("bumper", begin_pressed);
}

// A turn that goes on when it may no more ends at once.
void test_a_turn_under_way_ends_with_a_stop(void) {
    for (size_t k = 0; k < sizeof commands; k++) {
        begin_free();
        step(commands[k], commands[k] == ARCOS_CMD_VEL2 ? 5 : 90);
        client_run(&client, 400, true);
        TEST_ASSERT_TRUE(fabs(robot.w) > 0.1);
        stop();
        const double from = robot_heading_deg(&robot);
        const double w = fabs(robot.w);
        client_run(&client, 5000, true);
        const double braked_deg = (w * 0.1 + w * w / 2 / (100 * 0.0174533)) / 0.0174533;
        TEST_ASSERT_TRUE(fabs(robot_heading_deg(&robot) - from) <= braked_deg + 0.5);
        TEST_ASSERT_TRUE(robot.w == 0.0);
    }
}

// Motors that are on are no reason to forget a turn.
void test_enable_again_does_not_free_a_turn(void) {
    begin_beside_wall();
    robot.ignores[ARCOS_CMD_ENABLE] = true; // set points stay
    robot_box(&robot, -3000, -3000, 3000, 3000);
    memset(robot.segment, 0, 4 * sizeof robot.segment[0]); // nothing near: it is let to turn
    client_run(&client, 6000, true);
    client_say(&client, ARCOS_CMD_RVEL, 20);
    client_say(&client, ARCOS_CMD_ENABLE, 1);
    client_run(&client, 1000, true);
    TEST_ASSERT_TRUE(robot.w > 0.2);
    stop();
    client_run(&client, 1000, true);
    TEST_ASSERT_TRUE(robot.w == 0.0);
}

void test_numbers_at_the_ends_of_the_range(void) {
    static const unsigned magnitudes[] = {1,    2,     46,    180,   359,   3600,  4634,
                                          4635, 32767, 32768, 46340, 46341, 65534, 65535};
    for (size_t k = 0; k < sizeof commands; k++) {
        begin_beside_wall();
        for (size_t i = 0; i < sizeof magnitudes / sizeof magnitudes[0]; i++) {
            for (int type = 0; type < 4; type++) {
                static const uint8_t types[] = {ARCOS_ARG_POSITIVE, ARCOS_ARG_NEGATIVE, ARCOS_ARG_STRING, 0};
                if (commands[k] == ARCOS_CMD_VEL2 && (magnitudes[i] >> 8) == (magnitudes[i] & 0xFF)) {
                    continue; // no turn
                }
                const double from = robot_heading_deg(&robot);
                for (int again = 0; again < 5; again++) {
                    say_raw(commands[k], types[type], magnitudes[i]);
                    client_run(&client, 100, true);
                }
                char text[80];
                snprintf(text, sizeof text, "command %d type %02x number %u", commands[k], types[type],
                         magnitudes[i]);
                TEST_ASSERT_TRUE_MESSAGE(fabs(robot_heading_deg(&robot) - from) <= MOST_DEG, text);
                TEST_ASSERT_TRUE_MESSAGE(robot.closest_mm > 20, text);
                client_say(&client, ARCOS_CMD_VEL, 0);
            }
        }
    }
}

// The same turn elsewhere passes.
void test_where_nothing_is_near_each_step_passes(void) {
    for (size_t k = 0; k < sizeof commands; k++) {
        begin_free();
        TEST_ASSERT_TRUE(turned_by_steps(commands[k], 5, 250) > 8);
        TEST_ASSERT_EQUAL_INT(0, robot_count_events(&robot, ARGUS_EV_GUARD_TURN_HELD, 0));
    }
}

// A HEAD that was let is let to its end, though the client repeats it.
void test_a_turn_that_is_free_to_its_end_comes_there(void) {
    begin_with(2500, 2500, 320, "p3dx-sh"); // 108 mm beside it
    for (int i = 0; i < 40; i++) {
        client_say(&client, ARCOS_CMD_HEAD, 12);
        client_run(&client, 100, true);
    }
    TEST_ASSERT_INT_WITHIN(1, 12, (int)lround(robot_heading_deg(&robot)));
    TEST_ASSERT_EQUAL_INT(0, robot_count_events(&robot, ARGUS_EV_GUARD_TURN_HELD, 0));
    TEST_ASSERT_TRUE(robot.closest_mm > 25);
}

// The operator's stop came first, the manager had the robot: a client that comes does not undo it.
void test_a_client_that_comes_after_the_stop_moves_nothing(void) {
    begin_free();
    client_plain(&client, ARCOS_CMD_CLOSE);
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_ACTIVE, 0));
    client_run(&client, 3000, false);
    stop();
    client_run(&client, 1000, false);
    client_open(&client);
    expect_none("stop before the client", ARCOS_CMD_DHEAD, 5, 100);
    client_say(&client, ARCOS_CMD_VEL, 300);
    client_run(&client, 2000, true);
    TEST_ASSERT_TRUE(robot.v == 0.0);
    TEST_ASSERT_EQUAL_INT32(ARGUS_BOUND_HALTED, robot_last_event(&robot, ARGUS_EV_GUARD_HELD)->value);
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_GO, 0));
    client_run(&client, 500, true);
    client_say(&client, ARCOS_CMD_VEL, 300); // it drives again, motors on
    client_run(&client, 2000, true);
    TEST_ASSERT_TRUE(robot.motors);
    TEST_ASSERT_TRUE(robot.v > 100);
}

// Nothing that a client says takes the robot's SIPs, delays a STOP on its line, or fills what waits for it.
void test_no_flood_costs_a_sip_or_a_stop(void) {
    static const uint8_t said[] = {ARCOS_CMD_CONFIG, ARCOS_CMD_PULSE,  ARCOS_CMD_VEL,     ARCOS_CMD_DHEAD,
                                   ARCOS_CMD_RVEL,   ARCOS_CMD_ENABLE, ARCOS_CMD_SETA,    ARCOS_CMD_SETO,
                                   ARCOS_CMD_STOP,   ARCOS_CMD_DIGOUT, ARCOS_CMD_TICKSMM, ARCOS_CMD_CLOSE,
                                   ARCOS_CMD_OPEN,   ARCOS_CMD_GETAUX, ARCOS_CMD_E_STOP,  ARCOS_CMD_MOVE};
    for (size_t k = 0; k < sizeof said; k++) {
        begin_free();
        const uint32_t sips = robot.argus.session.sips;
        const uint32_t sent = robot.argus.session.outbox.sent;
        const uint32_t refused = robot.argus.session.outbox.refused;
        const int events = robot.events;
        for (uint32_t passed = 0; passed < 5000; passed += 10) {
            for (int i = 0; i < 50; i++) {
                client_say(&client, said[k], (int32_t)(passed + (uint32_t)i) % 300 + 1);
            }
            client_run(&client, 10, true);
        }
        char text[100];
        const uint32_t packets = robot.argus.session.outbox.sent - sent;
        snprintf(text, sizeof text, "command %d: %u packets in 5 s, %d events", said[k], (unsigned)packets,
                 robot.events - events);
        TEST_ASSERT_TRUE_MESSAGE(robot.argus.session.sips - sips >= 49, text);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(refused, robot.argus.session.outbox.refused, text);
        TEST_ASSERT_TRUE_MESSAGE(packets <= 5 * 130, text);
        TEST_ASSERT_TRUE_MESSAGE(robot.events - events < 80, text);
    }
    TEST_ASSERT_EQUAL_INT(0, argus_invariants_broken(&robot.argus));
}

void test_a_flood_of_what_is_refused_is_seen(void) {
    begin_free();
    const int configs = robot_count_commands(&robot, ARCOS_CMD_CONFIG, 0); // the session's own
    for (int i = 0; i < 1000; i++) {
        client_say(&client, ARCOS_CMD_TICKSMM, 1);
        client_say(&client, ARCOS_CMD_CONFIG, 1);
        client_run(&client, 10, false);
    }
    TEST_ASSERT_TRUE(client_port(&client)->refused > 1900);
    TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_GUARD_REFUSED, 0) >= 40);
    TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_GUARD_REFUSED, 0) <= 60);
    TEST_ASSERT_TRUE(robot_last_event(&robot, ARGUS_EV_GUARD_DROPPED)->value > 150);
    TEST_ASSERT_EQUAL_INT(0, robot_count_commands(&robot, ARCOS_CMD_TICKSMM, 0));
    TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_CONFIG, 0) - configs <= 25);
}

// A random client -------------------------------------------------------------------------------------------

static int32_t any_number(void) {
    static const int32_t ends[] = {0, 1, -1, 2, -2, 5, -9, 10, 90, -180, 360, 4635, -4635, 32767, -32767};
    const uint32_t from = robot_random(&robot, 3);
    if (from == 0) {
        return ends[robot_random(&robot, sizeof ends / sizeof ends[0])];
    }
    const int32_t most = from == 1 ? 10 : 180;
    return (int32_t)robot_random(&robot, (uint32_t)(2 * most + 1)) - most;
}

static void say_anything(void) {
    static const uint8_t turns[] = {ARCOS_CMD_DHEAD,  ARCOS_CMD_HEAD, ARCOS_CMD_DCHEAD, ARCOS_CMD_RVEL,
                                    ARCOS_CMD_ROTATE, ARCOS_CMD_VEL2, ARCOS_CMD_ENABLE, ARCOS_CMD_SETRV,
                                    ARCOS_CMD_SETRA,  ARCOS_CMD_SETO, ARCOS_CMD_STOP,   ARCOS_CMD_DHEAD};
    const uint8_t command = turns[robot_random(&robot, sizeof turns)];
    const int32_t number = any_number();
    switch (command) {
    case ARCOS_CMD_VEL2: // on the spot
        say_pair(number % 20, -(number % 20));
        break;
    case ARCOS_CMD_SETO:
    case ARCOS_CMD_STOP:
        client_plain(&client, command);
        break;
    case ARCOS_CMD_RVEL:
        say_raw(command, number < 0 ? ARCOS_ARG_NEGATIVE : ARCOS_ARG_POSITIVE,
                (unsigned)abs(number) * (1 + robot_random(&robot, 3)));
        break;
    default:
        client_say(&client, command, number);
        break;
    }
}

// A wall across, so that the body stands `off_mm` from it at this bearing.
static void stand_before_wall(int bearing_deg, double off_mm) {
    const double c = cos(bearing_deg * 0.0174533);
    const double s = sin(bearing_deg * 0.0174533);
    const double far = fmax(fmax(c * 210, -c * 301) + fabs(s) * 212.5 + off_mm, 0);
    robot.segments = 1;
    const double wall[4] = {far * c - 5000 * s, far * s + 5000 * c, far * c + 5000 * s, far * s - 5000 * c};
    memcpy(robot.segment[0], wall, sizeof wall);
}

// The truth of the body and the wall: how near a turn by so much brings it.
static double gap_turned_mm(double by_deg) {
    static robot_t truth;
    memcpy(&truth, &robot, sizeof truth);
    truth.th += by_deg * 0.0174533;
    const double *w = truth.segment[0];
    const double length = hypot(w[2] - w[0], w[3] - w[1]);
    const double nx = (w[3] - w[1]) / length, ny = -(w[2] - w[0]) / length;
    const double side = (w[0] - truth.x) * nx + (w[1] - truth.y) * ny < 0 ? -1 : 1;
    double nearest = 1e9;
    for (int corner = 0; corner < 4; corner++) {
        const double x = corner < 2 ? 210 : -301;
        const double y = corner % 2 == 0 ? 212.5 : -212.5;
        const double wx = truth.x + x * cos(truth.th) - y * sin(truth.th);
        const double wy = truth.y + x * sin(truth.th) + y * cos(truth.th);
        nearest = fmin(nearest, ((w[0] - wx) * nx + (w[1] - wy) * ny) * side);
    }
    return nearest;
}

// An array of eight falls out, and no other looks where it looked.
static void lose_array(int first, robot_fault_t fault) {
    for (int i = first; i < first + 8; i++) {
        robot.fault[i] = fault;
    }
    client_run(&client, 8000, true);
}

static void play_client(uint32_t seed, int bearing_deg, double off_mm, int lost) {
    char text[120];
    begin_free();
    robot.seed = seed * 2654435761u + 1;
    stand_before_wall(bearing_deg, off_mm);
    client_run(&client, 7000, true); // what was remembered of the room is gone
    if (lost >= 0) {
        lose_array(lost, seed % 2 == 0 ? ROBOT_OFF : ROBOT_SILENT);
    }
    const double from = robot_heading_deg(&robot);
    const bool near_left = gap_turned_mm(6) < 0; // it touches within a few degrees, whichever way it goes
    const bool near_right = gap_turned_mm(-6) < 0;
    for (int i = 0; i < 150; i++) {
        say_anything();
        client_run(&client, 10 * (1 + robot_random(&robot, 40)), true);
        const double turned = remainder(robot_heading_deg(&robot) - from, 360);
        snprintf(text, sizeof text, "seed %u, wall at %d deg, %.0f mm off: turned %.1f, gap %.1f",
                 (unsigned)seed, bearing_deg, off_mm, turned, gap_turned_mm(0));
        TEST_ASSERT_TRUE_MESSAGE(gap_turned_mm(0) > 0, text);
        TEST_ASSERT_FALSE_MESSAGE(near_left && turned > MOST_DEG, text);
        TEST_ASSERT_FALSE_MESSAGE(near_right && turned < -MOST_DEG, text);
    }
}

void test_a_random_client_before_a_wall_at_any_bearing(void) {
    for (uint32_t seed = 1; seed <= 24; seed++) {
        play_client(seed, (int)(seed * 47 % 360) - 180, 20 + seed * 37 % 90, -1);
    }
}

void test_a_random_client_before_a_wall_that_only_a_dead_array_has_heard(void) {
    for (uint32_t seed = 500; seed < 512; seed++) {
        play_client(seed, (int)(seed * 47 % 120) - 60, 20 + seed * 37 % 90, 0);
        play_client(seed, (int)(seed * 47 % 120) + 120, 20 + seed * 37 % 90, 8);
    }
}

void test_many_random_clients_before_walls(void) { // soak
    for (uint32_t seed = 100; seed < 400; seed++) {
        play_client(seed, (int)(seed * 47 % 360) - 180, 10 + seed * 37 % 150, -1);
    }
}
