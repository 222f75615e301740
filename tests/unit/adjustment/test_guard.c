// SPDX-License-Identifier: MIT
// Rule under attack: each safety rule by itself: what it allows on the near side of its limit, and forbids on
// the other.
#include "adjustment/guard.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "adjustment/plan.h"
#include "echo.h"
#include "health.h"
#include "knowledge/angle.h"
#include "knowledge/config.h"
#include "unity.h"

#define SONARS (ARGUS_SONARS < 16 ? ARGUS_SONARS : 16) // that its robot has, of those that a build manages

#define NOW_MS 100000u

static argus_config_t config;
static argus_knowledge_t k;
static argus_echoes_t e;
static argus_rays_t rays;
static argus_guard_t g;
static char text[64];

static void use(int32_t profile) {
    config.profile = profile;
    g.profile = argus_profile(&config);
}

void setUp(void) {
    argus_config_default(&config);
    argus_config_follow(&config, argus_config_follows(&config), argus_robot_default());
    argus_knowledge_init(&k);
    argus_echoes_init(&e);
    memset(&rays, 0, sizeof rays);
    memset(&g, 0, sizeof g);
    k.sip_ms = NOW_MS;
    k.flags = ARCOS_FLAG_MOTORS;
    for (int i = 0; i < SONARS; i++) {
        k.sonar[i].reported = true;
        k.sonar[i].reading_mm = 3000;
        k.sonar[i].heard_ms = NOW_MS;
        k.sonar[i].health = ARGUS_HEALTHY;
    }
    g = (argus_guard_t){.config = &config,
                        .knowledge = &k,
                        .echoes = &e,
                        .rays = &rays,
                        .now_ms = NOW_MS,
                        .active = true,
                        .linked = true,
                        .checked = true};
    use(ARGUS_PROFILE_PAPER);
}

// The echo of sonar 0, which looks abeam, lies this far from the robot's centre.
static void echo_at(int32_t mm) {
    int32_t reading = 0;
    do {
        k.sonar[0].reading_mm = (uint16_t)++reading;
    } while (argus_echo_to_centre_mm(&k, 0, 0) < mm);
}

static void remember_at(int x_mm, int y_mm) {
    const argus_point_t at = {x_mm, y_mm};
    argus_echoes_touched(&e, at, NOW_MS);
}

// S1 -------------------------------------------------------------------------------------------------------

// Under argus also while the others can cover for those that are out: how far, it is asked apart.
void test_s1_normal_driving_only_with_every_bearing_in_use(void) {
    for (unsigned disabled = 0; disabled <= 0x7Eu; disabled += 2) {
        const argus_plan_t plan =
            argus_plan(argus_robot_default(), ARGUS_POLICY_PAPER, (uint16_t)disabled, 0);
        use(ARGUS_PROFILE_PAPER);
        TEST_ASSERT_EQUAL(disabled == 0, argus_guard_may_drive(&g, &plan));
        use(ARGUS_PROFILE_ARGUS);
        TEST_ASSERT_EQUAL(disabled != 0x7Eu, argus_guard_may_drive(&g, &plan));
        TEST_ASSERT_EQUAL(disabled != 0x7Eu, argus_guard_may_step(&plan));
    }
}

// S2, S5, S6 -----------------------------------------------------------------------------------------------

void test_s6_nothing_translates_unless_all_allow_it(void) {
    TEST_ASSERT_TRUE(argus_guard_may_translate(&g));
    g.active = false;
    TEST_ASSERT_FALSE(argus_guard_may_translate(&g));
    g.active = true;
    g.linked = false;
    TEST_ASSERT_FALSE(argus_guard_may_translate(&g));
    g.linked = true;
    g.checked = false;
    TEST_ASSERT_FALSE(argus_guard_may_translate(&g));
    g.checked = true;
    g.bumpers = 1;
    TEST_ASSERT_FALSE(argus_guard_may_translate(&g));
    g.bumpers = 0;
    k.flags = 0;
    TEST_ASSERT_FALSE(argus_guard_may_translate(&g));
}

void test_s5_free_way_is_the_shortest_usable_front_reading(void) {
    put_health(&k.sonar[3], ARGUS_DISABLED, ARGUS_KIND_OFF, 0);
    k.sonar[3].reading_mm = 100; // a lie that must not count
    k.sonar[0].reading_mm = k.sonar[7].reading_mm = k.sonar[12].reading_mm = 150;
    k.sonar[4].reading_mm = 900;
    TEST_ASSERT_EQUAL(650, argus_guard_ahead_mm(&g, argus_guard_seen_mm(&g)));
    k.sonar[4].reading_mm = 250;
    TEST_ASSERT_EQUAL(0, argus_guard_ahead_mm(&g, argus_guard_seen_mm(&g)));
    k.sonar[4].reading_mm = 100;
    TEST_ASSERT_EQUAL(0, argus_guard_ahead_mm(&g, argus_guard_seen_mm(&g)));
}

void test_s5_the_way_driven_since_a_reading_is_taken_off(void) {
    k.sonar[4].reading_mm = 900;
    k.odometer_mm = 60;
    TEST_ASSERT_EQUAL(590, argus_guard_ahead_mm(&g, argus_guard_seen_mm(&g)));
    k.sonar[4].odometer_mm = 60;
    TEST_ASSERT_EQUAL(650, argus_guard_ahead_mm(&g, argus_guard_seen_mm(&g)));
    k.odometer_mm = 5000;
    TEST_ASSERT_EQUAL(0, argus_guard_ahead_mm(&g, argus_guard_seen_mm(&g)));
}

// What hangs over is seen by the upper deck alone: it bounds way and speed, from where it stands.
void test_s5_the_upper_deck_bounds_the_way(void) {
#if ARGUS_SONARS > 16
    use(ARGUS_PROFILE_ARGUS);
    k.robot = argus_robot_find("peoplebot-sh");
    k.sonars = 32;
    for (int i = 16; i < 32; i++) {
        k.sonar[i] = k.sonar[0];
    }
    k.heard = UINT32_MAX;
    const int32_t fast_mm_s = argus_guard_speed_mm_s(&g, INT32_MAX);
    for (int sonar = 17; sonar <= 22; sonar++) {
        const argus_sonar_pose_t pose = argus_robot_pose(k.robot, sonar);
        const int behind_mm = (int)(89 * cos(pose.heading_deg * 3.14159265 / 180));
        k.sonar[sonar].reading_mm = 600;
        TEST_ASSERT_INT32_WITHIN(1, 600 - behind_mm - config.object_range_mm,
                                 argus_guard_ahead_mm(&g, INT32_MAX));
        TEST_ASSERT_TRUE(argus_guard_speed_mm_s(&g, INT32_MAX) < fast_mm_s);
        put_health(&k.sonar[sonar], ARGUS_STALE, ARGUS_KIND_NONE,
                   0); // it reports no more, and no other is asked in its place
        TEST_ASSERT_INT32_WITHIN(2, 3000 - 88 - config.object_range_mm, argus_guard_ahead_mm(&g, INT32_MAX));
        put_health(&k.sonar[sonar], ARGUS_HEALTHY, ARGUS_KIND_NONE, 0);
        k.sonar[sonar].reading_mm = 3000;
    }
    k.sonar[19].reading_mm = 100; // nearer than its own deck is behind
    TEST_ASSERT_EQUAL(0, argus_guard_ahead_mm(&g, INT32_MAX));
    k.sonar[19].reading_mm = 5000;
    k.sonar[27].reading_mm = 100; // astern
    TEST_ASSERT_TRUE(argus_guard_ahead_mm(&g, INT32_MAX) > 2000);
#else
    TEST_IGNORE_MESSAGE("this build has no room for an upper deck");
#endif
}

void test_s2_a_sonar_unheard_for_two_rounds_is_blind(void) {
    for (int i = 1; i <= 6; i++) {
        k.sonar[i].heard_ms = NOW_MS - argus_guard_two_rounds_ms(&config);
        TEST_ASSERT_TRUE(argus_guard_sees_ahead(&g));
        k.sonar[i].heard_ms--;
        TEST_ASSERT_FALSE(argus_guard_sees_ahead(&g));
        put_health(&k.sonar[i], ARGUS_DISABLED, ARGUS_KIND_SILENT, 0); // others cover for it
        TEST_ASSERT_TRUE(argus_guard_sees_ahead(&g));
    }
}

// S4 -------------------------------------------------------------------------------------------------------

void test_s4_home_is_within_two_degrees(void) {
    k.pose.heading_cdeg = -17950;
    TEST_ASSERT_TRUE(argus_guard_is_home(&g, 17850));
    TEST_ASSERT_FALSE(argus_guard_is_home(&g, 17849));
    TEST_ASSERT_TRUE(argus_guard_is_home(&g, -17750));
    TEST_ASSERT_FALSE(argus_guard_is_home(&g, -17749));
}

// S7: turning ----------------------------------------------------------------------------------------------

void test_s7_no_turn_with_an_echo_in_the_swing_circle(void) {
    static const struct {
        int32_t profile;
        int32_t swing_mm;
    } by[] = {{ARGUS_PROFILE_PAPER, 369}, {ARGUS_PROFILE_ARGUS, 389}};
    for (int i = 0; i < 2; i++) {
        use(by[i].profile);
        const int32_t margin = g.profile->swing_margin_mm;
        TEST_ASSERT_INT32_WITHIN(1, by[i].swing_mm, 370 + margin);
        echo_at(370 + margin);
        TEST_ASSERT_TRUE(argus_guard_echo_blocks(&g, 0));
        TEST_ASSERT_TRUE(argus_guard_swing_is_blocked(&g));
        TEST_ASSERT_FALSE(argus_guard_may_turn(&g));
        echo_at(370 + margin + 1);
        TEST_ASSERT_TRUE(argus_guard_may_turn(&g));
    }
}

// One that has waited for room in vain turns where its body can.
void test_s7_after_waiting_what_the_body_needs_will_do(void) {
    use(ARGUS_PROFILE_ARGUS);
    for (int squeezes = 0; squeezes < 2; squeezes++) {
        g.squeezes = squeezes != 0;
        echo_at(384);
        TEST_ASSERT_EQUAL(squeezes != 0, argus_guard_may_turn(&g));
        echo_at(370 + 10);
        TEST_ASSERT_FALSE(argus_guard_may_turn(&g));
    }
    use(ARGUS_PROFILE_PAPER); // its circle has no margin to give
    echo_at(370);
    TEST_ASSERT_FALSE(argus_guard_may_turn(&g));
}

// What was touched is a reading that does not go away, whatever the sonars hear.
void test_s5_a_place_that_was_touched_is_kept_away_from(void) {
    use(ARGUS_PROFILE_ARGUS);
    TEST_ASSERT_EQUAL(INT32_MAX, argus_guard_touched_mm(&g));
    for (int i = 0; i < SONARS; i++) {
        k.sonar[i].reading_mm = 5000;
    }
    k.heard = UINT16_MAX;
    const int32_t fast_mm_s = argus_guard_speed_mm_s(&g, INT32_MAX);
    k.bumpers_front = 1u << 3;
    argus_echoes_met(&e, &k, ARGUS_CONTACT_BUMPER);
    k.pose.x_mm -= 300;
    const int32_t touched_mm = argus_guard_touched_mm(&g);
    TEST_ASSERT_INT32_WITHIN(2, 300 + k.robot->front_mm - k.robot->sonar_face_mm, touched_mm);
    TEST_ASSERT_TRUE(argus_guard_ahead_mm(&g, INT32_MAX) <= touched_mm - config.object_range_mm);
    TEST_ASSERT_TRUE(argus_guard_speed_mm_s(&g, INT32_MAX) < fast_mm_s);
    k.pose.x_mm += 200;
    TEST_ASSERT_EQUAL(0, argus_guard_ahead_mm(&g, INT32_MAX));
    TEST_ASSERT_FALSE(argus_guard_may_turn(&g));
}

void test_s7_no_turn_with_a_bumper_pressed_or_without_leave(void) {
    TEST_ASSERT_TRUE(argus_guard_may_turn(&g));
    g.bumpers = 1u << 8;
    TEST_ASSERT_FALSE(argus_guard_may_turn(&g));
    g.bumpers = 0;
    g.active = false;
    TEST_ASSERT_FALSE(argus_guard_may_turn(&g));
}

void test_s7_what_is_out_or_reads_nothing_forbids_nothing(void) {
    echo_at(300);
    put_health(&k.sonar[0], ARGUS_DISABLED, ARGUS_KIND_WRONG, 0);
    TEST_ASSERT_TRUE(argus_guard_may_turn(&g));
    put_health(&k.sonar[0], ARGUS_HEALTHY, ARGUS_KIND_NONE, 0);
    TEST_ASSERT_FALSE(argus_guard_may_turn(&g));
    k.sonar[0].reading_mm = 5000;
    TEST_ASSERT_TRUE(argus_guard_may_turn(&g));
}

// What has left the cones counts under argus alone.
void test_s7_what_is_remembered(void) {
    remember_at(0, 300);
    TEST_ASSERT_TRUE(argus_guard_may_turn(&g));
    use(ARGUS_PROFILE_ARGUS);
    TEST_ASSERT_FALSE(argus_guard_may_turn(&g));
    TEST_ASSERT_TRUE(argus_guard_memory_blocks(&g));
    TEST_ASSERT_EQUAL(300, argus_guard_nearest_mm(&g, 0));
    TEST_ASSERT_INT32_WITHIN(1, argus_hypot(200, 300), argus_guard_nearest_mm(&g, 200));
}

void test_s7_a_touch_in_a_turn_is_the_first_or_one_more(void) {
    argus_point_t at;
    bool left = false;
    echo_at(370 + 11);
    TEST_ASSERT_EQUAL(ARGUS_TOUCH_NONE, argus_guard_touch(&g, 0, &at, &left));
    echo_at(370 + 10);
    TEST_ASSERT_EQUAL(ARGUS_TOUCH_FIRST, argus_guard_touch(&g, 0, &at, &left));
    TEST_ASSERT_TRUE(left);
    argus_echoes_touched(&e, at, NOW_MS);
    TEST_ASSERT_EQUAL(ARGUS_TOUCH_AGAIN, argus_guard_touch(&g, 0, &at, &left));
    k.sonar[7].reading_mm = k.sonar[0].reading_mm;
    TEST_ASSERT_EQUAL(ARGUS_TOUCH_FIRST, argus_guard_touch(&g, 7, &at, &left));
    TEST_ASSERT_FALSE(left);
}

// A turn of 20 degrees at most asks for what the body sweeps in it, under `argus`: beside a wall it may turn
// away from it, not into it.
void test_s7_a_nudge_asks_for_what_the_body_sweeps(void) {
    use(ARGUS_PROFILE_ARGUS);
    k.sonar[0].reading_mm = 150; // walls at 286 mm: 73 beside the body
    k.sonar[15].reading_mm = 150;
    TEST_ASSERT_FALSE(argus_guard_may_turn(&g));
    TEST_ASSERT_TRUE(argus_guard_may_nudge(&g, -500));
    TEST_ASSERT_FALSE(argus_guard_may_nudge(&g, -2000)); // the rear corner comes too near
    TEST_ASSERT_FALSE(argus_guard_may_nudge(&g, 2000));  // the front one
    k.sonar[15].reading_mm = 3000;
    TEST_ASSERT_TRUE(argus_guard_may_nudge(&g, -2000));
    TEST_ASSERT_FALSE(argus_guard_may_nudge(&g, -2001));
    TEST_ASSERT_FALSE(argus_guard_may_nudge(&g, 2000));
    remember_at(-230, 290);
    TEST_ASSERT_FALSE(argus_guard_may_nudge(&g, -2000));
}

void test_s7_who_may_not_nudge(void) {
    TEST_ASSERT_FALSE(argus_guard_may_nudge(&g, 500)); // the paper
    use(ARGUS_PROFILE_ARGUS);
    TEST_ASSERT_TRUE(argus_guard_may_nudge(&g, 500));
    g.bumpers = 1;
    TEST_ASSERT_FALSE(argus_guard_may_nudge(&g, 500));
    g.bumpers = 0;
    g.active = false;
    TEST_ASSERT_FALSE(argus_guard_may_nudge(&g, 500));
}

// Whatever is near: a nudge that is allowed leaves 40 mm round the body all the way.
void test_s7_no_nudge_brings_the_body_near_anything(void) {
    use(ARGUS_PROFILE_ARGUS);
    srand(1);
    int allowed = 0;
    for (int i = 0; i < 20000; i++) {
        const int sonar = rand() % SONARS;
        const int by = rand() % 4001 - 2000;
        const uint16_t before = k.sonar[sonar].reading_mm;
        k.sonar[sonar].reading_mm = (uint16_t)(100 + rand() % 400);
        const argus_point_t at = argus_echo_robot(&k, sonar);
        const bool may = argus_guard_may_nudge(&g, by);
        allowed += may;
        for (int part = 1; part <= 5 && may; part++) {
            const double turned = by * part / 5 / 18000.0 * 3.14159265358979;
            const double x = at.x_mm * cos(turned) + at.y_mm * sin(turned);
            const double y = at.y_mm * cos(turned) - at.x_mm * sin(turned);
            snprintf(text, sizeof text, "seed 1, %d: sonar %d, by %d", i, sonar, by);
            TEST_ASSERT_TRUE_MESSAGE(x > 247 || x < -338 || fabs(y) > 249, text);
        }
        k.sonar[sonar].reading_mm = before;
    }
    TEST_ASSERT_TRUE(allowed > 5000 && allowed < 19000);
}

// S7: back -------------------------------------------------------------------------------------------------

static bool looks_aslant_back(int sonar) {
    const int deg = abs(argus_robot_table.poses[sonar].heading_deg);
    return deg == 130 || deg == 150;
}

void test_s7_the_rear_is_clear_when_all_of_it_reads_clear(void) {
    for (int i = 8; i < SONARS; i++) {
        const bool abeam = i == 8 || i == 15;
        for (int32_t profile = ARGUS_PROFILE_PAPER; profile <= ARGUS_PROFILE_ARGUS; profile++) {
            setUp();
            use(profile);
            const int clear_mm =
                abeam && profile == ARGUS_PROFILE_ARGUS ? 97 + config.backoff_mm / 2 : config.rear_clear_mm;
            k.sonar[i].reading_mm = (uint16_t)clear_mm;
            TEST_ASSERT_EQUAL(profile == ARGUS_PROFILE_ARGUS && looks_aslant_back(i),
                              argus_guard_rear_is_clear(&g));
            k.sonar[i].reading_mm++;
            TEST_ASSERT_TRUE(argus_guard_rear_is_clear(&g));
        }
    }
    setUp();
    k.sonar[3].reading_mm = 100; // not behind
    TEST_ASSERT_TRUE(argus_guard_rear_is_clear(&g));
}

// The post of a door and a wall along the way stand beside it. Wherever in its cone the echo is, the body
// does not come to it on the usual way back, nor on a longer one.
void test_s7_what_stands_beside_the_way_back_is_passed_by(void) {
    use(ARGUS_PROFILE_ARGUS);
    const argus_robot_t *robot = argus_robot_default();
    remember_at(250, 0); // so near that more than the usual way would free a turn
    int passed = 0;
    for (int i = 8; i < SONARS; i++) {
        for (int range = 100; range <= config.rear_clear_mm && looks_aslant_back(i); range++) {
            k.sonar[i].reading_mm = (uint16_t)range;
            if (!argus_guard_rear_is_clear(&g)) {
                continue;
            }
            passed++;
            TEST_ASSERT_EQUAL(config.backoff_mm, argus_guard_back_mm(&g));
            const argus_sonar_pose_t *pose = &argus_robot_table.poses[i];
            for (int off = -15; off <= 15; off++) {
                const double at = (pose->heading_deg + off) * 3.14159265358979 / 180;
                const double x = pose->x_mm + range * cos(at), y = pose->y_mm + range * sin(at);
                snprintf(text, sizeof text, "sonar %d, %d mm, %d degrees off", i, range, off);
                TEST_ASSERT_TRUE_MESSAGE(x < -robot->rear_mm - config.backoff_mm - 100 ||
                                             fabs(y) > argus_robot_half_width_mm(robot) + 15,
                                         text);
            }
        }
        k.sonar[i].reading_mm = 5000;
    }
    TEST_ASSERT_TRUE(passed > 300);
}

void test_s7_nobody_backs_past_a_sonar_that_cannot_be_relied_on(void) {
    for (int i = 8; i < SONARS; i++) {
        setUp();
        k.sonar[i].heard_ms = NOW_MS - (uint32_t)config.stale_ms;
        TEST_ASSERT_TRUE(argus_guard_rear_is_watched(&g));
        k.sonar[i].heard_ms--;
        TEST_ASSERT_FALSE(argus_guard_rear_is_watched(&g));
        k.sonar[i].heard_ms = NOW_MS;
        put_health(&k.sonar[i], ARGUS_DISABLED, ARGUS_KIND_OFF, 0);
        TEST_ASSERT_FALSE(argus_guard_rear_is_clear(&g));
        put_health(&k.sonar[i], ARGUS_SUSPECT, ARGUS_KIND_NONE, 0);
        TEST_ASSERT_TRUE(argus_guard_rear_is_clear(&g));
        put_health(&k.sonar[i], ARGUS_SUSPECT, ARGUS_KIND_OFF, 0); // it has the name of a fault
        TEST_ASSERT_FALSE(argus_guard_rear_is_clear(&g));
    }
}

void test_s7_it_backs_away_three_times_in_one_place(void) {
    for (uint8_t backed = 0; backed < 5; backed++) {
        g.backed = backed;
        TEST_ASSERT_EQUAL(backed < 3, argus_guard_may_back_off(&g));
    }
    g.backed = 0;
    g.bumpers = 1;
    TEST_ASSERT_FALSE(argus_guard_may_back_off(&g));
}

void test_s7_how_far_back(void) {
    remember_at(250, 0); // 390 + 10 mm are wanted: 250 + 175 > 400
    TEST_ASSERT_EQUAL(config.backoff_mm, argus_guard_back_mm(&g));
    use(ARGUS_PROFILE_ARGUS);
    TEST_ASSERT_EQUAL(175, argus_guard_back_mm(&g));
    g.backed = 2; // far once is far enough
    TEST_ASSERT_EQUAL(config.backoff_mm, argus_guard_back_mm(&g));
    g.backed = 0;
    remember_at(-400, 200); // beside the way back
    TEST_ASSERT_EQUAL(config.backoff_mm, argus_guard_back_mm(&g));
    config.rear_clear_mm = 250; // less than the usual way is read clear
    TEST_ASSERT_EQUAL(100, argus_guard_back_mm(&g));
}

void test_s5_how_fast_back(void) {
    TEST_ASSERT_EQUAL(config.step_speed_mm_s, argus_guard_back_speed_mm_s(&g));
    use(ARGUS_PROFILE_ARGUS);
    TEST_ASSERT_EQUAL(config.speed_mm_s, argus_guard_back_speed_mm_s(&g));
    const int32_t overhang_mm = 64; // of sonars 10 and 13
    config.object_range_mm = argus_config_stop_mm(&config, argus_robot_default(), 0) + overhang_mm;
    TEST_ASSERT_EQUAL(config.step_speed_mm_s, argus_guard_back_speed_mm_s(&g));
    config.object_range_mm++;
    TEST_ASSERT_EQUAL(config.speed_mm_s, argus_guard_back_speed_mm_s(&g));
}

// Nothing is changed by asking.// S2, S5: what was heard in the way a moment ago is there though nothing
// hears it now.
void test_s5_what_was_heard_in_the_way_counts_though_it_is_silent(void) {
    const int face_mm = k.robot->sonar_face_mm;
    const int half_mm = (int)argus_guard_straight_half_mm(k.robot);
    use(ARGUS_PROFILE_ARGUS);
    TEST_ASSERT_EQUAL(config.speed_max_mm_s, argus_guard_free_speed_mm_s(&g, INT32_MAX));
    remember_at(face_mm + 400, half_mm); // beside it
    TEST_ASSERT_EQUAL(config.speed_max_mm_s, argus_guard_free_speed_mm_s(&g, INT32_MAX));
    remember_at(face_mm + 400, half_mm - 1);
    TEST_ASSERT_EQUAL(400, argus_guard_heard_mm(&g));
    const int32_t slow_mm_s = argus_guard_free_speed_mm_s(&g, INT32_MAX);
    TEST_ASSERT_TRUE(slow_mm_s < config.speed_max_mm_s);
    k.sonar[3].reading_mm = 400; // as fast as if it heard it
    TEST_ASSERT_EQUAL(slow_mm_s, argus_guard_free_speed_mm_s(&g, INT32_MAX));
    k.sip_ms += 5001; // a moment is over
    TEST_ASSERT_TRUE(argus_guard_heard_mm(&g) > 3000);
}

void test_questions_change_nothing(void) {
    remember_at(200, 100);
    echo_at(300);
    use(ARGUS_PROFILE_ARGUS);
    const argus_knowledge_t knowledge = k;
    const argus_echoes_t echoes = e;
    argus_guard_may_turn(&g);
    argus_guard_back_mm(&g);
    argus_guard_may_translate(&g);
    TEST_ASSERT_EQUAL_MEMORY(&knowledge, &k, sizeof k);
    TEST_ASSERT_EQUAL_MEMORY(&echoes, &e, sizeof e);
}

// S1: without an echo the end that leads is heard no more: after one metre where it has heard none, after
// four where it has, and at once where another end has led.
void test_an_end_that_leads_without_an_echo_is_not_heard(void) {
    static const struct {
        bool heard, changed;
        uint32_t mm;
        bool led;
    } rows[] = {{true, false, 3999, false}, {true, false, 4000, true},  {false, false, 999, false},
                {false, false, 1000, true}, {false, true, 3999, false}, {false, true, 4000, true}};
    use(ARGUS_PROFILE_ARGUS);
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        for (int by_lead = 0; by_lead < 2; by_lead++) {
            setUp();
            use(ARGUS_PROFILE_ARGUS);
            k.heard = rows[i].heard ? (argus_mask_t)0xFFFFu : 0;
            k.odometer_mm = 20000;
            g.reverse.done = rows[i].changed;
            g.reverse.odometer_mm = by_lead != 0 ? 20000u - rows[i].mm : 0u;
            for (int s = 0; s < SONARS; s++) { // the lesser of both ways counts
                k.sonar[s].echo_mm = by_lead != 0 ? 0 : 20000 - rows[i].mm;
            }
            if (!rows[i].heard && by_lead == 0) {
                continue; // an echo that never was has no way
            }
            TEST_ASSERT_EQUAL(rows[i].led, argus_guard_has_led(&g));
            TEST_ASSERT_EQUAL(rows[i].heard && !rows[i].led, argus_guard_is_heard(&g));
        }
    }
    use(ARGUS_PROFILE_PAPER); // asks for none
    TEST_ASSERT_FALSE(argus_guard_has_led(&g));
    TEST_ASSERT_TRUE(argus_guard_is_heard(&g));
}

// S5: what is doubted ahead is not counted on by rules that drive by what others have seen; the other rules
// do not drive with a doubt at all, so there it is the way that is seen.
void test_s5_doubt_slows_by_the_rules_that_drive_with_it(void) {
    for (int seen = 0; seen < 2; seen++) {
        for (int doubted = 0; doubted < 2; doubted++) {
            setUp();
            use(ARGUS_PROFILE_ARGUS);
            argus_profile_t rules = *g.profile;
            rules.drives_seen = seen;
            g.profile = &rules;
            k.heard = (argus_mask_t)0xFFFFu;
            if (doubted != 0) {
                put_health(&k.sonar[3], ARGUS_SUSPECT, ARGUS_KIND_WRONG, NOW_MS);
            }
            const int32_t mm_s = argus_guard_speed_mm_s(&g, INT32_MAX);
            const bool slow = seen != 0 && doubted != 0;
            TEST_ASSERT_EQUAL(slow ? argus_min(config.step_speed_mm_s, config.speed_mm_s)
                                   : argus_guard_free_speed_mm_s(&g, INT32_MAX),
                              mm_s);
        }
    }
}

// What was heard twice a moment ago bars a nudge like what is heard now; the last of many as the first.
void test_s7_no_nudge_brings_the_body_near_what_is_remembered(void) {
    use(ARGUS_PROFILE_ARGUS);
    TEST_ASSERT_TRUE(argus_guard_may_nudge(&g, 1000));
    for (int others = 0; others < 3; others++) {
        e.count = 0;
        for (int i = 0; i <= others; i++) {
            place_echo(&e, &k, i < others ? 900 : 0,
                       i < others ? 100 * i : argus_robot_half_width_mm(k.robot) + 5);
            e.at[i].again = true;
        }
        TEST_ASSERT_FALSE(argus_guard_may_nudge(&g, 1000));
    }
}
