// SPDX-License-Identifier: MIT
// Rule under attack: what is wrong with a laser as a whole is found by its scans and the way alone, and a
// healthy one is left alone.
#include "awareness/evidence.h"
#include "awareness/laser.h"

#include <math.h>
#include <string.h>

#include "robot/table.h"
#include "sectors.h"
#include "unity.h"

#define SECTORS 15
#define WIDTH_DEG 12
#define STEP_MS 100
#define LATE 10 // scans
#define HOLD 64
#define PI 3.14159265358979

static argus_own_robot_t own;
static argus_knowledge_t k;
static argus_laser_t laser;
static double x, y, th; // mm, radians
static double scale, turned_deg, cut_mm;
static int late;
static bool frozen, dark;
static uint16_t past[HOLD][SECTORS];
static int taken;
static unsigned seed;

void setUp(void) {
    if (!ARGUS_LASER) {
        TEST_IGNORE_MESSAGE("this build takes no laser");
    }
    memset(&k, 0, sizeof k);
    sectors_begin(&own, &k, 0, SECTORS, WIDTH_DEG);
    k.fresh = (argus_mask_t)((1u << SECTORS) - 1);
    k.sip_ms = 1000;
    memset(&laser, 0, sizeof laser);
    x = y = 0, th = 0.35;
    scale = 1, turned_deg = 0, cut_mm = 5000, late = 0, frozen = dark = false;
    taken = 0;
    seed = 46;
}

static double noise(void) {
    seed = seed * 1103515245u + 12345u;
    return (double)(seed >> 16 & 31u) - 15.5;
}

// A room of 7 by 5 m with a box in a corner, by its walls.
static double ray(double bearing) {
    static const double wall[][4] = {{-2000, -1500, 5000, -1500}, {5000, -1500, 5000, 3500},
                                     {5000, 3500, -2000, 3500},   {-2000, 3500, -2000, -1500},
                                     {3500, 2500, 5000, 2500},    {3500, 2500, 3500, 3500}};
    double nearest = 9000;
    for (unsigned i = 0; i < sizeof wall / sizeof wall[0]; i++) {
        const double ex = wall[i][2] - wall[i][0], ey = wall[i][3] - wall[i][1];
        const double cross = cos(bearing) * ey - sin(bearing) * ex;
        const double px = wall[i][0] - x, py = wall[i][1] - y;
        const double far = (px * ey - py * ex) / cross;
        const double along = (px * sin(bearing) - py * cos(bearing)) / cross;
        if (fabs(cross) > 1e-9 && far > 0 && along >= 0 && along <= 1 && far < nearest) {
            nearest = far;
        }
    }
    return nearest;
}

static void see(uint16_t mm[SECTORS]) {
    for (int i = 0; i < SECTORS; i++) {
        const double middle = argus_robot_pose(k.robot, i).heading_deg + turned_deg;
        double nearest = 9000;
        for (int beam = -WIDTH_DEG / 2; beam <= WIDTH_DEG / 2; beam++) {
            nearest = fmin(nearest, ray(th + (middle + beam) * PI / 180) + noise());
        }
        nearest *= scale;
        mm[i] = (uint16_t)(dark || nearest >= cut_mm || nearest >= 5000 ? 5000 : nearest);
    }
}

static void step(double mm, double deg) {
    th += deg * PI / 180;
    x += mm * cos(th);
    y += mm * sin(th);
    k.sip_ms += STEP_MS;
    k.odometer_mm += (uint32_t)fabs(mm);
    k.pose = (argus_pose_t){(int32_t)x, (int32_t)y, (int32_t)(fmod(th * 180 / PI + 540, 360) * 100) - 18000};
    if (!frozen || taken == 0) {
        see(past[taken % HOLD]);
        taken++;
    }
    const int shown = taken - 1 - (late < taken ? late : taken - 1);
    for (int i = 0; i < SECTORS; i++) {
        k.sonar[i].reading_mm = past[shown % HOLD][i];
    }
    argus_laser_sip(&laser, &k);
}

// Round the room; how many steps until something is found, or all of them.
static int drive(int legs) {
    int steps = 0;
    for (int leg = 0; leg < legs; leg++) {
        for (int n = 0; n < 60 + 10 * (leg % 3); n++, steps++) {
            step(30, n % 20 < 10 ? 0.3 : -0.3);
            if (laser.news) {
                return steps;
            }
        }
        for (int n = 0; n < 20; n++, steps++) {
            step(0, 4.2);
            if (laser.news) {
                return steps;
            }
        }
    }
    return steps;
}

static void finds(argus_scan_fault_t fault, argus_fault_kind_t kind, int within) {
    const int steps = drive(10);
    TEST_ASSERT_EQUAL(fault, laser.fault);
    TEST_ASSERT_EQUAL(kind, argus_laser_kind(&laser));
    TEST_ASSERT_LESS_OR_EQUAL(within, steps);
}

void test_a_healthy_one_is_left_alone(void) {
    drive(24);
    TEST_ASSERT_EQUAL(ARGUS_SCAN_SOUND, laser.fault);
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_laser_kind(&laser));
}

void test_one_that_is_frozen_is_found_and_thaws(void) {
    drive(1);
    frozen = true;
    finds(ARGUS_SCAN_FROZEN, ARGUS_KIND_STUCK, 15);
    frozen = false;
    drive(1);
    TEST_ASSERT_EQUAL(ARGUS_SCAN_SOUND, laser.fault);
}

void test_a_robot_at_rest_tells_of_no_frozen_scan(void) {
    frozen = true;
    for (int n = 0; n < 300; n++) {
        step(0, 0);
    }
    TEST_ASSERT_EQUAL(ARGUS_SCAN_SOUND, laser.fault);
}

void test_one_without_any_return_is_found_where_things_were_near(void) {
    drive(1);
    dark = true;
    finds(ARGUS_SCAN_DARK, ARGUS_KIND_OFF, 15);
}

void test_nothing_in_range_from_the_first_is_no_fault(void) {
    dark = true;
    drive(4);
    TEST_ASSERT_EQUAL(ARGUS_SCAN_SOUND, laser.fault);
}

void test_one_that_is_late_is_found_in_turns(void) {
    drive(1);
    late = LATE;
    finds(ARGUS_SCAN_LATE, ARGUS_KIND_SLOW, 400);
}

void test_one_that_is_turned_is_found(void) {
    for (int side = -1; side <= 1; side += 2) {
        setUp();
        turned_deg = side * 10;
        finds(ARGUS_SCAN_TURNED, ARGUS_KIND_WRONG, 600);
    }
}

void test_one_that_is_scaled_is_found(void) {
    static const double scales[] = {0.9, 1.1};
    for (unsigned i = 0; i < 2; i++) {
        setUp();
        scale = scales[i];
        finds(ARGUS_SCAN_SCALED, ARGUS_KIND_WRONG, 600);
    }
}

void test_one_that_sees_no_farther_than_two_metres_is_found(void) {
    cut_mm = 2000;
    finds(ARGUS_SCAN_CUT, ARGUS_KIND_WRONG, 600);
}

void test_half_a_scan_is_none(void) {
    k.fresh = (argus_mask_t)(k.fresh & 0xFFu);
    frozen = true;
    drive(4);
    TEST_ASSERT_EQUAL(ARGUS_SCAN_SOUND, laser.fault);
}

// One that is dark, and sees again, is sound; what was found first stays until it ends.
void test_one_that_sees_again_is_sound(void) {
    drive(1);
    dark = true;
    finds(ARGUS_SCAN_DARK, ARGUS_KIND_OFF, 15);
    frozen = true; // a dark scan that stays as it is
    drive(1);
    TEST_ASSERT_EQUAL(ARGUS_SCAN_DARK, laser.fault);
    dark = frozen = false;
    drive(1);
    TEST_ASSERT_EQUAL(ARGUS_SCAN_SOUND, laser.fault);
}

// Turning in place shows a frozen scan as well as driving does.
void test_one_that_is_frozen_is_found_in_a_turn_on_the_spot(void) {
    drive(1);
    frozen = true;
    for (int n = 0; n < 100 && !laser.news; n++) {
        step(0, 4);
    }
    TEST_ASSERT_EQUAL(ARGUS_SCAN_FROZEN, laser.fault);
}

// More walls than are followed at a time crowd none out, and nothing is made of those that are left out.
void test_with_more_walls_than_are_followed_a_healthy_one_is_left_alone(void) {
    for (int i = 0; i < ARGUS_SCAN_WALLS; i++) {
        laser.wall[i] = (argus_wall_t){.scans = 1, .last_mm = 4900, .bearing_cdeg = 17000};
    }
    drive(12);
    TEST_ASSERT_EQUAL(ARGUS_SCAN_SOUND, laser.fault);
}

// A way ahead towards a single wall tells of the scale alone, and only where it is well off.
void test_ahead_of_one_wall_the_scale_is_found_where_it_is_well_off(void) {
    static const struct {
        double scale;
        bool found;
    } by[] = {{0.8, true}, {1.0, false}, {0.96, false}};
    for (size_t i = 0; i < sizeof by / sizeof by[0]; i++) {
        setUp();
        th = 0;
        scale = by[i].scale;
        for (int back = 0; back < 40 && !laser.news; back++) {
            for (int n = 0; n < 60 && !laser.news; n++) {
                step(back % 2 == 0 ? 30 : -30, 0);
            }
        }
        TEST_ASSERT_EQUAL(by[i].found, laser.fault == ARGUS_SCAN_SCALED);
        TEST_ASSERT_TRUE(by[i].found || laser.fault == ARGUS_SCAN_SOUND);
    }
}

// What is found of the whole is forgotten with any of its sectors, and with no sonar beside them.
void test_a_retest_of_a_sector_is_one_of_the_laser(void) {
#if ARGUS_LASER
    static argus_evidence_t evidence;
    evidence.laser.sectors = (argus_mask_t)0xFF00u;
    evidence.laser.fault = ARGUS_SCAN_FROZEN;
    evidence.laser.count = 3;
    argus_evidence_forget(&evidence, 3);
    TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, argus_evidence_laser(&evidence, 9));
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_evidence_laser(&evidence, 3));
    argus_evidence_forget(&evidence, 9);
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_evidence_laser(&evidence, 9));
    TEST_ASSERT_EQUAL(0, evidence.laser.count);
#endif
}

// What the sectors read is given; one of them varies, so that the scan is not frozen.
static void show(const uint16_t mm[SECTORS], const int32_t heading_cdeg) {
    k.sip_ms += STEP_MS;
    k.pose.heading_cdeg = heading_cdeg;
    for (int i = 0; i < SECTORS; i++) {
        k.sonar[i].reading_mm = mm[i];
    }
    k.sonar[SECTORS - 1].reading_mm = (uint16_t)(3000 + k.sip_ms / STEP_MS % 2);
    argus_laser_sip(&laser, &k);
}

static void nothing_in(uint16_t mm[SECTORS]) {
    for (int i = 0; i < SECTORS; i++) {
        mm[i] = ARGUS_NO_ECHO_MM;
    }
}

// A wall whose foot is in the middle of the second sector, 72 degrees to the left.
static void wall_in(uint16_t mm[SECTORS], const int at_mm) {
    nothing_in(mm);
    mm[1] = (uint16_t)at_mm;
    mm[0] = mm[2] = (uint16_t)(at_mm + at_mm / 50);
}

// So many steps of 50 mm along x while that wall, square to the left, recedes by so much each.
static void pass_wall(const int steps, const int from_mm, const int recedes_mm) {
    for (int n = 0; n <= steps; n++) {
        uint16_t mm[SECTORS];
        wall_in(mm, from_mm + n * recedes_mm);
        k.pose.x_mm = 50 * n;
        show(mm, 1800);
    }
}

// A wall abeam tells of the axis alone: its range says nothing of the scale, not even to divide by.
void test_a_wall_abeam_tells_nothing_of_the_scale(void) {
    pass_wall(8, 1500, 0);
    TEST_ASSERT_GREATER_THAN(0, laser.slopes.tt);
    TEST_ASSERT_EQUAL(0, laser.slopes.cc);
    TEST_ASSERT_EQUAL(ARGUS_SCAN_SOUND, laser.fault);
}

// It stands: a range that changes by more than part of the way is of something else.
void test_what_recedes_faster_than_the_way_is_no_wall(void) {
    pass_wall(8, 1500, 10); // a fifth of the way
    TEST_ASSERT_GREATER_THAN(0, laser.slopes.tt);
    setUp();
    pass_wall(8, 1500, 30);
    TEST_ASSERT_EQUAL(0, laser.slopes.tt);
}

void test_a_wall_that_is_too_near_is_not_followed(void) {
    for (int near = 0; near < 2; near++) {
        setUp();
        pass_wall(1, ARGUS_SCAN_WALL_LEAST_MM - near, 0);
        int followed = 0;
        for (int i = 0; i < ARGUS_SCAN_WALLS; i++) {
            followed += laser.wall[i].scans > 0 ? 1 : 0;
        }
        TEST_ASSERT_EQUAL(1 - near, followed);
    }
}

// Two scans of which less than half overlap cannot be compared, to either side.
void test_scans_that_hardly_overlap_tell_of_no_lag(void) {
    for (int side = -1; side <= 1; side += 2) {
        for (int sectors = 7; sectors <= 8; sectors++) {
            setUp();
            int compared = 0;
            for (int n = 0; n < 30; n++) {
                uint16_t mm[SECTORS];
                wall_in(mm, 2000);
                show(mm, n < 15 ? 0 : side * sectors * WIDTH_DEG * 100);
                compared += laser.misfit[0].scans;
            }
            TEST_ASSERT_EQUAL(sectors == 7, compared > 0);
        }
    }
}

// Returns that end at one range: often, far more often than anywhere nearer, and none from beyond.
void test_a_cut_takes_each_of_its_signs(void) {
    static const struct {
        uint8_t edges, inner;
        uint16_t most_mm;
        uint32_t way_mm;
        bool found;
    } rows[] = {{10, 2, 3999, 3000, true}, {9, 2, 3999, 3000, false},  {10, 3, 3999, 3000, false},
                {12, 3, 3999, 3000, true}, {10, 2, 4000, 3000, false}, {10, 2, 3999, 2999, false},
                {10, 0, 3500, 3500, true}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        uint16_t mm[SECTORS];
        setUp();
        wall_in(mm, 1000);
        show(mm, 0);
        laser.edges = rows[i].edges;
        laser.inner = rows[i].inner;
        laser.most_mm = rows[i].most_mm;
        k.odometer_mm += rows[i].way_mm;
        show(mm, 0);
        TEST_ASSERT_EQUAL(rows[i].found, laser.fault == ARGUS_SCAN_CUT);
        TEST_ASSERT_EQUAL(rows[i].way_mm < 3000 ? rows[i].edges : 0, laser.edges); // a stretch begins anew
    }
}
