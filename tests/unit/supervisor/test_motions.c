// SPDX-License-Identifier: MIT
// Rule under attack: what moves the wheels goes out where it may, and where it may not nothing does; never
// faster than the robot lets it.
#include "supervisor/motions.h"

#include <string.h>

#include "robot.h"
#include "unity.h"

static robot_t robot;
static argus_t *core;
static argus_outbox_t out;
static argus_bend_t bend;

void setUp(void) {
    const argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &config, 1000);
    robot.world = robot_world_segments;
    robot_box(&robot, -3000, -3000, 3000, 3000);
    robot_run(&robot, 6000);
    core = &robot.argus;
    out = (argus_outbox_t){0};
    bend = (argus_bend_t){0};
}

// The number of the command that waits and its argument; -1: none.
static int next(int32_t *const value) {
    uint8_t packet[ARGUS_PACKET_MAX];
    if (argus_outbox_fetch(&out, packet, sizeof packet) == 0) {
        return -1;
    }
    *value = packet[5] | packet[6] << 8;
    *value = packet[4] == ARCOS_ARG_NEGATIVE ? -*value : *value;
    return packet[3];
}

void test_a_move_is_no_faster_than_the_robot_lets_it(void) {
    static const struct {
        bool has_robot;
        uint16_t top_mm_s;
        int32_t speed_mm_s, sent_mm_s;
    } rows[] = {{true, 150, 200, 150},
                {true, 200, 150, 150},
                {true, 0, 180, 180},
                {false, 100, 180, 180},
                {true, 1, 180, 1}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        int32_t value = 0;
        setUp();
        core->session.has_robot = rows[i].has_robot;
        core->session.robot.vel_max_mm_s = rows[i].top_mm_s;
        TEST_ASSERT_TRUE(argus_move(core, &core->motion, &out, 300, rows[i].speed_mm_s));
        TEST_ASSERT_EQUAL(ARCOS_CMD_SETV, next(&value));
        TEST_ASSERT_EQUAL(rows[i].sent_mm_s, value);
        TEST_ASSERT_EQUAL(ARCOS_CMD_MOVE, next(&value));
        TEST_ASSERT_EQUAL(300, value);
    }
}

// A bumper ahead bars the way there, not the way back; and the other way round.
void test_a_way_is_asked_for_in_its_direction(void) {
    static const struct {
        uint8_t front, rear;
        int32_t mm;
        bool may;
    } rows[] = {{0, 0, 100, true},  {0, 0, -100, true},  {2, 0, 100, false},
                {2, 0, -100, true}, {0, 2, -100, false}, {0, 2, 100, true}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        int32_t value = 0;
        setUp();
        core->knowledge.bumpers_front = rows[i].front;
        core->knowledge.bumpers_rear = rows[i].rear;
        TEST_ASSERT_EQUAL(rows[i].may, argus_move(core, &core->motion, &out, rows[i].mm, 100));
        TEST_ASSERT_EQUAL(rows[i].may, next(&value) >= 0);
    }
}

static void bar(void) {
    core->session.state = ARGUS_SESSION_LISTEN; // there is no session: nothing may be ordered
}

void test_what_may_not_be_done_is_not_sent(void) {
    int32_t value = 0;
    for (int barred = 0; barred < 2; barred++) {
        setUp();
        if (barred != 0) {
            bar();
        }
        argus_steer(core, &bend, &out, 500);
        TEST_ASSERT_EQUAL(barred == 0, next(&value) >= 0);
        out = (argus_outbox_t){0};
        TEST_ASSERT_EQUAL(barred == 0, argus_turn_to(core, &core->motion, &bend, &out, 3000));
        TEST_ASSERT_EQUAL(barred == 0, next(&value) >= 0);
        out = (argus_outbox_t){0};
        argus_enable_motors(core, &out);
        TEST_ASSERT_EQUAL(barred == 0 ? ARCOS_CMD_ENABLE : -1, next(&value));
        TEST_ASSERT_EQUAL(barred == 0 ? 1 : 0, barred == 0 ? value : 0);
    }
}

void test_it_is_to_halt_while_it_rolls_or_is_under_way(void) {
    TEST_ASSERT_FALSE(argus_is_to_halt(core));
    core->knowledge.still_sips = 1; // one SIP at rest may be the end of a turn
    TEST_ASSERT_TRUE(argus_is_to_halt(core));
    setUp();
    TEST_ASSERT_TRUE(argus_move(core, &core->motion, &out, 300, 100));
    TEST_ASSERT_TRUE(argus_is_to_halt(core));
}

// The bend of a way is judged since the heading that was ordered last.
void test_a_heading_on_the_way_is_noted_for_the_bend(void) {
    static const argus_bend_t none;
    argus_steer(core, &bend, &out, 500);
    TEST_ASSERT_NOT_EQUAL(0, memcmp(&none, &bend, sizeof bend));
    TEST_ASSERT_GREATER_THAN(0, out.length);
}
