// SPDX-License-Identifier: MIT
// Rule under attack: a sonar is held to what a laser returns only where it must hear that: a wall whose foot
// lies well within its cone, a thing that stands out wholly within it; never what is behind, faint or not of
// now.
#include "awareness/scan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "awareness/numbers.h"
#include "knowledge/angle.h"
#include "robot/table.h"
#include "sectors.h"
#include "unity.h"

#define SECTORS 15
#define WIDTH_DEG 12
#define SONAR 0
#define FIRST 1
#define PI 3.14159265358979

static argus_own_robot_t own;
static argus_knowledge_t k;

void setUp(void) {
    if (!ARGUS_LASER) {
        TEST_IGNORE_MESSAGE("this build takes no laser");
    }
    memset(&k, 0, sizeof k);
    sectors_begin(&own, &k, FIRST, SECTORS, WIDTH_DEG);
    k.fresh = ~(argus_mask_t)0;
}

void tearDown(void) {
}

static int sector_at(double deg) {
    return FIRST + SECTORS / 2 - (int)lround(deg / WIDTH_DEG);
}

// Each sector returns the nearest of a wall whose foot is there; nothing beyond `wide_deg` to both sides.
static void see_wall(double foot_deg, double mm, double wide_deg) {
    for (int i = FIRST; i < FIRST + SECTORS; i++) {
        double nearest = ARGUS_NO_ECHO_MM;
        for (double beam = -WIDTH_DEG / 2.0; beam <= WIDTH_DEG / 2.0; beam += 1.0) {
            const double off = argus_robot_pose(k.robot, i).heading_deg + beam - foot_deg;
            if (fabs(off) < 80 && fabs(off) <= wide_deg) {
                nearest = fmin(nearest, mm / cos(off * PI / 180));
            }
        }
        k.sonar[i].reading_mm = (uint16_t)nearest;
    }
}

static int32_t aside_of(int sector) {
    int32_t aside_cdeg = 0;
    TEST_ASSERT_EQUAL_INT(ARGUS_SHAPE_WALL, argus_scan_shape(&k, sector, &aside_cdeg));
    return aside_cdeg;
}

void test_the_foot_of_a_wall_is_placed_to_within_two_degrees(void) {
    int placed = 0;
    for (int mm = 400; mm <= 3600; mm += 200) {
        for (int foot = -70; foot <= 70; foot++) {
            const int off = abs(foot) % WIDTH_DEG;
            if (off == WIDTH_DEG / 2 || off == WIDTH_DEG / 2 - 1 || off == WIDTH_DEG / 2 + 1) {
                continue; // two sectors share it
            }
            see_wall(foot, mm, 90);
            const int at = sector_at(foot);
            const int32_t found = argus_robot_pose(k.robot, at).heading_deg * 100 + aside_of(at);
            TEST_ASSERT_INT_WITHIN(200, foot * 100, found);
            placed++;
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(1000, placed);
}

// The last sector has one beside it only. A foot beyond its rim is placed, too: up to 3 degrees.
void test_at_the_rim_of_the_field_two_sectors_place_it(void) {
    for (int side = -1; side <= 1; side += 2) {
        for (int foot = 80; foot <= 93; foot++) {
            see_wall(side * foot, 1500, 90);
            const int at = side > 0 ? FIRST : FIRST + SECTORS - 1;
            const int32_t found = argus_robot_pose(k.robot, at).heading_deg * 100 + aside_of(at);
            TEST_ASSERT_INT_WITHIN(250, side * foot * 100, found);
        }
    }
}

// A thing as wide as a sector or less is no wall; at the rim nothing can be told of it.
void test_what_stands_out_is_an_edge(void) {
    int32_t aside_cdeg = 7;
    see_wall(0, 1000, 3);
    TEST_ASSERT_EQUAL_INT(ARGUS_SHAPE_EDGE, argus_scan_shape(&k, sector_at(0), &aside_cdeg));
    TEST_ASSERT_EQUAL_INT32(0, aside_cdeg);
    see_wall(85, 1000, 2);
    TEST_ASSERT_EQUAL_INT(ARGUS_SHAPE_NONE, argus_scan_shape(&k, FIRST, &aside_cdeg));
}

static int heard(int sonar_deg, int32_t *mm) {
    own.poses[SONAR].heading_deg = (int16_t)sonar_deg;
    *mm = 0;
    return argus_scan_heard(&k, SONAR, mm);
}

void test_a_wall_is_heard_well_within_the_cone_only(void) {
    int32_t mm = 0;
    see_wall(0, 1500, 90);
    for (int off = -30; off <= 30; off++) {
        const int sector = heard(off, &mm);
        if (abs(off) <= 9) {
            TEST_ASSERT_EQUAL_INT(sector_at(0), sector);
            TEST_ASSERT_INT_WITHIN(5, 1500, mm);
        } else if (abs(off) >= 11) {
            TEST_ASSERT_EQUAL_INT(-1, sector);
        }
    }
}

// Where in its sector an edge is nobody knows.
void test_an_edge_is_heard_where_its_whole_sector_is_within_the_cone(void) {
    int32_t mm = 0;
    see_wall(2, 1500, 2);
    for (int off = -30; off <= 30; off++) {
        TEST_ASSERT_EQUAL_INT(abs(off) <= 4 ? sector_at(0) : -1, heard(off, &mm));
    }
}

void test_the_nearest_that_must_be_heard_counts(void) {
    int32_t mm = 0;
    see_wall(0, 2500, 90);
    k.sonar[sector_at(24)].reading_mm = 900; // beside: a faint edge, at most
    TEST_ASSERT_EQUAL_INT(sector_at(0), heard(8, &mm));
    TEST_ASSERT_INT_WITHIN(10, 2500, mm);
    k.sonar[sector_at(0)].reading_mm = 1200;
    TEST_ASSERT_EQUAL_INT(sector_at(0), heard(2, &mm));
    TEST_ASSERT_INT_WITHIN(10, 1200, mm);
}

void test_what_is_not_of_now_or_out_or_too_far_or_near_is_not_heard(void) {
    int32_t mm = 0;
    see_wall(0, 1500, 90);
    k.fresh &= ~(argus_mask_t)(1u << sector_at(0));
    TEST_ASSERT_EQUAL_INT(-1, heard(0, &mm));
    k.fresh = ~(argus_mask_t)0;
    k.sonar[sector_at(0)].health = ARGUS_DISABLED;
    TEST_ASSERT_EQUAL_INT(-1, heard(0, &mm));
    k.sonar[sector_at(0)].health = ARGUS_HEALTHY;
    TEST_ASSERT_EQUAL_INT(sector_at(0), heard(0, &mm));
    see_wall(0, ARGUS_SURE_MM + 100, 90);
    TEST_ASSERT_EQUAL_INT(-1, heard(0, &mm));
    see_wall(0, ARGUS_NEAREST_MM - 20, 90);
    TEST_ASSERT_EQUAL_INT(-1, heard(0, &mm));
    see_wall(0, 1500, 90);
    TEST_ASSERT_EQUAL_INT(-1, heard(180, &mm));
}

static argus_shape_t shape_of(const int sector, const int mm, const int left_mm, const int right_mm) {
    int32_t aside_cdeg = 0;
    for (int i = FIRST; i < FIRST + SECTORS; i++) {
        k.sonar[i].reading_mm = ARGUS_NO_ECHO_MM;
    }
    k.sonar[sector].reading_mm = (uint16_t)mm;
    k.sonar[sector - 1].reading_mm = (uint16_t)left_mm;
    k.sonar[sector + 1].reading_mm = (uint16_t)right_mm;
    return argus_scan_shape(&k, sector, &aside_cdeg);
}

// A wall is seen on either side; where one of them returns nothing it is an edge, whichever that is.
void test_a_wall_takes_a_return_on_either_side(void) {
    const int at = sector_at(0);
    TEST_ASSERT_EQUAL(ARGUS_SHAPE_WALL, shape_of(at, 1500, 1530, 1530));
    TEST_ASSERT_EQUAL(ARGUS_SHAPE_EDGE, shape_of(at, 1500, ARGUS_NO_ECHO_MM, 1530));
    TEST_ASSERT_EQUAL(ARGUS_SHAPE_EDGE, shape_of(at, 1500, 1530, ARGUS_NO_ECHO_MM));
    TEST_ASSERT_EQUAL(ARGUS_SHAPE_NONE, shape_of(at, 1500, 1499, 1530));
    TEST_ASSERT_EQUAL(ARGUS_SHAPE_NONE, shape_of(at, 1500, 1530, 1499));
}

// At the rim it takes both beside it, that grow as a wall's do.
void test_at_the_rim_both_beside_it_must_be_of_the_wall(void) {
    static const struct {
        int mm, next_mm, second_mm;
        argus_shape_t shape;
    } rows[] = {{1500, 1530, 1630, ARGUS_SHAPE_WALL},
                {1500, ARGUS_NO_ECHO_MM, 1630, ARGUS_SHAPE_NONE},
                {1500, 1530, ARGUS_NO_ECHO_MM, ARGUS_SHAPE_NONE},
                {1500, 1530, 2300, ARGUS_SHAPE_NONE},  // the foot would lie far beyond the rim
                {1500, 1800, 1800, ARGUS_SHAPE_NONE},  // ... far within
                {1200, 1530, 1630, ARGUS_SHAPE_NONE}}; // it stands before the wall
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        for (int side = 0; side < 2; side++) {
            int32_t aside_cdeg = 0;
            const int at = side == 0 ? FIRST : FIRST + SECTORS - 1;
            const int inwards = side == 0 ? 1 : -1;
            k.sonar[at].reading_mm = (uint16_t)rows[i].mm;
            k.sonar[at + inwards].reading_mm = (uint16_t)rows[i].next_mm;
            k.sonar[at + 2 * inwards].reading_mm = (uint16_t)rows[i].second_mm;
            TEST_ASSERT_EQUAL(rows[i].shape, argus_scan_shape(&k, at, &aside_cdeg));
        }
    }
}

// Of two things that it must hear it hears the nearer, whichever is listed first.
void test_of_two_edges_the_nearer_is_heard(void) {
    for (int nearer = 0; nearer < 2; nearer++) {
        int32_t mm = 0;
        for (int i = FIRST; i < FIRST + SECTORS; i++) {
            k.sonar[i].reading_mm = ARGUS_NO_ECHO_MM;
        }
        own.poses[SONAR].x_mm = -3000; // so far behind that both lie well within its cone
        const int first = sector_at(WIDTH_DEG), second = sector_at(-WIDTH_DEG);
        k.sonar[first].reading_mm = nearer == 0 ? 800 : 900;
        k.sonar[second].reading_mm = nearer == 0 ? 900 : 800;
        TEST_ASSERT_EQUAL(nearer == 0 ? first : second, heard(0, &mm));
    }
}

// A laser alone: its first sector is the robot's first sensor.
void test_a_robot_without_sonars_has_a_rim_too(void) {
    int32_t aside_cdeg = 0;
    sectors_begin(&own, &k, 0, SECTORS, WIDTH_DEG);
    k.sonar[0].reading_mm = 1500;
    k.sonar[1].reading_mm = 1530;
    k.sonar[2].reading_mm = 1630;
    TEST_ASSERT_EQUAL(ARGUS_SHAPE_WALL, argus_scan_shape(&k, 0, &aside_cdeg));
}
