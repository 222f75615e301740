// SPDX-License-Identifier: MIT
// Attacks: a step of the odometry that no robot makes gets into the pose, or one that a robot made is left
// out, however late, bunched or lost its SIPs are.
#include "knowledge/odometry.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "knowledge/angle.h"
#include "knowledge/body.h"
#include "knowledge/knowledge.h"
#include "unity.h"

#define PI 3.14159265358979

static argus_knowledge_t k;
static argus_sip_t sip;
static uint32_t now_ms;
static double x, y, th; // the odometry of the robot, mm and radians
static uint32_t seed;
static int leaps;

void setUp(void) {
    argus_knowledge_init(&k);
    memset(&sip, 0, sizeof sip);
    now_ms = 0xFFFFFE00u;
    x = y = th = 0;
    leaps = 0;
    seed = 20261125;
}

static int draw(int below) {
    seed = seed * 1664525u + 1013904223u;
    return (int)((seed >> 8) % (uint32_t)below);
}

static void deliver(uint32_t ms) {
    now_ms += ms;
    sip.x_raw = (uint16_t)(int)lround(x);
    sip.y_raw = (uint16_t)(int)lround(y);
    const int raw = (int)lround(th / (2 * PI) * 4096) % 4096;
    sip.heading_raw = (int16_t)(raw > 2048 ? raw - 4096 : raw < -2047 ? raw + 4096 : raw);
    argus_knowledge_sip(&k, &sip, 1000, now_ms);
    leaps += k.leapt;
}

// The robot makes 100 ms of way at these speeds of its wheels, mm/s.
static void roll(int left, int right) {
    const double v = (left + right) / 2.0;
    const double w = (right - left) / (double)argus_robot_default()->track_mm;
    th += w * 0.1;
    x += v * 0.1 * cos(th);
    y += v * 0.1 * sin(th);
    sip.vel_left_mm_s = (int16_t)left;
    sip.vel_right_mm_s = (int16_t)right;
}

static void drive(int left, int right, int sips) {
    for (int i = 0; i < sips; i++) {
        roll(left, right);
        deliver(100);
    }
}

static void expect_pose(int want_x, int want_y, int want_cdeg) {
    TEST_ASSERT_INT32_WITHIN(25, want_x, k.pose.x_mm);
    TEST_ASSERT_INT32_WITHIN(25, want_y, k.pose.y_mm);
    TEST_ASSERT_LESS_OR_EQUAL_INT32(100, argus_angle_abs_diff(want_cdeg, k.pose.heading_cdeg));
}

// Positions and headings that a controller, a second program or a bit on the line may put there.
void test_leaps_are_left_out_and_the_pose_goes_on_as_the_wheels_say(void) {
    static const struct {
        double x, y, deg;
    } to[] = {{0, 0, 0},    {20000, 0, 0},  {-400, 900, 45}, {1500, 0, 180},
              {3500, 0, 0}, {1000, 400, 0}, {2000, 0, -90}};
    for (size_t i = 0; i < sizeof to / sizeof to[0]; i++) {
        setUp();
        deliver(100);
        drive(200, 200, 100); // 2 m
        x = to[i].x;
        y = to[i].y;
        th = to[i].deg * PI / 180;
        roll(200, 200);
        x -= 20 * cos(th);
        y -= 20 * sin(th);
        deliver(100);
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, leaps, "leap");
        expect_pose(2020, 0, 0);
        drive(200, 200, 50); // ahead in the new frame is ahead in the course's
        TEST_ASSERT_EQUAL_INT(1, leaps);
        expect_pose(3020, 0, 0);
    }
}

// What no wheels make between two SIPs that came in time: either way, at speed and at rest.
void test_short_steps_that_the_wheels_did_not_make_are_left_out(void) {
    static const struct {
        int speed;
        double ahead, aside, deg;
    } steps[] = {{500, 120, 0, 0}, {500, -120, 0, 0}, {500, 0, 130, 0}, {500, 0, 0, 6},
                 {500, 0, 0, -6},  {0, 60, 0, 0},     {0, -60, 0, 0},   {0, 0, 60, 0},
                 {0, 0, 0, 3},     {0, 0, 0, -3},     {-200, 90, 0, 0}, {-200, -90, 0, 0},
                 {200, 50, 0, 0},  {200, -50, 0, 0},  {400, 50, 0, 0},  {0, 40, 0, 0}};
    char text[80];
    for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++) {
        setUp();
        deliver(100);
        drive(steps[i].speed, steps[i].speed, 20);
        const double before = x;
        roll(steps[i].speed, steps[i].speed);
        const double after = x;
        x += steps[i].ahead;
        y += steps[i].aside;
        th += steps[i].deg * PI / 180;
        deliver(100);
        snprintf(text, sizeof text, "at %d mm/s: %.0f ahead, %.0f aside, %.0f degrees", steps[i].speed,
                 steps[i].ahead, steps[i].aside, steps[i].deg);
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, leaps, text);
        TEST_ASSERT_INT32_WITHIN_MESSAGE(10, (int)after, k.pose.x_mm, text);
        TEST_ASSERT_TRUE(fabs(after - before) <= 50);
    }
}

// A little more or less than the wheels say, SIP by SIP: it is found, and most of it is taken back.
void test_what_builds_up_in_motion_is_taken_back(void) {
    static const int creeps[] = {15, -15, 30, -30};
    for (size_t i = 0; i < sizeof creeps / sizeof creeps[0]; i++) {
        setUp();
        deliver(100);
        drive(500, 500, 20);
        int sips = 0;
        for (; sips < 40 && leaps == 0; sips++) {
            roll(500, 500);
            x += creeps[i];
            deliver(100);
        }
        TEST_ASSERT_EQUAL_INT(1, leaps);
        TEST_ASSERT_INT32_WITHIN(110, 1000 + 50 * sips, k.pose.x_mm);
    }
}

// The heading is off, the position goes on: the way is aslant, as no wheels make it unless they turn.
void test_a_way_aslant_is_told(void) {
    static const int slants[] = {10, -10, 20, -20, 45, 90};
    for (size_t i = 0; i < sizeof slants / sizeof slants[0]; i++) {
        setUp();
        deliver(100);
        drive(400, 400, 20);
        for (int sips = 0; sips < 60 && leaps == 0; sips++) {
            roll(400, 400);
            x += 40 * (cos(slants[i] * PI / 180) - 1);
            y += 40 * sin(slants[i] * PI / 180);
            deliver(100);
        }
        TEST_ASSERT_EQUAL_INT(1, leaps);
        TEST_ASSERT_INT32_WITHIN(250, 0, k.pose.y_mm);
    }
}

void test_a_position_that_flickers_is_never_believed(void) {
    deliver(100);
    for (int i = 0; i < 200; i++) {
        x = i % 2 == 0 ? 20000 : 0;
        deliver(100);
    }
    TEST_ASSERT_EQUAL_INT(200, leaps);
    expect_pose(0, 0, 0);
}

void test_a_heading_alone(void) {
    deliver(100);
    drive(100, 100, 20);
    th += PI / 4;
    deliver(100);
    TEST_ASSERT_TRUE(k.leapt);
    TEST_ASSERT_INT32_WITHIN(10, 0, k.leap_mm); // the wheels made 10
    TEST_ASSERT_INT32_WITHIN(10, 4500, k.leap_cdeg);
    expect_pose(210, 0, 0);
}

void test_what_creeps_while_the_wheels_stand_is_told_when_it_has_come_far(void) {
    deliver(100);
    for (int i = 0; i < 30 && leaps == 0; i++) {
        x += 40;
        deliver(100);
    }
    TEST_ASSERT_EQUAL_INT(1, leaps);
    TEST_ASSERT_LESS_THAN_INT32(320, k.pose.x_mm);
    setUp();
    deliver(100);
    for (int i = 0; i < 60 && leaps == 0; i++) {
        th += 5 * PI / 180;
        deliver(100);
    }
    TEST_ASSERT_EQUAL_INT(1, leaps);
}

void test_speeds_that_no_robot_has_do_not_excuse_a_leap(void) {
    deliver(100);
    sip.vel_left_mm_s = sip.vel_right_mm_s = 32767;
    x = 3000;
    deliver(100);
    TEST_ASSERT_EQUAL_INT(1, leaps);
    TEST_ASSERT_LESS_THAN_INT32(250, argus_abs(k.pose.x_mm));
}

// Speeds of all kinds; SIPs that come late and in bunches, and with `lost` percent of them lost.
static void wander(int rounds, int lost) {
    int held = 0;
    int left = 0, right = 0;
    uint32_t waited = 0;
    deliver(100);
    for (int i = 0; i < rounds; i++) {
        const int target_left = draw(1500) - 750;
        const int target_right = draw(4) == 0 ? target_left / 2 : target_left;
        for (int j = 0; j < 10; j++) {
            left += argus_max(-80, argus_min(80, target_left - left));
            right += argus_max(-80, argus_min(80, target_right - right));
            roll(left, right);
            waited += 100;
            held = held == 0 && draw(60) == 0 ? draw(8) : argus_max(0, held - 1);
            if (held > 0 || draw(100) < lost) {
                continue;
            }
            const uint32_t late = (uint32_t)draw(80);
            deliver(waited > late ? waited - late : 0);
            waited = late;
        }
    }
}

void test_what_a_robot_makes_is_believed(void) {
    wander(3000, 0);
    TEST_ASSERT_EQUAL_INT(0, leaps);
    setUp();
    wander(3000, 10);
    TEST_ASSERT_EQUAL_INT(0, leaps);
}

// The host slept, and reads in one go what came meanwhile.
void test_a_bunch_is_believed(void) {
    deliver(100);
    drive(750, 750, 20);
    for (int round = 0; round < 20; round++) {
        roll(750, 750);
        deliver(2000);
        for (int i = 0; i < 19; i++) {
            roll(750, 750);
            deliver(0);
        }
    }
    TEST_ASSERT_EQUAL_INT(0, leaps);
    expect_pose(1500 + 20 * 20 * 75, 0, 0);
}

void test_a_gap_in_motion_is_believed_and_a_leap_after_one_is_not(void) {
    deliver(100);
    drive(700, 700, 20);
    for (int i = 0; i < 20; i++) {
        roll(700, 700);
    }
    sip.vel_left_mm_s = sip.vel_right_mm_s = 0;
    deliver(2000);
    TEST_ASSERT_EQUAL_INT(0, leaps);
    x += 9000;
    deliver(3000);
    TEST_ASSERT_EQUAL_INT(1, leaps);
    TEST_ASSERT_EQUAL_UINT32(0, k.leaps_unseen); // it was at rest before
}

// A restart of the counters that comes with SIPs missing: what the robot made before it is in no figure.
void test_a_leap_with_sips_missing_in_motion_is_unseen(void) {
    static const struct {
        uint32_t ms;
        int speed;
        unsigned unseen;
    } cases[] = {{100, 500, 0}, {250, 500, 0}, {300, 500, 1}, {520, 500, 1}, {2500, 300, 1}, {520, 0, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        setUp();
        deliver(100);
        drive(500, 500, 20);
        drive(cases[i].speed, cases[i].speed, 5);
        x = -3000;
        deliver(cases[i].ms);
        TEST_ASSERT_EQUAL_INT(1, leaps);
        TEST_ASSERT_EQUAL_UINT32(cases[i].unseen, k.leaps_unseen);
    }
}

// A gap in motion; what it drove by the order, the watchdog and its brakes, or less where a STOP got through.
// The counters go on, or begin at zero somewhere within it. `way`: since the last SIP, or since zero.
void test_a_place_that_may_count_from_a_restart_in_a_gap_is_none(void) {
    static const struct {
        const char *what;
        int before_mm, speed, order, way;
        uint32_t ms;
        double deg; // heading before
        bool anew, told;
    } cases[] = {
        {"restart at once", 700, 500, 500, 1180, 5000, 7, true, true},
        {"the same, straight ahead", 700, 500, 500, 1180, 5000, 0, true, true},
        {"restart later", 700, 500, 500, 800, 3000, 7, true, true},
        {"restart in a stall", 100, 400, 400, 260, 700, 0, true, true},
        {"ordered, not yet seen to move", 300, 0, 400, 500, 2000, 0, true, true},
        {"goes on until the watchdog stops it", 300, 500, 500, 1208, 5000, 0, false, false},
        {"goes on while the link is away", 150, 500, 500, 400, 800, 7, false, false},
        {"a STOP got through, far from zero", 2500, 500, 500, 300, 5000, 0, false, false},
        {"the next SIP, read late", 100, 500, 500, 50, 3000, 0, false, false},
        {"the one after it, as the silence cut the next", 100, 500, 500, 100, 3000, 0, false, false},
        {"more than is lost of a bunch", 100, 500, 500, 170, 3000, 0, false, true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        setUp();
        th = cases[i].deg * PI / 180;
        deliver(100);
        const int v = cases[i].before_mm > 150 ? 500 : 250;
        drive(v, v, cases[i].before_mm * 10 / v);
        drive(cases[i].speed, cases[i].speed, cases[i].speed == 0);
        sip.vel_left_mm_s = sip.vel_right_mm_s = (int16_t)cases[i].speed;
        k.vel_left_mm_s = k.vel_right_mm_s = (int16_t)cases[i].speed;
        k.order = (argus_order_t){cases[i].order > 0, 5000, (uint16_t)cases[i].order, 300, 2000, 600};
        if (cases[i].anew) {
            x = y = th = 0;
        }
        x += cases[i].way * cos(th);
        y += cases[i].way * sin(th);
        const int go_on = cases[i].ms < 2500 || cases[i].before_mm == 100 ? cases[i].speed : 0;
        sip.vel_left_mm_s = sip.vel_right_mm_s = (int16_t)go_on;
        deliver(cases[i].ms);
        TEST_ASSERT_EQUAL_INT_MESSAGE(cases[i].told, leaps, cases[i].what);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(cases[i].told, k.leaps_unseen, cases[i].what);
    }
}

// Counters that begin anew as it turns on the spot stay near zero, and on its way to a place it makes no half
// turn. On the spot, 90 mm from zero, they went on; on it they may have begun anew.
void test_where_and_how_it_stands_tells_whether_counters_began_anew(void) {
    static const struct {
        const char *what;
        int at_mm, deg, way_mm;
        bool told;
    } cases[] = {
        {"turns, away from zero", 90, 20, 0, false},
        {"turns, at zero", 10, 20, 0, true},
        {"drives, on another heading", 90, 160, 1000, false},
        {"drives, near no heading", 90, 20, 1000, true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        setUp();
        x = cases[i].at_mm;
        th = cases[i].deg * PI / 180;
        deliver(100);
        k.order = (argus_order_t){true, (uint16_t)cases[i].way_mm, 400, 300, 2000, 600};
        th += 6 * PI / 180;
        deliver(1000);
        TEST_ASSERT_EQUAL_INT_MESSAGE(cases[i].told, leaps, cases[i].what);
    }
}

void test_values_that_are_frozen_while_the_wheels_turn_are_told(void) {
    deliver(100);
    for (int i = 0; i < 60 && leaps == 0; i++) {
        sip.vel_left_mm_s = sip.vel_right_mm_s = 200;
        deliver(100);
    }
    TEST_ASSERT_EQUAL_INT(1, leaps);
    setUp();
    deliver(100);
    for (int i = 0; i < 60 && leaps == 0; i++) {
        sip.vel_left_mm_s = -150;
        sip.vel_right_mm_s = 150;
        deliver(100);
    }
    TEST_ASSERT_EQUAL_INT(1, leaps);
}

void test_a_heading_that_is_none_is_left_out(void) {
    static const int none[] = {30000, -30000, 4097, -4097, 32767, -32768};
    deliver(100);
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        sip.x_raw = (uint16_t)(10 * i);
        sip.heading_raw = (int16_t)none[i];
        argus_knowledge_sip(&k, &sip, 1000, now_ms += 100);
        TEST_ASSERT_TRUE(k.leapt);
        TEST_ASSERT_EQUAL_INT32(0, k.pose.heading_cdeg);
    }
}

// SETO was sent, and the cable was unplugged before anybody knows whether it came.
void test_an_odometry_that_may_have_been_set_to_zero(void) {
    for (int done = 0; done < 2; done++) {
        setUp();
        deliver(100);
        drive(200, 200, 40); // 800 mm
        drive(0, 0, 2);
        argus_knowledge_origin_due(&k);
        if (done) {
            x = y = th = 0;
        }
        x += 60;
        deliver(2000);
        TEST_ASSERT_EQUAL_INT(0, leaps);
        expect_pose(860, 0, 0);
        x += 30;
        deliver(100);
        expect_pose(890, 0, 0);
        argus_knowledge_reopen(&k, now_ms);
        TEST_ASSERT_FALSE(k.origin_due);
    }
}

// Turns at the fastest, to and fro.
void test_turns_are_believed(void) {
    deliver(100);
    for (int round = 0; round < 50; round++) {
        for (int i = 0; i < 20; i++) {
            const int w = argus_min(330, 40 * argus_min(i, 20 - i));
            roll(round % 2 == 0 ? w : -w, round % 2 == 0 ? -w : w);
            deliver(100);
        }
    }
    TEST_ASSERT_EQUAL_INT(0, leaps);
}
