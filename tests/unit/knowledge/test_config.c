// SPDX-License-Identifier: MIT
// Rule under attack: S5 refuses every speed and step that could touch what the sonars were to keep away, and
// no other.
#include "knowledge/config.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "captures.h"
#include "unity.h"

static argus_config_t config;
static char message[160];

void setUp(void) {
    memset(&config, 0xA5, sizeof config);
    argus_config_default(&config);
    config.sonar_cycle_ms = argus_robot_default()->cycle_ms;
}

void test_the_defaults_are_those_of_the_table_and_pass(void) {
    argus_config_default(&config);
#define SAME(key, def, min, max, unit, choices, meaning) TEST_ASSERT_EQUAL_MESSAGE(def, config.key, #key);
    ARGUS_CONFIG_TABLE(SAME)
    const argus_config_report_t report = argus_config_check(&config);
    TEST_ASSERT_EQUAL(ARGUS_CONFIG_OK, report.fault);
    TEST_ASSERT_EQUAL(-1, report.key);
    TEST_ASSERT_EQUAL(44, report.overhang_mm);
    TEST_ASSERT_EQUAL(487, report.reaction_ms); // 8 x 40 + 100 + 64 bytes at 9600 baud
    TEST_ASSERT_EQUAL(97, report.travel_mm);
    TEST_ASSERT_EQUAL(66, report.brake_mm); // with 300 mm/s2, whatever more is asked
    TEST_ASSERT_EQUAL(report.driving_mm, report.overhang_mm + report.travel_mm + report.brake_mm);
    TEST_ASSERT_EQUAL(report.stepping_mm, report.reach_mm + 3 * config.noise_mm + 20);
}

static void assert_range(int32_t *setting, int32_t minimum, int32_t maximum, int32_t row, const char *name) {
    const int32_t bad[] = {minimum - 1, maximum + 1, INT32_MIN, INT32_MAX};
    const int32_t usual = *setting;
    *setting = minimum;
    TEST_ASSERT_NOT_EQUAL_MESSAGE(ARGUS_CONFIG_RANGE, argus_config_check(&config).fault, name);
    *setting = maximum;
    TEST_ASSERT_NOT_EQUAL_MESSAGE(ARGUS_CONFIG_RANGE, argus_config_check(&config).fault, name);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        *setting = bad[i];
        TEST_ASSERT_EQUAL_MESSAGE(ARGUS_CONFIG_RANGE, argus_config_check(&config).fault, name);
        TEST_ASSERT_EQUAL_MESSAGE(row, argus_config_check(&config).key, name);
    }
    *setting = usual;
}

void test_both_ends_of_every_range_hold(void) {
    int32_t row = 0;
#define ENDS(name, def, min, max, unit, choices, meaning) \
    assert_range(&config.name, (min), (max), row++, #name);
    ARGUS_CONFIG_TABLE(ENDS)
    TEST_ASSERT_EQUAL(sizeof config / sizeof(int32_t), row);
}

static bool driving_refused(void) {
    return argus_config_check(&config).fault == ARGUS_CONFIG_DRIVING;
}

void test_at_9600_baud_234_mm_s_is_the_limit(void) {
    for (config.speed_mm_s = 30; config.speed_mm_s <= 750; config.speed_mm_s++) {
        TEST_ASSERT_EQUAL(config.speed_mm_s > 234, driving_refused());
    }
}

static double driving_exactly(void) {
    const double wire = config.baud > 0 ? 64.0 * 10 / config.baud : 0;
    const double t = 8 * config.sonar_cycle_ms / 1000.0 + 0.1 + wire;
    const double v = config.speed_mm_s;
    return 44 + v * t + v * v / (2.0 * fmin(300, config.decel_mm_s2));
}

// Against the same inequality in floating point; within a thousandth of a mm either answer will do.
static void driving_cases(int cases) {
    static const int32_t bauds[] = {0, 1, 110, 1200, 9600, 19200, 38400, 57600, 115200};
    random_t random = random_seed(11);
    size_t refused = 0;
    for (int i = 0; i < cases; i++) {
        config.speed_mm_s = 30 + (int32_t)random_below(&random, 721);
        config.decel_mm_s2 = 50 + (int32_t)random_below(&random, 1951);
        config.object_range_mm = 150 + (int32_t)random_below(&random, 851);
        config.sonar_cycle_ms = 20 + (int32_t)random_below(&random, 101);
        config.baud = bauds[random_below(&random, sizeof bauds / sizeof bauds[0])];
        const double slack = config.object_range_mm - driving_exactly();
        snprintf(message, sizeof message, "case %d: slack %.4f mm", i, slack);
        if (fabs(slack) > 0.01) {
            TEST_ASSERT_EQUAL_MESSAGE(slack < 0, driving_refused(), message);
        }
        if (fabs(slack - round(slack)) > 0.01) {
            const int32_t wanted = (int32_t)floor(driving_exactly());
            TEST_ASSERT_EQUAL_MESSAGE(wanted, argus_config_check(&config).driving_mm, message);
        }
        refused += slack < 0;
    }
    const size_t tenth = (size_t)cases / 10;
    TEST_ASSERT_TRUE(refused > tenth && refused < 9 * tenth); // the cases lie on both sides
}

void test_driving_is_refused_when_the_inequality_fails(void) {
    driving_cases(200);
}

void test_driving_is_refused_exactly_when_the_inequality_fails(void) { // soak
    driving_cases(3000);
}

// S5 solved for the speed ----------------------------------------------------------------------------------

static const argus_robot_t *const robots[] = {&argus_robot_table.robots[0], &argus_robot_table.robots[1],
                                              &argus_robot_table.robots[2], &argus_robot_table.robots[3]};

// Settings that the check accepts; `speed_mm_s` is the slowest, so that few are refused.
static bool draw_settings(random_t *random) {
    static const int32_t bauds[] = {0, 110, 1200, 9600, 19200, 38400, 57600, 115200};
    config.speed_mm_s = 30;
    config.decel_mm_s2 = 50 + (int32_t)random_below(random, 1951);
    config.object_range_mm = 150 + (int32_t)random_below(random, 851);
    config.sonar_cycle_ms = 20 + (int32_t)random_below(random, 101);
    config.baud = bauds[random_below(random, sizeof bauds / sizeof bauds[0])];
    return !driving_refused();
}

// What the check would say of that speed at this range, without its own limits.
static int32_t driving_at(const argus_robot_t *robot, int32_t speed_mm_s) {
    argus_config_t at = config;
    at.speed_mm_s = speed_mm_s;
    return robot->front_mm - robot->sonar_face_mm + argus_config_stop_mm(&at, robot, 0);
}

// The check refuses a speed whose way reaches the range: what the law allows is not refused, and 6 mm/s more
// is.
static void assert_law(const argus_robot_t *robot, int32_t range_mm, int32_t speed_mm_s) {
    snprintf(message, sizeof message, "range %d, decel %d, cycle %d, baud %d: %d mm/s", (int)range_mm,
             (int)config.decel_mm_s2, (int)config.sonar_cycle_ms, (int)config.baud, (int)speed_mm_s);
    TEST_ASSERT_TRUE_MESSAGE(speed_mm_s >= 0, message);
    if (speed_mm_s > 0) {
        TEST_ASSERT_TRUE_MESSAGE(driving_at(robot, speed_mm_s) < range_mm, message);
    }
    TEST_ASSERT_TRUE_MESSAGE(driving_at(robot, speed_mm_s + 6) >= range_mm, message);
}

static void law_cases(int cases) {
    random_t random = random_seed(12);
    int drawn = 0;
    for (int i = 0; i < cases; i++) {
        const argus_robot_t *const robot = robots[random_below(&random, 4)];
        if (!draw_settings(&random)) {
            continue;
        }
        drawn++;
        int32_t slower_mm_s = 0;
        for (int32_t range_mm = 0; range_mm <= 5000; range_mm += 1 + (int32_t)random_below(&random, 90)) {
            const int32_t speed_mm_s = argus_config_speed_mm_s(&config, robot, range_mm, 0);
            TEST_ASSERT_TRUE_MESSAGE(speed_mm_s >= slower_mm_s, "less speed for more range");
            slower_mm_s = speed_mm_s;
            if (range_mm > robot->front_mm - robot->sonar_face_mm + 1) {
                assert_law(robot, range_mm, speed_mm_s);
            }
        }
    }
    TEST_ASSERT_TRUE(drawn > cases / 2);
}

void test_the_speed_of_a_range_is_the_most_that_s5_allows(void) {
    law_cases(40);
}

void test_the_speed_of_any_range_is_the_most_that_s5_allows(void) { // soak
    law_cases(3000);
}

// Nearer than the body's end there is no way left: no speed, and none below zero.
void test_no_range_no_speed(void) {
    for (int32_t range_mm = 0; range_mm <= 45; range_mm++) {
        TEST_ASSERT_EQUAL(0, argus_config_speed_mm_s(&config, argus_robot_default(), range_mm, 0));
    }
}

// The slowest link that any accepted setting has, and the longest range a reading can say: the squares of the
// law are the largest. Nothing wraps within 32 bits: the speed is what floating point gives.
void test_the_law_does_not_overflow(void) {
    config.speed_mm_s = 30;
    config.object_range_mm = 1000;
    for (config.baud = 1; driving_refused(); config.baud++) {
    }
    TEST_ASSERT_TRUE(config.baud < 60);
    for (config.sonar_cycle_ms = 20; config.sonar_cycle_ms <= 120; config.sonar_cycle_ms += 50) {
        for (int32_t range_mm = 1; range_mm <= INT16_MAX; range_mm += 97) {
            const double t = 8 * config.sonar_cycle_ms / 1000.0 + 0.1 + 640.0 / config.baud;
            const double at = 300 * t;
            const double wanted = sqrt(at * at + 2 * 300 * fmax(0, range_mm - 44.0)) - at;
            const int32_t speed_mm_s = argus_config_speed_mm_s(&config, argus_robot_default(), range_mm, 0);
            snprintf(message, sizeof message, "range %d: %d mm/s, exactly %.2f", (int)range_mm,
                     (int)speed_mm_s, wanted);
            TEST_ASSERT_TRUE_MESSAGE(speed_mm_s <= wanted && speed_mm_s >= wanted - 6, message);
        }
    }
}

void test_stepping_is_refused_exactly_when_the_inequality_fails(void) {
    const int32_t needed = argus_config_reach_mm(argus_robot_default(), 200) + 3 * 5 + 20;
    for (config.check_range_mm = 200; config.check_range_mm < 500; config.check_range_mm++) {
        const argus_config_report_t report = argus_config_check(&config);
        TEST_ASSERT_EQUAL(config.check_range_mm <= needed, report.fault == ARGUS_CONFIG_STEP);
        TEST_ASSERT_EQUAL(needed, report.stepping_mm);
    }
    config.check_range_mm = 350;
    config.noise_mm = 20;
    TEST_ASSERT_EQUAL(ARGUS_CONFIG_STEP, argus_config_check(&config).fault);
}

// The vendor's figures of the sonars 0 to 6 (p3dx-sh.p, SonarUnit).
static const double pose[][3] = {{69, 136, 90},   {114, 119, 50},  {148, 78, 30},   {166, 27, 10},
                                 {166, -27, -10}, {148, -78, -30}, {114, -119, -50}};

static double reading_exactly(double x, double y) {
    double seen = 1e9;
    double nearest = 1e9;
    for (int i = 1; i <= 6; i++) {
        const double d = hypot(x - pose[i][0], y - pose[i][1]);
        const double off = atan2(y - pose[i][1], x - pose[i][0]) * 57.29577951308232 - pose[i][2];
        nearest = fmin(nearest, d);
        seen = fabs(off) <= 15 ? fmin(seen, d) : seen;
    }
    return seen < 1e9 ? seen : nearest;
}

// Never less than the geometry in floating point on a finer grid, and at most 1 mm more.
void test_reach_is_what_geometry_gives(void) {
    for (int32_t step = 50; step <= 200; step += 10) {
        double exact = 0;
        for (double y = -212.5; y <= 212.5; y += 0.125) {
            exact = fmax(exact, reading_exactly(210 + step, y));
        }
        snprintf(message, sizeof message, "step %d: exactly %.2f mm", (int)step, exact);
        TEST_ASSERT_TRUE_MESSAGE(argus_config_reach_mm(argus_robot_default(), step) >= exact, message);
        TEST_ASSERT_TRUE_MESSAGE(argus_config_reach_mm(argus_robot_default(), step) <= exact + 1.01, message);
    }
    TEST_ASSERT_EQUAL(211, argus_config_reach_mm(argus_robot_default(), 100));
    TEST_ASSERT_EQUAL(252, argus_config_reach_mm(argus_robot_default(), 150));
    TEST_ASSERT_EQUAL(295, argus_config_reach_mm(argus_robot_default(), 200));
}

// What is in force is reported, whatever stands for it in the settings.
void test_the_report_shows_what_auto_stands_for(void) {
    argus_config_default(&config);
    config.speed_mm_s = config.object_range_mm = config.check_range_mm = ARGUS_AUTO;
    const argus_config_report_t report = argus_config_check(&config);
    TEST_ASSERT_EQUAL(ARGUS_CONFIG_OK, report.fault);
    argus_config_follow(&config, argus_config_follows(&config), argus_robot_default());
    TEST_ASSERT_GREATER_THAN(0, config.speed_mm_s);
    TEST_ASSERT_EQUAL(config.speed_mm_s, report.speed_mm_s);
    TEST_ASSERT_EQUAL(config.object_range_mm, report.object_range_mm);
    TEST_ASSERT_EQUAL(config.check_range_mm, report.check_range_mm);
}

// No speed is worked out of settings that are out of range.
void test_what_is_out_of_range_is_not_worked_with(void) {
    argus_config_default(&config);
    config.speed_mm_s = ARGUS_AUTO;
    config.noise_mm = INT32_MAX;
    argus_config_follow(&config, argus_config_follows(&config), argus_robot_default());
    TEST_ASSERT_EQUAL(200, config.speed_mm_s);
}
