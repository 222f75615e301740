// SPDX-License-Identifier: MIT
// Rule under attack (profile argus): a sonar is only ever turned onto what another one, that is relied on,
// lately heard near by from the same place, and only where that is news; what moves beside it is no evidence.
#include "awareness/evidence.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "awareness/evidence_internal.h"
#include "knowledge/angle.h"
#include "scene.h"
#include "unity.h"

#define HEARD_MM 1200
#define OLDEST_MS 10000u
#define TURN_LEAST_CDEG 300
#define TURN_MOST_CDEG 10000
#define NEAREST_MM 250
#define FARTHEST_MM 4450

static argus_knowledge_t k;
static argus_evidence_t e;
static int32_t aim_cdeg;

void setUp(void) {
    scene_blank(&k, &e);
    aim_cdeg = INT32_MIN;
}

// What `sonar` would have taken for a view from the present place, so long ago.
static argus_view_t *view(int sonar, int32_t reading_mm, uint32_t age_ms) {
    const argus_sonar_pose_t *mount = &argus_sonar_poses[sonar];
    const argus_point_t robot = {mount->x_mm, mount->y_mm};
    const argus_point_t at = argus_to_course(&k.pose, robot);
    argus_case_t *c = &e.of[sonar];
    argus_view_t *v = &c->view[c->view_next];
    c->view_next = (uint8_t)((c->view_next + 1) % ARGUS_VIEWS);
    *v = (argus_view_t){.x_mm = at.x_mm,
                        .y_mm = at.y_mm,
                        .bearing_cdeg = argus_angle_wrap(k.pose.heading_cdeg + mount->heading_deg * 100),
                        .t_ms = k.sip_ms - age_ms,
                        .reading_mm = (uint16_t)reading_mm,
                        .rest = true,
                        .valid = true};
    return v;
}

static bool aims(int sonar) {
    aim_cdeg = INT32_MIN;
    const bool found = argus_evidence_aim(&e, &k, sonar, &aim_cdeg);
    TEST_ASSERT_TRUE(!found || (aim_cdeg > -18000 && aim_cdeg <= 18000));
    return found;
}

// 3 looks to +10 degrees, 4 to -10: on -20 it looks where 4 does now.
void test_it_looks_along_the_bearing_that_another_has_heard_on(void) {
    for (int32_t heading = -17990; heading <= 18000; heading += 130) {
        setUp();
        k.pose = (argus_pose_t){70000, -70000, heading};
        const argus_view_t *heard = view(4, HEARD_MM, 500);
        TEST_ASSERT_TRUE(aims(3));
        TEST_ASSERT_EQUAL_INT32(argus_angle_wrap(heading - 2000), aim_cdeg);
        TEST_ASSERT_EQUAL_INT32(heard->bearing_cdeg,
                                argus_angle_wrap(aim_cdeg + argus_sonar_poses[3].heading_deg * 100));
    }
}

void test_there_is_no_aim_where_nobody_has_heard_anything(void) {
    for (int sonar = 0; sonar < ARGUS_SONARS; sonar++) {
        TEST_ASSERT_FALSE(aims(sonar));
        TEST_ASSERT_EQUAL_INT32(INT32_MIN, aim_cdeg);
    }
}

// What it heard itself is no witness of whether it hears.
void test_nobody_is_his_own_witness(void) {
    for (int sonar = 0; sonar < ARGUS_SONARS; sonar++) {
        setUp();
        view(sonar, HEARD_MM, 500);
        k.pose.heading_cdeg = 2000; // so that it would have to turn
        TEST_ASSERT_FALSE(aims(sonar));
    }
}

void test_only_what_is_near_is_aimed_at(void) {
    static const struct {
        int32_t mm;
        bool near;
    } heard[] = {{0, false},         {100, false},        {NEAREST_MM - 1, false},
                 {NEAREST_MM, true}, {FARTHEST_MM, true}, {FARTHEST_MM + 1, false},
                 {4999, false},      {5000, false},       {UINT16_MAX, false}};
    for (int i = 0; i < (int)(sizeof heard / sizeof heard[0]); i++) {
        setUp();
        view(4, heard[i].mm, 500);
        TEST_ASSERT_EQUAL_MESSAGE(heard[i].near, aims(3), "reading out of 250..3000 mm");
    }
}

void test_what_was_heard_long_ago_is_not_aimed_at(void) {
    view(4, HEARD_MM, OLDEST_MS);
    TEST_ASSERT_TRUE(aims(3));
    k.sip_ms++;
    TEST_ASSERT_FALSE(aims(3));
    k.sip_ms += 0x80000000u;
    TEST_ASSERT_FALSE(aims(3));
}

void test_what_was_heard_from_another_place_is_not_aimed_at(void) {
    static const int32_t far_off[][2] = {{160, 0}, {-160, 0}, {0, 160}, {0, -160}, {900, 900}, {0, 70000}};
    for (int i = 0; i < 6; i++) {
        setUp();
        view(4, HEARD_MM, 500);
        TEST_ASSERT_TRUE(aims(3));
        k.pose.x_mm = far_off[i][0];
        k.pose.y_mm = far_off[i][1];
        TEST_ASSERT_FALSE(aims(3));
    }
    setUp();
    view(4, HEARD_MM, 500);
    k.pose.y_mm = 100; // within reach along the bearing, but beside it
    TEST_ASSERT_FALSE(aims(3));
}

static void suspect(int sonar, argus_test_t test) {
    e.of[sonar].score[test] = argus_bounds[test].suspicious;
}

void test_one_that_is_doubted_is_no_witness(void) {
    for (int doubt = 0; doubt < 4 + ARGUS_TESTS; doubt++) {
        setUp();
        view(4, HEARD_MM, 500);
        TEST_ASSERT_TRUE(aims(3));
        if (doubt < 2) {
            k.sonar[4].health = doubt == 0 ? ARGUS_DISABLED : ARGUS_PROBATION;
        } else if (doubt < 4) {
            *(doubt == 2 ? &e.lost : &e.jumped) = 1u << 4;
        } else {
            suspect(4, (argus_test_t)(doubt - 4));
        }
        TEST_ASSERT_FALSE(aims(3));
        TEST_ASSERT_EQUAL_INT32(INT32_MIN, aim_cdeg);
    }
}

// It is the doubt of the witness that counts: who is doubted himself is the one to be turned.
void test_one_that_is_doubted_is_aimed_all_the_same(void) {
    view(4, HEARD_MM, 500);
    suspect(3, ARGUS_TEST_VIEW);
    e.lost = 1u << 3;
    TEST_ASSERT_TRUE(aims(3));
}

// Less than the width of a bearing shows nothing new; beyond 100 degrees others may look.
void test_the_turn_is_neither_idle_nor_half_round(void) {
    for (int side = -1; side <= 1; side += 2) {
        static const struct {
            int32_t turn_cdeg;
            bool worth;
        } turns[] = {{0, false},    {TURN_LEAST_CDEG - 1, false}, {TURN_LEAST_CDEG, true},
                     {4500, true},  {TURN_MOST_CDEG, true},       {TURN_MOST_CDEG + 1, false},
                     {18000, false}};
        for (int i = 0; i < (int)(sizeof turns / sizeof turns[0]); i++) {
            setUp();
            k.pose.heading_cdeg = 17000; // the heading to aim at is 15000
            view(4, HEARD_MM, 500);
            k.pose.heading_cdeg = argus_angle_wrap(15000 + side * turns[i].turn_cdeg);
            TEST_ASSERT_EQUAL(turns[i].worth, aims(3));
            TEST_ASSERT_EQUAL_INT32(turns[i].worth ? 15000 : INT32_MIN, aim_cdeg);
        }
    }
}

static void counted(int of, const argus_view_t *at, int partner, int32_t aside_mm) {
    argus_refuted_t *r = &e.of[of].refuted[0];
    *r = (argus_refuted_t){at->x_mm + aside_mm, at->y_mm, at->bearing_cdeg, (int8_t)partner};
}

// A conflict that was counted here already would not count again, whoever had the other side.
void test_what_has_been_counted_here_is_not_looked_at_again(void) {
    const argus_view_t *heard = view(4, HEARD_MM, 500);
    TEST_ASSERT_TRUE(aims(3));
    counted(3, heard, 4, 0);
    TEST_ASSERT_FALSE(aims(3));
    counted(3, heard, 5, 0);
    TEST_ASSERT_FALSE(aims(3));
    counted(3, heard, ARGUS_SCAN_PARTNER, 0);
    TEST_ASSERT_FALSE(aims(3));
    counted(3, heard, 4, 400); // elsewhere
    TEST_ASSERT_TRUE(aims(3));
    argus_evidence_init(&e);
    counted(4, view(4, HEARD_MM, 500), 3, 0); // of another
    TEST_ASSERT_TRUE(aims(3));
}

void test_of_two_like_turns_it_takes_the_nearer_thing(void) {
    for (int nearer = 0; nearer < 2; nearer++) {
        setUp();
        view(4, nearer == 0 ? 700 : 1900, 500); // to the right by 20 degrees
        view(2, nearer == 0 ? 1900 : 700, 500); // to the left by 20
        TEST_ASSERT_TRUE(aims(3));
        TEST_ASSERT_EQUAL_INT32(nearer == 0 ? -2000 : 2000, aim_cdeg);
    }
}

void test_of_two_like_things_it_takes_the_lesser_turn(void) {
    for (int side = -1; side <= 1; side += 2) { // whichever of them has the lower number
        setUp();
        view(side < 0 ? 5 : 1, HEARD_MM, 500);
        TEST_ASSERT_TRUE(aims(3));
        TEST_ASSERT_EQUAL_INT32(side * 4000, aim_cdeg);
        view(side < 0 ? 2 : 4, HEARD_MM, 500);
        TEST_ASSERT_TRUE(aims(3));
        TEST_ASSERT_EQUAL_INT32(side * -2000, aim_cdeg);
    }
}

// ---- whatever the state

static int below(int most) {
    return rand() % most;
}

static void random_state(unsigned seed) {
    srand(seed);
    setUp();
    k.sip_ms = (uint32_t)below(20000) - 10000u;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        k.pose = (argus_pose_t){below(60) - 30, below(60) - 30, below(36000) - 17999};
        for (int n = below(ARGUS_VIEWS + 1); n > 0; n--) {
            k.pose.heading_cdeg = below(36000) - 17999;
            view(i, below(4) == 0 ? 5000 : below(5000), (uint32_t)below(13000));
        }
        k.sonar[i].health = below(4) == 0 ? (argus_health_t)below(6) : ARGUS_HEALTHY;
        if (below(4) == 0) {
            e.of[i].score[below(ARGUS_TESTS)] = (int16_t)below(2000);
        }
    }
    e.lost = (uint16_t)(below(0x10000) & below(0x10000) & below(0x10000));
    e.jumped = (uint16_t)(below(0x10000) & below(0x10000) & below(0x10000));
}

static bool is_relied_on(int sonar) {
    return k.sonar[sonar].health != ARGUS_DISABLED && k.sonar[sonar].health != ARGUS_PROBATION &&
           ((unsigned)(e.lost | e.jumped) >> sonar & 1u) == 0 && !argus_evidence_suspects(&e, sonar);
}

// The view, of one that is relied on, that this heading looks along.
static bool is_borne_out(int sonar, int32_t heading_cdeg) {
    const int32_t bearing = argus_angle_wrap(heading_cdeg + argus_sonar_poses[sonar].heading_deg * 100);
    for (int other = 0; other < ARGUS_SONARS; other++) {
        for (int i = 0; other != sonar && is_relied_on(other) && i < ARGUS_VIEWS; i++) {
            const argus_view_t *v = &e.of[other].view[i];
            if (v->valid && v->bearing_cdeg == bearing && v->reading_mm >= NEAREST_MM &&
                v->reading_mm <= FARTHEST_MM && k.sip_ms - v->t_ms <= OLDEST_MS) {
                return true;
            }
        }
    }
    return false;
}

void test_every_aim_of_every_state_is_borne_out(void) {
    int found = 0;
    for (unsigned seed = 1; seed <= 800; seed++) {
        random_state(seed);
        for (int sonar = 0; sonar < ARGUS_SONARS; sonar++) {
            if (!aims(sonar)) {
                TEST_ASSERT_EQUAL_INT32(INT32_MIN, aim_cdeg);
                continue;
            }
            char text[60];
            snprintf(text, sizeof text, "seed %u, sonar %d, heading %d", seed, sonar, (int)aim_cdeg);
            const int32_t turn = argus_angle_abs_diff(aim_cdeg, k.pose.heading_cdeg);
            TEST_ASSERT_TRUE_MESSAGE(turn >= TURN_LEAST_CDEG && turn <= TURN_MOST_CDEG, text);
            TEST_ASSERT_TRUE_MESSAGE(is_borne_out(sonar, aim_cdeg), text);
            found++;
        }
    }
    TEST_ASSERT_TRUE_MESSAGE(found > 1000, "hardly anything was aimed at: the test shows nothing");
}

// ---- what moves before it or beside it

static scene_t s;
static int reading[ARGUS_SONARS];

static void see(int sonar, double deg, int mm) {
    s.th = deg * 3.14159265358979323846 / 180;
    reading[sonar] = mm;
    for (int i = 0; i < 4; i++) {
        scene_say(&s, 1u << sonar, reading);
    }
}

// 3 and 4 disagree on one bearing, so long after something moved before `restless`; the score of the latter.
static int conflict(int restless, uint32_t later_ms) {
    scene_init(&s, 1, 0xFFFFF000u);
    see(3, 0, 3000);
    if (restless >= 0) {
        argus_note_unrest(&s.e, &s.k, restless);
    }
    s.t_ms += later_ms;
    see(4, 20, 1000);
    TEST_ASSERT_TRUE(s.e.disagreements > 0);
    return s.e.of[4].score[ARGUS_TEST_VIEW];
}

static void counts_a_quarter(int restless) {
    const int calm = conflict(-1, 0);
    TEST_ASSERT_EQUAL(1, s.e.of[4].episodes);
    const int restless_score = conflict(restless, 0);
    TEST_ASSERT_INT_WITHIN(calm / 20, calm / 4, restless_score);
    TEST_ASSERT_EQUAL(0, s.e.of[4].episodes);
    TEST_ASSERT_EQUAL(1, s.e.of[4].conflicts);
}

void test_a_conflict_while_something_moves_before_it_counts_a_quarter_and_is_no_episode(void) {
    counts_a_quarter(4);
}

void test_a_conflict_while_something_moves_beside_it_counts_a_quarter_and_is_no_episode(void) {
    counts_a_quarter(3);
    counts_a_quarter(12);
}

// Among people, though nothing is seen to move.
void test_a_conflict_in_a_crowd_is_no_episode(void) {
    const int calm = conflict(-1, 0);
    scene_init(&s, 1, 0xFFFFF000u);
    see(3, 0, 3000);
    s.e.crowded = true;
    s.e.crowded_ms = s.k.sip_ms;
    see(4, 20, 1000);
    TEST_ASSERT_TRUE(s.e.crowded);
    TEST_ASSERT_EQUAL(calm, s.e.of[4].score[ARGUS_TEST_VIEW]);
    TEST_ASSERT_EQUAL(0, s.e.of[4].episodes);
}

void test_what_moved_some_time_ago_takes_nothing_from_a_conflict(void) {
    TEST_ASSERT_EQUAL(conflict(-1, 9000), conflict(4, 9000));
    TEST_ASSERT_EQUAL(1, s.e.of[4].episodes);
}

// One that is out sees things move that nobody else sees.
void test_the_unrest_of_one_that_is_out_protects_nobody_else(void) {
    scene_init(&s, 1, 0xFFFFF000u);
    see(3, 0, 3000);
    argus_note_unrest(&s.e, &s.k, 12);
    TEST_ASSERT_TRUE(argus_is_unrest_beside(&s.e, &s.k, 4));
    s.k.sonar[12].health = ARGUS_DISABLED;
    TEST_ASSERT_FALSE(argus_is_unrest_beside(&s.e, &s.k, 4));
    see(4, 20, 1000);
    TEST_ASSERT_EQUAL(1, s.e.of[4].episodes);
}

// One that is out sees things change that nobody else sees: nobody's conviction waits for that.
void test_the_unrest_of_one_that_is_out_delays_no_conviction(void) {
    scene_init(&s, 1, 0xFFFFF000u);
    s.k.sonar[11].health = ARGUS_DISABLED;
    argus_note_unrest(&s.e, &s.k, 11);
    TEST_ASSERT_FALSE(s.e.busy);
    s.k.sonar[11].health = ARGUS_HEALTHY;
    argus_note_unrest(&s.e, &s.k, 11);
    TEST_ASSERT_TRUE(s.e.busy);
}

// What 4 bears where 3 has heard at `mm` what it does not.
static int missed(int mm) {
    scene_init(&s, 1, 0xFFFFF000u);
    see(3, 0, mm);
    for (int i = 0; i < 2; i++) { // a silence is a view after five readings
        see(4, 20, 5000);
    }
    TEST_ASSERT_TRUE(s.e.disagreements > 0);
    return s.e.of[4].score[ARGUS_TEST_VIEW];
}

// Healthy pairs miss a tenth there: 1.4 nats, not 3.2.
void test_a_silence_is_worth_less_than_half_where_the_echo_is_faint(void) {
    const int near = missed(3900);
    const int faint = missed(4300);
    TEST_ASSERT_TRUE(near > 0);
    TEST_ASSERT_INT_WITHIN(near / 20, near * 45 / 100, faint);
}

// An echo from beyond 4 m comes and goes by itself, one from nearer does not.
void test_a_faint_echo_that_comes_and_goes_is_no_unrest(void) {
    for (int faint = 0; faint < 2; faint++) {
        scene_init(&s, 1, 0xFFFFF000u);
        for (int i = 0; i < 6; i++) {
            see(3, 0, faint ? 4300 : 3700);
            see(3, 0, 5000);
            see(3, 0, 5000);
        }
        TEST_ASSERT_EQUAL(!faint, s.e.busy);
    }
}

// Each sonar's for itself: one that goes on changing does not keep up what moved before another.
void test_what_moved_before_one_sonar_is_forgotten_whatever_goes_on_before_another(void) {
    scene_init(&s, 1, 0xFFFFF000u);
    see(3, 0, 3000);
    argus_note_unrest(&s.e, &s.k, 5);
    for (int i = 0; i < 4; i++) {
        argus_note_unrest(&s.e, &s.k, 2);
        see(3, 0, 3000);
        TEST_ASSERT_TRUE(s.e.busy);
        TEST_ASSERT_EQUAL_HEX16(i < 3 ? 1u << 5 | 1u << 2 : 1u << 2, s.e.stirred);
        s.t_ms += 10000;
    }
    s.k.sonar[2].health = ARGUS_DISABLED;
    see(3, 0, 3000);
    TEST_ASSERT_EQUAL_HEX16(0, s.e.stirred);
}
