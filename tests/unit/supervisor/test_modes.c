// SPDX-License-Identifier: MIT
// Rule under attack: a mode or a reflex writes its own state and nothing else, whatever the situation.
#include "supervisor/modes.h"

#include <stdio.h>
#include <string.h>

#include "behaviour/mode.h"
#include "behaviour/reflexes.h"
#include "behaviour/resting.h"
#include "behaviour/travel.h"
#include "robot.h"
#include "unity.h"

#define FEW_WORLDS 8u // all modes are seen in these
#define WORLDS 40u
#define WORLD_MS 60000u
#define LOOK_MS 100u

static robot_t robot;
static argus_t copy;
static char text[96];

static void begin(uint32_t seed) {
    argus_config_t config = robot_config_of(seed % 2 == 0 ? ARGUS_PROFILE_PAPER : ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &config, seed * 2654435761u);
    robot.seed = seed * 2246822519u + 1u;
    robot.noise_mm = 5;
    robot.world = robot_world_segments;
    robot_box(&robot, -1200, -1500, 3500, 1500);
    robot_box(&robot, 1200, -250, 1500, 250);
    if (seed % 4 != 3) { // else it idles
        robot_goal(&robot, 2800, 500);
    }
}

static uint32_t chance(uint32_t one_in) {
    return robot_random(&robot, one_in) == 0;
}

static void disturb(void) {
    if (chance(1000)) {
        robot.fault[robot_random(&robot, 8)] = (robot_fault_t)robot_random(&robot, 5);
    }
    robot.bumpers_front = chance(1500) ? 1u << 3 : robot.bumpers_front & (chance(300) ? 0 : 0xFF);
}

// What lies outside [at, at + size) must be as it was.
static void expect_nothing_else(const void *at, size_t size, const char *who) {
    const size_t from = (size_t)((const uint8_t *)at - (const uint8_t *)&copy);
    snprintf(text, sizeof text, "%s in mode %d, %u ms of a world", who, (int)robot.argus.mode,
             (unsigned)robot.t_ms);
    memcpy((uint8_t *)&copy + from, (const uint8_t *)&robot.argus + from, size);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&robot.argus, &copy, sizeof copy, text);
}

static void try_mode(void) {
    argus_intent_t intent = {0};
    memcpy(&copy, &robot.argus, sizeof copy);
    switch ((int)robot.argus.mode) {
    case ARGUS_MODE_CHECKING:
        argus_run_checking(&copy, &copy.checking, &intent);
        expect_nothing_else(&copy.checking, sizeof copy.checking, "checking");
        break;
    case ARGUS_MODE_VERIFYING:
        argus_run_verifying(&copy, &copy.verifying, &intent);
        expect_nothing_else(&copy.verifying, sizeof copy.verifying, "verifying");
        break;
    case ARGUS_MODE_IDLE:
        argus_run_idle(&copy, &intent);
        expect_nothing_else(&copy, 0, "idle");
        break;
    case ARGUS_MODE_BACKING:
        argus_run_backing(&copy, &intent);
        expect_nothing_else(&copy, 0, "backing");
        break;
    case ARGUS_MODE_WAITING:
        argus_run_waiting(&copy, &copy.waiting, &intent);
        argus_go_on_waiting(&copy, &copy.waiting, &intent);
        expect_nothing_else(&copy.waiting, sizeof copy.waiting, "waiting");
        break;
    case ARGUS_MODE_DRIVING:
        argus_run_driving(&copy, &copy.travel, &intent);
        expect_nothing_else(&copy.travel, sizeof copy.travel, "driving");
        break;
    case ARGUS_MODE_SWEEPING:
        argus_run_sweeping(&copy, &copy.travel, &intent);
        expect_nothing_else(&copy.travel, sizeof copy.travel, "sweeping");
        break;
    case ARGUS_MODE_STEPPING:
        argus_run_stepping(&copy, &copy.travel, &intent);
        expect_nothing_else(&copy.travel, sizeof copy.travel, "stepping");
        break;
    case ARGUS_MODE_CREEPING:
        argus_run_creeping(&copy, &copy.travel, &intent);
        expect_nothing_else(&copy.travel, sizeof copy.travel, "creeping");
        break;
    default:
        break;
    }
}

static void try_all_reflexes(void) {
    const argus_alarm_t alarm = {.dead = 1u << 3,
                                 .silent = 1u << 4,
                                 .object = 1u << 2,
                                 .object_sonar = 2,
                                 .object_mm = 200,
                                 .stall = true};
    memcpy(&copy, &robot.argus, sizeof copy);
    for (int i = 0; i < ARGUS_REFLEXES; i++) {
        argus_reflex((argus_reflex_t)i, &copy, &alarm, &copy.reflexes, &(argus_intent_t){0});
        expect_nothing_else(&copy.reflexes, sizeof copy.reflexes, "reflex");
    }
}

static unsigned try_worlds(uint32_t from, uint32_t to) {
    unsigned seen = 0;
    for (uint32_t seed = from; seed <= to; seed++) {
        begin(seed);
        for (uint32_t at = 0; at < WORLD_MS; at += 10) {
            disturb();
            robot_tick(&robot);
            if (at % LOOK_MS == 0) {
                seen |= 1u << robot.argus.mode;
                try_mode();
                try_all_reflexes();
            }
        }
    }
    return seen;
}

void test_a_mode_writes_its_own_state_alone(void) {
    const unsigned seen = try_worlds(1, FEW_WORLDS);
    for (int mode = ARGUS_MODE_CHECKING; mode <= ARGUS_MODE_WAITING; mode++) {
        snprintf(text, sizeof text, "mode %d was never looked at", mode);
        TEST_ASSERT_TRUE_MESSAGE((seen >> mode & 1u) != 0, text);
    }
}

void test_a_mode_writes_its_own_state_alone_in_many_worlds(void) { // soak
    TEST_ASSERT_NOT_EQUAL(0, try_worlds(FEW_WORLDS + 1, WORLDS));
}

// The order is that of the table: a contact comes before all else, and ends what is asked in its SIP.
void test_a_bumper_comes_first(void) {
    argus_alarm_t alarm = {.dead = 1u << 3, .object_sonar = -1, .bumper = true};
    begin(1);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
    robot_run(&robot, 1000); // what comes to a robot that stands is no place
    robot.argus.knowledge.bumpers_front = 1u << 2;
    argus_intent_t intent = {0};
    argus_reflex(ARGUS_REFLEX_bumper, &robot.argus, &alarm, &robot.argus.reflexes, &intent);
    TEST_ASSERT_EQUAL(ARGUS_DO_WAIT, intent.act);
    TEST_ASSERT_EQUAL(ARGUS_STOP_E_STOP, intent.stop);
    TEST_ASSERT_TRUE(intent.unchecked && intent.met == ARGUS_CONTACT_BUMPER);
    TEST_ASSERT_TRUE(argus_reflex_is_last(ARGUS_REFLEX_bumper));
    TEST_ASSERT_EQUAL(0, ARGUS_REFLEX_bumper);
    argus_intent_t again = {0};
    argus_reflex(ARGUS_REFLEX_bumper, &robot.argus, &alarm, &robot.argus.reflexes, &again);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, again.act); // answered already
}

// Nothing becomes of nothing.
void test_the_empty_intent_does_nothing(void) {
    begin(2);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
    memcpy(&copy, &robot.argus, sizeof copy);
    argus_do(&copy, &(argus_intent_t){0});
    TEST_ASSERT_EQUAL_MEMORY(&robot.argus, &copy, sizeof copy);
}

// S7 is asked of a turn when it is carried out: the mode need not know.
void test_a_turn_that_s7_forbids_is_not_commanded(void) {
    begin(2);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 20000));
    memcpy(&copy, &robot.argus, sizeof copy);
    copy.knowledge.sonar[0].reading_mm = 200;
    argus_do(&copy, &(argus_intent_t){.act = ARGUS_DO_TURN, .cdeg = 9000});
    TEST_ASSERT_NOT_EQUAL(ARGUS_MOTION_TURN, copy.motion.kind);
    TEST_ASSERT_TRUE(copy.mode == ARGUS_MODE_BACKING || copy.mode == ARGUS_MODE_WAITING);
}

void test_s1_a_plan_that_changes_under_a_sweep_begins_it_anew(void) {
    begin(2); // under `paper` a reading of 5000 is dead
    robot.world = robot_world_far;
    robot.fault[3] = ROBOT_OFF;
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_SWEEPING, 30000));
    for (int i = 0; i < 1000 && !(robot.argus.base.taken && robot.argus.motion.settled); i++) {
        robot_tick(&robot);
    }
    memcpy(&copy, &robot.argus, sizeof copy);
    copy.plan = argus_plan(copy.knowledge.robot, ARGUS_POLICY_PAPER, 1u << 2 | 1u << 3, 0);
    copy.travel.drive.index = 1;
    argus_intent_t intent = {0};
    argus_run_sweeping(&copy, &copy.travel, &intent);
    TEST_ASSERT_EQUAL(ARGUS_DO_TURN, intent.act);
    TEST_ASSERT_EQUAL(copy.base.cdeg + copy.plan.rotation_deg[0] * 100, intent.cdeg);
    TEST_ASSERT_EQUAL(0, copy.travel.drive.index);
    TEST_ASSERT_EQUAL_HEX16(copy.plan.disabled, copy.travel.drive.covers);
}
