// SPDX-License-Identifier: MIT
// Rule under attack: the turns of a robot are listed once each, in order, as many as there is room for, and
// what each shows is what the sonars that may look see after it.
#include "adjustment/turns.h"

#include <string.h>

#include "robot/table.h"
#include "unity.h"

static argus_own_robot_t own;
static argus_plan_t plan;
static argus_turns_t turns;

// A robot of so many sonars that look ahead, of 16 all around, `step_deg` apart and `bent_deg` more each.
static void build(const int forward, const int step_deg, const int bent_deg) {
    memset(&own, 0, sizeof own);
    memset(&plan, 0, sizeof plan);
    argus_robot_t *const row = &own.rows[0];
    row->poses = (int16_t)((const char *)own.poses - (const char *)row);
    row->sonars = 16;
    row->arrays = 2;
    row->cone_deg = 30;
    row->forward_count = (uint8_t)forward;
    for (int i = 0; i < 16; i++) {
        own.poses[i].heading_deg = (int16_t)(i * step_deg + i * i * bent_deg - 90);
        row->forward[i < forward ? i : 0] = (uint8_t)(i < forward ? i : 0);
    }
    row->forward_mask = (argus_mask_t)((1u << forward) - 1u);
    plan.disabled = row->forward_mask;
    plan.looks = (argus_mask_t)(0xFFFFu & ~(unsigned)row->forward_mask);
    argus_turns_of(&turns, row, &plan);
}

static void is_in_order(void) {
    TEST_ASSERT_LESS_OR_EQUAL(ARGUS_TURNS_MAX, turns.count);
    for (int k = 0; k < turns.count; k++) {
        TEST_ASSERT_NOT_EQUAL(0, turns.deg[k]);
        TEST_ASSERT_TRUE(turns.deg[k] > -180 && turns.deg[k] <= 180);
        TEST_ASSERT_TRUE(k == 0 || turns.deg[k] > turns.deg[k - 1]);
        for (int i = 0; i < turns.blinds; i++) {
            const bool seen = argus_plan_cover(&own.rows[0], &plan, turns.deg[k], turns.blind[i]) >= 0;
            TEST_ASSERT_EQUAL(seen, (turns.sees[k] >> i & 1u) != 0);
        }
    }
}

void test_sonars_at_equal_angles_share_their_turns(void) {
    build(2, 20, 0);
    TEST_ASSERT_EQUAL(15, turns.count); // each multiple of the angle, but 0
    TEST_ASSERT_EQUAL(3, argus_turns_open(&turns));
    is_in_order();
}

// Of a ring at odd angles there are more turns than are listed: none is written beyond the list.
void test_a_ring_of_odd_angles_has_more_turns_than_there_is_room_for(void) {
    build(ARGUS_FORWARD_MAX, 7, 1);
    TEST_ASSERT_EQUAL(ARGUS_TURNS_MAX, turns.count);
    TEST_ASSERT_EQUAL(ARGUS_FORWARD_MAX, turns.blinds);
    is_in_order();
}

void test_where_nothing_is_blind_there_is_no_turn(void) {
    build(4, 20, 0);
    plan.disabled = 0;
    argus_turns_of(&turns, &own.rows[0], &plan);
    TEST_ASSERT_EQUAL(0, turns.count);
    TEST_ASSERT_EQUAL(0, argus_turns_open(&turns));
}
