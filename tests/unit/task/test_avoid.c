// SPDX-License-Identifier: MIT
// Rule under attack: leg by leg: when one is given up, where none can be had, and when the waypoint is.
#include <stdlib.h>
#include <string.h>

#include "echo.h"
#include "floor.h"
#include "knowledge/angle.h"
#include "task/task.h"
#include "unity.h"

static argus_task_t t;
static argus_echoes_t e;
static argus_knowledge_t k;

static void stand(const int x_mm, const int y_mm) {
    k.pose.x_mm = x_mm;
    k.pose.y_mm = y_mm;
    k.fresh = 0;
    argus_echoes_see(&e, &k, k.sip_ms);
}

void setUp(void) {
    memset(&t, 0, sizeof t);
    argus_echoes_init(&e);
    argus_knowledge_init(&k);
    k.sip_ms = 100000;
    const argus_point_t goal = {5000, 0};
    TEST_ASSERT_TRUE(argus_task_set(&t, &goal, 1));
    stand(0, 0);
}

static bool chooses(void) {
    argus_search_news_t news = ARGUS_SEARCH_GOES_ON;
    for (int sips = 0; news == ARGUS_SEARCH_GOES_ON; sips++) {
        TEST_ASSERT_TRUE(sips < 40);
        k.sips++;
        news = argus_task_choose(&t, &k, &e, false);
    }
    return news == ARGUS_SEARCH_FOUND;
}

static void wall(const int x1, const int y1, const int x2, const int y2) {
    const argus_point_t from = {x1, y1};
    const argus_point_t to = {x2, y2};
    draw_wall(&e.grid, from, to);
}

static void shut_in(void) {
    wall(-800, -800, 800, -800);
    wall(800, -800, 800, 800);
    wall(800, 800, -800, 800);
    wall(-800, 800, -800, -800);
}

static void hears(const int sonar, const int mm) {
    k.sonar[sonar].reported = true;
    k.sonar[sonar].health = ARGUS_HEALTHY;
    k.sonar[sonar].reading_mm = (uint16_t)mm;
}

void test_the_leg_is_the_waypoint_while_the_way_is_free(void) {
    TEST_ASSERT_TRUE(chooses());
    TEST_ASSERT_TRUE(t.has_leg);
    TEST_ASSERT_FALSE(t.avoiding);
    TEST_ASSERT_EQUAL(0, argus_task_bearing_cdeg(&t, &k));
    TEST_ASSERT_EQUAL(5000, argus_task_leg_mm(&t, &k));
}

void test_a_detour_ends_and_the_waypoint_does_not(void) {
    wall(1500, -1500, 1500, 1500);
    TEST_ASSERT_TRUE(chooses());
    TEST_ASSERT_TRUE(t.avoiding);
    argus_task_keep(&t, &k, &e);
    TEST_ASSERT_TRUE(t.has_leg);
    stand((int)t.leg.to.x_mm - 61, (int)t.leg.to.y_mm);
    argus_task_keep(&t, &k, &e);
    TEST_ASSERT_TRUE(t.has_leg);
    stand((int)t.leg.to.x_mm - 60, (int)t.leg.to.y_mm);
    argus_task_keep(&t, &k, &e);
    TEST_ASSERT_FALSE(t.has_leg);
    setUp();
    TEST_ASSERT_TRUE(chooses());
    stand(4990, 0);
    argus_task_keep(&t, &k, &e);
    TEST_ASSERT_TRUE(t.has_leg);
}

void test_a_leg_ends_when_something_shows_on_it(void) {
    TEST_ASSERT_TRUE(chooses());
    argus_task_keep(&t, &k, &e);
    TEST_ASSERT_TRUE(t.has_leg);
    wall(900, 0, 900, 100);
    argus_task_keep(&t, &k, &e);
    TEST_ASSERT_FALSE(t.has_leg);
}

// What is heard near ahead of it, and where nothing is, what cannot be heard.
void test_what_stopped_the_robot_is_remembered(void) {
    const argus_point_t ahead = {310, 0};
    TEST_ASSERT_TRUE(chooses());
    hears(4, 350);
    argus_task_refuse(&t, &k, &e);
    TEST_ASSERT_FALSE(t.has_leg);
    TEST_ASSERT_TRUE(argus_grid_is_occupied(&e.grid, argus_grid_cell(argus_echo_robot(&k, 4))));
    TEST_ASSERT_FALSE(argus_grid_is_occupied(&e.grid, argus_grid_cell(ahead)));
    setUp();
    hears(4, 351);
    hears(11, 200); // behind
    argus_task_refuse(&t, &k, &e);
    TEST_ASSERT_TRUE(argus_grid_is_occupied(&e.grid, argus_grid_cell(ahead)));
    TEST_ASSERT_TRUE(chooses());
    TEST_ASSERT_TRUE(t.avoiding);
}

// Ahead but for a nudge, as far as nothing was seen, less what an object stops it at.
void test_escapes_where_the_way_ahead_is_free(void) {
    for (int by = -2000; by <= 2000; by += 1000) {
        setUp();
        TEST_ASSERT_TRUE(argus_task_escape(&t, &k, &e, by));
        TEST_ASSERT_TRUE(t.avoiding && t.has_leg);
        TEST_ASSERT_INT32_WITHIN(2, 300, argus_task_leg_mm(&t, &k));
        TEST_ASSERT_INT32_WITHIN(40, by, argus_task_bearing_cdeg(&t, &k));
    }
    setUp();
    place_echo(&e, &k, 600, 100);
    TEST_ASSERT_TRUE(argus_task_escape(&t, &k, &e, 0));
    TEST_ASSERT_INT32_WITHIN(2, 140, argus_task_leg_mm(&t, &k));
    setUp();
    place_echo(&e, &k, 559, 100);
    TEST_ASSERT_FALSE(argus_task_escape(&t, &k, &e, 0));
    TEST_ASSERT_FALSE(t.has_leg);
}

// A second of SIPs. True: hopeless.
static bool a_second(const bool drives) {
    bool hopeless = false;
    for (int i = 0; i < 10; i++) {
        k.sip_ms += 100;
        hopeless = argus_task_is_hopeless(&t, &k, drives);
    }
    return hopeless;
}

static int seconds_until_hopeless(const int most) {
    for (int s = 1; s <= most; s++) {
        if (a_second(true)) {
            return s;
        }
    }
    return -1;
}

void test_a_minute_and_a_half_of_driving_without_progress_is_hopeless(void) {
    TEST_ASSERT_TRUE(chooses());
    (void)argus_task_is_hopeless(&t, &k, true);
    TEST_ASSERT_EQUAL(90, seconds_until_hopeless(200));
}

void test_so_is_as_long_without_a_way(void) {
    shut_in();
    TEST_ASSERT_FALSE(chooses());
    (void)argus_task_is_hopeless(&t, &k, true);
    TEST_ASSERT_EQUAL(90, seconds_until_hopeless(200));
}

// A map may close by echoes of nothing. It is faded, and the way that opens counts from then on, however much
// longer it is; the third time it is believed.
void test_a_map_that_closes_is_doubted_twice(void) {
    for (int times = 1; times <= 3; times++) {
        TEST_ASSERT_TRUE(chooses());
        shut_in();
        for (int again = 0; again < 3; again++) { // while it waits it is one time
            TEST_ASSERT_FALSE(chooses());
        }
        TEST_ASSERT_EQUAL(times == 3, a_second(true));
        argus_grid_clear(&e.grid);
    }
}

void test_after_a_closed_map_the_way_is_measured_anew(void) {
    TEST_ASSERT_TRUE(chooses());
    stand(1500, 0);
    TEST_ASSERT_FALSE(a_second(true));
    stand(0, 0);
    shut_in();
    TEST_ASSERT_FALSE(chooses());
    argus_grid_clear(&e.grid);
    for (int i = 0; i < 45; i++) {
        TEST_ASSERT_FALSE(a_second(true));
    }
    TEST_ASSERT_TRUE(chooses());
    stand(100, 0); // far from its best, but nearer than now
    TEST_ASSERT_FALSE(a_second(true));
    TEST_ASSERT_EQUAL(90, seconds_until_hopeless(200));
}

void test_what_does_not_count_as_driving(void) {
    TEST_ASSERT_TRUE(chooses());
    for (int s = 0; s < 200; s++) {
        TEST_ASSERT_FALSE(a_second(false));
    }
    for (int i = 0; i < 200; i++) { // a link that stalls
        k.sip_ms += 2000;
        TEST_ASSERT_FALSE(argus_task_is_hopeless(&t, &k, true));
    }
    t.next = t.count;
    TEST_ASSERT_EQUAL(-1, seconds_until_hopeless(200));
}

void test_progress_is_a_way_to_go_that_is_100_mm_shorter(void) {
    for (int step = 99; step <= 100; step++) {
        setUp();
        TEST_ASSERT_TRUE(chooses());
        int hopeless = 0;
        for (int i = 1; i <= 3; i++) {
            for (int s = 0; s < 60; s++) {
                hopeless += a_second(true);
            }
            stand(i == 1 ? step : 2 * step, 0);
        }
        TEST_ASSERT_EQUAL(step == 99, hopeless > 0);
    }
}

// What is found in the way makes the way longer, and the new way counts; but not for ever.
void test_a_set_back_is_no_loss_of_time_but_there_are_only_so_many(void) {
    TEST_ASSERT_TRUE(chooses());
    wall(1500, -2500, 1500, 2500);
    TEST_ASSERT_TRUE(chooses());
    const int32_t to_go_mm = t.leg.to_go_mm + argus_task_leg_mm(&t, &k);
    TEST_ASSERT_TRUE(to_go_mm > 6000);
    for (int s = 0; s < 45; s++) {
        TEST_ASSERT_FALSE(a_second(true));
    }
    stand((int)t.leg.to.x_mm, (int)t.leg.to.y_mm);
    TEST_ASSERT_FALSE(a_second(true)); // nearer by the way round
    for (int s = 0; s < 45; s++) {
        TEST_ASSERT_FALSE(a_second(true));
    }
    int rounds = 0;
    while (!a_second(true) && rounds < 1000) { // its way grows and shrinks
        stand(rounds % 2 == 0 ? 0 : 4000, rounds % 2 == 0 ? 0 : 3000);
        argus_grid_clear(&e.grid);
        TEST_ASSERT_TRUE(chooses());
        rounds++;
    }
    TEST_ASSERT_TRUE(rounds > 10 && rounds < 100);
}

void test_a_new_course_begins_anew(void) {
    TEST_ASSERT_TRUE(chooses());
    for (int s = 0; s < 59; s++) {
        TEST_ASSERT_FALSE(a_second(true));
    }
    const argus_point_t goal = {0, 5000};
    TEST_ASSERT_TRUE(argus_task_set(&t, &goal, 1));
    TEST_ASSERT_TRUE(chooses());
    for (int s = 0; s < 59; s++) {
        TEST_ASSERT_FALSE(a_second(true));
    }
}

void test_many_refusals_are_survived(void) {
    for (int i = 0; i < 100; i++) {
        k.pose.heading_cdeg = argus_angle_wrap(i * 997);
        argus_task_refuse(&t, &k, &e);
        (void)chooses();
    }
}

// There is no way out to where nobody wants to go.
void test_without_a_course_there_is_no_escape(void) {
    TEST_ASSERT_TRUE(argus_task_escape(&t, &k, &e, 0));
    memset(&t, 0, sizeof t);
    TEST_ASSERT_FALSE(argus_task_escape(&t, &k, &e, 0));
    TEST_ASSERT_FALSE(t.has_leg);
}

// What was given up is not taken up again by looking at it.
void test_a_leg_that_was_given_up_is_not_kept(void) {
    TEST_ASSERT_TRUE(chooses());
    argus_task_keep(&t, &k, &e);
    TEST_ASSERT_TRUE(t.has_leg);
    t.has_leg = false;
    argus_task_keep(&t, &k, &e);
    TEST_ASSERT_FALSE(t.has_leg);
}

// The first way is no set-back, and a shorter one is none; a longer one is, once.
void test_a_set_back_is_a_way_that_has_grown(void) {
    TEST_ASSERT_TRUE(chooses());
    argus_task_is_hopeless(&t, &k, true);
    TEST_ASSERT_EQUAL(0, t.progress.set_backs);
    wall(1500, -3500, 1500, 3500);
    t.has_leg = false;
    TEST_ASSERT_TRUE(chooses());
    argus_task_is_hopeless(&t, &k, true);
    TEST_ASSERT_EQUAL(1, t.progress.set_backs);
}
