// SPDX-License-Identifier: MIT
// Rule under attack: no order is taken for done because it was sent. Whatever happens to any one byte between
// robot and manager, the robot gets to its goal, hits nothing, and no goal is reached but the true one.
//
// A campaign. Each run is a clean mission in which one byte, of either way, is dropped, flipped, doubled,
// preceded by another, or held up, or from which on a latency comes up for some seconds. ARGUS_SEED=n and
// ARGUS_LINK_RUNS=n choose which and how many; ARGUS_LINK_CASE=way:byte:kind:with:lasts:course is one alone,
// as it is printed of a run that fails. Over CAN the same with frames.
#include "supervisor/manager.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "robot.h"
#include "unity.h"

#define SHORT_RUNS 120u
#define SOAK_RUNS 20000u
#define WIDE_RUNS 100000u
#define CAN_RUNS 4000u
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANITIZED_SHARE 10u // a run takes that much longer
#endif
#endif
#ifndef SANITIZED_SHARE
#define SANITIZED_SHARE 1u
#endif
#define SNAPSHOT_MS 500u
#define SNAPSHOTS 64
#define REFERENCE_MS 60000u
// link_lost_ms: after a longer silence the session begins anew, and the course may be lost.
#define DELAY_MOST_MS 4000u
#define LATE_MS 60000u // later than the clean mission: it waits for ever
#define REACHED_MM 150.0
#define REST_MS 1000u
#define STANDS_MM_S 5

typedef enum { COURSE_PLAIN, COURSE_BLIND, COURSE_AROUND, COURSES } course_t;
#define WAYS 2 // to the robot, to the manager
#define SHARES ((unsigned)COURSES * WAYS)

typedef struct {
    unsigned runs;
    unsigned waits;
    unsigned hits;
    unsigned swings; // those of them that were met in a turn on the spot
    unsigned false_goals;
    unsigned given_up;
    unsigned broken; // a rule of the watch
} tally_t;

static robot_t robot;
static robot_t snapshot[SNAPSHOTS];
static int snapshots;
static uint32_t clean_ms;

static double goal_x, goal_y;

// Plain: 2.5 m through an open room. Blind: likewise with a sonar that yields nothing. Around: a box stands
// in the way.
static bool over_can;

static void begin(course_t course) {
    argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &config, 7000u);
    robot.has_line = true;
    robot.line.can = over_can;
    robot.tells_settings = true;
    robot.noise_mm = 5;
    robot.world = robot_world_segments;
    robot_box(&robot, -1500, -2000, 4500, 2000);
    if (course == COURSE_BLIND) {
        robot.fault[3] = ROBOT_SILENT;
    }
    if (course == COURSE_AROUND) {
        robot_box(&robot, 1500, -200, 1800, 200);
    }
    goal_x = 2500;
    goal_y = course == COURSE_AROUND ? 0 : 300;
    robot_goal(&robot, (int)goal_x, (int)goal_y);
}

static bool is_over(void) {
    return robot.argus.mission == ARGUS_MISSION_REACHED || robot.argus.mission == ARGUS_MISSION_FAILED;
}

static void make_reference(course_t course) {
    char text[400];
    begin(course);
    snapshots = 0;
    while (robot.t_ms < REFERENCE_MS && !is_over()) {
        if (robot.t_ms % SNAPSHOT_MS == 0 && snapshots < SNAPSHOTS) {
            snapshot[snapshots++] = robot;
        }
        robot_tick(&robot);
    }
    clean_ms = robot.t_ms;
    snprintf(text, sizeof text, "course %d, clean: t %u, %s", (int)course, (unsigned)clean_ms,
             robot.violation);
    TEST_ASSERT_TRUE_MESSAGE(robot.argus.mission == ARGUS_MISSION_REACHED && robot.violation[0] == '\0',
                             text);
}

static void start_before(const robot_harm_t *harm) {
    int i = snapshots - 1;
    while (i > 0 && snapshot[i].line.passed[harm->way] > harm->at) {
        i--;
    }
    robot = snapshot[i];
    robot.line.harm[robot.line.harms++] = *harm;
}

static bool is_at_goal(void) {
    return hypot(robot.x - goal_x, robot.y - goal_y) <= REACHED_MM;
}

static const char *judge(tally_t *tally, bool swings) {
    tally->runs++;
    if (robot.closest_mm <= 0) {
        tally->hits++;
        tally->swings += swings;
        return swings ? "hit in a turn" : "hit";
    }
    if (robot.violation[0] != '\0') {
        tally->broken++;
        return robot.violation;
    }
    if (robot.argus.mission == ARGUS_MISSION_REACHED && !is_at_goal()) {
        tally->false_goals++;
        return "false goal";
    }
    if (robot.argus.mission == ARGUS_MISSION_FAILED) {
        tally->given_up++;
        return "given up";
    }
    if (!is_over()) {
        tally->waits++;
        return "waits";
    }
    return NULL;
}

static void run_one(course_t course, const robot_harm_t *harm, tally_t *tally) {
    bool swings = false;
    start_before(harm);
    while (robot.t_ms < clean_ms + LATE_MS && !is_over() && robot.violation[0] == '\0') {
        const bool free = robot.closest_mm > 0;
        robot_tick(&robot);
        swings = swings || (free && robot.closest_mm <= 0 && fabs(robot.v) <= STANDS_MM_S);
    }
    robot_run(&robot, REST_MS);
    const char *what = judge(tally, swings);
    if (what != NULL) {
        printf("%sARGUS_LINK_CASE=%d:%u:%d:%u:%u:%d %s, %s, t %u ms, at %.0f %.0f\n",
               over_can ? "over CAN " : "", (int)harm->way, (unsigned)harm->at, (int)harm->kind,
               (unsigned)harm->with, (unsigned)harm->lasts_ms, (int)course, what,
               argus_name(ARGUS_NAME_MODE, robot.argus.mode), (unsigned)robot.t_ms, robot.x, robot.y);
    }
}

static uint32_t hash(uint32_t value) {
    value = (value ^ value >> 16) * 0x7feb352du;
    value = (value ^ value >> 15) * 0x846ca68bu;
    return value ^ value >> 16;
}

static robot_harm_t harm_of(robot_way_t way, uint32_t at, robot_harm_kind_t kind, uint32_t seed) {
    const uint32_t chance = hash(seed * 2654435761u + at * 31u + (uint32_t)way * 7u + (uint32_t)kind);
    robot_harm_t harm = {.kind = kind, .way = way, .at = at};
    switch (kind) {
    case ROBOT_FLIP:
        harm.with = 1u << chance % 8;
        break;
    case ROBOT_INSERT:
        harm.with = chance % 256;
        break;
    case ROBOT_DELAY:
        harm.with = 100 + chance % (DELAY_MOST_MS - 99);
        break;
    case ROBOT_LATENCY:
        harm.with = 50 + chance % 1951;
        harm.lasts_ms = 1000 + hash(chance) % 9000;
        break;
    default:
        break;
    }
    return harm;
}

static uint32_t number_of(const char *name, uint32_t usual) {
    const char *text = getenv(name);
    return text != NULL ? (uint32_t)strtoul(text, NULL, 10) : usual;
}

// Of either way so many, evenly over all bytes; the kinds of harm take turns.
static void run_course(course_t course, uint32_t runs, uint32_t seed, tally_t *tally) {
    make_reference(course);
    for (int way = 0; way < WAYS; way++) {
        const uint32_t bytes = snapshot[snapshots - 1].line.passed[way];
        const uint32_t first = hash(seed + (uint32_t)way) % bytes;
        for (uint32_t n = 0; n < runs; n++) {
            const uint32_t at = (first + (uint32_t)((uint64_t)n * bytes / runs)) % bytes;
            const robot_harm_t harm =
                harm_of((robot_way_t)way, at, (robot_harm_kind_t)(n % ROBOT_HARMS), seed + n);
            run_one(course, &harm, tally);
        }
    }
}

static bool run_single(tally_t *tally) {
    const char *text = getenv("ARGUS_LINK_CASE");
    unsigned value[6];
    if (text == NULL) {
        return false;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        6,
        sscanf(text, "%u:%u:%u:%u:%u:%u", &value[0], &value[1], &value[2], &value[3], &value[4], &value[5]),
        "ARGUS_LINK_CASE=way:byte:kind:with:lasts:course");
    const robot_harm_t harm = {.way = (robot_way_t)value[0],
                               .at = value[1],
                               .kind = (robot_harm_kind_t)value[2],
                               .with = value[3],
                               .lasts_ms = value[4]};
    make_reference((course_t)value[5]);
    run_one((course_t)value[5], &harm, tally);
    return true;
}

static void campaign(uint32_t usual, bool can) {
    over_can = can;
    tally_t tally = {0};
    char text[200];
    const uint32_t seed = number_of("ARGUS_SEED", 1);
    const uint32_t runs = number_of("ARGUS_LINK_RUNS", usual);
    if (!run_single(&tally)) {
        for (int course = 0; course < COURSES; course++) {
            run_course((course_t)course, (runs + SHARES - 1) / SHARES, seed, &tally);
        }
    }
    snprintf(
        text, sizeof text,
        "ARGUS_SEED=%u%s: %u runs, endless waits %u, hits %u (in turns %u), false goals %u, given up %u, "
        "rules broken %u",
        (unsigned)seed, over_can ? ", over CAN" : "", tally.runs, tally.waits, tally.hits, tally.swings,
        tally.false_goals, tally.given_up, tally.broken);
    printf("%s\n", text);
    TEST_ASSERT_TRUE_MESSAGE(
        tally.waits + tally.hits + tally.false_goals + tally.given_up + tally.broken == 0, text);
}

void test_few_harmed_bytes_strand_no_mission(void) {
    campaign(SHORT_RUNS, false);
}

void test_few_harmed_frames_strand_no_mission(void) {
    campaign(SHORT_RUNS, true);
}

void test_harmed_bytes_strand_no_mission(void) { // soak
    campaign(SOAK_RUNS / SANITIZED_SHARE, false);
}

void test_harmed_frames_strand_no_mission(void) { // soak
    campaign(CAN_RUNS / SANITIZED_SHARE, true);
}

void test_many_harmed_bytes_strand_no_mission(void) { // wide
    campaign(WIDE_RUNS / SANITIZED_SHARE, false);
}
