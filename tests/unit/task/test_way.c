// SPDX-License-Identifier: MIT
// Rule under attack: the first leg of the way: it is free, it gets on, and there is none only where there is
// none.
#include "task/way.h"

#include <stdio.h>
#include <stdlib.h>

#include "floor.h"
#include "knowledge/angle.h"
#include "unity.h"

#define P3DX_HALF_MM 213

#define SIPS_MOST 40
#define WORK_MOST 3200 // in one SIP: what a search may take, and its last step

static argus_search_t search;
static int sips; // that the last search took
static argus_grid_t g;
static argus_knowledge_t k;
static argus_ground_t ground;
static argus_leg_t leg;
static char text[96];

static void stand(const int x_mm, const int y_mm) {
    k.pose.x_mm = x_mm;
    k.pose.y_mm = y_mm;
    argus_grid_see(&g, &k);
}

void setUp(void) {
    argus_grid_init(&g);
    argus_knowledge_init(&k);
    ground = (argus_ground_t){&k, &g, false};
    stand(0, 0);
}

static bool finds(const int x_mm, const int y_mm) {
    const argus_point_t to = {x_mm, y_mm};
    argus_search_news_t news = ARGUS_SEARCH_GOES_ON;
    for (sips = 0; news == ARGUS_SEARCH_GOES_ON; sips++) {
        TEST_ASSERT_TRUE(sips < SIPS_MOST);
        k.sips++;
        news = argus_way_find(&search, &ground, to);
        TEST_ASSERT_TRUE(search.work <= WORK_MOST);
    }
    leg = search.leg;
    return news == ARGUS_SEARCH_FOUND;
}

static void wall(const int x1, const int y1, const int x2, const int y2) {
    const argus_point_t from = {x1, y1};
    const argus_point_t to = {x2, y2};
    draw_wall(&g, from, to);
}

// Of the middles of the cells of the grid, the one that is nearest to a straight way.
static int32_t clearance_mm(const argus_point_t from, const argus_point_t to) {
    int32_t least = INT32_MAX;
    for (int part = 0; part <= 100; part++) {
        const argus_point_t on = {from.x_mm + (to.x_mm - from.x_mm) * part / 100,
                                  from.y_mm + (to.y_mm - from.y_mm) * part / 100};
        const argus_cell_t about = argus_grid_cell(on);
        for (int dy = -5; dy <= 5; dy++) {
            for (int dx = -5; dx <= 5; dx++) {
                const argus_cell_t cell = {about.x + dx, about.y + dy};
                const argus_point_t centre = argus_grid_centre(cell);
                if (argus_grid_is_occupied(&g, cell)) {
                    least = argus_min(least, argus_hypot(centre.x_mm - on.x_mm, centre.y_mm - on.y_mm));
                }
            }
        }
    }
    return least;
}

// Leg by leg; how many it took, -1: no way, or no end.
static int walk(const int x_mm, const int y_mm, int32_t *const nearest_mm) {
    *nearest_mm = INT32_MAX;
    for (int legs = 1; legs <= 40; legs++) {
        if (!finds(x_mm, y_mm)) {
            return -1;
        }
        const argus_point_t from = {k.pose.x_mm, k.pose.y_mm};
        *nearest_mm = argus_min(*nearest_mm, clearance_mm(from, leg.to));
        if (leg.direct) {
            return legs;
        }
        stand((int)leg.to.x_mm, (int)leg.to.y_mm);
    }
    return -1;
}

void test_the_straight_way_where_nothing_is_known(void) {
    for (int a = 0; a < 36000; a += 700) {
        const int x = (int)(3000 * argus_cos(a) / ARGUS_TRIG_ONE);
        const int y = (int)(3000 * argus_sin(a) / ARGUS_TRIG_ONE);
        TEST_ASSERT_TRUE(finds(x, y));
        TEST_ASSERT_TRUE(leg.direct);
        TEST_ASSERT_FALSE(leg.narrow);
        TEST_ASSERT_EQUAL(x, leg.to.x_mm);
        TEST_ASSERT_EQUAL(y, leg.to.y_mm);
        TEST_ASSERT_EQUAL(0, leg.to_go_mm);
        TEST_ASSERT_TRUE(finds(9 * x, 9 * y)); // far outside the window
        TEST_ASSERT_TRUE(leg.direct);
    }
}

void test_before_the_first_sip_there_is_no_way(void) {
    argus_grid_init(&g);
    k.pose.x_mm = 100000;
    TEST_ASSERT_FALSE(finds(0, 0));
}

void test_far_from_the_start_nothing_overflows(void) {
    stand(2000000, -2000000);
    TEST_ASSERT_TRUE(finds(0, 0));
    TEST_ASSERT_TRUE(finds(30000, -30000));
    wall(2001000, -2000500, 2001000, -1999500);
    TEST_ASSERT_TRUE(finds(0, 0));
}

void test_round_a_wall_by_its_nearer_end(void) {
    wall(1500, -400, 1500, 1500);
    TEST_ASSERT_TRUE(finds(3000, 0));
    TEST_ASSERT_FALSE(leg.direct);
    TEST_ASSERT_TRUE(leg.to.y_mm < 0);
    int32_t nearest_mm;
    TEST_ASSERT_TRUE(walk(3000, 0, &nearest_mm) > 0);
    TEST_ASSERT_TRUE(nearest_mm > P3DX_HALF_MM + 100);
}

// 1000 mm: the middle of it is wide enough to turn in, the rest is not.
void test_through_a_door(void) {
    for (int y = -800; y <= 800; y += 50) {
        setUp();
        wall(1500, -3500, 1500, y - 500);
        wall(1500, y + 500, 1500, 3500);
        int32_t nearest_mm;
        snprintf(text, sizeof text, "door at %d", y);
        TEST_ASSERT_TRUE_MESSAGE(walk(3000, 0, &nearest_mm) > 0, text);
        TEST_ASSERT_TRUE_MESSAGE(nearest_mm > P3DX_HALF_MM + 50, text);
    }
}

void test_not_through_a_gap_that_is_too_narrow(void) {
    wall(1500, -4500, 1500, -250);
    wall(1500, 250, 1500, 4500);
    wall(-4000, -4500, -4000, 4500);
    wall(-4000, -3900, 1500, -3900);
    wall(-4000, 3900, 1500, 3900);
    TEST_ASSERT_FALSE(finds(3000, 0));
}

void test_out_of_a_dead_end(void) {
    wall(-1500, 600, 700, 600);
    wall(700, 600, 700, -600);
    wall(700, -600, -1500, -600);
    TEST_ASSERT_TRUE(finds(3000, 0));
    TEST_ASSERT_TRUE(leg.to.x_mm < -500);
    int32_t nearest_mm;
    TEST_ASSERT_TRUE(walk(3000, 0, &nearest_mm) > 1);
    TEST_ASSERT_TRUE(nearest_mm > P3DX_HALF_MM + 50);
}

void test_a_waypoint_that_is_walled_in_has_no_way(void) {
    wall(2000, -600, 3000, -600);
    wall(3000, -600, 3000, 600);
    wall(3000, 600, 2000, 600);
    TEST_ASSERT_TRUE(finds(2500, 0));
    wall(2000, 600, 2000, -600);
    TEST_ASSERT_FALSE(finds(2500, 0));
    TEST_ASSERT_TRUE(finds(20000, 0));
}

// Out of a place nearer to a wall than it would choose, and to one.
void test_near_walls_at_either_end(void) {
    wall(-1000, 300, 1000, 300);
    TEST_ASSERT_TRUE(finds(0, -2000));
    setUp();
    wall(2000, 300, 4000, 300);
    TEST_ASSERT_TRUE(finds(3000, 0));
    TEST_ASSERT_TRUE(finds(3000, 20));
}

// What stopped it stands ahead, whatever the grid says.
void test_one_that_was_stopped_does_not_go_on_ahead(void) {
    TEST_ASSERT_TRUE(finds(3000, 0));
    TEST_ASSERT_TRUE(leg.direct);
    ground.stopped = true;
    TEST_ASSERT_TRUE(finds(3000, 0));
    const int32_t bearing = argus_atan2(leg.to.y_mm, leg.to.x_mm);
    TEST_ASSERT_TRUE(argus_abs(bearing) > 2000);
}

void test_a_leg_is_given_up_when_something_shows_on_it(void) {
    TEST_ASSERT_TRUE(finds(3000, 0));
    TEST_ASSERT_TRUE(argus_way_is_free(&ground, &leg));
    wall(1700, -100, 1700, 100);
    TEST_ASSERT_TRUE(argus_way_is_free(&ground, &leg)); // not within the next metre
    wall(1000, 350, 1000, 450);
    TEST_ASSERT_FALSE(argus_way_is_free(&ground, &leg)); // no room to turn any more
    TEST_ASSERT_TRUE(finds(3000, 0));
    TEST_ASSERT_TRUE(argus_way_is_free(&ground, &leg));
}

// The way round by the far end of a long wall.
static void long_wall(void) {
    wall(1500, -3900, 1500, 3000);
    wall(-2000, -1500, 1500, -1500);
}

static argus_search_news_t searches(const int x_mm, const int y_mm) {
    const argus_point_t to = {x_mm, y_mm};
    k.sips++;
    return argus_way_find(&search, &ground, to);
}

void test_what_is_too_much_for_one_sip_goes_on_with_the_next(void) {
    long_wall();
    TEST_ASSERT_EQUAL(ARGUS_SEARCH_GOES_ON, searches(3000, -1000));
    stand(80, 0); // it drives on meanwhile
    TEST_ASSERT_TRUE(finds(3000, -1000));
    TEST_ASSERT_TRUE(leg.to.y_mm > 0);
    TEST_ASSERT_TRUE(sips < 6);
}

void test_a_search_for_another_waypoint_begins_anew(void) {
    long_wall();
    TEST_ASSERT_EQUAL(ARGUS_SEARCH_GOES_ON, searches(3000, -1000));
    TEST_ASSERT_EQUAL(ARGUS_SEARCH_FOUND, searches(-1000, 0));
    TEST_ASSERT_TRUE(search.leg.direct);
    TEST_ASSERT_EQUAL(-1000, search.leg.to.x_mm);
}

void test_each_coordinate_makes_another_waypoint(void) {
    for (int axis = 0; axis < 2; axis++) {
        setUp();
        long_wall();
        TEST_ASSERT_EQUAL(ARGUS_SEARCH_GOES_ON, searches(3000, -1000));
        argus_grid_clear(&g);
        TEST_ASSERT_EQUAL(ARGUS_SEARCH_FOUND, axis == 0 ? searches(2000, -1000) : searches(3000, 500));
        TEST_ASSERT_TRUE(search.leg.direct);
    }
}

// What the grid was then says nothing any more.
void test_a_search_that_was_left_for_a_sip_begins_anew(void) {
    long_wall();
    TEST_ASSERT_EQUAL(ARGUS_SEARCH_GOES_ON, searches(3000, -1000));
    argus_grid_clear(&g);
    k.sips++;
    TEST_ASSERT_EQUAL(ARGUS_SEARCH_FOUND, searches(3000, -1000));
    TEST_ASSERT_TRUE(search.leg.direct);
}

// ... and something ahead counts at once; that it comes and goes does not keep a search from its end.
void test_a_search_ends_though_something_ahead_comes_and_goes(void) {
    long_wall();
    TEST_ASSERT_EQUAL(ARGUS_SEARCH_GOES_ON, searches(3000, -1000));
    argus_search_news_t news = ARGUS_SEARCH_GOES_ON;
    for (int i = 0; news == ARGUS_SEARCH_GOES_ON; i++) {
        TEST_ASSERT_TRUE(i < 8);
        ground.stopped = i % 2 == 0;
        news = searches(3000, -1000);
    }
    TEST_ASSERT_EQUAL(ARGUS_SEARCH_FOUND, news);
    TEST_ASSERT_TRUE(argus_abs(argus_atan2(search.leg.to.y_mm, search.leg.to.x_mm)) > 2000);
}

// In random rooms: each way that is found is free and ends.
void test_random_rooms(void) {
    int found = 0;
    for (unsigned seed = 1; seed <= 400; seed++) {
        setUp();
        srand(seed);
        for (int i = 0; i < 5; i++) {
            const int x = rand() % 5000 - 2500;
            const int y = rand() % 5000 - 2500;
            const int length = rand() % 2000;
            const bool near = abs(x) < 800 && abs(y) < 800;
            const bool along = rand() % 2 == 0;
            if (!near && (x > 0) == (x + length > 0)) {
                wall(x, y, along ? x + length : x, along ? y : y + (y > 0 ? length : -length));
            }
        }
        const int to_x = rand() % 6000 - 3000;
        const int to_y = rand() % 6000 - 3000;
        const argus_point_t start = {0, 0};
        const bool free_start = clearance_mm(start, start) > 330;
        int32_t nearest_mm;
        const int legs = walk(to_x, to_y, &nearest_mm);
        snprintf(text, sizeof text, "seed %u: %d legs, nearest %d", seed, legs, (int)nearest_mm);
        found += legs > 0;
        const argus_point_t goal = {to_x, to_y};
        const bool free_goal = clearance_mm(goal, goal) > 330;
        TEST_ASSERT_TRUE_MESSAGE(legs < 0 || !free_start || !free_goal || nearest_mm > P3DX_HALF_MM, text);
    }
    snprintf(text, sizeof text, "%d of 400 found", found);
    TEST_ASSERT_TRUE_MESSAGE(found > 350, text);
}

// What a wide robot, which may turn there, asks for beside the way is more than what a narrow one does.
void test_a_narrow_leg_is_free_where_a_wide_one_is_not(void) {
    int only_narrow = 0;
    for (int beside_mm = 0; beside_mm <= 700; beside_mm += 20) {
        setUp();
        wall(300, beside_mm, 1200, beside_mm);
        const argus_leg_t narrow = {.to = {1500, 0}, .narrow = true};
        const argus_leg_t wide = {.to = {1500, 0}, .narrow = false};
        const bool lets_narrow = argus_way_is_free(&ground, &narrow);
        TEST_ASSERT_TRUE(lets_narrow || !argus_way_is_free(&ground, &wide));
        only_narrow += lets_narrow && !argus_way_is_free(&ground, &wide) ? 1 : 0;
    }
    TEST_ASSERT_GREATER_THAN(0, only_narrow);
}

// Wherever it stands in its cell, with a wall wherever that is near: a leg is either the whole way or so long
// that it is not done at once.
void test_no_leg_is_done_at_once(void) {
    int legs = 0;
    for (int at = 0; at < 25; at++) {
        for (int wall_mm = 120; wall_mm <= 420; wall_mm += 20) {
            setUp();
            const int x = at % 5 * 25 + 10, y = at / 5 * 25 + 10;
            wall(x - wall_mm, -400, x - wall_mm, 400);
            wall(1000, -1500, 1000, 1500);
            k.pose.x_mm = x;
            k.pose.y_mm = y;
            if (finds(2500, 0) && !leg.direct) {
                legs++;
                snprintf(text, sizeof text, "from %d, %d, wall at %d", x, y, wall_mm);
                const int32_t mm = argus_hypot(leg.to.x_mm - x, leg.to.y_mm - y);
                TEST_ASSERT_TRUE_MESSAGE(mm >= 100, text);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN(0, legs);
}
