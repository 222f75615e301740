// SPDX-License-Identifier: MIT
// Rule under attack: an array whose ranges along the way do not change as the way does is no witness,
// whatever its sonars say together; one slant thing, a turn, or an odometry that is off itself takes no
// witness away.
#include "awareness/scale.h"

#include "awareness/crosscheck.h"
#include "scene.h"
#include "unity.h"

#define STEP_MM 100
#define PINGS 5 // make a measure: along an axis that is 10 degrees off the way it is a little less
#define MEASURES 8
#define AHEAD 3
#define BESIDE_IT 4
#define BACK 11
#define OTHER 9 // of the rear array, looks elsewhere

static argus_knowledge_t k;
static argus_evidence_t e;
static int way_mm;
static int heading_cdeg;

void setUp(void) {
    scene_blank(&k, &e);
    way_mm = 0;
    heading_cdeg = 0;
}

static void read_at(int sonar, int range_mm) {
    const argus_pose_t pose = {.x_mm = way_mm, .heading_cdeg = heading_cdeg};
    argus_ping_t now = argus_ping_from(k.robot, sonar, &pose);
    now.reading_mm = (uint16_t)range_mm;
    argus_scale_take(&e, &k, sonar, &now);
    argus_pings_note(&e.pings[sonar], now);
}

// Drives up to a wall, and again; ranges ahead and back come to so many percent of what they should.
static void drive(int measures, int ahead_percent, int beside_percent, int back_percent) {
    const int from_mm = way_mm;
    for (int n = 0; n <= measures * PINGS; n++) {
        const int gone_mm = (way_mm - from_mm) % 2100;
        read_at(AHEAD, 2500 - gone_mm * ahead_percent / 100);
        read_at(BESIDE_IT, 2500 - gone_mm * beside_percent / 100);
        read_at(BACK, 500 + gone_mm * back_percent / 100);
        way_mm += STEP_MM;
    }
}

static bool is_witness(int sonar) {
    return argus_crosscheck_is_witness(&e, &k, sonar, OTHER);
}

void test_an_array_that_is_off_to_either_side_is_no_witness(void) {
    static const int percent[] = {60, 80, 85, 115, 125};
    for (unsigned i = 0; i < sizeof percent / sizeof *percent; i++) {
        setUp();
        drive(MEASURES, percent[i], percent[i], 100);
        for (int sonar = 0; sonar < 8; sonar++) {
            TEST_ASSERT_FALSE(is_witness(sonar));
        }
        TEST_ASSERT_TRUE(is_witness(BACK));
        drive(2, 100, 100, 100);
        TEST_ASSERT_TRUE_MESSAGE(is_witness(AHEAD), "one that fits ends it");
        TEST_ASSERT_TRUE(is_witness(0));
    }
}

void test_what_fits_within_a_tenth_is_a_witness(void) {
    for (int percent = 93; percent <= 107; percent++) {
        setUp();
        drive(4 * MEASURES, percent, percent, 100);
        TEST_ASSERT_EQUAL_HEX16(0, e.off_scale);
    }
}

void test_one_that_is_off_is_one(void) {
    drive(MEASURES, 80, 100, 100);
    TEST_ASSERT_EQUAL_HEX16(1u << AHEAD, e.off_scale);
}

// Two neighbours that others of their array contradict have failed, the array has not.
void test_two_neighbours_are_two(void) {
    e.of[AHEAD].against = e.of[BESIDE_IT].against = (argus_mask_t)(1u << 2 | 1u << 5);
    drive(MEASURES, 80, 80, 100);
    TEST_ASSERT_EQUAL_HEX16(1u << AHEAD | 1u << BESIDE_IT, e.off_scale);
}

void test_where_all_are_off_the_odometry_is(void) {
    drive(4 * MEASURES, 80, 80, 80);
    TEST_ASSERT_EQUAL_HEX16(0, e.off_scale);
}

// What was never measured back there keeps to nothing.
void test_without_another_array_nothing_is_known(void) {
    for (int n = 0; n < 40; n++) {
        const int gone_mm = way_mm % 2000;
        read_at(AHEAD, 2500 - gone_mm * 80 / 100);
        read_at(BESIDE_IT, 2500 - gone_mm * 80 / 100);
        way_mm += STEP_MM;
    }
    TEST_ASSERT_EQUAL_HEX16(0, e.off_scale);
}

void test_a_few_measures_are_a_slant_thing(void) {
    drive(3, 70, 70, 100);
    TEST_ASSERT_EQUAL_HEX16(0, e.off_scale);
}

void test_a_turn_ends_a_stretch(void) {
    for (int n = 0; n < 80; n++) {
        heading_cdeg = n % 2 * 200;
        const int gone_mm = way_mm % 2000;
        read_at(AHEAD, 2500 - gone_mm * 80 / 100);
        read_at(BESIDE_IT, 2500 - gone_mm * 80 / 100);
        read_at(BACK, 500 + gone_mm);
        way_mm += STEP_MM;
    }
    TEST_ASSERT_EQUAL_HEX16(0, e.off_scale);
}

// What it alone has said is taken back, as of one that is given up.
void test_what_they_said_is_taken_back(void) {
    e.of[OTHER].against = (argus_mask_t)(1u << 0 | 1u << 7);
    e.of[OTHER].score[ARGUS_TEST_PEERS] = 900;
    drive(MEASURES, 80, 80, 100);
    TEST_ASSERT_EQUAL(0, e.of[OTHER].score[ARGUS_TEST_PEERS]);
    TEST_ASSERT_EQUAL_HEX16(0, e.of[OTHER].against);
}
