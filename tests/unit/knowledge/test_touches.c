// SPDX-License-Identifier: MIT
// Rule under attack: no second hit at a place: where the body met something stays known, whichever end met
// it.
#include "knowledge/touches.h"

#include <stdlib.h>

#include "unity.h"

#define FRONT_MM (k.robot->front_mm)
#define REAR_MM (k.robot->rear_mm)

static argus_touches_t t;
static argus_knowledge_t k;

void setUp(void) {
    argus_touches_init(&t);
    argus_knowledge_init(&k);
}

void test_nothing_was_touched(void) {
    TEST_ASSERT_EQUAL(INT32_MAX, argus_touches_before_mm(&t, &k, 1));
    TEST_ASSERT_EQUAL(INT32_MAX, argus_touches_before_mm(&t, &k, -1));
    TEST_ASSERT_EQUAL(INT32_MAX, argus_touches_nearest_mm(&t, &k, 0));
}

void test_what_is_ahead_is_not_behind(void) {
    argus_touches_end(&t, &k, 1);
    TEST_ASSERT_EQUAL(0, argus_touches_before_mm(&t, &k, 1));
    TEST_ASSERT_EQUAL(INT32_MAX, argus_touches_before_mm(&t, &k, -1));
    k.pose.x_mm -= 150;
    TEST_ASSERT_EQUAL(150, argus_touches_before_mm(&t, &k, 1));
    k.pose.heading_cdeg = 18000;
    TEST_ASSERT_EQUAL(FRONT_MM + 150 - REAR_MM, argus_touches_before_mm(&t, &k, -1));
    TEST_ASSERT_EQUAL(INT32_MAX, argus_touches_before_mm(&t, &k, 1));
}

void test_what_was_met_backing_is_behind(void) {
    argus_touches_end(&t, &k, -1);
    TEST_ASSERT_EQUAL(0, argus_touches_before_mm(&t, &k, -1));
    TEST_ASSERT_EQUAL(INT32_MAX, argus_touches_before_mm(&t, &k, 1));
}

void test_segments_tell_the_side(void) {
    for (int segment = 1; segment <= k.robot->front_bumpers; segment++) {
        setUp();
        k.bumpers_front = (uint8_t)(1u << segment);
        argus_touches_bumped(&t, &k);
        TEST_ASSERT_EQUAL(1, t.count);
        TEST_ASSERT_EQUAL(segment < 3 ? 1 : (segment > 3 ? -1 : 0),
                          (t.at[0].y_mm > 20) - (t.at[0].y_mm < -20));
    }
}

void test_a_turn_ends_beside_the_body(void) {
    argus_touches_sides(&t, &k);
    TEST_ASSERT_EQUAL(INT32_MAX, argus_touches_before_mm(&t, &k, 1));
    TEST_ASSERT_EQUAL(INT32_MAX, argus_touches_before_mm(&t, &k, -1));
    TEST_ASSERT_TRUE(argus_touches_nearest_mm(&t, &k, 0) < k.robot->swing_radius_mm);
}

void test_the_same_place_takes_no_more_room(void) {
    for (int i = 0; i < 100; i++) {
        k.pose.x_mm = i % 3;
        argus_touches_end(&t, &k, 1);
    }
    TEST_ASSERT_EQUAL(3, t.count);
}

// Where there are more than fit, those near by are kept.
void test_the_farthest_is_forgotten(void) {
    for (int i = 0; i < 3 * ARGUS_TOUCHES_MAX; i++) {
        argus_touches_add(&t, (argus_point_t){1000 * i, 0});
        TEST_ASSERT_TRUE(t.count <= ARGUS_TOUCHES_MAX);
        k.pose.x_mm = 1000 * i;
        TEST_ASSERT_EQUAL(0, argus_touches_nearest_mm(&t, &k, 0));
    }
    for (int i = 0; i < t.count; i++) {
        TEST_ASSERT_TRUE(t.at[i].x_mm >= 1000 * ARGUS_TOUCHES_MAX);
    }
}

void test_far_away_nothing_overflows(void) {
    argus_touches_add(&t, (argus_point_t){INT32_MAX / 2, INT32_MIN / 2});
    k.pose.x_mm = INT32_MIN / 4;
    TEST_ASSERT_TRUE(argus_touches_nearest_mm(&t, &k, 0) > 30000);
    argus_touches_add(&t, (argus_point_t){INT32_MIN / 4, 0});
    TEST_ASSERT_EQUAL(2, t.count);
}

// Evenly across the bow: each segment's middle.
void test_segments_lie_side_by_side_across_the_body(void) {
    const int segments = k.robot->front_bumpers;
    const int wide_mm = k.robot->width_mm / segments;
    for (int segment = 1; segment <= segments; segment++) {
        setUp();
        k.bumpers_front = (uint8_t)(1u << segment);
        argus_touches_bumped(&t, &k);
        TEST_ASSERT_INT_WITHIN(1, FRONT_MM, t.at[0].x_mm);
        TEST_ASSERT_INT_WITHIN(1, (segments + 1 - 2 * segment) * wide_mm / 2, t.at[0].y_mm);
    }
}

static int left_after(int sign, int by_mm) {
    setUp();
    argus_touches_end(&t, &k, sign);
    k.pose.x_mm += by_mm;
    argus_touches_leave(&t, &k);
    return t.count;
}

// Somebody has let go of an end: what lies within 60 mm of it was that one, what lies farther off was not.
void test_what_let_go_is_forgotten_at_either_end_and_nothing_else(void) {
    TEST_ASSERT_EQUAL(0, left_after(1, 0));
    TEST_ASSERT_EQUAL(0, left_after(1, -59));
    TEST_ASSERT_EQUAL(3, left_after(1, -61));
    TEST_ASSERT_EQUAL(0, left_after(-1, 0));
    TEST_ASSERT_EQUAL(0, left_after(-1, 59));
    TEST_ASSERT_EQUAL(3, left_after(-1, 61));
}
