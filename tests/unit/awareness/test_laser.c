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
