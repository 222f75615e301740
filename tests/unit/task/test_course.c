// SPDX-License-Identifier: MIT
// Rule under attack: waypoints pass in order, the goal only within its own radius, and a bad course changes
// nothing.
#include "task/task.h"

#include <string.h>

#include "knowledge/config.h"
#include "unity.h"

static argus_task_t t;
static argus_knowledge_t k;
static argus_echoes_t echoes;
static argus_config_t config;
static int passed;

void setUp(void) {
    memset(&t, 0, sizeof t);
    argus_knowledge_init(&k);
    argus_echoes_init(&echoes);
    argus_config_default(&config);
    argus_config_follow(&config, argus_config_follows(&config), argus_robot_default());
}

static bool at(int x, int y) {
    k.pose.x_mm = x;
    k.pose.y_mm = y;
    return argus_task_progress(&t, &k, &config, &passed);
}

void test_courses_that_do_not_fit(void) {
    argus_point_t many[ARGUS_WAYPOINTS_MAX + 1] = {{0, 0}};
    const argus_point_t good[] = {{1000, 0}, {30000, -30000}};
    TEST_ASSERT_TRUE(argus_task_set(&t, good, 2));
    const argus_task_t before = t;
    TEST_ASSERT_FALSE(argus_task_set(&t, many, 0));
    TEST_ASSERT_FALSE(argus_task_set(&t, many, ARGUS_WAYPOINTS_MAX + 1));
    TEST_ASSERT_FALSE(argus_task_set(&t, many, UINT16_MAX));
    static const int32_t far[] = {30001, -30001, INT32_MAX, INT32_MIN + 1, INT32_MIN};
    for (int i = 0; i < 5; i++) {
        const argus_point_t bad[] = {{0, 0}, {far[i], 0}};
        const argus_point_t worse[] = {{0, far[i]}, {0, 0}};
        TEST_ASSERT_FALSE(argus_task_set(&t, bad, 2));
        TEST_ASSERT_FALSE(argus_task_set(&t, worse, 2));
    }
    TEST_ASSERT_EQUAL_MEMORY(&before, &t, sizeof t);
    TEST_ASSERT_TRUE(argus_task_set(&t, many, ARGUS_WAYPOINTS_MAX));
}

void test_waypoints_in_order(void) {
    const argus_point_t course[] = {{1000, 0}, {1000, 1000}, {2000, 1000}};
    TEST_ASSERT_TRUE(argus_task_set(&t, course, 3));
    TEST_ASSERT_FALSE(at(2000, 1000)); // the goal, but not yet its turn
    TEST_ASSERT_EQUAL(0, passed);
    TEST_ASSERT_FALSE(at(899, 0));
    TEST_ASSERT_EQUAL(0, passed);
    TEST_ASSERT_FALSE(at(900, 0));
    TEST_ASSERT_EQUAL(1, passed);
    TEST_ASSERT_FALSE(at(1000, 950));
    TEST_ASSERT_EQUAL(1, passed);
    TEST_ASSERT_FALSE(at(1939, 1000)); // the goal has a radius of its own
    TEST_ASSERT_TRUE(at(1940, 1000));
    TEST_ASSERT_TRUE(at(1940, 1000));
    TEST_ASSERT_EQUAL(0, passed);
    TEST_ASSERT_EQUAL(60, argus_task_goal_mm(&t, &k));
}

void test_several_waypoints_at_once(void) {
    const argus_point_t course[] = {{50, 0}, {60, 10}, {20, 20}};
    TEST_ASSERT_TRUE(argus_task_set(&t, course, 3));
    TEST_ASSERT_TRUE(at(0, 0));
    TEST_ASSERT_EQUAL(3, passed);
}

// Something stands before a waypoint: it is passed within 200 mm, the goal is not.
void test_a_waypoint_that_is_refused_is_passed_from_farther(void) {
    const argus_point_t course[] = {{1000, 0}, {2000, 0}};
    TEST_ASSERT_TRUE(argus_task_set(&t, course, 2));
    TEST_ASSERT_FALSE(at(810, 0));
    TEST_ASSERT_EQUAL(0, passed);
    argus_task_refuse(&t, &k, &echoes);
    TEST_ASSERT_FALSE(at(790, 0));
    TEST_ASSERT_EQUAL(0, passed);
    TEST_ASSERT_FALSE(at(810, 0));
    TEST_ASSERT_EQUAL(1, passed);
    argus_task_refuse(&t, &k, &echoes);
    TEST_ASSERT_FALSE(at(1810, 0));
    TEST_ASSERT_EQUAL(0, passed);
}

void test_without_a_course_nothing_is_reached(void) {
    TEST_ASSERT_FALSE(at(0, 0));
    TEST_ASSERT_EQUAL(0, argus_task_goal_mm(&t, &k));
    TEST_ASSERT_EQUAL(ARGUS_SEARCH_NO_WAY, argus_task_choose(&t, &k, &echoes, false));
}

void test_bearing_and_distance_of_the_leg(void) {
    const argus_point_t goal = {1000, 1000};
    TEST_ASSERT_TRUE(argus_task_set(&t, &goal, 1));
    TEST_ASSERT_EQUAL(ARGUS_SEARCH_FOUND, argus_task_choose(&t, &k, &echoes, false));
    TEST_ASSERT_INT32_WITHIN(6, 4500, argus_task_bearing_cdeg(&t, &k));
    TEST_ASSERT_INT32_WITHIN(1, 1414, argus_task_leg_mm(&t, &k));
}
