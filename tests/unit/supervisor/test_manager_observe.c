// SPDX-License-Identifier: MIT
// Rule under attack: what a robot without ARCOS says of itself is judged as a SIP is, by the same core, with
// the same events; and nothing is ever sent to it.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "behaviour/core.h"
#include "unity.h"

#define STEP_MS 100
#define SONARS 8
#define WALL_MM 900.0
#define DEG (3.14159265358979323846 / 180)

static argus_storage_t storage;
static argus_robot_storage_t robot_storage;
static argus_t *argus;
static uint32_t now_ms;
static double x_mm, y_mm, heading_rad, turn_rad_s, speed_mm_s;
static uint32_t ticks;
static uint32_t noise;

// Four ahead, two abeam, two astern, of a robot 300 mm across.
static const argus_sonar_mount_t mounts[SONARS] = {
    {0, 140, 90, ARGUS_ROLE_ABEAM},       {90, 107, 50, ARGUS_ROLE_AHEAD},   {134, 41, 17, ARGUS_ROLE_AHEAD},
    {134, -41, -17, ARGUS_ROLE_AHEAD},    {90, -107, -50, ARGUS_ROLE_AHEAD}, {0, -140, -90, ARGUS_ROLE_ABEAM},
    {-121, -70, -150, ARGUS_ROLE_ASTERN}, {-121, 70, 150, ARGUS_ROLE_ASTERN}};
static const argus_ring_t ring = {.name = "roundbot",
                                  .front_mm = 150,
                                  .rear_mm = 150,
                                  .width_mm = 300,
                                  .swing_radius_mm = 150,
                                  .track_mm = 240,
                                  .min_mm = 30,
                                  .no_echo_mm = 4000,
                                  .mounts = mounts,
                                  .sonars = SONARS,
                                  .forward = {1, 2, 3, 4},
                                  .forward_count = 4};

void setUp(void) {
    argus_config_t config;
    argus_config_default(&config);
    now_ms = UINT32_MAX - 5000; // it wraps on the way
    x_mm = turn_rad_s = speed_mm_s = 0;
    y_mm = 300;
    heading_rad = -16.5 * DEG;
    ticks = 0;
    noise = 4711; // the seed
    argus = argus_init(&storage, &config, now_ms);
    TEST_ASSERT_EQUAL(ARGUS_RING_OK, argus_set_ring(argus, &robot_storage, &ring).fault);
}

// The distance to a box round the way, 23 m by 1.8 m, along one ray.
static double ray_mm(double sx, double sy, double a) {
    double nearest = 4000;
    if (fabs(sin(a)) > 1e-6) {
        nearest = fmin(nearest, ((sin(a) > 0 ? WALL_MM : -WALL_MM) - sy) / sin(a));
    }
    if (fabs(cos(a)) > 1e-6) {
        nearest = fmin(nearest, ((cos(a) > 0 ? 20000 : -3000) - sx) / cos(a));
    }
    return nearest;
}

// The nearest in the cone, +-8 mm: the walls are rough.
static uint16_t truth(int sonar) {
    const double a = heading_rad + mounts[sonar].heading_deg * DEG;
    const double sx = x_mm + mounts[sonar].x_mm * cos(heading_rad) - mounts[sonar].y_mm * sin(heading_rad);
    const double sy = y_mm + mounts[sonar].x_mm * sin(heading_rad) + mounts[sonar].y_mm * cos(heading_rad);
    double nearest = 4000;
    for (int deg = -15; deg <= 15; deg += 3) {
        nearest = fmin(nearest, ray_mm(sx, sy, a + deg * DEG));
    }
    noise = noise * 1664525u + 1013904223u;
    return (uint16_t)(nearest < 3990 ? nearest + (double)(noise >> 16) / 65536 * 16 - 8 : 4000);
}

// What a sonar reads that says anything.
static uint16_t leaps(void) {
    noise = noise * 1664525u + 1013904223u;
    return (uint16_t)(300 + (noise >> 16) % 3500);
}

static bool observe(int dead, uint16_t age_ms) {
    argus_range_t ranges[SONARS];
    for (int i = 0; i < SONARS; i++) {
        ranges[i] = (argus_range_t){(uint8_t)i, i == dead ? leaps() : truth(i), age_ms};
    }
    const argus_observation_t seen = {
        .pose = {(int32_t)x_mm, (int32_t)y_mm, (int32_t)(heading_rad / DEG * 100)},
        .speed_mm_s = (int32_t)speed_mm_s,
        .turn_cdeg_s = (int32_t)(turn_rad_s / DEG * 100),
        .ranges = ranges,
        .count = SONARS};
    const bool taken = argus_observe(argus, now_ms, &seen);
    uint8_t packet[ARGUS_PACKET_MAX];
    (void)argus_process(argus, now_ms);
    TEST_ASSERT_EQUAL(0, argus_transmit(argus, packet, sizeof packet));
    TEST_ASSERT_EQUAL(0, argus_invariants_broken(argus));
    return taken;
}

// Six seconds straight on, two of turning at rest, and so on in a zigzag: sonars look where others looked.
static void step(void) {
    const bool turns = ticks % 80 >= 60;
    const double way = ticks / 80 % 2 == 0 ? 1 : -1;
    turn_rad_s = turns ? way * 16.5 * DEG : 0;
    speed_mm_s = turns ? 0 : 200;
    heading_rad += turn_rad_s * STEP_MS / 1000;
    x_mm += speed_mm_s * STEP_MS / 1000 * cos(heading_rad);
    y_mm += speed_mm_s * STEP_MS / 1000 * sin(heading_rad);
    ticks++;
}

static int drive(int dead, uint32_t seconds, uint16_t wanted) {
    int found = 0;
    argus_event_t event;
    for (uint32_t i = 0; i < seconds * 1000 / STEP_MS; i++) {
        step();
        now_ms += STEP_MS;
        TEST_ASSERT_TRUE(observe(dead, 0));
        while (argus_next_event(argus, &event)) {
            found += event.id == wanted;
        }
    }
    return found;
}

static argus_status_t status(void) {
    argus_status_t it;
    argus_status(argus, &it);
    return it;
}

void test_a_healthy_ring_is_healthy(void) {
    TEST_ASSERT_EQUAL(1, drive(-1, 30, ARGUS_EV_SESSION_OPEN));
    const argus_status_t it = status();
    TEST_ASSERT_EQUAL_STRING("roundbot", it.robot_body);
    TEST_ASSERT_TRUE(it.open && it.online && !it.active);
    TEST_ASSERT_EQUAL(ARGUS_BAR_NONE, it.bar);
    const double way_mm = hypot(x_mm, y_mm - 300); // the course begins where the first call was
    TEST_ASSERT_INT_WITHIN(60, (int32_t)way_mm, (int32_t)hypot(it.pose.x_mm, it.pose.y_mm));
    for (int i = 0; i < SONARS; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(ARGUS_KIND_NONE, it.kind[i], "a healthy one is named");
    }
}

void test_one_that_leaps_is_found(void) {
    TEST_ASSERT_TRUE(drive(2, 60, ARGUS_EV_SONAR_NAMED) >= 1);
    const argus_status_t it = status();
    TEST_ASSERT_EQUAL(ARGUS_KIND_GARBAGE, it.kind[2]);
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, it.kind[4]);
}

void test_what_the_ring_calls_no_echo_is_none(void) {
    argus_range_t ranges[] = {{1, 3999, 0}, {2, 4000, 0}, {3, 4800, 0}, {4, UINT16_MAX, 0}};
    const argus_observation_t seen = {.ranges = ranges, .count = 4};
    TEST_ASSERT_TRUE(argus_observe(argus, now_ms, &seen));
    static const uint16_t read_mm[] = {3999, ARGUS_NO_ECHO_MM, ARGUS_NO_ECHO_MM, UINT16_MAX};
    const argus_status_t it = status();
    TEST_ASSERT_EQUAL_UINT16_ARRAY(read_mm, &it.reading_mm[1], 4);
}

void test_without_a_body_it_is_refused_each_time(void) {
    argus_config_t config;
    argus_config_default(&config);
    argus = argus_init(&storage, &config, now_ms);
    int unknown = 0;
    argus_event_t event;
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_FALSE(observe(-1, 0));
        while (argus_next_event(argus, &event)) {
            unknown += event.id == ARGUS_EV_SUBCLASS_UNKNOWN;
        }
        now_ms += STEP_MS;
    }
    TEST_ASSERT_EQUAL(1, unknown);
    TEST_ASSERT_EQUAL(ARGUS_BAR_UNKNOWN, status().bar);
    config.robot = 1; // the setting is enough
    argus = argus_init(&storage, &config, now_ms);
    TEST_ASSERT_TRUE(observe(-1, 0));
    TEST_ASSERT_GREATER_THAN(0, status().sonars);
}

void test_old_ranges_are_no_news(void) {
    TEST_ASSERT_TRUE(observe(-1, 0));
    now_ms += STEP_MS;
    TEST_ASSERT_TRUE(observe(-1, ARGUS_RANGE_OLD_MS));
    TEST_ASSERT_EQUAL(2, status().readings[2]);
    now_ms += STEP_MS;
    TEST_ASSERT_TRUE(observe(-1, ARGUS_RANGE_OLD_MS + 1));
    TEST_ASSERT_EQUAL(2, status().readings[2]);
}

void test_a_silence_loses_the_session_and_the_next_call_opens_one(void) {
    (void)drive(-1, 5, 0);
    int lost = 0;
    argus_event_t event;
    for (int i = 0; i < 100; i++) {
        uint8_t packet[ARGUS_PACKET_MAX];
        now_ms += STEP_MS;
        (void)argus_process(argus, now_ms);
        TEST_ASSERT_EQUAL(0, argus_transmit(argus, packet, sizeof packet));
        while (argus_next_event(argus, &event)) {
            lost += event.id == ARGUS_EV_LINK_LOST;
            TEST_ASSERT_TRUE(event.id != ARGUS_EV_SESSION_NO_ANSWER);
        }
    }
    TEST_ASSERT_EQUAL(1, lost);
    TEST_ASSERT_FALSE(status().open);
    TEST_ASSERT_EQUAL(1, drive(-1, 5, ARGUS_EV_SESSION_OPEN));
    TEST_ASSERT_TRUE(status().online);
}

void test_it_never_drives_whatever_is_ordered(void) {
    static const argus_point_t goal = {1000, 0};
    TEST_ASSERT_TRUE(argus_set_course(argus, &goal, 1));
    (void)drive(-1, 3, 0);
    (void)argus_operator(argus, now_ms, ARGUS_OP_ACTIVE, 0);
    (void)argus_operator(argus, now_ms, ARGUS_OP_GO, 0);
    (void)drive(-1, 3, 0);
    TEST_ASSERT_FALSE(status().active);
}

void test_after_the_end_nothing_is_taken(void) {
    (void)drive(-1, 3, 0);
    argus_shutdown(argus, now_ms);
    for (int i = 0; i < 40 && !argus_closed(argus); i++) {
        now_ms += STEP_MS;
        (void)argus_process(argus, now_ms);
    }
    TEST_ASSERT_TRUE(argus_closed(argus));
    TEST_ASSERT_FALSE(observe(-1, 0));
}

void test_values_at_their_ends_break_nothing(void) {
    static const int32_t ends[] = {INT32_MIN, INT32_MIN + 1, -1, 0, 1, INT32_MAX};
    argus_range_t ranges[255];
    for (int i = 0; i < 255; i++) {
        ranges[i] = (argus_range_t){(uint8_t)i, (uint16_t)(i * 257), (uint16_t)(i * 3)};
    }
    for (size_t i = 0; i < 6 * 6 * 6; i++) {
        const argus_observation_t seen = {
            .pose = {ends[i % 6], ends[i / 6 % 6], ends[i / 36]},
            .speed_mm_s = ends[i % 6],
            .turn_cdeg_s = ends[i / 6 % 6],
            .ranges = ranges,
            .count = 255,
        };
        now_ms += STEP_MS;
        TEST_ASSERT_TRUE(argus_observe(argus, now_ms, &seen));
        (void)argus_process(argus, now_ms);
        TEST_ASSERT_EQUAL(0, argus_invariants_broken(argus));
    }
}
