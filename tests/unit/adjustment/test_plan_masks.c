// SPDX-License-Identifier: MIT
// Rule under attack: whichever sonars of a P3-DX are lost, each policy covers each bearing that can be
// covered, by sonars that may look, and the sweep ends on the heading that it began on: all 65,536 masks.
#include "adjustment/plan.h"

#include <stdio.h>
#include <string.h>

#include "adjustment/drive.h"
#include "knowledge/angle.h"
#include "unity.h"

#define BASE_CDEG 17300
#define SONARS 16
#define FORWARD 0x7E

static argus_knowledge_t k;
static char text[80];

// From the poses alone, not by what the planner asks.
static unsigned seen_after(const argus_robot_t *robot, const argus_plan_t *plan, int rotation_deg) {
    unsigned seen = 0;
    for (int d = 0; d < SONARS; d++) {
        for (int by = 0; by < SONARS; by++) {
            const int off = argus_robot_pose(robot, by).heading_deg + rotation_deg -
                            argus_robot_pose(robot, d).heading_deg;
            if ((plan->disabled >> d & 1u) != 0 && (plan->looks >> by & 1u) != 0 && off % 360 == 0) {
                seen |= 1u << d;
            }
        }
    }
    return seen;
}

static void check_rotations(const argus_plan_t *plan) {
    TEST_ASSERT_TRUE_MESSAGE(plan->count <= argus_count_bits(plan->disabled), text);
    for (int i = 0; i < plan->count; i++) {
        const int deg = plan->rotation_deg[i];
        TEST_ASSERT_TRUE_MESSAGE(deg > -180 && deg <= 180 && deg != 0, text);
        for (int j = 0; j < i; j++) {
            TEST_ASSERT_TRUE_MESSAGE(deg != plan->rotation_deg[j], text);
        }
    }
}

static void check_cover(const argus_robot_t *robot, const argus_plan_t *plan, unsigned disabled) {
    unsigned seen = 0;
    for (int i = 0; i < plan->count; i++) {
        const unsigned now = seen_after(robot, plan, plan->rotation_deg[i]);
        TEST_ASSERT_TRUE_MESSAGE(now != 0, text); // none for nothing
        seen |= now;
    }
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(disabled & FORWARD, plan->disabled, text);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, plan->looks & disabled, text);
    TEST_ASSERT_TRUE_MESSAGE(plan->complete == (plan->disabled == 0 || plan->looks != 0), text);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(plan->complete ? plan->disabled : 0u, seen, text);
}

static int32_t drive_through(const argus_plan_t *plan) {
    argus_drive_t drive;
    argus_sweep_begin(&drive, plan, BASE_CDEG);
    int32_t heading_cdeg = BASE_CDEG;
    int32_t left = 2 * ARGUS_ROTATIONS_MAX + 2;
    while (!drive.done && left-- > 0) {
        heading_cdeg = argus_sweep_heading_cdeg(&drive, plan);
        const argus_mark_t mark = argus_mark_now(&k);
        k.sips++;
        for (int i = 0; i < SONARS; i++) {
            k.sonar[i].sip = k.sips;
        }
        TEST_ASSERT_TRUE_MESSAGE(argus_sweep_step(&drive, plan, &k, &mark), text);
    }
    TEST_ASSERT_TRUE_MESSAGE(drive.done, text);
    return heading_cdeg;
}

static void check(const argus_policy_t policy, const unsigned disabled, const unsigned living) {
    const argus_robot_t *robot = argus_robot_default();
    snprintf(text, sizeof text, "policy %d, out 0x%04X, living 0x%04X", (int)policy, disabled, living);
    const argus_plan_t plan = argus_plan(robot, policy, (argus_mask_t)disabled, (argus_mask_t)living);
    check_rotations(&plan);
    check_cover(robot, &plan, disabled);
    TEST_ASSERT_EQUAL_MESSAGE(BASE_CDEG, drive_through(&plan), text);
}

static void check_masks(const unsigned step) {
    argus_knowledge_init(&k);
    for (int i = 0; i < SONARS; i++) {
        k.sonar[i].reported = true;
        k.sonar[i].reading_mm = 3000;
    }
    for (int policy = 0; policy < ARGUS_POLICIES; policy++) {
        for (unsigned disabled = 0; disabled <= 0xFFFF; disabled += step) {
            check((argus_policy_t)policy, disabled, ~disabled & 0xFFFF);
        }
    }
}

void test_some_masks_under_each_policy(void) {
    check_masks(257);
}

void test_every_mask_under_each_policy(void) { // soak
    check_masks(1);
}
