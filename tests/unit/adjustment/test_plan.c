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

void test_a_p3at_plans_as_a_p3dx(void) {
    const argus_robot_t *p3at = argus_robot_find("p3at-sh");
    for (int policy = 0; policy < 2; policy++) {
        for (uint16_t map = 0; map < 128; map = (uint16_t)(map + 2)) {
            const argus_plan_t want = argus_plan(argus_robot_default(), (argus_policy_t)policy, map);
            const argus_plan_t got = argus_plan(p3at, (argus_policy_t)policy, map);
            TEST_ASSERT_EQUAL(want.count, got.count);
            TEST_ASSERT_EQUAL(want.complete, got.complete);
            TEST_ASSERT_EQUAL_INT16_ARRAY(want.rotation_deg, got.rotation_deg, ARGUS_ROTATIONS_MAX);
        }
    }
}

// Its four look at 41, 15, -15 and -41 degrees.
static int amigo_bearing(int sonar) {
    static const int bearing[] = {41, 15, -15, -41};
    return bearing[sonar - 1];
}

void test_an_amigobot_plans_with_its_own_bearings(void) {
    const argus_robot_t *amigo = argus_robot_find("amigo-sh");
    for (int policy = 0; policy < 2; policy++) {
        for (unsigned map = 2; map < 0x1E; map += 2) {
            const argus_plan_t plan = argus_plan(amigo, (argus_policy_t)policy, (uint16_t)map);
            unsigned seen = 0;
            TEST_ASSERT_TRUE(plan.complete);
            for (int i = 0; i < plan.count; i++) {
                unsigned by = 0;
                for (int d = 1; d <= 4; d++) {
                    for (int h = 1; h <= 4; h++) {
                        const bool covers = (map >> d & 1u) != 0 && (map >> h & 1u) == 0 &&
                                            amigo_bearing(h) + plan.rotation_deg[i] == amigo_bearing(d);
                        seen |= covers ? 1u << d : 0u;
                        by |= covers ? 1u << h : 0u;
                        TEST_ASSERT_TRUE(!covers ||
                                         argus_plan_cover(amigo, &plan, plan.rotation_deg[i], d) == h);
                    }
                }
                TEST_ASSERT_EQUAL_HEX16(by, argus_plan_covering(amigo, &plan, plan.rotation_deg[i]));
            }
            TEST_ASSERT_EQUAL_HEX16(map, seen);
        }
        TEST_ASSERT_FALSE(argus_plan(amigo, (argus_policy_t)policy, 0x1E).complete);
    }
}

void test_an_amigobots_plans_by_hand(void) {
    const argus_robot_t *amigo = argus_robot_find("amigo-sh");
    const argus_plan_t one = argus_plan(amigo, ARGUS_POLICY_PAPER, 1u << 2); // 41 - 26, nearer than -15 + 30
    TEST_ASSERT_EQUAL(1, one.count);
    TEST_ASSERT_EQUAL(-26, one.rotation_deg[0]);
    const argus_plan_t two = argus_plan(amigo, ARGUS_POLICY_PAPER, 1u << 2 | 1u << 3); // and -41 + 26
    TEST_ASSERT_EQUAL(2, two.count);
    TEST_ASSERT_EQUAL(-26, two.rotation_deg[0]);
    TEST_ASSERT_EQUAL(26, two.rotation_deg[1]);
    const argus_plan_t right = argus_plan(amigo, ARGUS_POLICY_FEWEST, 1u << 3 | 1u << 4); // both by one turn
    TEST_ASSERT_EQUAL(1, right.count);
    TEST_ASSERT_EQUAL(-56, right.rotation_deg[0]);
    const argus_plan_t others = argus_plan(amigo, ARGUS_POLICY_PAPER, 0xFFE1);
    TEST_ASSERT_EQUAL(0, others.disabled);
}
