// SPDX-License-Identifier: MIT
// Rule under attack: the body that answers is the one that is driven by: with another one the front leads
// again, what was known of the sonars before is forgotten, and a record or a ring is taken only as far as it
// fits.
#include "supervisor/body.h"

#include <string.h>

#include "analysis/record.h"
#include "behaviour/state.h"
#include "health.h"
#include "robot.h"
#include "supervisor/history.h"
#include "supervisor/manager.h"
#include "unity.h"

static robot_t robot;
static argus_t *core;

void setUp(void) {
    robot_in_box(&robot, ARGUS_PROFILE_ARGUS, -3000, -3000, 3000, 3000);
    robot_run(&robot, 6000);
    core = &robot.argus;
}

static void meet(const char *subclass) {
    strcpy(core->session.subclass, subclass);
    argus_meet_body(core);
}

void test_another_body_is_met_with_its_front_ahead(void) {
    for (int reversed = 0; reversed < 2; reversed++) {
        setUp();
        if (reversed != 0) {
            core->knowledge.robot = argus_robot_other_end(core->knowledge.robot);
        }
        meet("p3at-sh");
        TEST_ASSERT_EQUAL_PTR(argus_robot_find("p3at-sh"), core->knowledge.robot);
        TEST_ASSERT_FALSE(core->knowledge.robot->reversed);
        TEST_ASSERT_EQUAL(ARGUS_BAR_NONE, core->orders.bar);
    }
}

void test_the_same_body_keeps_what_is_known_of_it(void) {
    put_health(&core->knowledge.sonar[3], ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
    core->knowledge.robot = argus_robot_other_end(core->knowledge.robot);
    meet("p3dx-sh");
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, core->knowledge.sonar[3].health);
    TEST_ASSERT_TRUE(core->knowledge.robot->reversed);
}

// ... but what its own record says.
void test_another_body_forgets_all_that_is_not_of_its_record(void) {
    put_health(&core->knowledge.sonar[3], ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
    put_health(&core->knowledge.sonar[4], ARGUS_PROBATION, ARGUS_KIND_OFF, core->now_ms);
    core->history.recorded = 1u << 4;
    meet("p3at-sh");
    TEST_ASSERT_EQUAL(ARGUS_UNKNOWN, core->knowledge.sonar[3].health);
    TEST_ASSERT_EQUAL(ARGUS_PROBATION, core->knowledge.sonar[4].health);
}

void test_a_body_that_is_not_known_bars_and_a_known_one_lets_it_drive_again(void) {
    meet("seekur");
    TEST_ASSERT_EQUAL(ARGUS_BAR_UNKNOWN, core->orders.bar);
    TEST_ASSERT_TRUE(core->orders.passive && core->orders.barred);
    meet("p3dx-sh");
    TEST_ASSERT_EQUAL(ARGUS_BAR_NONE, core->orders.bar);
    TEST_ASSERT_FALSE(core->orders.passive || core->orders.barred);
    core->orders.passive = true; // an operator wants it so: no body makes it active
    meet("p3at-sh");
    TEST_ASSERT_TRUE(core->orders.passive);
}

// ---- a record

void test_a_record_that_comes_while_the_session_is_open_is_of_its_robot_or_ignored(void) {
    static uint8_t record[ARGUS_RECORD_BYTES];
    put_health(&core->knowledge.sonar[3], ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
    TEST_ASSERT_EQUAL(ARGUS_RECORD_BYTES, argus_record_save(core, record, sizeof record));
    setUp();
    TEST_ASSERT_TRUE(argus_record_load(core, record, sizeof record));
    TEST_ASSERT_EQUAL(ARGUS_PROBATION, core->knowledge.sonar[3].health);
    TEST_ASSERT_FALSE(core->history.loaded); // it is compared
    setUp();
    put_health(&core->knowledge.sonar[3], ARGUS_DISABLED, ARGUS_KIND_STUCK, core->now_ms);
    TEST_ASSERT_TRUE(argus_record_load(core, record, sizeof record)); // what is known now is newer
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, core->knowledge.sonar[3].health);
    TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, core->knowledge.sonar[3].kind);
    setUp();
    strcpy(core->session.name, "another");
    TEST_ASSERT_TRUE(argus_record_load(core, record, sizeof record));
    TEST_ASSERT_EQUAL(ARGUS_UNKNOWN, core->knowledge.sonar[3].health);
    TEST_ASSERT_EQUAL_HEX32(0, core->history.recorded);
}

// ---- a ring

void test_a_ring_with_a_fault_changes_nothing(void) {
    static argus_storage_t storage;
    static argus_robot_storage_t own;
    static const argus_ring_t nameless = {.name = ""};
    argus_config_t config;
    argus_config_default(&config);
    argus_t *const argus = argus_init(&storage, &config, 0);
    const argus_robot_t *const before = argus->knowledge.robot;
    TEST_ASSERT_EQUAL(ARGUS_RING_NAME, argus_set_ring(argus, &own, &nameless).fault);
    TEST_ASSERT_EQUAL_PTR(before, argus->knowledge.robot);
}

// A name without a kind of fault is one of a kind that is not known: `wrong` says the least.
void test_a_record_without_a_kind_puts_on_probation_as_wrong(void) {
    static uint8_t record[ARGUS_RECORD_BYTES];
    put_health(&core->knowledge.sonar[3], ARGUS_PROBATION, ARGUS_KIND_NONE, core->now_ms);
    TEST_ASSERT_EQUAL(ARGUS_RECORD_BYTES, argus_record_save(core, record, sizeof record));
    setUp();
    TEST_ASSERT_TRUE(argus_record_load(core, record, sizeof record));
    TEST_ASSERT_EQUAL(ARGUS_PROBATION, core->knowledge.sonar[3].health);
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, core->knowledge.sonar[3].kind);
}

// What belongs to another robot is taken back of those that it put on probation, and only while they are.
void test_what_another_robots_record_says_is_taken_back(void) {
    core->history.loaded = true;
    core->history.robot = 4711;
    core->history.recorded = 1u << 3 | 1u << 4;
    put_health(&core->knowledge.sonar[3], ARGUS_PROBATION, ARGUS_KIND_OFF, core->now_ms);
    put_health(&core->knowledge.sonar[4], ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms); // in this mission
    put_health(&core->knowledge.sonar[5], ARGUS_PROBATION, ARGUS_KIND_OFF, core->now_ms);
    argus_meet_robot(core);
    TEST_ASSERT_EQUAL(ARGUS_UNKNOWN, core->knowledge.sonar[3].health);
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, core->knowledge.sonar[4].health);
    TEST_ASSERT_EQUAL(ARGUS_PROBATION, core->knowledge.sonar[5].health);
    TEST_ASSERT_EQUAL(0, core->history.recorded);
}

// Not of a record of no robot's, of the same robot, or of none that was read.
void test_a_record_of_no_robot_is_this_ones(void) {
    const uint32_t own = core->history.robot;
    static const struct {
        bool loaded, other, named, kept;
    } rows[] = {{true, true, true, false},
                {false, true, true, true},
                {true, false, true, true},
                {true, true, false, true}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        core->history.loaded = rows[i].loaded;
        core->history.robot = !rows[i].named ? 0 : rows[i].other ? own + 1 : own;
        core->history.recorded = 1u << 3;
        put_health(&core->knowledge.sonar[3], ARGUS_PROBATION, ARGUS_KIND_OFF, core->now_ms);
        argus_meet_robot(core);
        TEST_ASSERT_EQUAL(rows[i].kept ? ARGUS_PROBATION : ARGUS_UNKNOWN, core->knowledge.sonar[3].health);
        TEST_ASSERT_EQUAL(own, core->history.robot);
        TEST_ASSERT_FALSE(core->history.loaded);
    }
}

// Only what another body cannot have been told of keeps its health: one that was never known has none to
// lose.
void test_a_body_that_changes_forgets_each_health_that_may_be_forgotten(void) {
    core->knowledge.sonar[2].health = ARGUS_UNKNOWN;
    meet("p3at-sh");
    for (int i = 0; i < core->knowledge.sonars; i++) {
        TEST_ASSERT_EQUAL(ARGUS_UNKNOWN, core->knowledge.sonar[i].health);
    }
}

// Sonars that the robot should not have: with room for more, it is another body, and is not driven. A build
// that manages no more than the robot has tells of it and goes on.
void test_strange_sonars_show_another_body_where_more_could_be_managed(void) {
    static argus_own_robot_t own;
    for (int all = 0; all < 2; all++) {
        setUp();
        argus_robot_t *const row = &own.rows[0];
        *row = *core->knowledge.robot;
        row->poses = (int16_t)((const char *)own.poses - (const char *)row);
        row->sonars = (uint8_t)(ARGUS_SONARS - (all != 0 ? 0 : 1));
        core->knowledge.robot = row;
        core->orders.passive = false;
        core->orders.bar = ARGUS_BAR_NONE;
        core->knowledge.strange_sips = 0;
        TEST_ASSERT_FALSE(argus_sees_through_body(core, &core->orders, &core->events));
        for (int n = 1; n < UINT8_MAX && core->events.count == 0; n++) { // until it is told
            core->knowledge.strange_sips = (uint8_t)n;
            const bool other = argus_sees_through_body(core, &core->orders, &core->events);
            TEST_ASSERT_EQUAL(all == 0 && core->events.count > 0, other);
        }
        TEST_ASSERT_EQUAL(1, core->events.count);
        TEST_ASSERT_EQUAL(all == 0, core->orders.passive);
        TEST_ASSERT_EQUAL(all == 0 ? ARGUS_BAR_SONARS : ARGUS_BAR_NONE, core->orders.bar);
    }
}

// A ring that the settings could not be driven with, in normal driving or in steps, is not taken.
void test_a_ring_that_would_not_be_safe_is_not_taken(void) {
    static argus_storage_t storage;
    static argus_robot_storage_t taken;
    static argus_sonar_mount_t mounts[2] = {{100, 60, 20, ARGUS_ROLE_AHEAD},
                                            {100, -60, -20, ARGUS_ROLE_AHEAD}};
    argus_ring_t ring = {.name = "own", .mounts = mounts, .sonars = 2, .forward = {0, 1}, .forward_count = 2};
    ring.front_mm = ring.rear_mm = 200;
    ring.width_mm = 300;
    for (int step = 0; step < 2; step++) {
        argus_config_t config;
        argus_config_default(&config);
        config.speed_mm_s = step != 0 ? config.speed_mm_s : 750;
        config.object_range_mm = step != 0 ? 1000 : 150;
        config.check_range_mm = step != 0 ? 200 : 1500;
        argus_t *const argus = argus_init(&storage, &config, 0);
        TEST_ASSERT_EQUAL(ARGUS_RING_UNSAFE, argus_set_ring(argus, &taken, &ring).fault);
        const argus_robot_t *const row = &((argus_own_robot_t *)&taken)->rows[0];
        TEST_ASSERT_EQUAL(step != 0 ? ARGUS_CONFIG_STEP : ARGUS_CONFIG_DRIVING,
                          argus_config_check_for(&argus->config, row).fault);
    }
}

// What is said of a robot that may not be driven is the way that is too long: in normal driving, else in a
// step.
void test_a_bar_says_which_way_is_too_long(void) {
    for (int step = 0; step < 2; step++) {
        setUp();
        core->config.speed_mm_s = step != 0 ? core->config.speed_mm_s : 750;
        core->config.object_range_mm = step != 0 ? 1000 : 150;
        core->config.check_range_mm = step != 0 ? 200 : 1500;
        const argus_config_report_t report = argus_config_check_for(&core->config, core->knowledge.robot);
        TEST_ASSERT_EQUAL(step != 0 ? ARGUS_CONFIG_STEP : ARGUS_CONFIG_DRIVING, report.fault);
        TEST_ASSERT_TRUE(argus_find_bar(core, &core->orders, &core->events));
        robot_drain(&robot);
        TEST_ASSERT_EQUAL_INT32(step != 0 ? report.stepping_mm : report.driving_mm,
                                robot_last_event(&robot, ARGUS_EV_ROBOT_UNSAFE)->value);
    }
}
