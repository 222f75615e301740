// SPDX-License-Identifier: MIT
// Rule under attack: what the grid takes for occupied, for how long, and that it goes with the robot.
#include "knowledge/grid.h"

#include <stdio.h>
#include <stdlib.h>

#include "health.h"
#include "knowledge/angle.h"
#include "robot/table.h"
#include "unity.h"

static argus_grid_t g;
static argus_knowledge_t k;
static char text[48];

void setUp(void) {
    argus_grid_init(&g);
    argus_knowledge_init(&k);
    k.sip_ms = 100000;
}

// A SIP with one fresh reading, or none.
static void reads(const int sonar, const int mm) {
    k.fresh = 0;
    if (sonar >= 0) {
        k.sonar[sonar].reported = true;
        k.sonar[sonar].reading_mm = (uint16_t)mm;
        k.fresh = (argus_mask_t)(1u << sonar);
    }
    argus_grid_see(&g, &k);
}

static bool is_there(const argus_point_t at) {
    return argus_grid_is_occupied(&g, argus_grid_cell(at));
}

static argus_point_t echo_of(const int sonar) {
    return argus_to_course(&k.pose, argus_echo_robot(&k, sonar));
}

static int occupied(void) {
    int count = 0;
    for (int y = 0; y < ARGUS_GRID_CELLS; y++) {
        for (uint64_t row = argus_grid_row(&g, y); row != 0; row &= row - 1) {
            count++;
        }
    }
    return count;
}

void test_two_near_echoes_occupy_the_cell_where_they_lie(void) {
    k.pose.heading_cdeg = 9000;
    reads(3, 800);
    TEST_ASSERT_EQUAL(0, occupied()); // one may be crosstalk
    reads(3, 800);
    TEST_ASSERT_EQUAL(1, occupied());
    TEST_ASSERT_TRUE(is_there(echo_of(3)));
}

void test_far_echoes_alone_occupy_nothing(void) {
    for (int i = 0; i < 50; i++) {
        reads(3, 1001);
        reads(4, 1600);
        reads(2, 4999);
    }
    TEST_ASSERT_EQUAL(0, occupied());
}

void test_who_does_not_tell(void) {
    for (int i = 0; i < 10; i++) {
        k.rotating = false;
        put_health(&k.sonar[3], ARGUS_DISABLED, ARGUS_KIND_OFF, 0);
        reads(3, 500);
        put_health(&k.sonar[4], ARGUS_SUSPECT, ARGUS_KIND_NONE, 0);
        reads(4, 500);
        k.rotating = true;
        reads(5, 500);
    }
    TEST_ASSERT_EQUAL(0, occupied());
}

// A beam that passes lowers what it passes by one, at rest in the first second only: it tells nothing new.
void test_beams_that_pass_take_back_what_is_not_there(void) {
    reads(3, 400);
    reads(3, 400);
    const argus_point_t at = echo_of(3);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(is_there(at));
        reads(3, 2000);
    }
    TEST_ASSERT_FALSE(is_there(at));
    setUp();
    reads(3, 400);
    reads(3, 400);
    k.still_sips = 11;
    for (int i = 0; i < 10; i++) {
        reads(3, 2000);
    }
    TEST_ASSERT_TRUE(is_there(at));
}

void test_silence_passes_less_far_than_an_echo(void) {
    for (int silent = 0; silent < 2; silent++) {
        setUp();
        reads(3, 1000);
        reads(3, 1000);
        const argus_point_t at = echo_of(3);
        for (int i = 0; i < 20; i++) {
            reads(3, silent ? 5000 : 2000);
        }
        TEST_ASSERT_EQUAL(silent, is_there(at));
    }
}

void test_what_is_marked_and_what_is_touched(void) {
    const argus_point_t ahead = {350, 27}; // on the axis of sonar 3, nearly
    for (int sure = 0; sure < 2; sure++) {
        setUp();
        reads(-1, 0);
        argus_grid_mark(&g, ahead, sure != 0);
        TEST_ASSERT_TRUE(is_there(ahead));
        for (int i = 0; i < 20; i++) {
            reads(3, 3000);
        }
        TEST_ASSERT_EQUAL(sure, is_there(ahead));
        argus_grid_fade(&g);
        argus_grid_fade(&g);
        TEST_ASSERT_FALSE(is_there(ahead));
    }
}

// The post of a door sends its echo while the axis looks through the door. Where the post is known, and
// nothing in the door, that says nothing new; without it, or where something is known there, it counts.
void test_an_echo_that_what_is_known_explains_is_not_of_something_else(void) {
    const argus_sonar_pose_t at = argus_robot_pose(k.robot, 3);
    for (int side = -1; side <= 1; side++) {
        for (int known = 0; known < 2; known++) {
            setUp();
            reads(-1, 0);
            const argus_pose_t ray = {at.x_mm, at.y_mm, at.heading_deg * 100 + side * 1500};
            const argus_point_t post = argus_to_course(&ray, (argus_point_t){800, 0});
            if (known != 0) {
                argus_grid_mark(&g, post, true);
            }
            for (int i = 0; i < 5; i++) {
                reads(3, 800);
            }
            TEST_ASSERT_EQUAL(side == 0 || known == 0, is_there(echo_of(3)));
        }
    }
}

void test_where_the_robot_stands_nothing_is(void) {
    const argus_point_t here = {0, 0};
    reads(-1, 0);
    argus_grid_mark(&g, here, true);
    reads(-1, 0);
    TEST_ASSERT_EQUAL(0, occupied());
}

// It is heard abeam only, and the next door is not part of it once a beam has passed there.
void test_a_wall_beside_the_robot_goes_on(void) {
    for (int side = 0; side < 2; side++) {
        setUp();
        const int sonar = side == 0 ? 0 : 7;
        for (int x = 0; x <= 400; x += 100) {
            k.pose.x_mm = x;
            reads(sonar, 300);
        }
        const argus_point_t last = echo_of(sonar);
        const argus_point_t on = {last.x_mm + 480, last.y_mm};
        const argus_point_t beyond = {last.x_mm + 800, last.y_mm};
        TEST_ASSERT_TRUE(is_there(on));
        TEST_ASSERT_FALSE(is_there(beyond));
        k.pose.x_mm = on.x_mm - 69; // where its axis passes
        reads(sonar, 1500);
        TEST_ASSERT_FALSE(is_there(on));
    }
}

void test_two_echoes_that_are_no_wall_along_the_way_go_on_nowhere(void) {
    reads(0, 300);
    k.pose.x_mm = 20; // as good as no way
    reads(0, 300);
    k.pose.x_mm = 500; // another thing
    reads(0, 300);
    k.pose.x_mm = 520;
    k.pose.y_mm = 200; // across the way
    reads(0, 300);
    TEST_ASSERT_TRUE(occupied() <= 1);
}

// Wherever it is: what stands within 3.5 m stays, what is farther than the window is gone when the robot
// returns.
void test_the_window_goes_with_the_robot(void) {
    srand(1);
    for (int i = 0; i < 200; i++) {
        setUp();
        k.pose.x_mm = rand() % 4000000 - 2000000;
        k.pose.y_mm = rand() % 4000000 - 2000000;
        reads(-1, 0);
        const argus_point_t at = {k.pose.x_mm + rand() % 1400 + 300, k.pose.y_mm + rand() % 1400 + 300};
        argus_grid_mark(&g, at, true);
        k.pose.x_mm -= 1500;
        k.pose.y_mm -= 1500;
        reads(-1, 0);
        snprintf(text, sizeof text, "seed 1, round %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(1, occupied(), text);
        TEST_ASSERT_TRUE_MESSAGE(is_there(at), text);
        k.pose.x_mm -= ARGUS_GRID_CELLS * ARGUS_GRID_CELL_MM;
        reads(-1, 0);
        TEST_ASSERT_EQUAL_MESSAGE(0, occupied(), text);
        k.pose.x_mm += ARGUS_GRID_CELLS * ARGUS_GRID_CELL_MM;
        reads(-1, 0);
        TEST_ASSERT_EQUAL_MESSAGE(0, occupied(), text);
    }
}

// A long robot's sonar sees beyond the window: what lies on its other side stays as it is.
void test_a_beam_that_leaves_the_window_takes_nothing_back(void) {
    static argus_own_robot_t own;
    argus_robot_t *const row = &own.rows[0];
    *row = *k.robot;
    row->poses = (int16_t)((const char *)own.poses - (const char *)row);
    own.poses[3] = (argus_sonar_pose_t){2900, 0, 0};
    k.robot = row;
    reads(-1, 0);
    for (; k.pose.x_mm < 5000; k.pose.x_mm += 100) { // the window follows late
        reads(-1, 0);
    }
    const argus_cell_t robot = argus_grid_cell((argus_point_t){k.pose.x_mm, 0});
    const int high = g.low.x + ARGUS_GRID_CELLS; // the first cell beyond
    TEST_ASSERT_TRUE((high - robot.x) * ARGUS_GRID_CELL_MM < 2900 + 1000);
    const argus_cell_t wrapped = {high + 1 - ARGUS_GRID_CELLS, robot.y};
    argus_grid_mark(&g, argus_grid_centre(wrapped), false);
    TEST_ASSERT_TRUE(argus_grid_is_occupied(&g, wrapped));
    for (int i = 0; i < 20; i++) {
        reads(3, 3000);
    }
    TEST_ASSERT_TRUE(argus_grid_is_occupied(&g, wrapped));
}

void test_cells_are_rounded_down(void) {
    for (int mm = -3 * ARGUS_GRID_CELL_MM; mm < 3 * ARGUS_GRID_CELL_MM; mm++) {
        const argus_point_t at = {mm, -mm};
        const argus_cell_t cell = argus_grid_cell(at);
        const argus_point_t centre = argus_grid_centre(cell);
        TEST_ASSERT_TRUE(mm >= cell.x * ARGUS_GRID_CELL_MM && mm < (cell.x + 1) * ARGUS_GRID_CELL_MM);
        TEST_ASSERT_TRUE(-mm >= cell.y * ARGUS_GRID_CELL_MM && -mm < (cell.y + 1) * ARGUS_GRID_CELL_MM);
        TEST_ASSERT_INT32_WITHIN(ARGUS_GRID_CELL_MM / 2 + 1, mm, centre.x_mm);
    }
}

// However far and on whichever axis the robot is put elsewhere, nothing of the old place shows there.
void test_a_robot_put_elsewhere_on_one_axis_alone(void) {
    static const argus_point_t by[] = {{100000, 0}, {-100000, 0}, {0, 100000}, {0, -100000}};
    for (size_t i = 0; i < sizeof by / sizeof by[0]; i++) {
        setUp();
        reads(-1, 0);
        argus_grid_mark(&g, (argus_point_t){1000, 1000}, true);
        k.pose.x_mm += by[i].x_mm;
        k.pose.y_mm += by[i].y_mm;
        reads(-1, 0);
        TEST_ASSERT_EQUAL(0, occupied());
        const argus_point_t at = {k.pose.x_mm + 500, k.pose.y_mm - 500};
        argus_grid_mark(&g, at, true);
        TEST_ASSERT_TRUE(is_there(at));
    }
}

// Two echoes of a wall abeam tell where it goes on from 80 mm between them on, and up to 300.
void test_a_wall_goes_on_by_two_echoes_that_lie_apart(void) {
    for (int mm = 70; mm <= 310; mm += 10) {
        setUp();
        reads(0, 300);
        k.pose.x_mm = mm;
        reads(0, 300);
        const argus_point_t last = echo_of(0);
        TEST_ASSERT_EQUAL(mm >= 80 && mm <= 300, is_there((argus_point_t){last.x_mm + 480, last.y_mm}));
    }
}
