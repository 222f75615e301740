// SPDX-License-Identifier: MIT
// Rule under attack: a wave has come nowhere outside of its window, what it counts as within a radius is, it
// ends, and it comes to each cell when a wave that asks cell by cell comes there.
#include "task/wave.h"

#include <limits.h>
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

// Cell by cell
// -----------------------------------------------------------------------------------------------

#define CELLS ARGUS_GRID_CELLS
#define SLOW 5 // steps from a cell to one where it is narrow
#define NOT_YET INT_MAX

static int since[CELLS][CELLS];

static bool has(const uint64_t *const rows, const int x, const int y) {
    return (rows[y] >> x & 1u) != 0;
}

// The step in which the wave came to the neighbour of a cell from which it may come there now, the earliest.
static int from_beside(const int x, const int y, const bool corners) {
    int first = NOT_YET;
    for (int dy = -1; dy <= 1; dy++) {
        for (int dx = -1; dx <= 1; dx++) {
            const bool beside = (dx == 0) != (dy == 0) || (corners && dx != 0 && dy != 0);
            if (beside && argus_wave_is_within((argus_cell_t){x + dx, y + dy})) {
                first = argus_min(first, since[y + dy][x + dx]);
            }
        }
    }
    return first;
}

static void come_on(const int step) {
    static bool comes[CELLS][CELLS];
    for (int y = 0; y < CELLS; y++) {
        for (int x = 0; x < CELLS; x++) {
            const int first = from_beside(x, y, step % 2 == 0);
            const int takes = has(wave.wide, x, y) ? 1 : SLOW;
            comes[y][x] =
                since[y][x] == NOT_YET && has(wave.narrow, x, y) && first != NOT_YET && step - first >= takes;
        }
    }
    for (int y = 0; y < CELLS; y++) {
        for (int x = 0; x < CELLS; x++) {
            since[y][x] = comes[y][x] ? step : since[y][x];
        }
    }
}

static void compare(const int step) {
    for (int y = 0; y < CELLS; y++) {
        for (int x = 0; x < CELLS; x++) {
            const unsigned label =
                since[y][x] == NOT_YET ? 0 : 1u + (unsigned)since[y][x] % ARGUS_WAVE_LABELS;
            TEST_ASSERT_EQUAL_UINT_MESSAGE(label, argus_wave_label(&wave, (argus_cell_t){x, y}), "label");
        }
    }
    TEST_ASSERT_EQUAL_INT(step + 1, wave.step);
}

static int below(uint32_t *const state, const int most) {
    *state = *state * 1664525u + 1013904223u;
    return (int)(*state >> 16) % most;
}

// Things anywhere but about the robot and the waypoint; both lie in the window.
static void furnish(uint32_t *const state, const int things) {
    k.pose.x_mm = k.pose.y_mm = 8 * ARGUS_GRID_CELL_MM;
    for (int i = 0; i < things; i++) {
        const argus_cell_t cell = {below(state, CELLS), below(state, CELLS)};
        argus_grid_mark(&grid, argus_grid_centre(cell), true);
    }
}

static void wave_is_as_cell_by_cell(uint32_t seed) {
    uint32_t state = seed;
    furnish(&state, 10 + below(&state, 120));
    begin((50 + below(&state, 10)) * ARGUS_GRID_CELL_MM, (50 + below(&state, 10)) * ARGUS_GRID_CELL_MM,
          false);
    for (int i = 0; i < CELLS * CELLS; i++) {
        since[i / CELLS][i % CELLS] = NOT_YET;
    }
    since[wave.from.y][wave.from.x] = 0;
    int32_t work = 0;
    for (int step = 1; argus_wave_spread(&wave, &work) == ARGUS_WAVE_SPREADS; step++) {
        come_on(step);
        compare(step);
    }
}

void test_it_comes_to_each_cell_when_one_cell_by_cell_does(void) {
    for (uint32_t seed = 1; seed <= 40; seed++) {
        setUp();
        wave_is_as_cell_by_cell(seed);
    }
}
