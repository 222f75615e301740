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
