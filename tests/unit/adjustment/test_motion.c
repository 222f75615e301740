// SPDX-License-Identifier: MIT
// Rule under attack: settled means two SIPs in a row at rest (a turn: within 1 degree), and readings of later
// SIPs only.
#include "adjustment/motion.h"

#include <string.h>

#include "unity.h"

static argus_motion_t m;
static argus_outbox_t out;
static argus_knowledge_t k;
static argus_sip_t sip;
static uint32_t now_ms;

void setUp(void) {
    argus_motion_init(&m);
    memset(&out, 0, sizeof out);
    argus_knowledge_init(&k);
    memset(&sip, 0, sizeof sip);
    now_ms = 0xFFFFFF00u;
    argus_knowledge_sip(&k, &sip, 1000, now_ms);
}

static void take(int heading_raw, int speed) {
    now_ms += 100;
    sip.heading_raw = (int16_t)heading_raw;
    sip.vel_left_mm_s = (int16_t)-speed;
    sip.vel_right_mm_s = (int16_t)speed;
    argus_knowledge_sip(&k, &sip, 1000, now_ms);
    if (argus_motion_sip(&m, &k, now_ms)) {
        argus_motion_again(&m, &out, &k, true, now_ms);
    }
}

static int32_t next(uint8_t command) {
    uint8_t packet[ARGUS_FRAME_TOTAL_MAX];
    TEST_ASSERT_TRUE(argus_outbox_fetch(&out, packet, sizeof packet) > 0);
    TEST_ASSERT_EQUAL(command, packet[3]);
    const int32_t value = packet[5] | packet[6] << 8;
    return packet[4] == 0x1B ? -value : value;
}

void test_a_turn_settles_after_two_sips_at_rest_on_target(void) {
    argus_motion_turn(&m, &out, &k, 2000, now_ms);
    TEST_ASSERT_EQUAL(20, next(ARCOS_CMD_HEAD));
    take(100, 260);
    take(228, 6); // 20.04 degrees, but not at rest
    TEST_ASSERT_FALSE(m.settled);
    take(228, 5);
    TEST_ASSERT_FALSE(m.settled);
    take(228, 6);
    take(228, 0);
    TEST_ASSERT_FALSE(m.settled);
    take(228, 0);
    TEST_ASSERT_TRUE(m.settled);
    TEST_ASSERT_EQUAL(k.sips, m.mark.sip);
}

void test_a_turn_beside_its_target_is_not_settled(void) {
    argus_motion_turn(&m, &out, &k, 2000, now_ms);
    take(107, 300);
    take(214, 0); // 18.8 degrees
    take(214, 0);
    take(214, 0);
    TEST_ASSERT_FALSE(m.settled);
    take(217, 0); // 19.07
    take(217, 0);
    TEST_ASSERT_TRUE(m.settled);
}

void test_a_turn_that_does_not_come_about_is_repeated_three_times_and_fails(void) {
    argus_motion_turn(&m, &out, &k, 9000, now_ms);
    int heads = 0;
    for (int i = 0; i < 100; i++) {
        uint8_t packet[32];
        while (argus_outbox_fetch(&out, packet, sizeof packet) > 0) {
            heads += packet[3] == ARCOS_CMD_HEAD;
        }
        take(0, 0);
    }
    TEST_ASSERT_TRUE(m.failed);
    TEST_ASSERT_FALSE(m.settled);
    TEST_ASSERT_EQUAL(3, heads);
}

void test_headings_go_out_in_whole_degrees_of_the_robots_own_frame(void) {
    k.heading_offset_cdeg = 1234;
    for (int32_t heading = -18000; heading <= 18000; heading += 77) {
        argus_motion_turn(&m, &out, &k, heading, now_ms);
        const int32_t degrees = next(ARCOS_CMD_HEAD);
        TEST_ASSERT_TRUE(degrees >= -180 && degrees <= 180);
        const int32_t off = ((degrees * 100 + 1234 - heading) % 36000 + 54000) % 36000 - 18000;
        TEST_ASSERT_INT32_WITHIN(50, 0, off);
        TEST_ASSERT_INT32_WITHIN(50, 0, ((m.target_cdeg - heading) % 36000 + 54000) % 36000 - 18000);
    }
}

void test_with_the_rear_ahead_moves_and_headings_go_out_for_the_robot_as_it_is_built(void) {
    argus_knowledge_turn_about(&k, argus_robot_other_end(k.robot));
    argus_motion_move(&m, &out, &k, 150, 100, now_ms);
    TEST_ASSERT_EQUAL(100, next(ARCOS_CMD_SETV));
    TEST_ASSERT_EQUAL(-150, next(ARCOS_CMD_MOVE));
    argus_motion_move(&m, &out, &k, -90, 100, now_ms);
    TEST_ASSERT_EQUAL(90, next(ARCOS_CMD_MOVE));
    argus_motion_steer(&out, &k, -17000);
    TEST_ASSERT_EQUAL(10, next(ARCOS_CMD_HEAD));
    argus_motion_turn(&m, &out, &k, -16000, now_ms);
    TEST_ASSERT_EQUAL(20, next(ARCOS_CMD_HEAD));
    take(100, 260);
    take(228, 5);
    TEST_ASSERT_FALSE(m.settled);
    take(228, 0);
    TEST_ASSERT_TRUE(m.settled);
}

void test_a_move_is_given_time_to_begin(void) {
    argus_motion_move(&m, &out, &k, 150, 100, now_ms);
    take(0, 0);
    take(0, 0);
    take(0, 0);
    TEST_ASSERT_FALSE(m.settled);
    take(0, 50);
    take(0, 50);
    take(0, 50);
    TEST_ASSERT_FALSE(m.settled);
    take(0, 0);
    take(0, 0);
    TEST_ASSERT_TRUE(m.settled);
}

void test_the_speed_goes_before_the_move_when_it_differs(void) {
    argus_motion_move(&m, &out, &k, 150, 100, now_ms);
    TEST_ASSERT_EQUAL(100, next(ARCOS_CMD_SETV));
    TEST_ASSERT_EQUAL(150, next(ARCOS_CMD_MOVE));
    argus_motion_move(&m, &out, &k, -90, 100, now_ms);
    TEST_ASSERT_EQUAL(-90, next(ARCOS_CMD_MOVE));
    argus_motion_move(&m, &out, &k, 90, 200, now_ms);
    TEST_ASSERT_EQUAL(200, next(ARCOS_CMD_SETV));
    TEST_ASSERT_EQUAL(90, next(ARCOS_CMD_MOVE));
}

// Rolling at that speed, so far; returns what has gone out.
static int renewed(int32_t distance_mm, int32_t speed_mm_s, int driven_mm) {
    uint8_t packet[ARGUS_FRAME_TOTAL_MAX];
    int moves = 0;
    sip.x_raw = (uint16_t)(sip.x_raw + driven_mm);
    sip.vel_left_mm_s = sip.vel_right_mm_s = (int16_t)speed_mm_s;
    now_ms += 100;
    argus_knowledge_sip(&k, &sip, 1000, now_ms);
    argus_motion_sip(&m, &k, now_ms);
    argus_motion_move(&m, &out, &k, distance_mm, speed_mm_s, now_ms);
    while (argus_outbox_fetch(&out, packet, sizeof packet) > 0) {
        moves += packet[3] == ARCOS_CMD_MOVE;
    }
    return moves;
}

// It counts from where the robot is when it comes, so that it ends farther on if it comes late.
void test_a_move_that_ends_where_the_one_at_work_ends_is_not_sent_again(void) {
    TEST_ASSERT_EQUAL(1, renewed(600, 200, 0));
    for (int left_mm = 580; left_mm > 0; left_mm -= 20) {
        TEST_ASSERT_EQUAL(0, renewed(left_mm + left_mm % 3 * 9, 200, 20));
        TEST_ASSERT_EQUAL(left_mm, m.target_mm);
        TEST_ASSERT_FALSE(m.settled);
    }
}

void test_a_move_that_ends_before_the_one_at_work_is_sent_at_once(void) {
    TEST_ASSERT_EQUAL(1, renewed(5000, 200, 0));
    TEST_ASSERT_EQUAL(1, renewed(4974, 200, 20));
    TEST_ASSERT_EQUAL(0, renewed(4950, 200, 20));
    TEST_ASSERT_EQUAL(1, renewed(300, 200, 20));
}

void test_a_move_that_goes_farther_is_sent_before_the_robot_brakes(void) {
    TEST_ASSERT_EQUAL(1, renewed(1000, 200, 0));
    const int brakes_mm = 200 * 200 / (2 * k.robot->decel_mm_s2);
    int left_mm = 1000;
    while (renewed(1000, 200, 20) == 0) {
        left_mm -= 20;
        TEST_ASSERT_TRUE(left_mm > brakes_mm + 100);
    }
    TEST_ASSERT_TRUE(left_mm < brakes_mm + 200);
    TEST_ASSERT_EQUAL(1000, m.target_mm);
}

void test_a_robot_at_rest_is_sent_its_move_again(void) {
    TEST_ASSERT_EQUAL(1, renewed(500, 200, 0));
    sip.vel_left_mm_s = sip.vel_right_mm_s = 0;
    argus_knowledge_sip(&k, &sip, 1000, now_ms);
    argus_motion_move(&m, &out, &k, 500, 200, now_ms);
    TEST_ASSERT_EQUAL(500, next(ARCOS_CMD_MOVE));
}

void test_another_speed_sends_the_move_again(void) {
    TEST_ASSERT_EQUAL(1, renewed(500, 200, 0));
    TEST_ASSERT_EQUAL(1, renewed(480, 175, 20));
}

// A queue that is full takes none, and the next SIP sends it.
void test_a_move_that_did_not_go_out_is_not_at_work(void) {
    while (argus_outbox_int(&out, ARCOS_CMD_ADSEL, 0)) {
    }
    argus_motion_move(&m, &out, &k, 500, 0x7FFF, now_ms);
    memset(&out, 0, sizeof out);
    TEST_ASSERT_EQUAL(1, renewed(500, 0x7FFF, 0));
}

void test_a_move_after_a_stop_is_sent(void) {
    TEST_ASSERT_EQUAL(1, renewed(500, 200, 0));
    argus_motion_stop(&m, &out, now_ms);
    TEST_ASSERT_EQUAL(1, renewed(480, 200, 20));
}

void test_a_stop_overtakes_and_drops_motions(void) {
    argus_motion_move(&m, &out, &k, 1000, 200, now_ms);
    argus_motion_stop(&m, &out, now_ms);
    uint8_t packet[32];
    TEST_ASSERT_EQUAL(6, argus_outbox_fetch(&out, packet, sizeof packet));
    TEST_ASSERT_EQUAL(ARCOS_CMD_STOP, packet[3]);
    while (argus_outbox_fetch(&out, packet, sizeof packet) > 0) {
        TEST_ASSERT_TRUE(packet[3] != ARCOS_CMD_MOVE);
    }
    take(0, 100);
    take(0, 0);
    TEST_ASSERT_FALSE(m.settled);
    take(0, 0);
    TEST_ASSERT_TRUE(m.settled);
}

void test_a_hold_commands_nothing(void) {
    argus_motion_hold(&m, now_ms);
    take(0, 0);
    take(0, 0);
    TEST_ASSERT_TRUE(m.settled);
    TEST_ASSERT_EQUAL(0, out.length);
}

// From 400 ms on a robot that stands has stopped, not failed to begin.
void test_a_move_may_be_over_after_400_ms(void) {
    argus_motion_move(&m, &out, &k, 150, 100, now_ms);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_FALSE(m.settled);
        take(0, 0);
    }
    take(0, 0); // the second of them that counts
    TEST_ASSERT_TRUE(m.settled);
}

void test_a_turn_that_may_not_be_tried_again_has_failed(void) {
    argus_motion_turn(&m, &out, &k, 2000, now_ms);
    m.tries = 1;
    argus_motion_again(&m, &out, &k, false, now_ms);
    TEST_ASSERT_TRUE(m.failed);
}
