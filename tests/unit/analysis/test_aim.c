// SPDX-License-Identifier: MIT
// Rule under attack (profile argus): a sonar is only ever turned onto what another one, that is relied on,
// lately heard near by from the same place.
#include "analysis/aim.h"

#include "awareness/evidence.h"
#include "knowledge/angle.h"
#include "scene.h"
#include "unity.h"

static argus_knowledge_t k;
static argus_evidence_t e;
static int32_t aim_cdeg;

void setUp(void) {
    scene_blank(&k, &e);
}

static argus_ping_t *heard(int sonar, int mm, uint32_t age_ms) {
    argus_ping_t at = argus_ping_from(k.robot, sonar, &k.pose);
    at.t_ms = (uint16_t)((k.sip_ms - age_ms) & 0xFFFFu);
    at.reading_mm = (uint16_t)mm;
    argus_pings_note(&e.pings[sonar], at);
    return argus_pings_mark(&e.pings[sonar], 1);
}

static bool aims(int sonar) {
    aim_cdeg = INT32_MIN;
    const bool found = argus_aim(&e, &k, sonar, &aim_cdeg);
    TEST_ASSERT_TRUE(!found || (aim_cdeg > -18000 && aim_cdeg <= 18000));
    return found;
}

// 3 looks to +10 degrees, 4 to -10: on -20 it looks where 4 does now.
void test_it_looks_along_the_bearing_that_another_has_heard_on(void) {
    for (int32_t heading = -17990; heading <= 18000; heading += 1310) {
        setUp();
        k.pose = (argus_pose_t){70000, -70000, heading};
        heard(4, 1200, 0);
        TEST_ASSERT_TRUE(aims(3));
        TEST_ASSERT_EQUAL_INT32(argus_angle_wrap(heading - 2000), aim_cdeg);
    }
}

void test_there_is_no_aim_at_what_is_old_far_elsewhere_or_its_own(void) {
    TEST_ASSERT_FALSE(aims(3));
    heard(3, 1200, 0);
    TEST_ASSERT_FALSE(aims(3));
    setUp();
    heard(4, 5000, 0);
    TEST_ASSERT_FALSE(aims(3));
    setUp();
    heard(4, 4600, 0);
    TEST_ASSERT_FALSE(aims(3));
    setUp();
    heard(4, 1200, 15000);
    TEST_ASSERT_FALSE(aims(3));
    setUp();
    heard(4, 1200, 0)->x_mm += 500;
    TEST_ASSERT_FALSE(aims(3));
}

void test_one_that_is_doubted_or_out_is_no_witness(void) {
    heard(4, 1200, 0);
    e.of[4].score[ARGUS_TEST_GARBAGE] = 1000;
    TEST_ASSERT_FALSE(aims(3));
    e.of[4].score[ARGUS_TEST_GARBAGE] = 0;
    k.sonar[4].health = ARGUS_DISABLED;
    TEST_ASSERT_FALSE(aims(3));
    k.sonar[4].health = ARGUS_HEALTHY;
    TEST_ASSERT_TRUE(aims(3));
}

// Of two like turns it takes the nearer thing, of two like things the lesser turn.
void test_it_takes_the_nearer_and_the_lesser(void) {
    heard(4, 1500, 0);
    heard(2, 1200, 0);
    TEST_ASSERT_TRUE(aims(3));
    TEST_ASSERT_EQUAL_INT32(2000, aim_cdeg);
    setUp();
    heard(4, 1200, 0);
    heard(1, 1200, 0);
    TEST_ASSERT_TRUE(aims(3));
    TEST_ASSERT_EQUAL_INT32(-2000, aim_cdeg);
}

// Where it has lately looked itself, there is nothing new.
void test_it_is_not_turned_onto_what_it_has_looked_at(void) {
    heard(4, 1200, 0);
    TEST_ASSERT_TRUE(aims(3));
    k.pose.heading_cdeg = aim_cdeg;
    heard(3, 5000, 0);
    k.pose.heading_cdeg = 0;
    TEST_ASSERT_FALSE(aims(3));
}

// What sonar 4 heard where 3 would look after such a turn, from just there.
static argus_ping_t *heard_after(const int32_t turn_cdeg, const int mm, const uint32_t age_ms) {
    argus_pose_t turned = k.pose;
    turned.heading_cdeg = argus_angle_wrap(turned.heading_cdeg + turn_cdeg);
    argus_ping_t at = argus_ping_from(k.robot, 3, &turned);
    at.t_ms = (uint16_t)((k.sip_ms - age_ms) & 0xFFFFu);
    at.reading_mm = (uint16_t)mm;
    argus_pings_note(&e.pings[4], at);
    return argus_pings_mark(&e.pings[4], 1);
}

void test_each_bound_of_what_is_worth_a_turn(void) {
    static const struct {
        int32_t turn_cdeg;
        int mm;
        uint32_t age_ms;
        bool worth;
    } rows[] = {{2000, 250, 0, true},    {2000, 249, 0, false},     {2000, 4400, 0, true},
                {2000, 4401, 0, false},  {2000, 1200, 10000, true}, {2000, 1200, 10001, false},
                {300, 1200, 0, true},    {299, 1200, 0, false},     {-300, 1200, 0, true},
                {10000, 1200, 0, true},  {10001, 1200, 0, false},   {-10000, 1200, 0, true},
                {-10001, 1200, 0, false}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        heard_after(rows[i].turn_cdeg, rows[i].mm, rows[i].age_ms);
        TEST_ASSERT_EQUAL(rows[i].worth, aims(3));
        TEST_ASSERT_TRUE(!rows[i].worth || aim_cdeg == rows[i].turn_cdeg);
    }
}

// Turned by -10 degrees it looks along x: what is beside it is across, what is before it along.
void test_only_from_about_its_place(void) {
    static const struct {
        int x_mm, y_mm;
        bool worth;
    } rows[] = {{200, 0, true}, {201, 0, false}, {-200, 0, true}, {-201, 0, false},
                {0, 60, true},  {0, 61, false},  {0, -60, true},  {0, -61, false}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        argus_ping_t *const there = heard_after(-1000, 1200, 0);
        TEST_ASSERT_EQUAL(0, there->bearing_cdeg);
        there->x_mm = (uint16_t)(there->x_mm + rows[i].x_mm);
        there->y_mm = (uint16_t)(there->y_mm + rows[i].y_mm);
        TEST_ASSERT_EQUAL(rows[i].worth, aims(3));
    }
}

// It has looked there itself: lately, from about there, on about that bearing; each of them by itself.
void test_each_bound_of_having_looked_there(void) {
    static const struct {
        uint32_t age_ms;
        int x_mm, turned_cdeg;
        bool looked;
    } rows[] = {{0, 0, 0, true},    {10000, 0, 0, true}, {10001, 0, 0, false}, {0, 200, 0, true},
                {0, 201, 0, false}, {0, 0, 300, true},   {0, 0, 301, false},   {0, 0, -300, true}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        argus_ping_t own = *heard_after(-1000, 1200, 0);
        own.t_ms = (uint16_t)((k.sip_ms - rows[i].age_ms) & 0xFFFFu);
        own.x_mm = (uint16_t)(own.x_mm + rows[i].x_mm);
        own.bearing_cdeg = (int16_t)(own.bearing_cdeg + rows[i].turned_cdeg);
        argus_pings_note(&e.pings[3], own);
        own.x_mm = (uint16_t)(own.x_mm + 3000); // the last one was elsewhere: each is asked
        argus_pings_note(&e.pings[3], own);
        TEST_ASSERT_EQUAL(!rows[i].looked, aims(3));
    }
}
