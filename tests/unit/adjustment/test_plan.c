// SPDX-License-Identifier: MIT
// Rule under attack: Table IV, bits that are none of the six, and what covers what; all 62 lists: tests/core.
#include "adjustment/plan.h"

#include "unity.h"

static void expect(argus_policy_t policy, uint16_t disabled, int count, const int16_t *rotations) {
    const argus_plan_t plan = argus_plan(argus_robot_default(), policy, disabled);
    TEST_ASSERT_EQUAL(count, plan.count);
    TEST_ASSERT_TRUE(plan.complete);
    TEST_ASSERT_EQUAL_INT16_ARRAY(rotations, plan.rotation_deg, count);
}

void test_table_iv(void) {
    expect(ARGUS_POLICY_PAPER, 1 << 3, 1, (const int16_t[]){-20});
    expect(ARGUS_POLICY_PAPER, 1 << 2 | 1 << 3, 2, (const int16_t[]){-20, 20});
    expect(ARGUS_POLICY_PAPER, 1 << 2 | 1 << 4 | 1 << 5 | 1 << 6, 3, (const int16_t[]){-20, -40, -60});
    expect(ARGUS_POLICY_FEWEST, 1 << 1 | 1 << 2 | 1 << 3, 1, (const int16_t[]){60});
}

void test_every_map_is_covered_by_healthy_sonars(void) {
    for (int policy = 0; policy < 2; policy++) {
        for (uint16_t map = 2; map < 126; map = (uint16_t)(map + 2)) {
            const argus_plan_t plan = argus_plan(argus_robot_default(), (argus_policy_t)policy, map);
            unsigned seen = 0;
            for (int i = 0; i < plan.count; i++) {
                for (int d = 1; d <= 6; d++) {
                    const int by = argus_plan_cover(argus_robot_default(), &plan, plan.rotation_deg[i], d);
                    TEST_ASSERT_TRUE(by < 0 || (map >> by & 1u) == 0);
                    seen |= by >= 0 ? 1u << d : 0u;
                }
                TEST_ASSERT_EQUAL(0, argus_plan_covering(argus_robot_default(), &plan, plan.rotation_deg[i]) &
                                         map);
                TEST_ASSERT_TRUE(argus_plan_covering(argus_robot_default(), &plan, plan.rotation_deg[i]) !=
                                 0);
            }
            TEST_ASSERT_EQUAL_HEX16(map, seen & map);
        }
    }
}

void test_nothing_or_everything_out(void) {
    for (int policy = 0; policy < 2; policy++) {
        TEST_ASSERT_EQUAL(0, argus_plan(argus_robot_default(), (argus_policy_t)policy, 0).count);
        TEST_ASSERT_TRUE(argus_plan(argus_robot_default(), (argus_policy_t)policy, 0).complete);
        TEST_ASSERT_EQUAL(0, argus_plan(argus_robot_default(), (argus_policy_t)policy, 0x7E).count);
        TEST_ASSERT_FALSE(argus_plan(argus_robot_default(), (argus_policy_t)policy, 0x7E).complete);
    }
}

void test_only_the_six_count(void) {
    const argus_plan_t plan = argus_plan(argus_robot_default(), ARGUS_POLICY_PAPER, 0xFF81);
    TEST_ASSERT_EQUAL(0, plan.count);
    TEST_ASSERT_EQUAL(0, plan.disabled);
}
