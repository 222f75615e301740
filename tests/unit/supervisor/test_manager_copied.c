// SPDX-License-Identifier: MIT
// Rule: SIPs that come a second time are reported at the first, second, fourth and so on.
#include "robot.h"
#include "unity.h"

#define AWAY_MM 100 // farther than a robot goes that comes to rest where it was

static robot_t robot;

void setUp(void) {
    const argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &config, 1000);
    robot.world = robot_world_segments;
    robot_box(&robot, -4000, -3000, 4000, 3000);
    robot_run(&robot, 4000);
}

// From one SIP to the next there and back: each one from the first place is as an earlier one.
static void jump(robot_t *const it) {
    it->x += it->x < AWAY_MM / 2.0 ? AWAY_MM : -AWAY_MM;
}

void test_many_copies_are_few_events(void) {
    robot.before_sip = jump;
    robot_run(&robot, 30000);
    const uint32_t found = robot.argus.session.copies.found;
    TEST_ASSERT_GREATER_THAN_UINT32(3, found);
    int due = 0;
    for (uint32_t power = 1; power <= found; power *= 2) {
        due++;
    }
    TEST_ASSERT_EQUAL_INT(due, robot_count_events(&robot, ARGUS_EV_SIP_COPIED, 0));
}
