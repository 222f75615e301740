// SPDX-License-Identifier: MIT
// Rule under attack (S2, S3): each detector says what it sees once, in the SIP that shows it, asks for what
// that calls for, and is not led astray by one odd value.
#include "behaviour/reflexes.h"

#include "behaviour/state.h"
#include "echo.h"
#include "knowledge/angle.h"
#include "robot.h"
#include "unity.h"

#define LOW_DV 115
#define IN_A_ROW 5
#define UNSOUND_MS 60000u

static robot_t robot;
static argus_t *core;
static argus_intent_t intent;

void setUp(void) {
    robot_in_box(&robot, ARGUS_PROFILE_ARGUS, -3000, -3000, 3000, 3000);
    robot_run(&robot, 5000);
    core = &robot.argus;
}

static void ask(argus_reflex_t reflex) {
    static const argus_alarm_t none;
    intent = (argus_intent_t){0};
    argus_reflex(reflex, core, &none, &core->reflexes, &intent);
}

// ---- battery

// What the detector says of so many SIPs of a voltage; 0: nothing.
static int says_of(int32_t battery_dv, int sips) {
    int said = 0;
    core->knowledge.battery_dv = (uint16_t)battery_dv;
    for (int i = 0; i < sips; i++) {
        ask(ARGUS_REFLEX_battery);
        said = intent.event != 0 ? intent.event : said;
        TEST_ASSERT_TRUE(intent.event == 0 || intent.value == battery_dv);
        TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
    }
    return said;
}

void test_a_low_battery_is_said_once_after_some_sips(void) {
    TEST_ASSERT_EQUAL(0, says_of(LOW_DV, IN_A_ROW - 1));
    TEST_ASSERT_EQUAL(0, says_of(LOW_DV + 1, 1)); // in a row
    TEST_ASSERT_EQUAL(0, says_of(LOW_DV, IN_A_ROW - 1));
    TEST_ASSERT_EQUAL(ARGUS_EV_BATTERY_LOW, says_of(LOW_DV, 1));
    TEST_ASSERT_EQUAL(0, says_of(LOW_DV, 1000));
}

// It sags under load and recovers: two decivolts more are the same low battery, and three are not.
void test_a_battery_that_sags_and_recovers_is_one(void) {
    says_of(LOW_DV, IN_A_ROW);
    says_of(LOW_DV + 2, 20);
    TEST_ASSERT_EQUAL(0, says_of(LOW_DV, 20));
    says_of(LOW_DV + 3, 1);
    TEST_ASSERT_EQUAL(ARGUS_EV_BATTERY_LOW, says_of(LOW_DV, 20));
}

void test_the_robot_itself_says_what_is_low(void) {
    core->session.has_robot = true;
    core->session.robot.low_battery_dv = 220;
    TEST_ASSERT_EQUAL(ARGUS_EV_BATTERY_LOW, says_of(220, IN_A_ROW));
    setUp();
    core->session.has_robot = true; // ... or does not
    core->session.robot.low_battery_dv = 0;
    TEST_ASSERT_EQUAL(0, says_of(LOW_DV + 1, 20));
    TEST_ASSERT_EQUAL(ARGUS_EV_BATTERY_LOW, says_of(LOW_DV, IN_A_ROW));
}

void test_a_voltage_that_no_robot_has_is_odd_and_not_low(void) {
    static const int32_t odd_dv[] = {0, 59, 301, 2550};
    for (size_t i = 0; i < sizeof odd_dv / sizeof odd_dv[0]; i++) {
        setUp();
        TEST_ASSERT_EQUAL(0, says_of(odd_dv[i], IN_A_ROW - 1));
        TEST_ASSERT_EQUAL(ARGUS_EV_BATTERY_ODD, says_of(odd_dv[i], 1));
        TEST_ASSERT_EQUAL(0, says_of(odd_dv[i], 1000));
    }
    setUp();
    TEST_ASSERT_EQUAL(0, says_of(300, 20));
    TEST_ASSERT_EQUAL(ARGUS_EV_BATTERY_LOW, says_of(60, IN_A_ROW));
}

// ---- odometry

void test_a_slip_stops_the_robot_and_is_said_once(void) {
    core->slip.slips++;
    core->slip.slipped_mm = 480;
    ask(ARGUS_REFLEX_slip);
    TEST_ASSERT_EQUAL(ARGUS_EV_SLIP, intent.event);
    TEST_ASSERT_EQUAL_INT32(480, intent.value);
    TEST_ASSERT_EQUAL(ARGUS_STOP_STOP, intent.stop);
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act);
    TEST_ASSERT_TRUE(intent.full && intent.unchecked);
    TEST_ASSERT_EQUAL(ARGUS_BASE_DROP, intent.base);
    ask(ARGUS_REFLEX_slip);
    TEST_ASSERT_EQUAL(0, intent.event);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
}

static int slip(void) {
    core->slip.slips++;
    ask(ARGUS_REFLEX_slip);
    return intent.act;
}

// Three times within a minute each, and the place is lost; after that all is said.
void test_an_odometry_that_fails_again_and_again_is_given_up(void) {
    for (int wait = 0; wait < 2; wait++) {
        setUp();
        TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, slip());
        core->now_ms += UNSOUND_MS - 1;
        TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, slip());
        core->now_ms += wait != 0 ? UNSOUND_MS : UNSOUND_MS - 1;
        TEST_ASSERT_EQUAL(wait != 0 ? ARGUS_DO_CHECK : ARGUS_DO_GIVE_UP, slip());
        TEST_ASSERT_EQUAL(wait != 0 ? ARGUS_EV_SLIP : ARGUS_EV_ODOMETRY_LOST, intent.event);
        if (wait == 0) {
            TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, slip());
            TEST_ASSERT_EQUAL(0, intent.event);
        }
    }
}

void test_a_leap_is_told_by_what_leapt(void) {
    core->knowledge.leaps++;
    core->knowledge.leap_mm = 300;
    core->knowledge.leap_cdeg = 3000;
    ask(ARGUS_REFLEX_leap);
    TEST_ASSERT_EQUAL(ARGUS_EV_POSE_LEAP, intent.event);
    TEST_ASSERT_EQUAL_INT32(300, intent.value);
    core->knowledge.leaps++;
    core->knowledge.leap_cdeg = 3001;
    ask(ARGUS_REFLEX_leap);
    TEST_ASSERT_EQUAL(ARGUS_EV_HEADING_LEAP, intent.event);
    TEST_ASSERT_EQUAL_INT32(30, intent.value);
    ask(ARGUS_REFLEX_leap);
    TEST_ASSERT_EQUAL(0, intent.event);
}

// Where it went meanwhile nobody saw: the first time is the last.
void test_a_leap_that_was_not_seen_is_given_up_at_once(void) {
    core->knowledge.leaps++;
    core->knowledge.leaps_unseen++;
    ask(ARGUS_REFLEX_leap);
    TEST_ASSERT_EQUAL(ARGUS_EV_ODOMETRY_LOST, intent.event);
    TEST_ASSERT_EQUAL(ARGUS_DO_GIVE_UP, intent.act);
}

// ---- S7: in a turn

// It turns left by far, and `sonar` reads `mm` beside it, seen in this SIP.
static void see_in_turn(int sonar, int32_t mm) {
    core->motion.kind = ARGUS_MOTION_TURN;
    core->motion.settled = false;
    core->motion.target_cdeg = argus_angle_wrap(core->knowledge.pose.heading_cdeg + 9000);
    core->knowledge.fresh = (argus_mask_t)(1u << sonar);
    core->knowledge.sonar[sonar].reading_mm = (uint16_t)mm;
    ask(ARGUS_REFLEX_swing);
}

void test_s7_what_comes_into_the_circle_twice_ends_the_turn(void) {
    see_in_turn(7, 180);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act); // one echo may be anything
    see_in_turn(7, 180);
    TEST_ASSERT_EQUAL(ARGUS_DO_END_TURN, intent.act);
}

void test_s7_two_echoes_are_one_thing_only_soon_and_in_one_place(void) {
    see_in_turn(7, 180);
    core->now_ms += argus_guard_two_rounds_ms(&core->config) + 1;
    see_in_turn(7, 180);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act); // too late
    setUp();
    see_in_turn(7, 180);
    see_in_turn(8, 180);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act); // elsewhere
    setUp();
    see_in_turn(7, 180);
    core->motion.settled = true;
    ask(ARGUS_REFLEX_swing); // the turn is over, and what was near with it
    see_in_turn(7, 180);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
}

void test_s7_what_is_not_fresh_or_not_relied_on_ends_no_turn(void) {
    see_in_turn(7, 180);
    core->knowledge.fresh = 0;
    ask(ARGUS_REFLEX_swing);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
    core->knowledge.sonar[7].health = ARGUS_DISABLED;
    see_in_turn(7, 180);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
}

// ---- S2: beside the way

// A thing stands `ahead_mm` before the sonars' faces, in front, and `sonar` hears nothing.
static void lose_ahead(int sonar, int ahead_mm) {
    setUp();
    core->mode = ARGUS_MODE_DRIVING;
    core->motion.kind = ARGUS_MOTION_MOVE;
    core->motion.settled = false;
    core->motion.target_mm = 1000;
    argus_echoes_init(&core->echoes);
    place_echo(&core->echoes, &core->knowledge, core->knowledge.robot->sonar_face_mm + ahead_mm, 0);
    core->echoes.at[0].again = true; // heard twice
    core->knowledge.sonar[sonar].reading_mm = (uint16_t)core->knowledge.robot->no_echo_mm;
    core->knowledge.fresh = (argus_mask_t)(1u << sonar);
}

static int flank_acts(void) {
    ask(ARGUS_REFLEX_flank);
    return intent.act;
}

void test_s2_a_wall_that_is_not_heard_any_more_stops_it(void) {
    const int32_t within_mm = core->config.object_range_mm - 20;
    for (int sonar = 1; sonar <= 6; sonar++) { // those that look farther aside pass by what they lose
        lose_ahead(sonar, within_mm);
        TEST_ASSERT_EQUAL(sonar >= 2 && sonar <= 5 ? ARGUS_DO_CHECK : ARGUS_DO_NOTHING, flank_acts());
        TEST_ASSERT_EQUAL(sonar >= 2 && sonar <= 5 ? ARGUS_STOP_STOP : ARGUS_STOP_NONE, intent.stop);
    }
    lose_ahead(3, within_mm);
    core->knowledge.sonar[3].reading_mm = (uint16_t)(core->knowledge.robot->no_echo_mm - 1);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, flank_acts()); // it hears something
    lose_ahead(3, within_mm + 100);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, flank_acts()); // the wall is farther off
    lose_ahead(3, within_mm);
    core->knowledge.sonar[3].health = ARGUS_SUSPECT;
    core->knowledge.sonar[3].kind = ARGUS_KIND_OFF;
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, flank_acts()); // it is not trusted
}

void test_s2_beside_the_way_counts_on_a_way_ahead_only(void) {
    const int32_t within_mm = core->config.object_range_mm - 20;
    lose_ahead(3, within_mm);
    core->mode = ARGUS_MODE_BACKING;
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, flank_acts());
    core->mode = ARGUS_MODE_IDLE;
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, flank_acts());
    core->mode = ARGUS_MODE_DRIVING;
    core->motion.settled = true;
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, flank_acts());
    core->motion.settled = false;
    core->motion.kind = ARGUS_MOTION_TURN;
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, flank_acts());
    core->motion.kind = ARGUS_MOTION_MOVE;
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, flank_acts());
}

// ---- those that do not face forward, by the rules of the paper

// News is a healthy one that yields nothing any more, or one that did not and does again; nothing else is.
void test_the_others_are_watched_where_their_silence_changes(void) {
    static const argus_health_t healths[] = {ARGUS_UNKNOWN, ARGUS_HEALTHY, ARGUS_SUSPECT, ARGUS_DISABLED,
                                             ARGUS_STALE};
    const argus_config_t paper = robot_config_of(ARGUS_PROFILE_PAPER);
    core->rules = argus_profile(&paper);
    for (size_t i = 0; i < sizeof healths / sizeof healths[0]; i++) {
        for (int silent = 0; silent < 2; silent++) {
            for (int ahead = 0; ahead < 2; ahead++) {
                const int sonar = ahead != 0 ? 3 : 7;
                robot_in_box(&robot, ARGUS_PROFILE_PAPER, -3000, -3000, 3000, 3000);
                robot_run(&robot, 5000);
                argus_sonar_t *const s = &core->knowledge.sonar[sonar];
                s->health = healths[i];
                s->heard_ms =
                    core->knowledge.sip_ms - (silent != 0 ? (uint32_t)core->config.stale_ms + 1 : 0);
                ask(ARGUS_REFLEX_others);
                const bool news = healths[i] == (silent != 0 ? ARGUS_HEALTHY : ARGUS_STALE);
                TEST_ASSERT_EQUAL_HEX32(news && ahead == 0 ? 1u << sonar : 0u, intent.sonars);
                TEST_ASSERT_EQUAL(news && ahead == 0 ? ARGUS_DO_WATCH : ARGUS_DO_NOTHING, intent.act);
            }
        }
    }
}
