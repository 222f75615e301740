// SPDX-License-Identifier: MIT
// Rule under attack: wheels that turn while nothing changes along the way, or round the ring in a turn, are
// told, and the pose goes back to where that began; once is chance, and one range that changes as it should
// clears.
#include "knowledge/slip.h"

#include <string.h>

#include "unity.h"

#define SIP_MM 20
#define STRETCH_SIPS 25 // 500 mm
#define AHEAD 3
#define BACK 12

static argus_slip_t slip;
static argus_knowledge_t k;

void setUp(void) {
    memset(&slip, 0, sizeof slip);
    argus_knowledge_init(&k);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        k.sonar[i].health = ARGUS_HEALTHY;
        k.sonar[i].reported = true;
        k.sonar[i].reading_mm = 5000;
    }
    k.vel_left_mm_s = 200;
    k.vel_right_mm_s = 200;
}

void tearDown(void) {
}

// SIPs of straight way by the odometry; ranges ahead and back change by so much in each. The SIP that says
// it, or -1.
static int drive(int sips, int ahead_mm, int back_mm) {
    for (int sip = 0; sip < sips; sip++) {
        k.pose.x_mm += SIP_MM;
        k.odometer_mm += SIP_MM;
        k.fresh = UINT16_MAX;
        for (int i = 0; i < ARGUS_SONARS; i++) {
            k.sonar[i].odometer_mm = k.odometer_mm;
        }
        k.sonar[AHEAD].reading_mm = (uint16_t)(k.sonar[AHEAD].reading_mm + ahead_mm);
        k.sonar[BACK].reading_mm = (uint16_t)(k.sonar[BACK].reading_mm + back_mm);
        if (argus_slip_sip(&slip, &k)) {
            return sip;
        }
    }
    return -1;
}

static void walls(void) {
    k.sonar[AHEAD].reading_mm = 2000;
    k.sonar[BACK].reading_mm = 1500;
}

void test_what_stays_ahead_and_behind_for_two_stretches_is_slip(void) {
    walls();
    TEST_ASSERT_EQUAL(-1, drive(STRETCH_SIPS + 2, 0, 0));
    TEST_ASSERT_NOT_EQUAL(-1, drive(STRETCH_SIPS + 4, 0, 0));
    TEST_ASSERT_EQUAL(1, slip.slips);
    TEST_ASSERT_INT_WITHIN(100, 1000, slip.slipped_mm);
    TEST_ASSERT_INT_WITHIN(2 * SIP_MM, 0, slip.first.x_mm);
}

// A wall along the way is heard ahead and behind at the edge of the cone, and stays as far off. It does so,
// too, where a door is beside the robot at one end of a stretch.
void test_a_door_in_a_wall_beside_the_way_hides_no_wall(void) {
    for (int walled = 0; walled < 2; walled++) {
        setUp();
        walls();
        k.sonar[0].reading_mm = k.sonar[15].reading_mm = 4000; // a door, where it begins
        TEST_ASSERT_EQUAL(-1, drive(STRETCH_SIPS / 2, 0, 0));
        k.sonar[0].reading_mm = k.sonar[15].reading_mm = walled != 0 ? 650 : 4000;
        TEST_ASSERT_EQUAL(-1, drive(STRETCH_SIPS / 2 + 2, 0, 0));
        TEST_ASSERT_EQUAL(walled == 0, slip.proof > 0);
    }
}

void test_one_stretch_is_chance(void) {
    walls();
    TEST_ASSERT_EQUAL(-1, drive(STRETCH_SIPS + 2, 0, 0));
    TEST_ASSERT_EQUAL(-1, drive(STRETCH_SIPS, -SIP_MM, SIP_MM));
    walls();
    TEST_ASSERT_EQUAL(-1, drive(STRETCH_SIPS - 4, 0, 0));
}

void test_a_range_that_changes_as_it_should_clears(void) {
    walls();
    TEST_ASSERT_EQUAL(-1, drive(4 * STRETCH_SIPS, 0, SIP_MM));
    TEST_ASSERT_EQUAL(0, slip.slips);
}

void test_one_ahead_alone_may_follow_somebody(void) {
    k.sonar[AHEAD].reading_mm = 2000;
    TEST_ASSERT_EQUAL(-1, drive(8 * STRETCH_SIPS, 0, 0));
}

void test_two_ahead_alone_take_three_stretches(void) {
    k.sonar[AHEAD].reading_mm = 2000;
    k.sonar[AHEAD + 1].reading_mm = 1900;
    TEST_ASSERT_EQUAL(-1, drive(2 * STRETCH_SIPS + 2, 0, 0));
    TEST_ASSERT_NOT_EQUAL(-1, drive(STRETCH_SIPS + 6, 0, 0));
}

void test_two_that_look_back_take_three_stretches(void) {
    k.sonar[BACK].reading_mm = 1300;
    k.sonar[11].reading_mm = 1250;
    TEST_ASSERT_EQUAL(-1, drive(2 * STRETCH_SIPS + 2, 0, 0));
    TEST_ASSERT_NOT_EQUAL(-1, drive(STRETCH_SIPS + 6, 0, 0));
}

// 30 degrees off the way a wall that goes along with it stays as far off, too.
void test_those_that_look_aslant_tell_nothing(void) {
    k.sonar[2].reading_mm = k.sonar[5].reading_mm = 1200;
    k.sonar[10].reading_mm = k.sonar[13].reading_mm = 1200;
    TEST_ASSERT_EQUAL(-1, drive(8 * STRETCH_SIPS, 0, 0));
}

void test_a_goal_is_none_after_slip_until_a_range_tells_of_motion(void) {
    walls();
    TEST_ASSERT_NOT_EQUAL(-1, drive(3 * STRETCH_SIPS, 0, 0));
    k.sonar[AHEAD].reading_mm = k.sonar[BACK].reading_mm = 5000;
    drive(2 * STRETCH_SIPS, 0, 0); // nothing can tell
    TEST_ASSERT_TRUE(argus_slip_denies(&slip, &k));
    TEST_ASSERT_EQUAL(2, slip.slips);
    TEST_ASSERT_INT_WITHIN(4 * SIP_MM, 0, slip.first.x_mm);
    TEST_ASSERT_INT_WITHIN(4 * SIP_MM, k.pose.x_mm, slip.slipped_mm);
    walls();
    drive(STRETCH_SIPS + 2, -SIP_MM, SIP_MM);
    TEST_ASSERT_FALSE(argus_slip_denies(&slip, &k));
}

void test_half_of_the_proof_denies_a_goal(void) {
    walls();
    TEST_ASSERT_FALSE(argus_slip_denies(&slip, &k));
    TEST_ASSERT_EQUAL(-1, drive(STRETCH_SIPS + 2, 0, 0));
    TEST_ASSERT_TRUE(argus_slip_denies(&slip, &k));
    TEST_ASSERT_INT_WITHIN(2 * SIP_MM, 0, slip.first.x_mm);
    setUp();
    k.sonar[AHEAD].reading_mm = 2000;
    k.sonar[AHEAD + 1].reading_mm = 1900;
    TEST_ASSERT_EQUAL(-1, drive(STRETCH_SIPS + 2, 0, 0)); // that is chance
    TEST_ASSERT_FALSE(argus_slip_denies(&slip, &k));
}

// Every second sonar hears one thing and its neighbours another.
static void things(void) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        k.sonar[i].reading_mm = i % 2 == 0 ? 1000 : 2000;
    }
}

static int listen(int sips, bool rotating) {
    for (int sip = 0; sip < sips; sip++) {
        k.rotating = rotating;
        k.fresh = UINT16_MAX;
        if (argus_slip_sip(&slip, &k)) {
            return sip;
        }
    }
    return -1;
}

// seen: each sonar hears the other thing after it.
static int turn(int deg, bool seen) {
    TEST_ASSERT_EQUAL(-1, listen(2, false));
    k.pose.heading_cdeg += deg * 100;
    TEST_ASSERT_EQUAL(-1, listen(3, true));
    for (int i = 0; seen && i < ARGUS_SONARS; i++) {
        k.sonar[i].reading_mm = (uint16_t)(3000 - k.sonar[i].reading_mm);
    }
    return listen(2, false);
}

// By 60 degrees, three sonars of the front, those on the bearings hear the other thing.
void test_two_turns_in_which_all_stay_are_slip(void) {
    things();
    TEST_ASSERT_EQUAL(-1, turn(60, false));
    TEST_ASSERT_NOT_EQUAL(-1, turn(-60, false));
    TEST_ASSERT_EQUAL(1, slip.slips);
}

void test_turns_in_which_they_hear_what_others_heard_are_none(void) {
    things();
    for (int i = 0; i < 6; i++) {
        TEST_ASSERT_EQUAL(-1, turn(60, true));
    }
    TEST_ASSERT_EQUAL(0, slip.slips);
    TEST_ASSERT_FALSE(argus_slip_denies(&slip, &k));
}

void test_small_turns_and_a_ring_that_hears_one_thing_tell_nothing(void) {
    things();
    for (int i = 0; i < 6; i++) {
        TEST_ASSERT_EQUAL(-1, turn(i % 2 == 0 ? 30 : -30, false));
    }
    for (int i = 0; i < ARGUS_SONARS; i++) {
        k.sonar[i].reading_mm = 1500;
    }
    TEST_ASSERT_EQUAL(-1, turn(60, false));
    TEST_ASSERT_EQUAL(-1, turn(60, false));
    TEST_ASSERT_FALSE(argus_slip_denies(&slip, &k));
}

void test_a_turn_denies_a_goal_though_the_way_behind_tells_nothing(void) {
    things();
    TEST_ASSERT_EQUAL(-1, turn(60, false));
    for (int i = 0; i < ARGUS_SONARS; i++) {
        k.sonar[i].reading_mm = 5000;
    }
    TEST_ASSERT_EQUAL(-1, drive(4 * STRETCH_SIPS, 0, 0));
    TEST_ASSERT_TRUE(argus_slip_denies(&slip, &k));
}

void test_motion_after_a_turn_clears_it(void) {
    things();
    k.pose.heading_cdeg = -6000;
    TEST_ASSERT_EQUAL(-1, turn(60, false));
    walls();
    TEST_ASSERT_EQUAL(-1, drive(2 * STRETCH_SIPS, -SIP_MM, SIP_MM));
    TEST_ASSERT_FALSE(argus_slip_denies(&slip, &k));
}

void test_a_restart_begins_anew(void) {
    walls();
    TEST_ASSERT_EQUAL(-1, drive(STRETCH_SIPS + 2, 0, 0));
    argus_slip_restart(&slip);
    TEST_ASSERT_EQUAL(-1, drive(STRETCH_SIPS + 2, 0, 0));
}

// Many stay, and one hears what another heard there: the body did turn.
void test_one_that_hears_what_was_there_denies_slip_in_a_turn(void) {
    things();
    TEST_ASSERT_EQUAL(-1, turn(60, false));
    TEST_ASSERT_EQUAL(-1, listen(2, false));
    k.pose.heading_cdeg += 6000;
    TEST_ASSERT_EQUAL(-1, listen(3, true));
    k.sonar[5].reading_mm = (uint16_t)(3000 - k.sonar[5].reading_mm); // as sonar 2 did, where it looks now
    TEST_ASSERT_EQUAL(-1, listen(2, false));
    TEST_ASSERT_EQUAL(0, slip.slips);
}
