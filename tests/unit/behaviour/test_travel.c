// SPDX-License-Identifier: MIT
// Rule under attack: the robot drives as fast as what it sees ahead allows (S5), no faster than the robot
// itself lets it, and turns while it drives only by angles that the sonars ahead see and with its swing
// circle free. The paper's rules know neither.
#include "behaviour/travel.h"

#include <math.h>
#include <stdio.h>

#include "robot.h"
#include "unity.h"

#define RAD (3.14159265358979323846 / 180)

static robot_t robot;
static char text[120];

static void start(int32_t profile) {
    const argus_config_t config = robot_config_of(profile);
    robot_init(&robot, &config, 0xFFFF8000u);
    robot.noise_mm = 5;
    robot.world = robot_world_segments;
}

static void hall(double end_mm) {
    robot_box(&robot, -3000, -3000, end_mm, 3000);
}

static void finish(void) { // the watch compares the speed asked at each MOVE with S5
    TEST_ASSERT_EQUAL_STRING("", robot.violation);
}

static double fastest(uint32_t ms) {
    double most = 0;
    for (uint32_t at = 0; at < ms && robot.argus.mission == ARGUS_MISSION_RUNNING; at += 10) {
        robot_tick(&robot);
        most = fmax(most, robot.v);
    }
    return most;
}

// ---- speed

void test_s5_it_hurries_where_the_way_is_free_and_slows_down_before_a_wall(void) {
    start(ARGUS_PROFILE_ARGUS);
    hall(8000);
    TEST_ASSERT_TRUE(robot_goal(&robot, 7300, 0));
    const double most = fastest(60000);
    TEST_ASSERT_EQUAL(ARGUS_MISSION_REACHED, robot.argus.mission);
    TEST_ASSERT_TRUE(most > 480 && most <= robot.argus.config.speed_max_mm_s + 1);
    TEST_ASSERT_TRUE(robot.closest_mm >= 50);
    finish();
}

// Some robots do nothing for a MOVE of a few millimetres. So little way is none: the robot looks for another.
void test_a_way_of_a_few_millimetres_is_none(void) {
    start(ARGUS_PROFILE_ARGUS);
    hall(8000);
    TEST_ASSERT_TRUE(robot_goal(&robot, 3000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
    robot_run(&robot, 1000);
    robot.fault[6] = ROBOT_VALUE;
    robot.fault_value[6] = (uint16_t)(robot.argus.config.object_range_mm + 3);
    robot.stuck_wheels = true;                                          // they make nothing of it
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_OBJECT, 2500)); // before it is taken for motors
    TEST_ASSERT_EQUAL(6, robot_last_event(&robot, ARGUS_EV_OBJECT)->sonar);
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_WAITING, 0));
    finish();
}

// What it met on its way stays known though the bumper is free after some millimetres of the way back. What
// lets go of a robot that has not moved was no place, nor was what came to one that stood.
void test_s2_what_a_bumper_met_is_remembered_if_it_is_a_place(void) {
    static const struct {
        bool drives, backs;
        int places;
    } by[] = {{true, true, 1}, {true, false, 0}, {false, true, 0}};
    for (size_t i = 0; i < sizeof by / sizeof by[0]; i++) {
        start(ARGUS_PROFILE_ARGUS);
        hall(8000);
        TEST_ASSERT_TRUE(robot_goal(&robot, 7300, 0));
        if (by[i].drives) {
            TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
            robot_run(&robot, 1500);
        } else {
            TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_CHECKING, 20000));
        }
        robot.bumpers_front = 1 << 3;
        robot_run(&robot, 300);
        if (by[i].backs) {
            TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_BACKING, 5000));
            robot_run(&robot, 200);
        }
        robot.bumpers_front = 0;
        robot_run(&robot, 300);
        TEST_ASSERT_EQUAL(by[i].places, robot.argus.echoes.touches.count);
    }
}

// Whatever comes up before it, whenever: it stands before it.
void test_s5_what_comes_up_ahead_is_not_touched(void) {
    for (int range_mm = 500; range_mm <= 2500; range_mm += 125) {
        start(ARGUS_PROFILE_ARGUS);
        hall(20000);
        TEST_ASSERT_TRUE(robot_goal(&robot, 15000, 0));
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
        robot_run(&robot, 4000);
        const double face_mm = robot.x + 166; // of sonars 3 and 4
        robot_box(&robot, face_mm + range_mm, -2900, face_mm + range_mm + 500, 2900);
        for (int i = 0; i < 800 && robot.v > 1; i++) { // until it stands; turns beside a wall are for S7
            robot_tick(&robot);
        }
        TEST_ASSERT_TRUE(robot.v <= 1);
        snprintf(text, sizeof text, "a wall %d mm ahead: %.0f mm at the closest", range_mm, robot.closest_mm);
        // one that comes up nearer than its way to stop at full speed is none that S5 was asked about
        TEST_ASSERT_TRUE_MESSAGE(range_mm < 750 || robot.closest_mm > 0, text);
        TEST_ASSERT_TRUE_MESSAGE(range_mm < 1000 || robot.closest_mm >= 50, text);
    }
}

void test_it_drives_no_faster_than_the_robot_lets_it(void) {
    static const int32_t tops_mm_s[] = {100, 300, 400};
    for (int i = 0; i < 3; i++) {
        start(ARGUS_PROFILE_ARGUS);
        hall(20000);
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
        robot_run(&robot, 2000); // SETV of the set-up may go out again
        robot.argus.session.has_robot = true;
        robot.argus.session.robot.vel_max_mm_s = (uint16_t)tops_mm_s[i];
        const int from = robot.commands;
        TEST_ASSERT_TRUE(robot_goal(&robot, 15000, 0));
        fastest(8000);
        int32_t asked = 0;
        for (int k = from; k < robot.commands; k++) {
            const bool speed = robot.command[k].command == ARCOS_CMD_SETV;
            asked = speed && robot.command[k].argument > asked ? robot.command[k].argument : asked;
        }
        TEST_ASSERT_EQUAL(tops_mm_s[i], asked);
        TEST_ASSERT_TRUE(robot.v > tops_mm_s[i] - 5 && robot.v < tops_mm_s[i] + 1);
        finish();
    }
}

void test_the_paper_drives_at_one_speed(void) {
    start(ARGUS_PROFILE_PAPER);
    robot.world = robot_world_far;
    TEST_ASSERT_TRUE(robot_goal(&robot, 4000, 0));
    const double most = fastest(40000);
    TEST_ASSERT_EQUAL(ARGUS_MISSION_REACHED, robot.argus.mission);
    TEST_ASSERT_TRUE(most > 195 && most <= robot.argus.config.speed_mm_s + 1);
    TEST_ASSERT_EQUAL(robot.argus.config.speed_mm_s, robot.speed_asked_mm_s);
    finish();
}

// ---- gentle turns

// The least speed from one second after the first metre on, until half a metre behind the corner.
static double slowest_round_a_corner(int32_t profile, int corner_deg) {
    const argus_point_t way[] = {{2000, 0},
                                 {2000 + (int32_t)lround(2000 * cos(corner_deg * RAD)),
                                  (int32_t)lround(2000 * sin(corner_deg * RAD))}};
    start(profile);
    hall(9000);
    if (profile == ARGUS_PROFILE_PAPER) {
        robot.world = robot_world_far;
    }
    TEST_ASSERT_TRUE(argus_set_course(&robot.argus, way, 2));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
    double least = 1e9;
    for (int i = 0; i < 4000 && hypot(robot.x - 2000, robot.y) < 2500; i++) {
        robot_tick(&robot);
        const bool beyond = robot_count_events(&robot, ARGUS_EV_WAYPOINT, 0) > 0;
        if (beyond && hypot(robot.x - 2000, robot.y) > 500) {
            break;
        }
        least = robot.x > 1000 ? fmin(least, robot.v) : least;
    }
    finish();
    return least;
}

void test_it_turns_gently_by_up_to_40_degrees_while_it_drives(void) {
    static const int corners[] = {-35, -20, 20, 35};
    for (int i = 0; i < 4; i++) {
        snprintf(text, sizeof text, "%d degrees", corners[i]);
        TEST_ASSERT_TRUE_MESSAGE(slowest_round_a_corner(ARGUS_PROFILE_ARGUS, corners[i]) > 100, text);
    }
}

void test_it_stops_for_a_turn_by_more(void) {
    static const int corners[] = {-90, -50, 50, 90};
    for (int i = 0; i < 4; i++) {
        snprintf(text, sizeof text, "%d degrees", corners[i]);
        TEST_ASSERT_TRUE_MESSAGE(slowest_round_a_corner(ARGUS_PROFILE_ARGUS, corners[i]) < 1, text);
    }
}

void test_the_paper_stops_for_every_turn(void) {
    TEST_ASSERT_TRUE(slowest_round_a_corner(ARGUS_PROFILE_PAPER, 30) < 1);
}

// An echo within the swing circle, by a sonar behind: no HEAD while it drives. At rest it may turn by so
// little that the body clears it.
void test_it_does_not_turn_gently_with_the_swing_circle_blocked(void) {
    const argus_point_t way[] = {{2000, 0}, {4000, 1000}};
    start(ARGUS_PROFILE_ARGUS);
    hall(9000);
    TEST_ASSERT_TRUE(argus_set_course(&robot.argus, way, 2));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
    while (robot.x < 1200) {
        robot_tick(&robot);
    }
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_PIN, 12); // or it would be found out
    robot.fault[12] = ROBOT_VALUE;
    robot.fault_value[12] = 100;
    robot_run(&robot, 400); // until it has been read
    int turns = robot_count_commands(&robot, ARCOS_CMD_HEAD, 0);
    for (int i = 0; i < 600; i++) {
        robot_tick(&robot);
        const int now = robot_count_commands(&robot, ARCOS_CMD_HEAD, 0);
        TEST_ASSERT_TRUE_MESSAGE(now == turns || robot.v < 1, "HEAD while it drives");
        turns = now;
    }
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_WAYPOINT, 0));
    finish();
}

// ---- a place too narrow to turn in

// One echo within the swing circle may be crosstalk: it is read again before a way out is looked for ahead,
// where the wall is.
void test_s7_one_echo_is_read_again_before_a_way_out(void) {
    start(ARGUS_PROFILE_ARGUS);
    hall(2100);
    const argus_point_t course[] = {{1500, 0}, {1500, 1500}};
    TEST_ASSERT_TRUE(argus_set_course(&robot.argus, course, 2));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_WAYPOINT, 30000));
    while (robot.v > 0.5) {
        robot_tick(&robot);
    }
    const double x = robot.x;
    robot.fault[6] = ROBOT_VALUE;
    robot.fault_value[6] = 196;
    const uint32_t readings = robot.argus.knowledge.sonar[6].readings;
    while (robot.argus.knowledge.sonar[6].readings == readings) {
        robot_tick(&robot);
    }
    robot.fault[6] = ROBOT_OK;
    double most = x;
    for (int i = 0; i < 1500 && robot.y < 300; i++) {
        robot_tick(&robot);
        most = fmax(most, robot.x);
    }
    snprintf(text, sizeof text, "went %.0f mm on towards the wall", most - x);
    TEST_ASSERT_TRUE_MESSAGE(robot.y >= 300, "it does not go on");
    TEST_ASSERT_TRUE_MESSAGE(most - x < 40, text);
    finish();
}

// ---- the goal

// Carried back from it before it was said, as when the robot makes room for a look: it goes there again.
void test_a_goal_is_not_reached_from_afar(void) {
    start(ARGUS_PROFILE_ARGUS);
    hall(6000);
    TEST_ASSERT_TRUE(robot_goal(&robot, 1500, 0));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_WAYPOINT, 30000));
    robot.argus.knowledge.pose.x_mm -= 180;
    robot.x -= 180; // its odometry goes on as if nothing had happened
    robot.x0 -= 180;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 30000));
    const int32_t off_mm = robot_last_event(&robot, ARGUS_EV_GOAL_REACHED)->value;
    snprintf(text, sizeof text, "%d mm off by its word, truly at %.0f", (int)off_mm, robot.x);
    TEST_ASSERT_TRUE_MESSAGE(off_mm <= robot.argus.config.waypoint_radius_mm, text);
    TEST_ASSERT_TRUE_MESSAGE(fabs(robot.x - 1500) < 110, text);
    finish();
}
