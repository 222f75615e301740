// SPDX-License-Identifier: MIT
// Rule under attack: whatever the robot, its sonars, the link and the operator do, no invariant breaks (S1 to
// S8).
#include "supervisor/manager.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "robot.h"
#include "unity.h"

#define WORLDS 200u
#define FEW_WORLDS 20u
#define WORLD_MS 60000u

static robot_t robot;

static uint32_t chance(uint32_t one_in) {
    return robot_random(&robot, one_in) == 0;
}

static argus_config_t random_config(uint32_t seed) {
    argus_config_t config = robot_config_of(seed % 3 == 0 ? ARGUS_PROFILE_PAPER : ARGUS_PROFILE_ARGUS);
    config.policy = (int32_t)(seed & 1u);
    config.active = seed % 7 != 0;
    if (seed % 5 == 0) { // the bare paper
        config.suspect_readings = 1;
        config.holdoff_mm = 0;
        config.holdoff_deg = 0;
    }
    return config;
}

static void begin(uint32_t seed) {
    const argus_config_t config = random_config(seed);
    robot_init(&robot, &config, seed * 2654435761u);
    robot.seed = seed * 2246822519u + 1u;
    robot.noise_mm = (int)robot_random(&robot, 12);
    robot.lists_all = chance(8);
    robot.deny_motors = chance(20);
    robot.e_stop_cuts_motors = chance(3);
    robot.position_mask = chance(2) ? 0xFFFF : 0x7FFF;
    if (chance(4)) {
        robot.subclass = "p3dx";
        robot.unit_mm = 0.485;
    }
    const bool far = chance(2); // nothing near, nothing disparate: the robot drives
    robot.world = far ? robot_world_far : robot_world_segments;
    if (!far) {
        robot_box(&robot, -1200, -1500, 3500, 1500);
    }
    if (!far && chance(2)) {
        robot_box(&robot, 1200, -250, 1500, 250);
    }
    robot_goal(&robot, 500 + (int)robot_random(&robot, 2500), (int)robot_random(&robot, 1600) - 800);
}

static void random_fault(void) {
    const int sonar = (int)robot_random(&robot, 16);
    static const int scale[] = {20, 50, 80, 130};
    robot.fault[sonar] = (robot_fault_t)robot_random(&robot, 5);
    robot.fault_value[sonar] = robot.fault[sonar] == ROBOT_SCALE
                                   ? scale[robot_random(&robot, 4)]
                                   : (int)robot_random(&robot, chance(9) ? 65536 : 5001);
}

static void random_contact(void) {
    robot.bumpers_front = chance(2) ? (uint8_t)(robot_random(&robot, 32) << 1) : 0;
    robot.bumpers_rear = chance(6) ? (uint8_t)(robot_random(&robot, 32) << 1) : 0;
    robot.stall = chance(10);
}

static void random_link(void) {
    switch (robot_random(&robot, 6)) {
    case 0:
        robot.mute = true;
        break;
    case 1:
        argus_link_lost(&robot.argus, robot.start_ms + robot.t_ms);
        robot_drain(&robot);
        break;
    default:
        robot.mute = false;
        argus_link_up(&robot.argus, robot.start_ms + robot.t_ms);
        break;
    }
}

static void random_noise(void) {
    uint8_t bytes[64];
    const size_t count = robot_random(&robot, sizeof bytes);
    for (size_t i = 0; i < count; i++) {
        bytes[i] = chance(3) ? (uint8_t)(0xFA + robot_random(&robot, 2)) : (uint8_t)robot_random(&robot, 256);
    }
    robot_deliver(&robot, bytes, count);
    robot_drain(&robot);
}

static void random_operator(void) {
    static const int32_t arguments[] = {0, 1, -1, 90, -90, 200, -150, INT32_MAX, INT32_MIN};
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, (argus_op_t)robot_random(&robot, 9),
                   arguments[robot_random(&robot, 9)]);
    robot_drain(&robot);
}

static void random_motors(void) {
    robot.stop_button = chance(3);
    robot.motors = robot.motors && !robot.stop_button && !chance(3);
    robot.stuck_wheels = chance(6);
}

// Mean seconds between two disturbances of a kind; what presses, cuts or blocks is let go again soon.
static uint32_t every(uint32_t seconds) {
    return chance(seconds * 100);
}

static void disturb(void) {
    if (every(25))
        random_fault();
    if (every(15))
        random_contact();
    if (every(20))
        random_link();
    if (every(8))
        random_noise();
    if (every(20))
        random_operator();
    if (every(30))
        random_motors();
    if (every(3))
        robot.bumpers_front = robot.bumpers_rear = 0;
    if (every(3))
        robot.stall = robot.stop_button = robot.stuck_wheels = false;
    if (robot.mute && every(2))
        robot.mute = false;
    if (every(5))
        argus_link_up(&robot.argus, robot.start_ms + robot.t_ms);
}

static void fuzz(uint32_t seed) {
    char text[400];
    begin(seed);
    for (uint32_t at = 0; at < WORLD_MS && robot.violation[0] == '\0'; at += 10) {
        disturb();
        robot_tick(&robot);
    }
    snprintf(text, sizeof text, "ARGUS_SEED=%u: %s", (unsigned)seed, robot.violation);
    TEST_ASSERT_TRUE_MESSAGE(robot.violation[0] == '\0', text);
}

// ARGUS_SEED=n in the environment runs that world alone.
static void fuzz_worlds(uint32_t worlds) {
    const char *only = getenv("ARGUS_SEED");
    if (only != NULL) {
        fuzz((uint32_t)strtoul(only, NULL, 10));
        return;
    }
    unsigned long moves = 0;
    unsigned long turns = 0;
    for (uint32_t seed = 1; seed <= worlds; seed++) {
        fuzz(seed);
        moves += (unsigned long)robot_count_commands(&robot, ARCOS_CMD_MOVE, 0);
        turns += (unsigned long)robot_count_commands(&robot, ARCOS_CMD_HEAD, 0);
    }
    printf("%lu MOVE, %lu HEAD in %u worlds\n", moves, turns, (unsigned)worlds);
    TEST_ASSERT_TRUE_MESSAGE(moves > 5 * worlds && turns > 5 * worlds, "the worlds exercise no driving");
}

void test_few_random_worlds_break_no_invariant(void) {
    fuzz_worlds(FEW_WORLDS);
}

void test_random_worlds_break_no_invariant(void) { // soak
    fuzz_worlds(WORLDS);
}
