// SPDX-License-Identifier: MIT
// Rule under attack (S1, S2, S5): each reason by itself closes the way of a client or bounds its speed, and
// says which it was.
#include "guardian/bounds.h"

#include "behaviour/state.h"
#include "client.h"
#include "echo.h"
#include "health.h"
#include "knowledge/angle.h"
#include "unity.h"

static robot_t robot;
static client_t client;
static argus_t *core;

static void begin_with(int32_t profile) {
    robot_in_box(&robot, profile, -4000, -4000, 4000, 4000);
    client_init(&client, &robot);
    client_run(&client, 4000, false);
    client_open(&client);
    client_say(&client, ARCOS_CMD_VEL, 1); // it drives
    client_run(&client, 2000, true);
    core = &robot.argus;
    TEST_ASSERT_TRUE(core->orders.passive);
}

void setUp(void) {
    begin_with(ARGUS_PROFILE_ARGUS);
}

static void expect_closed(bool ahead, argus_bound_why_t why) {
    const argus_bound_t bound = argus_bound_way(core, ahead);
    TEST_ASSERT_EQUAL_INT32(0, bound.speed_mm_s);
    TEST_ASSERT_EQUAL_INT32(0, bound.way_mm);
    TEST_ASSERT_EQUAL(why, bound.why);
}

static int32_t free_mm_s(bool ahead) {
    const argus_bound_t bound = argus_bound_way(core, ahead);
    TEST_ASSERT_EQUAL(ARGUS_BOUND_FREE, bound.why);
    TEST_ASSERT_GREATER_THAN_INT32(0, bound.way_mm);
    return bound.speed_mm_s;
}

static void read_all(argus_mask_t sonars, int32_t mm) {
    for (int i = 0; i < core->knowledge.sonars; i++) {
        if ((sonars >> i & 1u) != 0) {
            core->knowledge.sonar[i].reading_mm = (uint16_t)mm;
            core->knowledge.sonar[i].odometer_mm = core->knowledge.odometer_mm;
        }
    }
}

void test_why_a_way_is_closed_is_told_by_the_permit(void) {
    TEST_ASSERT_EQUAL(ARGUS_BOUND_FREE, argus_bound_why(ARGUS_PERMIT_GIVEN));
    TEST_ASSERT_EQUAL(ARGUS_BOUND_BUMPER, argus_bound_why(ARGUS_PERMIT_BUMPER));
    TEST_ASSERT_EQUAL(ARGUS_BOUND_OBJECT, argus_bound_why(ARGUS_PERMIT_SWING));
    TEST_ASSERT_EQUAL(ARGUS_BOUND_HALTED, argus_bound_why(ARGUS_PERMIT_NO_ROBOT));
    TEST_ASSERT_EQUAL(ARGUS_BOUND_HALTED, argus_bound_why(ARGUS_PERMIT_STOPPED));
    TEST_ASSERT_EQUAL(ARGUS_BOUND_HALTED, argus_bound_why(ARGUS_PERMIT_BODY));
    TEST_ASSERT_EQUAL(ARGUS_BOUND_HALTED, argus_bound_why(ARGUS_PERMIT_OTHER));
}

void test_without_any_reason_both_ways_are_free(void) {
    TEST_ASSERT_GREATER_THAN_INT32(core->config.speed_mm_s, free_mm_s(true));
    TEST_ASSERT_EQUAL_INT32(core->config.speed_mm_s, free_mm_s(false));
}

void test_a_bumper_closes_the_way_to_it_alone(void) {
    core->knowledge.bumpers_front = 8;
    expect_closed(true, ARGUS_BOUND_BUMPER);
    free_mm_s(false);
    core->knowledge.bumpers_front = 0;
    core->knowledge.bumpers_rear = 8;
    expect_closed(false, ARGUS_BOUND_BUMPER);
    free_mm_s(true);
}

void test_s5_what_is_heard_on_the_way_bounds_the_speed_and_then_closes_it(void) {
    const argus_mask_t ahead = argus_robot_ahead(core->knowledge.robot);
    int32_t before_mm_s = INT32_MAX;
    bool open = true;
    for (int32_t mm = 1900; mm >= core->config.object_range_mm; mm -= 50) {
        read_all(ahead, mm);
        const argus_bound_t bound = argus_bound_way(core, true);
        TEST_ASSERT_TRUE(bound.speed_mm_s <= before_mm_s);
        TEST_ASSERT_TRUE(open || bound.speed_mm_s == 0);
        before_mm_s = bound.speed_mm_s;
        open = bound.speed_mm_s > 0;
    }
    expect_closed(true, ARGUS_BOUND_OBJECT);
}

// A weak brake and a late link leave no speed that is worth a command.
void test_s5_where_it_could_only_crawl_it_stands(void) {
    const argus_mask_t ahead = argus_robot_ahead(core->knowledge.robot);
    read_all(ahead, core->config.object_range_mm + 80);
    TEST_ASSERT_GREATER_THAN_INT32(0, free_mm_s(true));
    core->latency.late_ms = 20000;
    expect_closed(true, ARGUS_BOUND_OBJECT);
}

void test_s1_what_no_sonar_sees_is_closed(void) {
    core->reflexes.touched_unheard = true; // the sonars ahead do not live
    core->knowledge.heard = 0;
    expect_closed(true, ARGUS_BOUND_UNSEEN);
    setUp();
    for (int i = 0; i < core->knowledge.sonars; i++) {
        put_health(&core->knowledge.sonar[i], ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
    }
    argus_rays_forget_all(&core->rays); // nor has any seen it lately
    expect_closed(true, ARGUS_BOUND_UNSEEN);
    expect_closed(false, ARGUS_BOUND_UNSEEN);
}

// The rules of the paper know of no way that others have seen: with a bearing blind it is closed.
void test_s1_by_the_rules_of_the_paper_a_blind_bearing_closes_the_way(void) {
    begin_with(ARGUS_PROFILE_PAPER);
    free_mm_s(true);
    put_health(&core->knowledge.sonar[3], ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
    expect_closed(true, ARGUS_BOUND_UNSEEN);
}

void test_back_it_goes_only_where_each_that_looks_astern_has_reported_lately(void) {
    const uint32_t limit_ms = argus_guard_two_rounds_ms(&core->config);
    const unsigned astern = argus_robot_astern(core->knowledge.robot);
    for (int i = 0; i < core->knowledge.sonars; i++) {
        setUp();
        core->knowledge.sonar[i].heard_ms = core->now_ms - limit_ms - 1;
        if ((astern >> i & 1u) != 0) {
            expect_closed(false, ARGUS_BOUND_UNSEEN);
        } else {
            free_mm_s(false);
        }
        setUp();
        put_health(&core->knowledge.sonar[i], ARGUS_SUSPECT, ARGUS_KIND_WRONG, core->now_ms);
        if ((astern >> i & 1u) != 0) {
            expect_closed(false, ARGUS_BOUND_UNSEEN);
        } else {
            free_mm_s(false);
        }
    }
}

void test_back_it_goes_slowly_until_one_astern_has_heard_an_echo(void) {
    core->knowledge.heard = (argus_mask_t) ~(unsigned)argus_robot_astern(core->knowledge.robot);
    const argus_guard_t guard = argus_guard(core);
    TEST_ASSERT_EQUAL_INT32(argus_guard_unseen_mm_s(&guard), free_mm_s(false));
}

void test_with_one_named_ahead_it_is_careful(void) {
    put_health(&core->knowledge.sonar[0], ARGUS_SUSPECT, ARGUS_KIND_WRONG, core->now_ms);
    TEST_ASSERT_GREATER_THAN_INT32(core->config.speed_mm_s, free_mm_s(true)); // abeam: no matter
    put_health(&core->knowledge.sonar[1], ARGUS_SUSPECT, ARGUS_KIND_WRONG, core->now_ms);
    TEST_ASSERT_LESS_OR_EQUAL_INT32(core->config.speed_mm_s, free_mm_s(true));
}

// What was heard twice a moment ago and has left the cones is still there, if the rules remember.
void test_what_has_left_the_cones_is_remembered(void) {
    for (int profile = 0; profile < (int)ARGUS_PROFILES; profile++) {
        begin_with(profile);
        const argus_robot_t *const body = core->knowledge.robot;
        const argus_point_t at =
            argus_to_course(&core->knowledge.pose, (argus_point_t){body->front_mm + 40, 150});
        place_echo(&core->echoes, &core->knowledge, at.x_mm, at.y_mm);
        core->echoes.at[core->echoes.count - 1].again = true;
        const argus_bound_t bound = argus_bound_way(core, true);
        TEST_ASSERT_EQUAL(argus_rules(core)->remembers ? 0 : 1, bound.speed_mm_s > 0);
    }
}

void test_in_a_turn_beside_a_thing_it_goes_no_faster_than_a_step(void) {
    core->knowledge.vel_left_mm_s = 150;
    core->knowledge.vel_right_mm_s = 250;
    TEST_ASSERT_GREATER_THAN_INT32(core->config.step_speed_mm_s, free_mm_s(true));
    read_all(1u << 7, 300); // abeam
    TEST_ASSERT_EQUAL_INT32(core->config.step_speed_mm_s, free_mm_s(true));
    core->knowledge.vel_left_mm_s = 200;
    core->knowledge.vel_right_mm_s = 200;
    TEST_ASSERT_GREATER_THAN_INT32(core->config.step_speed_mm_s, free_mm_s(true));
}

// A curve is left on a tangent: the tighter it is, the slower, down to a step's speed and no slower.
void test_a_tight_curve_is_slow_where_there_is_no_room(void) {
    int32_t before_mm_s = INT32_MAX;
    for (int deg_s = 0; deg_s <= 200; deg_s += 10) {
        const int32_t half_mm_s = deg_s * core->knowledge.robot->track_mm / ARGUS_DEG_PER_RAD / 2;
        core->knowledge.vel_left_mm_s = (int16_t)(400 - half_mm_s);
        core->knowledge.vel_right_mm_s = (int16_t)(400 + half_mm_s);
        const argus_bound_t bound = argus_bound_way(core, true);
        TEST_ASSERT_TRUE(bound.speed_mm_s <= before_mm_s);
        TEST_ASSERT_TRUE(bound.speed_mm_s >= core->config.step_speed_mm_s);
        before_mm_s = bound.speed_mm_s;
    }
}

// ... where a step is slow; one that is fast enough to leave the curve far bounds it by itself.
void test_a_tight_curve_is_no_slower_than_a_step(void) {
    core->config.step_speed_mm_s = 700;
    core->knowledge.vel_left_mm_s = 0;
    core->knowledge.vel_right_mm_s = 1500;
    read_all(0xFFFF, 1900);
    read_all(1u << 7, 600); // abeam
    const argus_bound_t bound = argus_bound_way(core, true);
    TEST_ASSERT_EQUAL_INT32(700, bound.speed_mm_s);
}

// How far apart wheels that skid act is known from the headings alone.
void test_a_curve_is_as_tight_as_the_headings_say(void) {
    core->knowledge.vel_left_mm_s = core->knowledge.vel_right_mm_s = 400;
    core->knowledge.turn_deg_s = 0;
    read_all(argus_robot_flank(core->knowledge.robot), 900); // no room for a tangent
    const int32_t straight_mm_s = free_mm_s(true);
    for (int sign = -1; sign <= 1; sign += 2) {
        core->knowledge.turn_deg_s = sign * 90;
        TEST_ASSERT_EQUAL_INT32(sign * 90, argus_turn_deg_s(&core->knowledge));
        TEST_ASSERT_LESS_THAN_INT32(straight_mm_s, argus_bound_way(core, true).speed_mm_s);
    }
    core->knowledge.vel_left_mm_s = 300;
    core->knowledge.vel_right_mm_s = 500;
    core->knowledge.turn_deg_s = -5;
    TEST_ASSERT_EQUAL_INT32(200 * ARGUS_DEG_PER_RAD / core->knowledge.robot->track_mm,
                            argus_turn_deg_s(&core->knowledge));
}

// The rules of the paper ask for no echo: behind, as fast as the manager drives.
void test_back_by_the_rules_of_the_paper_no_echo_is_asked_for(void) {
    for (int paper = 0; paper < 2; paper++) {
        begin_with(ARGUS_PROFILE_ARGUS);
        argus_profile_t rules = *argus_rules(core);
        rules.asks_echo = paper == 0;
        core->rules = &rules;
        core->knowledge.heard = 0;
        const int32_t mm_s = argus_bound_way(core, false).speed_mm_s;
        TEST_ASSERT_EQUAL(paper != 0, mm_s == core->config.speed_mm_s);
        TEST_ASSERT_EQUAL(paper == 0, mm_s < core->config.speed_mm_s);
    }
}

// Where a bearing is blind, what has been seen of the way bounds it as what is heard does: where that is so
// little that it could only crawl, it stands.
void test_s5_a_way_of_which_too_little_is_seen_is_closed(void) {
    bool open = false, crawls = false;
    for (int free_mm = 0; free_mm <= 1500; free_mm += 25) {
        setUp();
        put_health(&core->knowledge.sonar[3], ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
        core->latency.late_ms = 4000;
        for (int i = 0; i < ARGUS_RAYS_MAX; i++) {
            core->rays.at[i].free_mm = (uint16_t)argus_min(core->rays.at[i].free_mm, free_mm);
        }
        const argus_guard_t guard = argus_guard(core);
        const argus_bound_t bound = argus_bound_way(core, true);
        open = open || bound.speed_mm_s > 0;
        crawls = crawls || (bound.why == ARGUS_BOUND_UNSEEN && argus_guard_seen_mm(&guard) > 0);
        TEST_ASSERT_TRUE(bound.speed_mm_s == 0 || bound.speed_mm_s >= 30);
    }
    TEST_ASSERT_TRUE(open);
    TEST_ASSERT_TRUE(crawls);
}
