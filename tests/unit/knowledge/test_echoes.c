// SPDX-License-Identifier: MIT
// Rule under attack: what is remembered, where, for how long, and what of it counts as seen again.
#include "knowledge/echoes.h"

#include <stdio.h>
#include <stdlib.h>

#include "echo.h"
#include "health.h"
#include "unity.h"

static argus_echoes_t e;
static argus_knowledge_t k;
static char text[32];

void setUp(void) {
    argus_echoes_init(&e);
    argus_knowledge_init(&k);
    k.sip_ms = 100000;
}

void test_echoes_are_remembered_where_they_lie(void) {
    k.pose.heading_cdeg = 9000;
    see_echo(&e, &k, 3, 1000); // mounted at +10 degrees
    TEST_ASSERT_EQUAL(1, e.count);
    TEST_ASSERT_INT32_WITHIN(5, -200, e.at[0].x_mm);
    TEST_ASSERT_INT32_WITHIN(5, 1151, e.at[0].y_mm);
}

void test_what_is_not_remembered(void) {
    see_echo(&e, &k, 3, 2000);
    see_echo(&e, &k, 3, 5000);
    put_health(&k.sonar[4], ARGUS_DISABLED, ARGUS_KIND_OFF, 0);
    see_echo(&e, &k, 4, 500);
    put_health(&k.sonar[5], ARGUS_SUSPECT, ARGUS_KIND_NONE, 0);
    see_echo(&e, &k, 5, 500);
    k.rotating = true;
    see_echo(&e, &k, 2, 500);
    TEST_ASSERT_EQUAL(0, e.count);
}

// S7 asks for what is near, and one echo may be crosstalk: two of one thing, 5 s and 150 mm apart at most, by
// whomever; what was touched is there for sure.
void test_near_is_what_was_seen_again(void) {
    static const struct {
        int second;
        int second_mm;
        uint32_t later_ms;
        bool again;
    } by[] = {{0, 200, 320, true},  {0, 200, 5000, true},  {0, 200, 5001, false}, {0, 349, 320, true},
              {0, 352, 320, false}, {15, 200, 320, false}, {1, 150, 320, true},   {0, 120, 320, true}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        setUp();
        see_echo(&e, &k, 0, 200);
        TEST_ASSERT_EQUAL(INT32_MAX, argus_echoes_nearest_mm(&e, &k, 0));
        k.sip_ms += by[i].later_ms;
        see_echo(&e, &k, by[i].second, by[i].second_mm);
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].again, argus_echoes_nearest_mm(&e, &k, 0) < INT32_MAX, text);
    }
    setUp();
    const argus_point_t touched = {240, 0};
    argus_echoes_touched(&e, touched, k.sip_ms);
    TEST_ASSERT_EQUAL(240, argus_echoes_nearest_mm(&e, &k, 0));
}

// ... and stays so in its place for the minute that it is remembered.
void test_what_was_seen_twice_once_more_is_seen_again(void) {
    for (int late = 0; late < 2; late++) {
        setUp();
        see_echo(&e, &k, 3, 200);
        k.sip_ms += 320;
        see_echo(&e, &k, 3, 200);
        k.sip_ms += 60000u + (uint32_t)late;
        TEST_ASSERT_EQUAL(INT32_MAX, argus_echoes_nearest_mm(&e, &k, 0));
        see_echo(&e, &k, 3, 210);
        TEST_ASSERT_EQUAL(!late, argus_echoes_nearest_mm(&e, &k, 0) < INT32_MAX);
    }
}

// S7: what stands beside the body, between two cones, does not go away because no sonar looks there. Here at
// (69, 336), and then the robot drives so far.
static void pass(int driven_mm) {
    setUp();
    see_echo(&e, &k, 0, 200);
    k.sip_ms += 320;
    see_echo(&e, &k, 0, 200);
    k.pose.x_mm = driven_mm;
}

void test_what_stands_abreast_of_the_body_stays_for_a_minute(void) {
    static const struct {
        int driven_mm;
        uint32_t later_ms;
        bool stays;
    } by[] = {{100, 5000, true},   {100, 5001, true},   {100, 60000, true},
              {100, 60001, false}, {369, 60000, true},  {370, 60000, false},
              {370, 5000, true},   {-140, 60000, true}, {-141, 60000, false}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        pass(by[i].driven_mm);
        k.sip_ms += by[i].later_ms;
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].stays, argus_echoes_nearest_mm(&e, &k, 0) < INT32_MAX, text);
    }
}

// ... until one hears past it: within 12 degrees of its axis, 40 mm farther off. Silence is no proof, nor is
// a reading in a turn or of a suspect.
void test_what_a_sonar_hears_past_has_gone(void) {
    static const struct {
        int sonar;
        int mm;
        int driven_mm;
        bool stays;
    } by[] = {{0, 900, 0, false},  {0, 241, 0, false}, {0, 240, 0, true}, {0, 900, 40, false},
              {0, 900, 45, true},  {0, 5000, 0, true}, {1, 900, 0, true}, {15, 900, 226, false},
              {8, 900, 226, true}, {7, 900, 0, true}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        for (int doubt = 0; doubt < 3; doubt++) {
            pass(by[i].driven_mm);
            put_health(&k.sonar[by[i].sonar], doubt == 1 ? ARGUS_SUSPECT : ARGUS_HEALTHY, ARGUS_KIND_NONE, 0);
            k.rotating = doubt == 2;
            see_echo(&e, &k, by[i].sonar, by[i].mm);
            k.sip_ms += 5001;
            snprintf(text, sizeof text, "case %d, doubt %d", i, doubt);
            TEST_ASSERT_EQUAL_MESSAGE(by[i].stays || doubt != 0, argus_echoes_nearest_mm(&e, &k, 0) < 375,
                                      text);
        }
    }
}

// ... and a face behind a corner, heard next to it from farther on, does not take its place.
void test_a_face_does_not_take_the_place_of_its_corner(void) {
    pass(50);
    see_echo(&e, &k, 0, 250);
    see_echo(&e, &k, 0, 250);
    TEST_ASSERT_EQUAL(2, e.count);
    k.sip_ms += 5001;
    TEST_ASSERT_INT32_WITHIN(1, 336, argus_echoes_nearest_mm(&e, &k, 0));
    see_echo(&e, &k, 0, 190); // nearer: the same place
    TEST_ASSERT_EQUAL(2, e.count);
}

// A sonar hears what lies anywhere in its cone, and an echo is put on the axis: from afar two of a wall aside
// are put where the way is free. When the robot has come there they forbade it to turn.
void test_an_echo_from_afar_shows_nothing_again(void) {
    static const struct {
        int first_mm;
        int second_mm;
        bool again;
    } by[] = {
        {1900, 1900, false}, {1001, 1001, false}, {1000, 1000, true}, {1010, 990, true}, {990, 1010, false}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        setUp();
        see_echo(&e, &k, 3, by[i].first_mm);
        see_echo(&e, &k, 3, by[i].second_mm);
        k.pose.x_mm = by[i].second_mm;
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].again, argus_echoes_nearest_mm(&e, &k, 0) < INT32_MAX, text);
    }
}

// ... nor does it take away what was seen again from near.
void test_an_echo_from_afar_takes_nothing_away(void) {
    see_echo(&e, &k, 3, 900);
    see_echo(&e, &k, 3, 900);
    k.pose.x_mm = -500;
    see_echo(&e, &k, 3, 1400); // 87 mm farther left: another place, and
    TEST_ASSERT_EQUAL(2, e.count);
    k.pose.y_mm = -87; // ... the same
    see_echo(&e, &k, 3, 1408);
    k.pose.x_mm = 500;
    TEST_ASSERT_TRUE(argus_echoes_nearest_mm(&e, &k, 0) < INT32_MAX);
}

void test_one_thing_is_at_most_150_mm_apart_each_way(void) {
    const argus_point_t at = {-40, 70};
    for (int sign = -1; sign <= 1; sign += 2) {
        TEST_ASSERT_TRUE(argus_are_one_thing(at, (argus_point_t){-40 + 150 * sign, 70 - 150 * sign}));
        TEST_ASSERT_FALSE(argus_are_one_thing(at, (argus_point_t){-40 + 151 * sign, 70}));
        TEST_ASSERT_FALSE(argus_are_one_thing((argus_point_t){-40, 70 + 151 * sign}, at));
    }
}

// A turn asks whether an echo is the second one of something near: at (69, 336), 343 mm from the centre.
void test_what_a_turn_is_told_of_a_second_echo(void) {
    see_echo(&e, &k, 0, 200);
    const argus_point_t there = argus_to_course(&k.pose, argus_echo_robot(&k, 0));
    const argus_point_t aside = {there.x_mm + 150, there.y_mm};
    const argus_point_t beyond = {there.x_mm + 151, there.y_mm};
    TEST_ASSERT_TRUE(argus_echoes_have_seen(&e, &k, there, 345));
    TEST_ASSERT_FALSE(argus_echoes_have_seen(&e, &k, there, 340));
    TEST_ASSERT_TRUE(argus_echoes_have_seen(&e, &k, aside, 345));
    TEST_ASSERT_FALSE(argus_echoes_have_seen(&e, &k, beyond, 345));
    k.sip_ms += 5001;
    TEST_ASSERT_FALSE(argus_echoes_have_seen(&e, &k, there, 345));
}

void test_a_convicted_sonars_echoes_are_forgotten(void) {
    see_echo(&e, &k, 3, 500);
    see_echo(&e, &k, 6, 900);
    see_echo(&e, &k, 2, 1300);
    argus_echoes_forget(&e, 6, true);
    TEST_ASSERT_EQUAL(2, e.count);
    for (int i = 0; i < e.count; i++) {
        TEST_ASSERT_TRUE(e.at[i].sonar != 6);
    }
}

// One that hears nothing any more has told the truth until then.
void test_what_a_deaf_sonar_heard_stays(void) {
    see_echo(&e, &k, 3, 500);
    see_echo(&e, &k, 6, 900);
    argus_echoes_forget(&e, 6, false);
    TEST_ASSERT_EQUAL(2, e.count);
}

void test_memory_is_bounded_and_drops_the_oldest(void) {
    for (int i = 0; i < 2 * ARGUS_POINTS_MAX; i++) {
        k.pose.x_mm = i * 100;
        see_echo(&e, &k, 3, 500);
        TEST_ASSERT_TRUE(e.count < ARGUS_POINTS_MAX + 1);
        TEST_ASSERT_TRUE(e.next < ARGUS_POINTS_MAX);
    }
    int newest = 0;
    for (int i = 0; i < e.count; i++) {
        newest += e.at[i].x_mm >= (2 * ARGUS_POINTS_MAX - 20) * 100 + 600;
    }
    TEST_ASSERT_TRUE_MESSAGE(newest >= 20, "the newest echoes are not all there");
}

void test_free_length_of_a_corridor(void) {
    TEST_ASSERT_EQUAL(INT32_MAX, argus_echoes_clear_mm(&e, &k, 0, 305));
    place_echo(&e, &k, 1000, 100);
    TEST_ASSERT_INT32_WITHIN(2, 1000, argus_echoes_clear_mm(&e, &k, 0, 305));
    TEST_ASSERT_EQUAL(INT32_MAX, argus_echoes_clear_mm(&e, &k, 9000, 305));
    TEST_ASSERT_EQUAL(INT32_MAX, argus_echoes_clear_mm(&e, &k, 18000, 305));
    place_echo(&e, &k, 700, -500); // beside the corridor
    TEST_ASSERT_INT32_WITHIN(2, 1000, argus_echoes_clear_mm(&e, &k, 0, 305));
    k.sip_ms += 60001; // long ago
    TEST_ASSERT_EQUAL(INT32_MAX, argus_echoes_clear_mm(&e, &k, 0, 305));
}

void test_ahead_is_what_was_seen_twice_in_the_way_of_the_body(void) {
    const struct {
        int x_mm, y_mm;
        bool ahead;
    } by[] = {{600, 0, true}, {600, 259, true}, {600, 260, false}, {600, -260, false},
              {101, 0, true}, {100, 0, false},  {-600, 0, false}};
    for (size_t i = 0; i < sizeof by / sizeof by[0]; i++) {
        setUp();
        place_echo(&e, &k, by[i].x_mm, by[i].y_mm);
        TEST_ASSERT_EQUAL(INT32_MAX, argus_echoes_ahead_mm(&e, &k, 260)); // once may be crosstalk
        e.at[0].again = true;
        TEST_ASSERT_EQUAL(by[i].ahead ? by[i].x_mm : INT32_MAX, argus_echoes_ahead_mm(&e, &k, 260));
        k.sip_ms += 5001;
        TEST_ASSERT_EQUAL(INT32_MAX, argus_echoes_ahead_mm(&e, &k, 260));
    }
}

void test_a_bumper_hit_is_remembered_ahead_and_in_the_map(void) {
    k.bumpers_front = 1 << 3;
    argus_echoes_met(&e, &k, ARGUS_CONTACT_BUMPER);
    TEST_ASSERT_EQUAL(1, e.touches.count);
    TEST_ASSERT_TRUE(e.touches.at[0].x_mm > 200 && abs(e.touches.at[0].y_mm) < 20);
    TEST_ASSERT_TRUE(argus_grid_is_occupied(&e.grid, argus_grid_cell(e.touches.at[0])));
    setUp();
    k.bumpers_front = 1 << 1; // leftmost
    argus_echoes_met(&e, &k, ARGUS_CONTACT_BUMPER);
    TEST_ASSERT_TRUE(e.touches.at[0].y_mm > 100);
}

// What is touched stands there whatever beams pass, whoever is given up and however long ago it was.
void test_what_was_touched_stays(void) {
    argus_echoes_met(&e, &k, ARGUS_CONTACT_AHEAD);
    TEST_ASSERT_EQUAL(3, e.touches.count);
    const argus_cell_t there = argus_grid_cell(e.touches.at[1]);
    argus_echoes_forget(&e, 3, true);
    TEST_ASSERT_TRUE(argus_grid_is_occupied(&e.grid, there));
    for (int i = 0; i < 4; i++) {
        argus_grid_fade(&e.grid);
    }
    k.sip_ms += 600000;
    argus_echoes_see(&e, &k, k.sip_ms);
    TEST_ASSERT_TRUE(argus_grid_is_occupied(&e.grid, there));
    TEST_ASSERT_EQUAL(e.touches.at[1].x_mm, argus_echoes_clear_mm(&e, &k, 0, 200));
    TEST_ASSERT_EQUAL(e.touches.at[1].x_mm, argus_echoes_nearest_mm(&e, &k, 0));
}

// Half of the body's width to either side is beside, not in the way.
void test_what_lies_on_the_edge_of_the_way_is_not_in_it(void) {
    place_echo(&e, &k, 1000, 200);
    place_echo(&e, &k, 1000, -200);
    TEST_ASSERT_EQUAL(INT32_MAX, argus_echoes_clear_mm(&e, &k, 0, 200));
    TEST_ASSERT_EQUAL(1000, argus_echoes_clear_mm(&e, &k, 0, 201));
}

void test_a_place_beyond_16_bits_is_not_remembered(void) {
    static const argus_point_t far[] = {{40000, 0}, {-40000, 0}, {0, 40000}, {0, -40000}};
    for (size_t i = 0; i < sizeof far / sizeof far[0]; i++) {
        argus_echoes_touched(&e, far[i], k.sip_ms);
    }
    TEST_ASSERT_EQUAL(0, e.count);
    argus_echoes_touched(&e, (argus_point_t){INT16_MAX, -INT16_MAX}, k.sip_ms);
    TEST_ASSERT_EQUAL(1, e.count);
}

// A turn sweeps nothing from a metre on.
void test_what_lies_a_metre_off_is_about_the_robot_no_more(void) {
    for (int mm = 998; mm <= 1002; mm++) {
        for (int axis = 0; axis < 2; axis++) {
            setUp();
            argus_point_t at;
            place_echo(&e, &k, axis == 0 ? mm : 0, axis == 0 ? 0 : -mm);
            e.at[0].again = true;
            const argus_view_t from = argus_view(&k);
            TEST_ASSERT_EQUAL(mm < 1000, argus_echoes_beside(&e, &from, 0, &at));
        }
    }
}
