// SPDX-License-Identifier: MIT
// Rule under attack: a sweep reads every bearing of the plan after the turn has settled, keeps the smallest,
// ends at home.
#include "adjustment/drive.h"

#include <string.h>

#include "health.h"
#include "knowledge/angle.h"
#include "unity.h"

#define BASE 17900

static argus_knowledge_t k;
static argus_plan_t plan;
static argus_drive_t drive;
static argus_mark_t mark;

static void begin(argus_policy_t policy, uint16_t disabled) {
    argus_knowledge_init(&k);
    for (int i = 0; i < 16; i++) {
        k.sonar[i].reported = true;
        k.sonar[i].reading_mm = 3000;
        if ((disabled >> i & 1u) != 0) {
            put_health(&k.sonar[i], ARGUS_DISABLED, ARGUS_KIND_OFF, 0);
            k.sonar[i].reading_mm = 100; // a lie that must not count
        }
    }
    plan = argus_plan(argus_robot_default(), policy, disabled, (argus_mask_t)~disabled);
    argus_sweep_begin(&drive, &plan, BASE);
}

static void settle(void) {
    mark = argus_mark_now(&k);
}

static void read(int sonar, int mm) {
    k.sips++;
    k.sonar[sonar].sip = k.sips;
    k.sonar[sonar].reading_mm = (uint16_t)mm;
}

static bool step(void) {
    return argus_sweep_step(&drive, &plan, &k, &mark);
}

// At a rotation: refuses until all that cover have fired, then goes on.
static void look(int rotation_deg, int mm) {
    TEST_ASSERT_EQUAL(argus_angle_wrap(BASE + rotation_deg * 100), argus_sweep_heading_cdeg(&drive, &plan));
    settle();
    TEST_ASSERT_FALSE(step());
    const uint16_t covering = argus_plan_covering(argus_robot_default(), &plan, (int16_t)rotation_deg);
    for (int i = 0; i < 16; i++) {
        if ((covering >> i & 1u) != 0) {
            TEST_ASSERT_FALSE(step());
            read(i, mm);
        }
    }
    TEST_ASSERT_TRUE(step());
}

static void home(void) {
    TEST_ASSERT_EQUAL(BASE, argus_sweep_heading_cdeg(&drive, &plan));
    TEST_ASSERT_FALSE(drive.done);
    settle();
    TEST_ASSERT_TRUE(step());
}

void test_paper_returns_after_each_rotation(void) {
    begin(ARGUS_POLICY_PAPER, 1 << 2 | 1 << 3);
    look(-20, 900);
    home();
    look(20, 800);
    home();
    TEST_ASSERT_TRUE(drive.done);
    TEST_ASSERT_EQUAL(800, drive.smallest_mm);
    TEST_ASSERT_EQUAL(3, drive.smallest_of); // seen by 4 after +20
    TEST_ASSERT_EQUAL(1, drive.smallest_at);
    TEST_ASSERT_FALSE(step());
}

void test_fewest_passes_from_side_to_side(void) {
    begin(ARGUS_POLICY_FEWEST, 1 << 1 | 1 << 6);
    TEST_ASSERT_EQUAL(2, plan.count);
    look(plan.rotation_deg[0], 700);
    look(plan.rotation_deg[1], 1700);
    home();
    TEST_ASSERT_TRUE(drive.done);
    TEST_ASSERT_EQUAL(700, drive.smallest_mm);
}

void test_one_stop_sees_several_bearings(void) {
    begin(ARGUS_POLICY_FEWEST, 1 << 1 | 1 << 2 | 1 << 3);
    TEST_ASSERT_EQUAL(6000, argus_angle_wrap(argus_sweep_heading_cdeg(&drive, &plan) - BASE));
    settle();
    read(4, 1000);
    read(5, 350);
    TEST_ASSERT_FALSE(step());
    read(6, 900);
    TEST_ASSERT_TRUE(step());
    home();
    TEST_ASSERT_EQUAL(350, drive.smallest_mm);
    TEST_ASSERT_EQUAL(2, drive.smallest_of);
}

void test_the_healthy_sonars_own_bearings_do_not_count(void) {
    begin(ARGUS_POLICY_PAPER, 1 << 3);
    k.sonar[5].reading_mm = 120; // covers nothing at -20
    look(-20, 2000);
    home();
    TEST_ASSERT_EQUAL(2000, drive.smallest_mm);
}

void test_an_empty_plan_is_done_at_home(void) {
    begin(ARGUS_POLICY_PAPER, 0);
    home();
    TEST_ASSERT_TRUE(drive.done);
    TEST_ASSERT_EQUAL(UINT16_MAX, drive.smallest_mm);
}

void test_the_rear_reads_for_a_lost_front(void) {
    begin(ARGUS_POLICY_RING, 0x7E);
    TEST_ASSERT_EQUAL_HEX16(0x7E00, argus_sweep_wants(&drive, &plan, argus_robot_default()));
    look(180, 600);
    TEST_ASSERT_EQUAL_HEX16(0, argus_sweep_wants(&drive, &plan, argus_robot_default()));
    home();
    TEST_ASSERT_TRUE(drive.done);
    TEST_ASSERT_EQUAL(600, drive.smallest_mm);
    TEST_ASSERT_EQUAL(1, drive.smallest_of);
}

// S1: with another to look it is another sweep, though the bearings are the same.
void test_a_sweep_is_outdated_by_who_looks(void) {
    begin(ARGUS_POLICY_RING, 0x7E);
    TEST_ASSERT_FALSE(argus_sweep_is_outdated(&drive, &plan));
    const argus_plan_t fewer = argus_plan(argus_robot_default(), ARGUS_POLICY_RING, 0x7E, 0x8181);
    TEST_ASSERT_TRUE(argus_sweep_is_outdated(&drive, &fewer));
    const argus_plan_t other = argus_plan(argus_robot_default(), ARGUS_POLICY_RING, 0x7C, 0xFF83);
    TEST_ASSERT_TRUE(argus_sweep_is_outdated(&drive, &other));
}

// A plan that has become shorter under a sweep has no rotation left for it: it asks for none, and looks home.
void test_a_plan_that_became_shorter_asks_for_nothing(void) {
    begin(ARGUS_POLICY_PAPER, 0x0C);
    drive.index = plan.count;
    TEST_ASSERT_FALSE(drive.home);
    TEST_ASSERT_EQUAL_HEX16(0, argus_sweep_wants(&drive, &plan, argus_robot_default()));
    TEST_ASSERT_EQUAL(BASE, argus_sweep_heading_cdeg(&drive, &plan));
}
