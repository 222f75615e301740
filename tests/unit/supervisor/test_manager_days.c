// SPDX-License-Identifier: MIT
// Rule under attack: days of faults leave nothing behind: no invariant breaks, no event is lost, nothing is
// written beyond the manager, time goes on over the wrap of its 49.7 days, and a robot that is whole again
// drives.
#include "supervisor/manager.h"

#include <stdio.h>
#include <string.h>

#include "robot.h"
#include "unity.h"

#define SEED 7u
#define MINUTE_MS 60000u
#define HOUR_MS (60u * MINUTE_MS)
#define GUARD_BYTES 4096

static struct {
    uint8_t before[GUARD_BYTES];
    robot_t robot;
    uint8_t after[GUARD_BYTES];
} held;
static robot_t *const robot = &held.robot;
static char text[400];

static uint32_t now_ms(void) {
    return robot->start_ms + robot->t_ms;
}

static void begin(uint32_t start_ms) {
    const argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    memset(held.before, 0xA5, sizeof held.before);
    memset(held.after, 0xA5, sizeof held.after);
    robot_init(robot, &config, start_ms);
    robot->seed = SEED;
    robot->world = robot_world_segments;
    robot_box(robot, -2500, -2000, 3500, 2000);
}

static void break_something(void) {
    const int sonar = (int)robot_random(robot, 16);
    switch (robot_random(robot, 6)) {
    case 0:
        robot->fault[sonar] = (robot_fault_t)robot_random(robot, 9);
        robot->fault_value[sonar] = 1 + (int)robot_random(robot, 8);
        break;
    case 1:
        robot->mute = true;
        break;
    case 2:
        robot->bumpers_front = (uint8_t)(1u << (1 + robot_random(robot, 5)));
        break;
    case 3:
        robot->stall = true;
        break;
    case 4:
        argus_operator(&robot->argus, now_ms(), (argus_op_t)robot_random(robot, 9), 3);
        break;
    default:
        robot_goal(robot, (int)robot_random(robot, 3000) - 1000, (int)robot_random(robot, 2000) - 1000);
        break;
    }
}

static void mend(void) {
    memset(robot->fault, 0, sizeof robot->fault);
    robot->mute = robot->stall = robot->stuck_wheels = robot->stop_button = false;
    robot->bumpers_front = robot->bumpers_rear = 0;
    argus_link_up(&robot->argus, now_ms());
}

static void check_bytes(const uint8_t *bytes) {
    for (size_t i = 0; i < GUARD_BYTES; i++) {
        TEST_ASSERT_EQUAL_HEX8(0xA5, bytes[i]);
    }
}

static void check(void) {
    snprintf(text, sizeof text, "seed %u, minute %u: %s", SEED, (unsigned)(robot->t_ms / MINUTE_MS),
             robot->violation);
    TEST_ASSERT_TRUE_MESSAGE(robot->violation[0] == '\0', text);
    TEST_ASSERT_EQUAL_MESSAGE(0, argus_invariants_broken(&robot->argus), text);
    TEST_ASSERT_EQUAL_MESSAGE(0, robot->argus.events.lost, text);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(now_ms(), robot->argus.now_ms, text);
    check_bytes(held.before);
    check_bytes(held.after);
}

// A minute: something breaks, and is whole again before it is over, or not.
static void minute(void) {
    robot->commands = robot->events = 0;
    break_something();
    robot_run(robot, 20000);
    if (robot_random(robot, 3) != 0) {
        mend();
    }
    robot_run(robot, 40000);
    check();
}

static void days(uint32_t hours) {
    begin(UINT32_MAX - hours / 2 * HOUR_MS - HOUR_MS / 2); // it wraps in the middle
    for (uint32_t i = 0; i < hours * 60u; i++) {
        minute();
    }
    mend();
    robot->x = robot->y = 0; // somebody carries it to the middle, and says so
    argus_operator(&robot->argus, now_ms(), ARGUS_OP_ACTIVE, 0);
    argus_operator(&robot->argus, now_ms(), ARGUS_OP_GO, 0);
    robot->commands = robot->events = 0;
    robot_run(robot, MINUTE_MS);
    printf("%u h, %u SIPs, %u mm driven, %u failed checksums\n", (unsigned)hours,
           (unsigned)robot->argus.session.sips, (unsigned)robot->argus.knowledge.odometer_mm,
           (unsigned)robot->argus.session.parser.bad_checksums);
    check();
    TEST_ASSERT_TRUE_MESSAGE(argus_session_is_open(&robot->argus.session), text);
    TEST_ASSERT_UINT32_WITHIN_MESSAGE(200, 0, now_ms() - robot->argus.knowledge.sip_ms, text);
}

void test_an_hour_of_faults_over_the_wrap_of_the_clock(void) {
    days(1);
}

void test_three_days_of_faults_over_the_wrap_of_the_clock(void) { // wide
    days(72);
}
