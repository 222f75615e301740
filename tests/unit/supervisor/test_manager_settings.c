// SPDX-License-Identifier: MIT
// Rule under attack: settings that argus_config_check() refuses make the manager passive for good, and
// neither they nor any that it takes make it trap.
#include "supervisor/manager.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "robot.h"
#include "unity.h"

#define GARBAGE_RUNS 60u
#define GARBAGE_SOAK_RUNS 2000u
#define RUN_MS 6000u

static robot_t robot;

#define FIELDS (sizeof(argus_config_t) / sizeof(int32_t))
#define MINIMUM(key, def, min, max, unit, choices, meaning) (min),
#define MAXIMUM(key, def, min, max, unit, choices, meaning) (max),
#define KEY(key, def, min, max, unit, choices, meaning) #key,
static const int32_t minima[] = {ARGUS_CONFIG_TABLE(MINIMUM)};
static const int32_t maxima[] = {ARGUS_CONFIG_TABLE(MAXIMUM)};
static const char *const keys[] = {ARGUS_CONFIG_TABLE(KEY)};

static void put(argus_config_t *config, size_t row, int32_t value) {
    memcpy((uint8_t *)config + row * sizeof value, &value, sizeof value);
}

// The robot opens, is given a goal and orders, and is closed: no trap, and passive for good where that is
// due.
static void live_with(const argus_config_t *config, const char *what) {
    const bool refused = argus_config_check(config).fault != ARGUS_CONFIG_OK;
    robot_init(&robot, config, 100u);
    robot_box(&robot, -1500, -1500, 3000, 1500);
    robot.world = robot_world_segments;
    robot_goal(&robot, 1500, 200);
    robot_run(&robot, RUN_MS / 2);
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_ACTIVE, 0);
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_GO, 0);
    robot_run(&robot, RUN_MS / 2);
    if (refused) {
        TEST_ASSERT_TRUE_MESSAGE(robot.argus.orders.passive, what);
        TEST_ASSERT_EQUAL_MESSAGE(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, 0), what);
        TEST_ASSERT_EQUAL_MESSAGE(0, robot_count_commands(&robot, ARCOS_CMD_HEAD, 0), what);
        TEST_ASSERT_EQUAL_MESSAGE(0, robot_count_commands(&robot, ARCOS_CMD_ENABLE, 0), what);
    }
    argus_shutdown(&robot.argus, robot.start_ms + robot.t_ms);
    robot_run(&robot, 4000);
    TEST_ASSERT_TRUE_MESSAGE(argus_closed(&robot.argus), what);
}

void test_each_setting_beyond_its_range_makes_it_passive(void) {
    for (size_t row = 0; row < FIELDS; row++) {
        const int32_t values[] = {INT32_MIN, minima[row] - 1, -1, 0, maxima[row] + 1, INT32_MAX};
        for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
            char text[80];
            argus_config_t config;
            argus_config_default(&config);
            put(&config, row, values[i]);
            snprintf(text, sizeof text, "%s = %d", keys[row], (int)values[i]);
            live_with(&config, text);
        }
    }
}

void test_each_setting_at_its_ends_is_lived_with(void) {
    for (size_t row = 0; row < FIELDS; row++) {
        for (int end = 0; end < 2; end++) {
            char text[80];
            argus_config_t config;
            argus_config_default(&config);
            put(&config, row, end == 0 ? minima[row] : maxima[row]);
            snprintf(text, sizeof text, "%s at its %s", keys[row], end == 0 ? "least" : "most");
            live_with(&config, text);
        }
    }
}

static uint32_t next(uint32_t *seed) {
    *seed ^= *seed << 13;
    *seed ^= *seed >> 17;
    *seed ^= *seed << 5;
    return *seed;
}

static int32_t garbage(uint32_t *seed, size_t row) {
    switch (next(seed) % 6) {
    case 0:
        return (int32_t)next(seed);
    case 1:
        return (int32_t)(next(seed) % 3) - 1;
    case 2:
        return minima[row] - (int32_t)(next(seed) % 3);
    case 3:
        return maxima[row] + (int32_t)(next(seed) % 3);
    case 4:
        return next(seed) % 2 == 0 ? INT32_MIN : INT32_MAX;
    default:
        return minima[row] + (int32_t)(next(seed) % (uint32_t)(maxima[row] - minima[row] + 1));
    }
}

// ARGUS_SEED=n runs that one alone.
static void live_with_garbage(uint32_t runs) {
    const char *const only = getenv("ARGUS_SEED");
    const uint32_t first = only != NULL ? (uint32_t)strtoul(only, NULL, 10) : 1;
    for (uint32_t run = first; run < first + (only != NULL ? 1 : runs); run++) {
        uint32_t seed = run * 2654435761u + 1;
        char text[40];
        argus_config_t config;
        argus_config_default(&config);
        const uint32_t share = 1 + next(&seed) % 8; // one field in so many
        for (size_t row = 0; row < FIELDS; row++) {
            if (next(&seed) % share == 0) {
                put(&config, row, garbage(&seed, row));
            }
        }
        snprintf(text, sizeof text, "ARGUS_SEED=%u", (unsigned)run);
        live_with(&config, text);
    }
}

void test_some_garbage_is_lived_with(void) {
    live_with_garbage(GARBAGE_RUNS);
}

void test_much_garbage_is_lived_with(void) { // soak
    live_with_garbage(GARBAGE_SOAK_RUNS);
}
