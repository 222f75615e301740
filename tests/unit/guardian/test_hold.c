// SPDX-License-Identifier: MIT
// Attacks: whatever a client asks of the wheels, the body meets nothing that a trusted sonar sees (S2, S5,
// S7), goes nowhere that no sonar sees (S1), and does what was asked where nothing is in the way.
#include <math.h>
#include <string.h>

#include "client.h"
#include "unity.h"

static robot_t robot;
static client_t client;

static void begin(double ahead_mm, double behind_mm, double beside_mm) {
    const argus_config_t settings = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &settings, 1000);
    robot.world = robot_world_segments;
    robot.noise_mm = 6;
    robot_box(&robot, -behind_mm, -beside_mm, ahead_mm, beside_mm);
    client_init(&client, &robot);
    client_run(&client, 4000, false);
    client_open(&client);
}

static void run(uint32_t ms) {
    client_run(&client, ms, true);
}

static int32_t last(int event) {
    return robot_last_event(&robot, event)->value;
}

static int count(int event) {
    return robot_count_events(&robot, event, 0);
}

static int quiet(void) {
    return count(ARGUS_EV_GUARD_HELD) + count(ARGUS_EV_GUARD_SLOWED) + count(ARGUS_EV_GUARD_TURN_HELD) +
           count(ARGUS_EV_GUARD_LOOKS) + count(ARGUS_EV_GUARD_REFUSED);
}

// In a large room everything passes as it was said.
void test_nothing_is_bounded_where_nothing_is_near(void) {
    begin(4500, 4500, 4500);
    client_say(&client, ARCOS_CMD_VEL, 500);
    run(2500);
    TEST_ASSERT_EQUAL_INT(500, (int)(robot.v + 0.5));
    client_say(&client, ARCOS_CMD_RVEL, 30);
    run(1500);
    TEST_ASSERT_TRUE(robot.w > 0.5);
    client_say(&client, ARCOS_CMD_RVEL, 0);
    client_say(&client, ARCOS_CMD_VEL, -200);
    run(4000);
    TEST_ASSERT_EQUAL_INT(-200, (int)(robot.v - 0.5));
    client_say(&client, ARCOS_CMD_VEL, 0);
    run(2000);
    client_say(&client, ARCOS_CMD_HEAD, 90);
    run(5000);
    TEST_ASSERT_INT_WITHIN(2, 90, (int)robot_heading_deg(&robot));
    client_say(&client, ARCOS_CMD_DHEAD, -45);
    run(5000);
    TEST_ASSERT_INT_WITHIN(2, 45, (int)robot_heading_deg(&robot));
    TEST_ASSERT_EQUAL_INT(0, quiet());
}

static void drive_at_wall(int32_t mm_s) {
    begin(2500, 2500, 2500);
    client_say(&client, ARCOS_CMD_VEL, mm_s);
    run(20000);
    TEST_ASSERT_TRUE(robot.v == 0.0);
    TEST_ASSERT_TRUE_MESSAGE(robot.closest_mm > 40, "nearer to a wall than S5 lets it");
    TEST_ASSERT_TRUE(robot.closest_mm < 260);
    TEST_ASSERT_EQUAL_INT32(ARGUS_BOUND_OBJECT, last(ARGUS_EV_GUARD_HELD));
}

void test_vel_stands_before_a_wall(void) {
    drive_at_wall(200);
    drive_at_wall(400);
    drive_at_wall(750);
}

void test_vel_back_stands_before_a_wall(void) {
    drive_at_wall(-200);
    drive_at_wall(-400);
    drive_at_wall(-750);
}

// What goes to the robot ends by itself, whatever becomes of the next order: no VEL but 0, no matter how
// often the client repeats its own, and few MOVEs.
void test_vel_goes_out_with_an_end(void) {
    static const int32_t speeds[] = {200, 400, 750, -200};
    for (size_t k = 0; k < sizeof speeds / sizeof speeds[0]; k++) {
        begin(2500, 2500, 2500);
        for (int i = 0; i < 200; i++) {
            client_say(&client, ARCOS_CMD_VEL, speeds[k]);
            client_run(&client, 100, true);
        }
        for (int i = 0; i < robot.commands; i++) {
            TEST_ASSERT_TRUE(robot.command[i].command != ARCOS_CMD_VEL || robot.command[i].argument == 0);
        }
        TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_MOVE, 0) > 0);
        TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_MOVE, 0) < 12);
        TEST_ASSERT_TRUE(robot.closest_mm > 40);
        TEST_ASSERT_TRUE(robot.closest_mm < 260);
    }
}

// S5: either end, until a sonar that looks there has heard an echo.
void test_back_is_slow_where_nothing_was_ever_heard(void) {
    begin(2500, 9000, 9000);
    client_say(&client, ARCOS_CMD_VEL, -200);
    run(4000);
    TEST_ASSERT_EQUAL_INT(-100, (int)(robot.v - 0.5));
}

// What a curve costs beside something is shown by the fuzzer's corpus: a corner met on a tangent.
void test_a_fast_curve_where_nothing_is_near_is_the_clients(void) {
    begin(4500, 4500, 4500);
    client_say(&client, ARCOS_CMD_VEL, 700);
    client_say(&client, ARCOS_CMD_RVEL, 40);
    run(5000);
    TEST_ASSERT_EQUAL_INT(700, (int)(robot.v + 0.5));
    TEST_ASSERT_EQUAL_INT(0, quiet());
}

void test_it_slows_down_first(void) {
    begin(2500, 2500, 2500);
    client_say(&client, ARCOS_CMD_VEL, 750);
    run(20000);
    TEST_ASSERT_TRUE(count(ARGUS_EV_GUARD_SLOWED) > 0);
    TEST_ASSERT_TRUE(last(ARGUS_EV_GUARD_SLOWED) < 750);
}

void test_a_client_that_turns_away_gets_on(void) {
    begin(1500, 2500, 2500);
    client_say(&client, ARCOS_CMD_VEL, 400);
    run(8000);
    TEST_ASSERT_TRUE(robot.v == 0.0);
    client_say(&client, ARCOS_CMD_RVEL, 40);
    run(4000);
    client_say(&client, ARCOS_CMD_RVEL, 0);
    run(3000);
    TEST_ASSERT_TRUE(robot.v > 100);
    TEST_ASSERT_TRUE(robot.closest_mm > 20);
}

void test_move_goes_as_far_as_is_free(void) {
    begin(2500, 2500, 2500);
    client_say(&client, ARCOS_CMD_MOVE, 1000);
    run(8000);
    TEST_ASSERT_INT_WITHIN(25, 1000, (int)robot.x);
    TEST_ASSERT_EQUAL_INT(0, count(ARGUS_EV_GUARD_HELD));
    client_say(&client, ARCOS_CMD_MOVE, 5000);
    run(20000);
    TEST_ASSERT_TRUE(robot.v == 0.0);
    TEST_ASSERT_TRUE(robot.closest_mm > 40);
    TEST_ASSERT_TRUE(robot.x > 1800);
}

void test_move_back_likewise(void) {
    begin(2500, 2500, 2500);
    client_say(&client, ARCOS_CMD_MOVE, -5000);
    run(20000);
    TEST_ASSERT_TRUE(robot.v == 0.0);
    TEST_ASSERT_TRUE(robot.closest_mm > 40);
    TEST_ASSERT_TRUE(robot.x < -1500);
}

void test_vel2_is_slowed_on_its_curve(void) {
    begin(2500, 2500, 2500);
    const uint8_t data[] = {ARCOS_CMD_VEL2, ARCOS_ARG_POSITIVE, 25, 25}; // 500 mm/s
    uint8_t packet[16];
    client_bytes(&client, packet, argus_frame_encode(packet, sizeof packet, data, sizeof data));
    TEST_ASSERT_EQUAL_INT(500, client_port(&client)->hold.given.mm_s);
    begin(650, 2500, 2500);
    client_bytes(&client, packet, argus_frame_encode(packet, sizeof packet, data, sizeof data));
    TEST_ASSERT_TRUE(client_port(&client)->hold.given.mm_s < 400);
    TEST_ASSERT_EQUAL_INT8(client_port(&client)->hold.given.left, client_port(&client)->hold.given.right);
}

void test_back_is_closed_while_the_rear_is_not_seen(void) {
    begin(2500, 2500, 2500);
    robot.fault[11] = ROBOT_SILENT;
    run(3000);
    client_say(&client, ARCOS_CMD_VEL, -200);
    run(2000);
    TEST_ASSERT_TRUE(robot.x > -1);
    TEST_ASSERT_EQUAL_INT32(ARGUS_BOUND_UNSEEN, last(ARGUS_EV_GUARD_HELD));
}

// A thing that only sonar 3 would hear stands in the way, and it is silent: the others look there.
void test_with_a_blind_bearing_the_heading_swings_and_nothing_is_met(void) {
    begin(4000, 2500, 2500);
    robot_box(&robot, 1800, 40, 1860, 150);
    robot.fault[3] = ROBOT_SILENT;
    run(3000);
    TEST_ASSERT_EQUAL_INT(1, count(ARGUS_EV_SONAR_SILENT));
    client_say(&client, ARCOS_CMD_VEL, 400);
    run(40000);
    TEST_ASSERT_TRUE(count(ARGUS_EV_GUARD_LOOKS) > 0);
    TEST_ASSERT_TRUE_MESSAGE(robot.closest_mm > 5, "it met the thing");
    TEST_ASSERT_TRUE_MESSAGE(robot.x > 1000, "it did not get on");
}

void test_without_a_thing_there_it_gets_on_with_a_blind_bearing(void) {
    begin(9000, 2500, 2500);
    robot.fault[3] = ROBOT_SILENT;
    run(3000);
    client_say(&client, ARCOS_CMD_VEL, 400);
    run(30000);
    TEST_ASSERT_TRUE_MESSAGE(robot.x > 4000, "it did not get on");
    client_say(&client, ARCOS_CMD_VEL, 0);
    run(4000);
    TEST_ASSERT_INT_WITHIN(3, 0, (int)robot_heading_deg(&robot));
}

void test_a_turn_into_a_thing_beside_is_held(void) {
    begin(2500, 2500, 2500);
    robot_box(&robot, -300, 240, -100, 300); // beside the rear: its corner would sweep it
    run(1000);
    client_say(&client, ARCOS_CMD_RVEL, -40);
    run(4000);
    TEST_ASSERT_TRUE(count(ARGUS_EV_GUARD_TURN_HELD) > 0);
    TEST_ASSERT_TRUE_MESSAGE(robot.closest_mm > 0, "it met the thing");
}

void test_a_bumper_ends_what_it_does_and_lets_it_back_away(void) {
    begin(2500, 2500, 2500);
    client_say(&client, ARCOS_CMD_VEL, 300);
    run(1500);
    robot.bumpers_front = 0x08;
    robot_next_sip(&robot);
    TEST_ASSERT_EQUAL_INT(1, robot_count_commands(&robot, ARCOS_CMD_E_STOP, 0));
    run(500);
    TEST_ASSERT_TRUE(robot.v == 0.0);
    client_say(&client, ARCOS_CMD_VEL, 300);
    run(500);
    TEST_ASSERT_TRUE(robot.v == 0.0);
    client_say(&client, ARCOS_CMD_VEL, -200);
    run(1000);
    TEST_ASSERT_TRUE(robot.v < -100);
}

void test_sonars_that_do_not_report_close_the_way(void) {
    begin(2500, 2500, 2500);
    client_say(&client, ARCOS_CMD_VEL, 300);
    run(2000);
    robot.sonar_on = false;
    run(4000);
    TEST_ASSERT_TRUE(robot.v == 0.0);
}

// A smooth wall that the way slants into: only the sonar abeam hears it, and only driving shows the slant.
static void drive_into_smooth_wall(int slant_deg) {
    const double slant = tan(slant_deg * 0.0174533);
    const double beside = 300 + 1500 * slant;
    const double wall[4] = {-4000, beside + 4000 * slant, 8000, beside - 8000 * slant};
    begin(20000, 20000, 20000);
    robot.world = robot_world_smooth;
    robot.segments = 1;
    memcpy(robot.segment[0], wall, sizeof wall);
    client_say(&client, ARCOS_CMD_VEL, 300);
    run(30000); // no faster than a step, where nothing ahead has been heard
}

void test_a_wall_that_the_way_slants_into_is_not_forgotten(void) {
    for (int slant_deg = 6; slant_deg <= 18; slant_deg += 4) {
        drive_into_smooth_wall(slant_deg);
        TEST_ASSERT_TRUE_MESSAGE(robot.v == 0.0, "it drives into the wall");
        const double x = robot.x;
        run(180000); // much longer than what was heard is kept
        TEST_ASSERT_TRUE_MESSAGE(fabs(robot.x - x) < 5, "it creeps on");
        TEST_ASSERT_TRUE_MESSAGE(robot.closest_mm > 0, "it met the wall");
        client_say(&client, ARCOS_CMD_VEL, -200); // back, and away from it
        run(8000);
        client_say(&client, ARCOS_CMD_VEL, 0);
        client_say(&client, ARCOS_CMD_HEAD, -40);
        run(5000);
        client_say(&client, ARCOS_CMD_VEL, 300);
        run(3000);
        TEST_ASSERT_TRUE_MESSAGE(robot.v > 50, "it does not get away");
    }
}

void test_a_weak_brake_is_not_passed(void) {
    begin(2500, 2500, 2500);
    client_say(&client, ARCOS_CMD_SETA, -50);
    TEST_ASSERT_EQUAL_INT(-300, robot_last_command(&robot, ARCOS_CMD_SETA)->argument);
    client_say(&client, ARCOS_CMD_SETA, -500);
    TEST_ASSERT_EQUAL_INT(-500, robot_last_command(&robot, ARCOS_CMD_SETA)->argument);
}

void test_an_unknown_body_is_not_moved(void) {
    const argus_config_t settings = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &settings, 1000);
    robot.subclass = "hovercraft";
    client_init(&client, &robot);
    client_run(&client, 4000, false);
    client_open(&client);
    client_say(&client, ARCOS_CMD_VEL, 300);
    run(2000);
    TEST_ASSERT_TRUE(robot.v == 0.0);
    TEST_ASSERT_EQUAL_INT32(ARGUS_BOUND_HALTED, last(ARGUS_EV_GUARD_HELD));
}

// Random commands in a room with things in it, for an hour: nothing is met.
void test_random_commands_meet_nothing(void) { // soak
    begin(3000, 3000, 2000);
    robot_box(&robot, 1200, 500, 1700, 1000);
    robot_box(&robot, -1800, -1000, -1300, -600);
    for (int i = 0; i < 3600; i++) {
        static const uint8_t commands[] = {ARCOS_CMD_VEL,  ARCOS_CMD_VEL,   ARCOS_CMD_RVEL,
                                           ARCOS_CMD_MOVE, ARCOS_CMD_DHEAD, ARCOS_CMD_HEAD};
        const uint8_t command = commands[robot_random(&robot, sizeof commands)];
        const int32_t most = command == ARCOS_CMD_VEL ? 700 : command == ARCOS_CMD_MOVE ? 2000 : 90;
        client_say(&client, command, (int32_t)robot_random(&robot, (uint32_t)(2 * most + 1)) - most);
        run(1000);
        TEST_ASSERT_TRUE_MESSAGE(robot.closest_mm > 0, "something was met");
    }
}
