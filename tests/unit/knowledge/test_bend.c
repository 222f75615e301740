// SPDX-License-Identifier: MIT
// Rule under attack: a piece of way tells how far the heading turned on it where nobody ordered a turn; what
// was ordered, a push, a leap and a crawl tell nothing.
#include "knowledge/bend.h"

#include "knowledge/angle.h"
#include "unity.h"
#include <string.h>

#define SIP_MS 100u

static argus_bend_t bend;
static argus_knowledge_t k;
static argus_way_turn_t piece;
static int pieces;

void setUp(void) {
    memset(&bend, 0, sizeof bend);
    argus_knowledge_init(&k);
    k.sip_ms = 10000;
    k.vel_left_mm_s = k.vel_right_mm_s = 200;
    pieces = 0;
}

// So many SIPs of 20 mm on which the heading turns by so much each.
static void drive(int sips, int32_t turn_cdeg) {
    for (int i = 0; i < sips; i++) {
        k.sip_ms += SIP_MS;
        k.odometer_mm += 20;
        k.pose.heading_cdeg = argus_angle_wrap(k.pose.heading_cdeg + turn_cdeg);
        pieces += argus_bend_sip(&bend, &k, true, &piece) ? 1 : 0;
    }
}

void test_a_bent_way_is_told_once_it_is_bent_enough(void) {
    drive(1 + 6, 10);
    TEST_ASSERT_EQUAL_INT(1, pieces);
    TEST_ASSERT_EQUAL_INT32(120, piece.way_mm);
    TEST_ASSERT_EQUAL_INT32(60, piece.turn_cdeg);
}

void test_to_the_right_and_across_the_seam(void) {
    k.pose.heading_cdeg = -17990;
    drive(1 + 6, -10);
    TEST_ASSERT_EQUAL_INT(1, pieces);
    TEST_ASSERT_EQUAL_INT32(-60, piece.turn_cdeg);
}

void test_a_straight_way_is_told_after_a_metre(void) {
    drive(1 + 49, 0);
    TEST_ASSERT_EQUAL_INT(0, pieces);
    drive(1, 0);
    TEST_ASSERT_EQUAL_INT(1, pieces);
    TEST_ASSERT_EQUAL_INT32(1000, piece.way_mm);
    TEST_ASSERT_EQUAL_INT32(0, piece.turn_cdeg);
}

void test_an_order_to_turn_ends_the_piece_and_is_waited_for(void) {
    drive(4, 10);
    argus_bend_ordered(&bend, k.pose.heading_cdeg + 3000, k.sip_ms);
    drive(28, 100); // slow as the vendor's emulator: still a degree and more from there
    TEST_ASSERT_EQUAL_INT(0, pieces);
    drive(1, 100);
    TEST_ASSERT_EQUAL_INT(0, pieces);
    drive(1 + 6, 10);
    TEST_ASSERT_EQUAL_INT(1, pieces);
    TEST_ASSERT_EQUAL_INT32(60, piece.turn_cdeg);
}

void test_a_short_order_is_given_time_to_show(void) {
    argus_bend_ordered(&bend, k.pose.heading_cdeg + 90, k.sip_ms);
    drive(4, 22);
    drive(1 + 5, 0);
    TEST_ASSERT_EQUAL_INT(0, pieces);
}

// At once by more than a piece bends: it spoils the piece that it falls into, and no other.
void test_a_push_is_one_piece_at_most(void) {
    drive(1, 0);
    drive(1, 300);
    TEST_ASSERT_EQUAL_INT(0, pieces);
    drive(1, 0);
    TEST_ASSERT_EQUAL_INT(1, pieces);
    TEST_ASSERT_EQUAL_INT32(40, piece.way_mm);
    drive(49, 0);
    TEST_ASSERT_EQUAL_INT(1, pieces);
}

// The robot is steered back once it is off by two degrees: two pieces must fit in before, at whatever phase.
void test_a_tenth_short_is_two_pieces_before_it_is_steered_back(void) {
    for (int32_t first = 0; first < 36; first += 4) {
        setUp();
        drive(1, 0);
        drive(1, first);
        const int32_t begun_cdeg = k.pose.heading_cdeg - first;
        while (pieces < 2) {
            drive(1, 36);
        }
        TEST_ASSERT_LESS_THAN_INT32(200, k.pose.heading_cdeg - begun_cdeg);
        TEST_ASSERT_GREATER_OR_EQUAL_INT32(40, piece.way_mm);
    }
}

void test_what_tells_nothing(void) {
    drive(3, 10);
    k.leapt = true;
    drive(1, 10);
    k.leapt = false;
    drive(6, 10);
    TEST_ASSERT_EQUAL_INT(0, pieces);
    k.bumpers_front = 4;
    drive(10, 10);
    k.bumpers_front = 0;
    k.vel_left_mm_s = 40;
    drive(10, 10);
    k.vel_left_mm_s = 200;
    TEST_ASSERT_EQUAL_INT(0, pieces);
    for (int i = 0; i < 20; i++) { // no MOVE at work
        k.sip_ms += SIP_MS;
        k.odometer_mm += 20;
        k.pose.heading_cdeg += 10;
        pieces += argus_bend_sip(&bend, &k, false, &piece) ? 1 : 0;
    }
    TEST_ASSERT_EQUAL_INT(0, pieces);
}

// 500 ms after the order it has shown; the piece begins with that SIP.
void test_a_piece_begins_half_a_second_after_the_order(void) {
    argus_bend_ordered(&bend, k.pose.heading_cdeg, k.sip_ms);
    drive(5 + 6, 10);
    TEST_ASSERT_EQUAL_INT(1, pieces);
    TEST_ASSERT_EQUAL_INT32(120, piece.way_mm);
}

void test_one_slow_wheel_is_a_turn_and_no_bend(void) {
    k.vel_right_mm_s = 49;
    drive(20, 10);
    TEST_ASSERT_EQUAL_INT(0, pieces);
    k.vel_right_mm_s = 50;
    drive(1 + 6, 10);
    TEST_ASSERT_EQUAL_INT(1, pieces);
}

void test_a_hit_from_behind_is_no_bend(void) {
    k.bumpers_rear = 2;
    drive(20, 10);
    TEST_ASSERT_EQUAL_INT(0, pieces);
}
