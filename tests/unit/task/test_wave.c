// SPDX-License-Identifier: MIT
// Rule under attack: a wave has come nowhere outside of its window, what it counts as within a radius is, and
// it ends.
#include "task/wave.h"

#include <string.h>

#include "knowledge/angle.h"
#include "unity.h"

static argus_wave_t wave;
static argus_grid_t grid;
static argus_knowledge_t k;

void setUp(void) {
    argus_knowledge_init(&k);
    memset(&grid, 0, sizeof grid);
    memset(&wave, 0, sizeof wave);
}

static void begin(const int32_t x_mm, const int32_t y_mm, const bool stopped) {
    const argus_ground_t ground = {&k, &grid, stopped};
    argus_wave_begin(&wave, &ground, (argus_point_t){x_mm, y_mm});
}

void test_outside_of_the_window_there_is_no_label(void) {
    static const argus_cell_t outside[] = {
        {-1, 0}, {0, -1}, {ARGUS_GRID_CELLS, 0}, {0, ARGUS_GRID_CELLS}, {INT16_MAX, INT16_MIN}};
    memset(wave.label, 0xFF, sizeof wave.label);
    for (unsigned i = 0; i < sizeof outside / sizeof outside[0]; i++) {
        TEST_ASSERT_FALSE(argus_wave_is_within(outside[i]));
        TEST_ASSERT_EQUAL(0, argus_wave_label(&wave, outside[i]));
    }
    TEST_ASSERT_EQUAL(15, argus_wave_label(&wave, (argus_cell_t){0, 0}));
    TEST_ASSERT_EQUAL(15,
                      argus_wave_label(&wave, (argus_cell_t){ARGUS_GRID_CELLS - 1, ARGUS_GRID_CELLS - 1}));
}

// The farthest cell of each row whose centre is within the radius, by their squares.
void test_the_reach_of_a_row_is_the_circle(void) {
    for (int32_t radius_mm = 50; radius_mm <= 1000; radius_mm += 25) {
        for (int dy = -12; dy <= 12; dy++) {
            const int wide = argus_wave_reach(radius_mm, dy);
            const int32_t most = radius_mm * radius_mm / (ARGUS_GRID_CELL_MM * ARGUS_GRID_CELL_MM);
            TEST_ASSERT_TRUE(wide >= -1);
            TEST_ASSERT_TRUE(wide < 0 || wide * wide + dy * dy <= most);
            TEST_ASSERT_TRUE((wide + 1) * (wide + 1) + dy * dy > most);
        }
    }
}

static argus_wave_news_t run(void) {
    argus_wave_news_t news = ARGUS_WAVE_SPREADS;
    for (int step = 0; news == ARGUS_WAVE_SPREADS; step++) {
        int32_t work = 0;
        TEST_ASSERT_LESS_THAN(5000, step);
        news = argus_wave_spread(&wave, &work);
    }
    return news;
}

void test_in_the_open_it_comes_from_wherever_the_waypoint_is(void) {
    for (int32_t far_mm = 0; far_mm <= 200000; far_mm += 20000) {
        setUp();
        begin(far_mm, -far_mm / 2, false);
        TEST_ASSERT_EQUAL(ARGUS_WAVE_THERE, run());
    }
}

// What stands before a robot that was stopped is in the window; where that is beyond its edge, nothing is
// set.
void test_what_stopped_the_robot_is_taken_within_the_window_only(void) {
    for (int32_t heading = -17000; heading <= 18000; heading += 1000) {
        setUp();
        k.pose.heading_cdeg = heading;
        begin(argus_cos(heading) / 8, argus_sin(heading) / 8, true);
        const argus_wave_news_t news = run();
        TEST_ASSERT_TRUE(news == ARGUS_WAVE_THERE || news == ARGUS_WAVE_DEAD);
    }
}

// However long the way is, a search ends.
void test_at_its_last_step_a_wave_that_has_not_come_is_dead(void) {
    for (uint16_t step = 999; step <= 1000; step++) {
        setUp();
        begin(3000, 0, false);
        wave.step = step;
        int32_t work = 0;
        TEST_ASSERT_EQUAL(step < 1000 ? ARGUS_WAVE_SPREADS : ARGUS_WAVE_DEAD,
                          argus_wave_spread(&wave, &work));
    }
}
