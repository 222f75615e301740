// SPDX-License-Identifier: MIT
// Rule under attack: Table IV, bits that are none of the six, and what covers what; all 62 lists: tests/core.
#include "adjustment/plan.h"

#include "adjustment/policy_cover.h"

#include "unity.h"

static void expect(argus_policy_t policy, uint16_t disabled, int count, const int16_t *rotations) {
    const argus_plan_t plan = argus_plan(argus_robot_default(), policy, disabled, 0);
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
    for (int policy = 0; policy <= ARGUS_POLICY_LEAST_TURN; policy++) {
        for (uint16_t map = 2; map < 126; map = (uint16_t)(map + 2)) {
            const argus_plan_t plan = argus_plan(argus_robot_default(), (argus_policy_t)policy, map, 0);
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
    for (int policy = 0; policy <= ARGUS_POLICY_LEAST_TURN; policy++) {
        TEST_ASSERT_EQUAL(0, argus_plan(argus_robot_default(), (argus_policy_t)policy, 0, 0).count);
        TEST_ASSERT_TRUE(argus_plan(argus_robot_default(), (argus_policy_t)policy, 0, 0).complete);
        TEST_ASSERT_EQUAL(0, argus_plan(argus_robot_default(), (argus_policy_t)policy, 0x7E, 0).count);
        TEST_ASSERT_FALSE(argus_plan(argus_robot_default(), (argus_policy_t)policy, 0x7E, 0).complete);
    }
}

void test_only_the_six_count(void) {
    const argus_plan_t plan = argus_plan(argus_robot_default(), ARGUS_POLICY_PAPER, 0xFF81, 0);
    TEST_ASSERT_EQUAL(0, plan.count);
    TEST_ASSERT_EQUAL(0, plan.disabled);
}

void test_a_p3at_plans_as_a_p3dx(void) {
    const argus_robot_t *p3at = argus_robot_find("p3at-sh");
    for (int policy = 0; policy <= ARGUS_POLICY_LEAST_TURN; policy++) {
        for (uint16_t map = 0; map < 128; map = (uint16_t)(map + 2)) {
            const argus_plan_t want = argus_plan(argus_robot_default(), (argus_policy_t)policy, map, 0);
            const argus_plan_t got = argus_plan(p3at, (argus_policy_t)policy, map, 0);
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
    for (int policy = 0; policy <= ARGUS_POLICY_LEAST_TURN; policy++) {
        for (unsigned map = 2; map < 0x1E; map += 2) {
            const argus_plan_t plan = argus_plan(amigo, (argus_policy_t)policy, (uint16_t)map, 0);
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
        TEST_ASSERT_FALSE(argus_plan(amigo, (argus_policy_t)policy, 0x1E, 0).complete);
    }
}

void test_an_amigobots_plans_by_hand(void) {
    const argus_robot_t *amigo = argus_robot_find("amigo-sh");
    const argus_plan_t one =
        argus_plan(amigo, ARGUS_POLICY_PAPER, 1u << 2, 0); // 41 - 26, nearer than -15 + 30
    TEST_ASSERT_EQUAL(1, one.count);
    TEST_ASSERT_EQUAL(-26, one.rotation_deg[0]);
    const argus_plan_t two = argus_plan(amigo, ARGUS_POLICY_PAPER, 1u << 2 | 1u << 3, 0); // and -41 + 26
    TEST_ASSERT_EQUAL(2, two.count);
    TEST_ASSERT_EQUAL(-26, two.rotation_deg[0]);
    TEST_ASSERT_EQUAL(26, two.rotation_deg[1]);
    const argus_plan_t right =
        argus_plan(amigo, ARGUS_POLICY_FEWEST, 1u << 3 | 1u << 4, 0); // both by one turn
    TEST_ASSERT_EQUAL(1, right.count);
    TEST_ASSERT_EQUAL(-56, right.rotation_deg[0]);
    const argus_plan_t others = argus_plan(amigo, ARGUS_POLICY_PAPER, 0xFFE1, 0);
    TEST_ASSERT_EQUAL(0, others.disabled);
}

static argus_plan_t of_ring(argus_policy_t policy, uint16_t disabled) {
    return argus_plan(argus_robot_default(), policy, disabled, (argus_mask_t)~disabled);
}

void test_the_rear_looks_ahead_after_half_a_turn(void) {
    const argus_plan_t plan = of_ring(ARGUS_POLICY_RING, 0x7E);
    TEST_ASSERT_TRUE(plan.complete);
    TEST_ASSERT_EQUAL(1, plan.count);
    TEST_ASSERT_EQUAL(180, plan.rotation_deg[0]);
    TEST_ASSERT_EQUAL_HEX16(0x7E00, argus_plan_needs(argus_robot_default(), &plan));
    TEST_ASSERT_EQUAL(11, argus_plan_cover(argus_robot_default(), &plan, 180, 3)); // -170 + 180
}

void test_any_one_of_the_ring_is_enough(void) {
    for (int policy = ARGUS_POLICY_RING; policy <= ARGUS_POLICY_ADAPTIVE; policy++) {
        for (int last = 0; last < 16; last++) {
            const argus_plan_t plan = of_ring((argus_policy_t)policy, (uint16_t)~(1u << last));
            TEST_ASSERT_TRUE(plan.complete);
            TEST_ASSERT_EQUAL_HEX16(1u << last, argus_plan_needs(argus_robot_default(), &plan));
        }
        TEST_ASSERT_FALSE(of_ring((argus_policy_t)policy, 0xFFFF).complete);
        TEST_ASSERT_EQUAL(0, of_ring((argus_policy_t)policy, 0xFFFF).count);
    }
}

// A sonar that is neither disabled nor living is not asked, and is not covered for.
void test_only_the_living_look(void) {
    const argus_plan_t plan = argus_plan(argus_robot_default(), ARGUS_POLICY_ADAPTIVE, 1u << 3, 1u << 0);
    TEST_ASSERT_EQUAL_HEX16(1u << 0, plan.looks);
    TEST_ASSERT_EQUAL(1, plan.count);
    TEST_ASSERT_EQUAL(-80, plan.rotation_deg[0]);
    TEST_ASSERT_FALSE(argus_plan(argus_robot_default(), ARGUS_POLICY_ADAPTIVE, 1u << 3, 0).complete);
}

void test_once_around_where_that_is_less(void) {
    const argus_plan_t plan =
        of_ring(ARGUS_POLICY_LEAST_TURN, 0x7E & ~(1u << 6)); // by 6 alone: all to the left
    TEST_ASSERT_EQUAL(5, plan.count);
    TEST_ASSERT_EQUAL(20, plan.rotation_deg[0]);
    TEST_ASSERT_EQUAL(100, plan.rotation_deg[4]);
    const argus_plan_t around =
        of_ring(ARGUS_POLICY_ADAPTIVE, 0xFFFF & ~(1u << 11)); // by 11, which looks at -170
    TEST_ASSERT_EQUAL(6, around.count);
    for (int i = 1; i < around.count; i++) { // on and on to the left
        const int step = around.rotation_deg[i] - around.rotation_deg[i - 1];
        TEST_ASSERT_EQUAL(20, (step + 360) % 360);
    }
    TEST_ASSERT_EQUAL(120, around.rotation_deg[0]);
}

void test_every_robots_ring(void) {
    for (int r = 0; r < ARGUS_ROBOTS; r++) {
        const argus_robot_t *robot = &argus_robot_table.robots[r];
        const argus_mask_t forward = argus_robot_forward(robot);
        const argus_mask_t others = (argus_mask_t)(argus_robot_all(robot) & ~(unsigned)forward);
        const argus_plan_t plan = argus_plan(robot, ARGUS_POLICY_ADAPTIVE, forward, others);
        TEST_ASSERT_TRUE_MESSAGE(plan.complete, robot->name);
        TEST_ASSERT_EQUAL_HEX32(0, argus_plan_needs(robot, &plan) & ~(unsigned)others);
    }
}

// The bound of the header holds for any robot and any half of its ring: steps are counted, not time.
void test_the_steps_are_bounded(void) {
    uint32_t most = 0;
    for (int r = 0; r < ARGUS_ROBOTS; r++) {
        const argus_robot_t *robot = &argus_robot_table.robots[r];
        const argus_mask_t forward = argus_robot_forward(robot);
        for (unsigned blind = 1; blind < 1u << robot->forward_count; blind++) {
            argus_plan_t plan = {.disabled = (argus_mask_t)(blind << 1 & forward)};
            plan.looks = (argus_mask_t)(argus_robot_all(robot) & ~(unsigned)plan.disabled);
            argus_turns_t turns;
            argus_turns_of(&turns, robot, &plan);
            const uint32_t steps = argus_policy_cover(&plan, &turns, 1, 1);
            most = steps > most ? steps : most;
        }
    }
    TEST_ASSERT_TRUE(most > 1000 && most <= ARGUS_COVER_STEPS_MAX);
}
