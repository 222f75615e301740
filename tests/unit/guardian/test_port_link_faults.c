// SPDX-License-Identifier: MIT
// Rule under attack: whatever happens to any one byte between client and guard port or between manager and
// robot, the robot hits nothing, makes no motion that the client does not ask for, and obeys it again.
//
// A campaign. In each run a client drives up to a wall, turns and drives on, and repeats what it wants as
// clients do; one byte of one of the four ways is dropped, flipped, doubled, preceded by another or held up,
// or a latency comes up behind it. ARGUS_SEED=n and ARGUS_LINK_RUNS=n choose which and how many;
// ARGUS_LINK_CASE=way:byte:kind:with:lasts is one alone, as it is printed of a run that fails.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "client.h"
#include "unity.h"

#define SHORT_RUNS 80u
#define SOAK_RUNS 3000u
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANITIZED_SHARE 10u // a run takes that much longer
#endif
#endif
#ifndef SANITIZED_SHARE
#define SANITIZED_SHARE 1u
#endif
#define OPENS_MS 4000u
#define DRIVES_MS 20000u
#define SNAPSHOT_MS 2000u
#define SNAPSHOTS 12
#define REPEAT_MS 300u
#define DEAF_MS 1500u   // without a SIP for so long a client opens its session anew
#define HEEDED_MS 3000u // later than an order to stand takes, sent again where it was lost
#define STANDS_MM_S 20
#define STANDS_RAD_S 0.05
#define OBEYS_MM 150
// At the robot's own line: after a longer silence it stands by itself.
#define LATE_MS 2000u
#define CLIENT_LATE_MS 5000u
#define LAST_MS 6000u

typedef struct {
    unsigned runs, hits, unasked, deaf, broken;
} tally_t;

static robot_t robot, robots[SNAPSHOTS];
static client_t client, clients[SNAPSHOTS];
static int snapshots;
static uint32_t stands_since_ms; // that the client wants nothing
static uint32_t sips, sip_ms;    // that reached the client

// What the client wants at this time of its course.
typedef struct {
    uint32_t until_ms;
    int mm_s, deg_s;
} wish_t;

static const wish_t wishes[] = {{5000, 400, 0},  {7000, 0, 0},  {10000, 0, 30},   {12000, 0, 0},
                                {16000, 300, 0}, {17000, 0, 0}, {18500, -150, 0}, {DRIVES_MS, 0, 0}};

static const wish_t *wish_at(uint32_t ms) {
    const wish_t *wish = wishes;
    while (ms >= wish->until_ms && wish->until_ms < DRIVES_MS) {
        wish++;
    }
    return wish;
}

static void begin(void) {
    const argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &config, UINT32_MAX - 9000); // the clock wraps
    robot.has_line = true;
    robot.tells_settings = true;
    robot.noise_mm = 5;
    robot.world = robot_world_segments;
    robot_box(&robot, -1800, -1800, 1800, 1800);
    client_init(&client, &robot);
    client.there = false;
    client_run(&client, OPENS_MS, false);
    client.there = true;
    client_open(&client);
    stands_since_ms = 0;
    sips = 0;
    sip_ms = robot.t_ms;
}

static void order(int mm_s, int deg_s) {
    if (mm_s != 0 || deg_s != 0) {
        stands_since_ms = robot.t_ms;
    }
    client_say(&client, ARCOS_CMD_VEL, mm_s);
    client_say(&client, ARCOS_CMD_RVEL, deg_s);
}

static void look(void) {
    if (client.sips != sips) {
        sips = client.sips;
        sip_ms = robot.t_ms;
    } else if (robot.t_ms - sip_ms > DEAF_MS) {
        sip_ms = robot.t_ms;
        client_open(&client);
    }
}

// True: it moves, and nobody wants it to.
static bool tick(int mm_s, int deg_s, uint32_t late_ms) {
    client_run(&client, 10, true);
    look();
    if (robot.t_ms % REPEAT_MS == 0) {
        order(mm_s, deg_s);
    }
    const bool moves = fabs(robot.v) > STANDS_MM_S || fabs(robot.w) > STANDS_RAD_S;
    return moves && robot.t_ms - stands_since_ms > HEEDED_MS + late_ms;
}

static bool drive_on(uint32_t to_ms, uint32_t late_ms) {
    bool unasked = false;
    while (robot.t_ms < to_ms) {
        const wish_t *wish = wish_at(robot.t_ms - OPENS_MS);
        unasked = tick(wish->mm_s, wish->deg_s, late_ms) || unasked;
    }
    return unasked;
}

// Told to drive back, then ahead, from where it stands it makes no way: the client is not heard any more.
static bool is_deaf(uint32_t late_ms) {
    const uint32_t from_ms = robot.t_ms;
    double way = 0;
    while (robot.t_ms - from_ms < LAST_MS + late_ms && way < OBEYS_MM) {
        tick((robot.t_ms - from_ms) / (LAST_MS / 2) % 2 == 0 ? -100 : 100, 0, late_ms);
        way += fabs(robot.v) / 100;
    }
    return way < OBEYS_MM;
}

static void make_reference(void) {
    begin();
    for (snapshots = 0; snapshots < SNAPSHOTS && robot.t_ms < OPENS_MS + DRIVES_MS; snapshots++) {
        robots[snapshots] = robot;
        clients[snapshots] = client;
        TEST_ASSERT_FALSE(drive_on(robot.t_ms + SNAPSHOT_MS, 0));
    }
    TEST_ASSERT_FALSE(is_deaf(0));
    TEST_ASSERT_TRUE(robot.closest_mm > 0);
    TEST_ASSERT_EQUAL_STRING("", robot.violation);
}

static const char *judge(bool unasked, uint32_t late_ms, tally_t *tally) {
    tally->runs++;
    if (robot.closest_mm <= 0) {
        tally->hits++;
        return "hit";
    }
    if (unasked) {
        tally->unasked++;
        return "moves unasked";
    }
    if (is_deaf(late_ms)) {
        tally->deaf++;
        return "does not obey any more";
    }
    if (robot.violation[0] != '\0') {
        tally->broken++;
        return robot.violation;
    }
    return NULL;
}

static void run_one(const robot_harm_t *harm, tally_t *tally) {
    int i = snapshots - 1;
    while (i > 0 && robots[i].line.passed[harm->way] > harm->at) {
        i--;
    }
    robot = robots[i];
    client = clients[i];
    stands_since_ms = robot.t_ms;
    sips = client.sips;
    sip_ms = robot.t_ms;
    robot.line.harm[robot.line.harms++] = *harm;
    const bool late = harm->kind == ROBOT_DELAY || harm->kind == ROBOT_LATENCY;
    const uint32_t late_ms = late ? harm->with + harm->lasts_ms : 0;
    const bool unasked = drive_on(OPENS_MS + DRIVES_MS, late_ms);
    const char *what = judge(unasked, late_ms, tally);
    if (what != NULL) {
        printf("ARGUS_LINK_CASE=%d:%u:%d:%u:%u %s, t %u ms, at %.0f %.0f\n", (int)harm->way,
               (unsigned)harm->at, (int)harm->kind, (unsigned)harm->with, (unsigned)harm->lasts_ms, what,
               (unsigned)robot.t_ms, robot.x, robot.y);
    }
}

static uint32_t hash(uint32_t value) {
    value = (value ^ value >> 16) * 0x7feb352du;
    value = (value ^ value >> 15) * 0x846ca68bu;
    return value ^ value >> 16;
}

static robot_harm_t harm_of(robot_way_t way, uint32_t at, robot_harm_kind_t kind, uint32_t seed) {
    const uint32_t chance = hash(seed * 2654435761u + at);
    robot_harm_t harm = {.kind = kind, .way = way, .at = at};
    harm.with = kind == ROBOT_FLIP ? 1u << chance % 8 : kind == ROBOT_INSERT ? chance % 256 : 0;
    if (kind == ROBOT_DELAY || kind == ROBOT_LATENCY) {
        harm.with = 50 + chance % ((way <= ROBOT_TO_MANAGER ? LATE_MS : CLIENT_LATE_MS) - 50);
        harm.lasts_ms = kind == ROBOT_LATENCY ? 500 + hash(chance) % 4000 : 0;
    }
    return harm;
}

static uint32_t number_of(const char *name, uint32_t usual) {
    const char *text = getenv(name);
    return text != NULL ? (uint32_t)strtoul(text, NULL, 10) : usual;
}

static bool run_single(tally_t *tally) {
    const char *text = getenv("ARGUS_LINK_CASE");
    unsigned v[5];
    if (text == NULL) {
        return false;
    }
    TEST_ASSERT_EQUAL_INT(5, sscanf(text, "%u:%u:%u:%u:%u", &v[0], &v[1], &v[2], &v[3], &v[4]));
    const robot_harm_t harm = {(robot_harm_kind_t)v[2], (robot_way_t)v[0], v[1], v[3], v[4], 0};
    run_one(&harm, tally);
    return true;
}

static void campaign(uint32_t usual) {
    tally_t tally = {0};
    char text[160];
    const uint32_t seed = number_of("ARGUS_SEED", 1);
    const uint32_t runs = (number_of("ARGUS_LINK_RUNS", usual) + ROBOT_WAYS - 1) / ROBOT_WAYS;
    make_reference();
    const bool single = run_single(&tally);
    for (int way = 0; way < ROBOT_WAYS && !single; way++) {
        const uint32_t from = robots[0].line.passed[way];
        const uint32_t bytes = robots[snapshots - 1].line.passed[way] - from;
        for (uint32_t n = 0; n < runs; n++) {
            const uint32_t at = from + (hash(seed) + (uint32_t)((uint64_t)n * bytes / runs)) % bytes;
            const robot_harm_t harm =
                harm_of((robot_way_t)way, at, (robot_harm_kind_t)(n % ROBOT_HARMS), seed + n);
            run_one(&harm, &tally);
        }
    }
    snprintf(text, sizeof text,
             "ARGUS_SEED=%u: %u runs, hits %u, unasked motions %u, deaf %u, rules broken %u", (unsigned)seed,
             tally.runs, tally.hits, tally.unasked, tally.deaf, tally.broken);
    printf("%s\n", text);
    TEST_ASSERT_TRUE_MESSAGE(tally.hits + tally.unasked + tally.deaf + tally.broken == 0, text);
}

void test_few_harmed_bytes_move_nothing_unasked(void) {
    campaign(SHORT_RUNS);
}

void test_harmed_bytes_move_nothing_unasked(void) { // soak
    campaign(SOAK_RUNS / SANITIZED_SHARE);
}
