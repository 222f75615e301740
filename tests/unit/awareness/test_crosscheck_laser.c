// SPDX-License-Identifier: MIT
// Rule under attack: what a laser returns square to itself, within the cone of a sonar, that sonar hears, or
// something nearer. A laser never contradicts what is nearer, and where it returns nothing it says nothing.
#include "awareness/crosscheck.h"
#include "awareness/evidence.h"
#include "awareness/numbers.h"
#include "robot/table.h"

#include <string.h>

#include "scene.h"
#include "sectors.h"
#include "unity.h"

#define ME 0
#define SECTORS 9
#define FIRST 1 // sector
#define MIDDLE (FIRST + SECTORS / 2)
#define WIDTH_DEG 12
#define AHEAD_MM 100 // where the sonar sits; the laser is in the middle
#define NONE_MM 5000

typedef enum { NOTHING, AGAINST, FOR } verdict_t;

static argus_own_robot_t own;
static argus_knowledge_t k;
static argus_evidence_t e;

// One sonar that looks ahead, and a laser over 108 degrees. A wall stands square, `wall_mm` ahead of the
// laser.
static void begin(int wall_mm) {
    scene_blank(&k, &e);
    sectors_begin(&own, &k, FIRST, SECTORS, WIDTH_DEG);
    own.poses[ME] = (argus_sonar_pose_t){AHEAD_MM, 0, 0};
    k.fresh = (argus_mask_t)((1u << k.sonars) - 1u);
    for (int i = FIRST; i < FIRST + SECTORS; i++) {
        const int off = i > MIDDLE ? i - MIDDLE : MIDDLE - i;
        k.sonar[i].reading_mm = (uint16_t)(wall_mm + wall_mm * off * off * 3 / 100);
        k.sonar[i].health = ARGUS_HEALTHY;
    }
}

void setUp(void) {
    if (!ARGUS_LASER) {
        TEST_IGNORE_MESSAGE("this build takes no laser");
    }
    begin(1500);
}

static verdict_t verdict(int mm) {
    argus_ping_t at = argus_ping_from(k.robot, ME, &k.pose);
    at.t_ms = (uint16_t)(k.sip_ms & 0xFFFFu);
    at.steady = 1;
    at.reading_mm = (uint16_t)mm;
    const int before = e.of[ME].score[ARGUS_TEST_PEERS];
    argus_pings_note(&e.pings[ME], at);
    argus_crosscheck_take(&e, &k, ME);
    const int change = e.of[ME].score[ARGUS_TEST_PEERS] - before;
    return change > 0 ? AGAINST : change < 0 ? FOR : NOTHING;
}

void test_what_it_returns_square_must_be_heard(void) {
    TEST_ASSERT_EQUAL(FOR, verdict(1500 - AHEAD_MM));
    begin(1500);
    TEST_ASSERT_EQUAL(AGAINST, verdict(NONE_MM));
    begin(1500);
    TEST_ASSERT_EQUAL(AGAINST, verdict(2500));
}

void test_the_border_is_the_tolerance_of_an_echo(void) {
    const int mm = 1500 - AHEAD_MM, limit = ARGUS_AGREE_MM + mm * ARGUS_AGREE_PERCENT / 100;
    TEST_ASSERT_EQUAL(FOR, verdict(mm + limit));
    begin(1500);
    TEST_ASSERT_EQUAL(AGAINST, verdict(mm + limit + 1));
    begin(1500);
    TEST_ASSERT_EQUAL(FOR, verdict(mm - limit));
}

// What is nearer may lie below the plane of the scan.
void test_nearer_is_never_contradicted(void) {
    for (int mm = 150; mm < 1250; mm += 110) {
        begin(1500);
        TEST_ASSERT_EQUAL(NOTHING, verdict(mm));
    }
}

void test_a_scan_counts_for_two(void) {
    TEST_ASSERT_EQUAL(AGAINST, verdict(NONE_MM));
    TEST_ASSERT_EQUAL_HEX32(1u << MIDDLE | 1u << (MIDDLE + 1), e.of[ME].against);
}

// The last sector of all has none beside it on one side: the one on the other side counts.
void test_at_the_last_sector_the_one_before_counts(void) {
    const int last = FIRST + SECTORS - 1;
    own.poses[ME].heading_deg = own.poses[last].heading_deg;
    own.poses[ME].x_mm = 0;
    for (int i = FIRST; i <= last; i++) {
        k.sonar[i].reading_mm = (uint16_t)(i == last ? 1500 : 1510 + (last - i) * 40);
    }
    TEST_ASSERT_EQUAL(AGAINST, verdict(NONE_MM));
    TEST_ASSERT_EQUAL_HEX32(1u << last | 1u << (last - 1), e.of[ME].against);
}

// At the rim of the field nothing is known of one side: what comes nearer fast from the other is seen aslant.
void test_a_wall_aslant_at_the_rim_need_not_be_heard(void) {
    const int last = FIRST + SECTORS - 1;
    own.poses[ME].heading_deg = own.poses[last].heading_deg;
    own.poses[ME].x_mm = 0;
    for (int i = FIRST; i <= last; i++) {
        k.sonar[i].reading_mm = (uint16_t)(1500 + (last - i) * 500);
    }
    TEST_ASSERT_EQUAL(NOTHING, verdict(NONE_MM));
}

void test_what_lies_aslant_need_not_be_heard(void) {
    for (int i = FIRST; i < FIRST + SECTORS; i++) {
        k.sonar[i].reading_mm = (uint16_t)(1500 + (i - MIDDLE) * 200); // falls to the left
    }
    TEST_ASSERT_EQUAL(NOTHING, verdict(NONE_MM));
}

void test_where_it_returns_nothing_it_says_nothing(void) {
    for (int i = FIRST; i < FIRST + SECTORS; i++) {
        k.sonar[i].reading_mm = NONE_MM;
    }
    TEST_ASSERT_EQUAL(NOTHING, verdict(NONE_MM));
    begin(1500);
    k.fresh = 1u << ME; // a scan of before
    TEST_ASSERT_EQUAL(NOTHING, verdict(NONE_MM));
    begin(1500);
    for (int i = FIRST; i < FIRST + SECTORS; i++) {
        k.sonar[i].health = ARGUS_DISABLED; // the laser is out
    }
    TEST_ASSERT_EQUAL(NOTHING, verdict(NONE_MM));
}

void test_outside_of_the_cone_behind_or_too_far_it_says_nothing(void) {
    own.poses[ME].heading_deg = 90;
    TEST_ASSERT_EQUAL(NOTHING, verdict(NONE_MM));
    begin(1500);
    own.poses[ME].x_mm = 1600; // the wall of the scan lies behind the transducer
    TEST_ASSERT_EQUAL(NOTHING, verdict(NONE_MM));
    begin(AHEAD_MM + ARGUS_SURE_MM + 50);
    TEST_ASSERT_EQUAL(NOTHING, verdict(NONE_MM));
    begin(AHEAD_MM + ARGUS_NEAREST_MM - 20);
    TEST_ASSERT_EQUAL(NOTHING, verdict(NONE_MM));
}

// Of two returns within the cone the nearer one is asked.
void test_the_nearest_in_the_cone_is_asked(void) {
    k.robot = &own.rows[0];
    own.rows[0].cone_deg = 60; // three sectors now
    k.sonar[MIDDLE + 1].reading_mm = 800;
    TEST_ASSERT_EQUAL(AGAINST, verdict(1500 - AHEAD_MM));
    TEST_ASSERT_EQUAL_HEX32(1u << (MIDDLE + 1) | 1u << (MIDDLE + 2), e.of[ME].against);
}

// A sector is judged by the whole laser, not by its neighbour.
void test_a_sector_is_not_judged_by_sectors(void) {
    argus_ping_t at = argus_ping_from(k.robot, MIDDLE, &k.pose);
    at.t_ms = (uint16_t)(k.sip_ms & 0xFFFFu);
    at.steady = 1;
    at.reading_mm = 4000;
    argus_pings_note(&e.pings[MIDDLE], at);
    argus_crosscheck_take(&e, &k, MIDDLE);
    TEST_ASSERT_EQUAL(0, e.of[MIDDLE].score[ARGUS_TEST_PEERS]);
}

// A transducer that sits far behind the laser hears nothing for sure of what is near to that.
void test_what_is_too_far_from_the_transducer_alone_says_nothing(void) {
    begin(ARGUS_SURE_MM - 200);
    own.poses[ME].x_mm = 0;
    TEST_ASSERT_EQUAL(AGAINST, verdict(NONE_MM));
    begin(ARGUS_SURE_MM - 200);
    own.poses[ME].x_mm = -400;
    TEST_ASSERT_EQUAL(NOTHING, verdict(NONE_MM));
}

// Two sectors that look the same way may have two things as their nearest; but where one returns nothing
// there is nothing.
void test_a_sector_is_contradicted_in_its_silence_alone(void) {
    static const int reads_mm[] = {NONE_MM, 2500};
    for (int i = 0; i < 2; i++) {
        begin(1500);
        own.poses[FIRST + 1] = own.poses[FIRST];
        argus_ping_t at = argus_ping_from(k.robot, FIRST, &k.pose);
        at.t_ms = (uint16_t)(k.sip_ms & 0xFFFFu);
        at.steady = at.weighed = 1;
        at.reading_mm = 1500;
        argus_pings_note(&e.pings[FIRST + 1], at);
        at.weighed = 0;
        at.reading_mm = (uint16_t)reads_mm[i];
        argus_pings_note(&e.pings[FIRST], at);
        argus_crosscheck_take(&e, &k, FIRST);
        TEST_ASSERT_EQUAL(i == 0, e.of[FIRST].score[ARGUS_TEST_PEERS] > 0);
    }
}

// A sector bears a sonar out as a whole scan does, never as one of the ring, and no sonar a sector.
void test_sonars_and_sectors_are_no_witnesses_of_each_other(void) {
    TEST_ASSERT_FALSE(argus_crosscheck_is_witness(&e, &k, FIRST, ME));
    TEST_ASSERT_FALSE(argus_crosscheck_is_witness(&e, &k, ME, FIRST));
    TEST_ASSERT_TRUE(argus_crosscheck_is_witness(&e, &k, FIRST, MIDDLE));
}
