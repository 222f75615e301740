// SPDX-License-Identifier: MIT
// Rule under attack: the safety invariants S1 to S8, each at the packet that would break it.
#include "supervisor/manager.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "robot.h"
#include "unity.h"

#define SONARS (ARGUS_SONARS < 16 ? ARGUS_SONARS : 16) // that its robot has, of those that a build manages

static robot_t robot;
static int32_t profile;
static char which_case[32];

static const uint8_t STOP[] = {0xFA, 0xFB, 0x03, 0x1D, 0x00, 0x1D};
static const uint8_t E_STOP[] = {0xFA, 0xFB, 0x03, 0x37, 0x00, 0x37};

// 2000 mm on every bearing, but for a post of 600 mm that only a look to the left of 25 degrees (world) sees.
static int world_with_step(const robot_t *r, int sonar) {
    const double bearing = remainder(robot_heading_deg(r) + argus_robot_table.poses[sonar].heading_deg, 360);
    return fabs(bearing - 30) < 8 ? 1200 : 2000;
}

// Readings that stay the same whatever the robot does are evidence of a fault under argus: it gets a room.
static void start_with(const argus_config_t *config) {
    robot_init(&robot, config, 0xFFFF0000u);
    if (config->profile == ARGUS_PROFILE_ARGUS) {
        robot_box(&robot, -2500, -2500, 3500, 2500);
        robot.world = robot_world_segments;
        robot.noise_mm = 5;
    }
}

// Whatever a sonar's fault, both profiles put it out for silence; 5000 alone is enough for the paper.
static robot_fault_t fault_that_puts_out(void) {
    return profile == ARGUS_PROFILE_PAPER ? ROBOT_OFF : ROBOT_SILENT;
}

void tearDown(void) {
    if (Unity.CurrentTestFailed) {
        printf("profile %s\n", profile == ARGUS_PROFILE_PAPER ? "paper" : "argus");
    }
}

static void with_profile(int32_t which, void (*check)(void)) {
    profile = which;
    check();
}

static void in_both_profiles(void (*check)(void)) {
    with_profile(ARGUS_PROFILE_PAPER, check);
    with_profile(ARGUS_PROFILE_ARGUS, check);
}

static void start_idle(void) {
    const argus_config_t config = robot_config_of(profile);
    start_with(&config);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
}

// On the way, at speed.
static void start_driving(void) {
    start_idle();
    TEST_ASSERT_TRUE(robot_goal(&robot, 20000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 30000));
    robot_run(&robot, 2000);
    TEST_ASSERT_EQUAL(ARGUS_MODE_DRIVING, robot.argus.mode);
    TEST_ASSERT_TRUE(robot.v > 190);
}

static void finish(void) {
    TEST_ASSERT_EQUAL_STRING("", robot.violation);
}

// Sips pass until one says what the test waits for; the reply to that very SIP is left in robot.reply.
static bool until_reply(const uint8_t *packet, size_t length, int sips) {
    for (int i = 0; i < sips; i++) {
        robot_next_sip(&robot);
        if (robot.reply_length == length && memcmp(robot.reply, packet, length) == 0) {
            return true;
        }
        argus_process(&robot.argus, robot.start_ms + robot.t_ms);
        robot_drain(&robot);
    }
    return false;
}

static bool listed(int sonar) {
    return (robot.argus.knowledge.fresh >> sonar & 1u) != 0;
}

// Judged bad.
static bool is_covered_for(int sonar) {
    const bool disabled = robot.argus.knowledge.sonar[sonar].health == ARGUS_DISABLED;
    return disabled && (robot.argus.plan.disabled >> sonar & 1u) != 0;
}

// Under argus no look comes by itself here.
static bool until_verifying(int sonar) {
    if (profile == ARGUS_PROFILE_ARGUS) {
        argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_RETEST, sonar);
        robot_drain(&robot);
    }
    return robot_until_mode(&robot, ARGUS_MODE_VERIFYING, 8000);
}

static int moves_ahead(int from) {
    int count = 0;
    for (int i = from; i < robot.commands; i++) {
        count += robot.command[i].command == ARCOS_CMD_MOVE && robot.command[i].argument > 0;
    }
    return count;
}

// Under argus it may drive as far as others have seen.
static void check_s1_every_step_in_failure_mode_follows_a_sweep(void) {
    start_idle();
    robot.fault[3] = fault_that_puts_out();
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_DISABLED, 4000));
    TEST_ASSERT_TRUE(robot_goal(&robot, 900, 0));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 90000));
    TEST_ASSERT_TRUE(profile != ARGUS_PROFILE_PAPER || robot_count_events(&robot, ARGUS_EV_STEP, 0) >= 4);
    TEST_ASSERT_TRUE(hypot(robot.x - 900, robot.y) <= 150);
    finish(); // the watch compares every MOVE with the sweeps, and with what was seen
}

void test_s1_every_step_in_failure_mode_follows_a_sweep(void) {
    in_both_profiles(check_s1_every_step_in_failure_mode_follows_a_sweep);
}

static void check_s1_object_on_a_compensated_bearing_stops_the_next_step(void) {
    start_idle();
    robot.fault[2] = fault_that_puts_out();
    robot.world = world_with_step;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_DISABLED, 4000));
    robot_box(&robot, -3000, -3000, 3000, 3000);
    robot.world = robot_world_segments;
    const int from = robot.commands;
    TEST_ASSERT_TRUE(robot_goal(&robot, 2000, 0));
    if (profile == ARGUS_PROFILE_PAPER) { // what is seen before a leg is chosen is gone round
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_SWEEPING, 20000));
    }
    robot_box(&robot, 390, 180, 420, 230); // ahead on the left, on the bearing of sonar 2 alone
    robot_until_event(
        &robot, profile == ARGUS_PROFILE_PAPER ? ARGUS_EV_OBJECT_CHECKED : ARGUS_EV_GOAL_REACHED, 40000);
    if (profile == ARGUS_PROFILE_PAPER) {
        TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_OBJECT_CHECKED, 0));
        TEST_ASSERT_EQUAL(0, moves_ahead(from));
    } else { // it finds a way round
        TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_GOAL_REACHED, 0) == 1);
        TEST_ASSERT_TRUE(robot.closest_mm >= 50);
    }
    finish();
}

void test_s1_object_on_a_compensated_bearing_stops_the_next_step(void) {
    in_both_profiles(check_s1_object_on_a_compensated_bearing_stops_the_next_step);
}

static void check_s1_object_on_a_healthy_bearing_stops_the_next_step(void) {
    for (int mm = 350; mm <= 351; mm++) {
        start_idle();
        robot.fault[2] = fault_that_puts_out();
        for (int i = 3; i <= 6; i++) {
            robot.fault[i] = ROBOT_VALUE;
            robot.fault_value[i] = mm;
        }
        robot_run(&robot, 4000);
        TEST_ASSERT_EQUAL_HEX16(1u << 2, argus_disabled(&robot.argus.knowledge));
        TEST_ASSERT_TRUE(robot_goal(&robot, 2000, 0));
        TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SWEEP, 20000));
        robot_run(&robot, 1000);
        TEST_ASSERT_EQUAL(mm == 350 ? 0 : 1, moves_ahead(0));
        finish();
    }
}

void test_s1_object_on_a_healthy_bearing_stops_the_next_step(void) {
    with_profile(ARGUS_PROFILE_PAPER, check_s1_object_on_a_healthy_bearing_stops_the_next_step);
}

static void check_s2_dead_reading_in_motion_is_answered_by_stop_in_the_same_call(void) {
    for (int sonar = 1; sonar <= 6; sonar++) {
        start_driving();
        robot.fault[sonar] = ROBOT_OFF;
        do {
            robot_next_sip(&robot);
            if (!listed(sonar)) {
                argus_process(&robot.argus, robot.start_ms + robot.t_ms);
                robot_drain(&robot);
            }
        } while (!listed(sonar) || robot.shown[sonar] != 5000);
        TEST_ASSERT_EQUAL(sizeof STOP, robot.reply_length);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(STOP, robot.reply, sizeof STOP);
        TEST_ASSERT_EQUAL(ARGUS_DISABLED, robot.argus.knowledge.sonar[sonar].health);
        TEST_ASSERT_EQUAL(ARGUS_KIND_OFF, robot.argus.knowledge.sonar[sonar].kind);
        finish();
    }
}

void test_s2_dead_reading_in_motion_is_answered_by_stop_in_the_same_call(void) {
    with_profile(ARGUS_PROFILE_PAPER, check_s2_dead_reading_in_motion_is_answered_by_stop_in_the_same_call);
}

static void check_s2_dead_reading_at_rest_is_answered_by_stop(void) {
    start_idle();
    robot.fault[5] = ROBOT_OFF;
    TEST_ASSERT_TRUE(until_reply(STOP, sizeof STOP, 5));
    finish();
}

void test_s2_dead_reading_at_rest_is_answered_by_stop(void) {
    with_profile(ARGUS_PROFILE_PAPER, check_s2_dead_reading_at_rest_is_answered_by_stop);
}

static void check_s2_sonars_0_and_7_and_the_rear_may_read_5000(void) {
    start_idle();
    robot.fault[0] = robot.fault[7] = robot.fault[11] = ROBOT_OFF;
    const uint32_t stops = robot.argus.stops;
    robot_run(&robot, 3000);
    TEST_ASSERT_EQUAL(stops, robot.argus.stops);
    TEST_ASSERT_EQUAL(0, argus_disabled(&robot.argus.knowledge));
    finish();
}

void test_s2_sonars_0_and_7_and_the_rear_may_read_5000(void) {
    in_both_profiles(check_s2_sonars_0_and_7_and_the_rear_may_read_5000);
}

static void check_s2_object_in_motion_is_answered_by_stop_in_the_same_call(void) {
    for (int sonar = 1; sonar <= 6; sonar++) {
        start_driving();
        robot.fault[sonar] = ROBOT_VALUE;
        robot.fault_value[sonar] = 250;
        do {
            robot_next_sip(&robot);
            if (!listed(sonar)) {
                argus_process(&robot.argus, robot.start_ms + robot.t_ms);
                robot_drain(&robot);
            }
        } while (!listed(sonar) || robot.shown[sonar] != 250);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(STOP, robot.reply, sizeof STOP);
        TEST_ASSERT_EQUAL(sonar, robot_last_event(&robot, ARGUS_EV_OBJECT)->sonar);
        finish();
    }
}

void test_s2_object_in_motion_is_answered_by_stop_in_the_same_call(void) {
    in_both_profiles(check_s2_object_in_motion_is_answered_by_stop_in_the_same_call);
}

static void check_s2_object_one_mm_beyond_the_range_is_none(void) {
    start_driving();
    robot.fault[3] = ROBOT_VALUE;
    robot.fault_value[3] = 251;
    robot_next_sip(&robot);
    robot_next_sip(&robot);
    robot_next_sip(&robot);
    robot_next_sip(&robot);
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_OBJECT, 0));
    finish();
}

void test_s2_object_one_mm_beyond_the_range_is_none(void) {
    in_both_profiles(check_s2_object_one_mm_beyond_the_range_is_none);
}

// The MOVE is on its way, the SIPs do not show it yet, and somebody steps in front.
static void check_s2_object_before_the_first_sip_that_shows_motion(void) {
    start_idle();
    TEST_ASSERT_TRUE(robot_goal(&robot, 5000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 30000));
    robot.stuck_wheels = true; // the MOVE has been taken, the wheels have not started
    for (int i = 0; i < 600 && robot_count_commands(&robot, ARCOS_CMD_MOVE, 0) == 0; i++) {
        robot_tick(&robot);
    }
    TEST_ASSERT_EQUAL(1, robot_count_commands(&robot, ARCOS_CMD_MOVE, 0));
    for (int i = 1; i <= 6; i++) {
        robot.fault[i] = ROBOT_VALUE;
        robot.fault_value[i] = 230;
    }
    robot_next_sip(&robot);
    argus_process(&robot.argus, robot.start_ms + robot.t_ms);
    robot_drain(&robot);
    robot.stuck_wheels = false;
    robot_run(&robot, 3000);
    TEST_ASSERT_TRUE_MESSAGE(robot.x < 20, "the robot set off towards an object in range");
    finish();
}

void test_s2_object_before_the_first_sip_that_shows_motion(void) {
    in_both_profiles(check_s2_object_before_the_first_sip_that_shows_motion);
}

static void check_s2_a_suspect_before_the_first_sip_that_shows_motion(void) {
    start_idle();
    TEST_ASSERT_TRUE(robot_goal(&robot, 5000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 30000));
    robot.stuck_wheels = true;
    for (int i = 0; i < 600 && robot_count_commands(&robot, ARCOS_CMD_MOVE, 0) == 0; i++) {
        robot_tick(&robot);
    }
    robot_run(&robot, 1000); // it has followed its echo on this heading
    robot.fault[3] = ROBOT_SCALE;
    robot.fault_value[3] = 50;
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_VERIFYING, 5000));
    robot.stuck_wheels = false;
    robot_run(&robot, 1000);
    TEST_ASSERT_TRUE_MESSAGE(robot.x < 20, "the robot set off while it verifies");
    finish();
}

void test_s2_a_suspect_before_the_first_sip_that_shows_motion(void) {
    with_profile(ARGUS_PROFILE_PAPER, check_s2_a_suspect_before_the_first_sip_that_shows_motion);
}

// GO and ACTIVE begin a health check: what was under way must not go on beside it.
static void check_s2_a_check_asked_for_in_motion_stops_the_robot(void) {
    static const argus_op_t ops[] = {ARGUS_OP_GO, ARGUS_OP_ACTIVE, ARGUS_OP_RECHECK, ARGUS_OP_STOP,
                                     ARGUS_OP_PASSIVE};
    for (int i = 0; i < 5; i++) {
        start_driving();
        const int from = robot.commands;
        const double brake_mm = robot.v * robot.v / (2.0 * robot.argus.config.decel_mm_s2);
        const double most_mm = brake_mm + 0.3 * robot.v; // the way of 300 ms at speed beside
        argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ops[i], 0);
        robot_drain(&robot);
        TEST_ASSERT_EQUAL_MESSAGE(1, robot_count_commands(&robot, ARCOS_CMD_STOP, from), "STOP");
        const double x = robot.x;
        robot_run(&robot, 900);
        TEST_ASSERT_TRUE(robot.x - x < most_mm);
        finish();
    }
}

void test_s2_a_check_asked_for_in_motion_stops_the_robot(void) {
    in_both_profiles(check_s2_a_check_asked_for_in_motion_stops_the_robot);
}

static void check_s2_sonars_switched_off_in_motion_end_the_drive(void) {
    start_driving();
    robot.sonar_on = false;
    robot_run(&robot, 4000);
    TEST_ASSERT_TRUE(robot.v == 0);
    const double x = robot.x;
    robot_run(&robot, 10000);
    TEST_ASSERT_TRUE(robot.x == x);
    finish();
}

void test_s2_sonars_switched_off_in_motion_end_the_drive(void) {
    in_both_profiles(check_s2_sonars_switched_off_in_motion_end_the_drive);
}

static void check_s2_bumper_is_answered_by_e_stop_in_the_same_call(void) {
    for (int segment = 1; segment <= 5; segment++) {
        for (int rear = 0; rear < 2; rear++) {
            start_driving();
            *(rear ? &robot.bumpers_rear : &robot.bumpers_front) = (uint8_t)(1 << segment);
            robot_next_sip(&robot);
            TEST_ASSERT_EQUAL(sizeof E_STOP, robot.reply_length);
            TEST_ASSERT_EQUAL_HEX8_ARRAY(E_STOP, robot.reply, sizeof E_STOP);
            finish();
        }
    }
}

void test_s2_bumper_is_answered_by_e_stop_in_the_same_call(void) {
    in_both_profiles(check_s2_bumper_is_answered_by_e_stop_in_the_same_call);
}

static void check_s5_move_is_bounded_by_the_shortest_reading(void) {
    start_driving();
    robot.fault[4] = ROBOT_VALUE;
    robot.fault_value[4] = 700;
    robot_run(&robot, 350);
    const robot_command_t *move = robot_last_command(&robot, ARCOS_CMD_MOVE);
    TEST_ASSERT_TRUE(move->argument <= 450);
    finish();
}

void test_s5_move_is_bounded_by_the_shortest_reading(void) {
    in_both_profiles(check_s5_move_is_bounded_by_the_shortest_reading);
}

// "fresh": a reading that is not renewed must not renew the way ahead.
static void check_s2_a_silent_sonar_does_not_renew_its_move(void) {
    start_driving();
    for (int i = 3; i <= 5; i++) {
        robot.fault[i] = ROBOT_VALUE;
        robot.fault_value[i] = 500;
    }
    robot_run(&robot, 400);
    TEST_ASSERT_EQUAL(ARGUS_MODE_DRIVING, robot.argus.mode);
    const double x = robot.x;
    robot.fault[3] = robot.fault[4] = robot.fault[5] = ROBOT_SILENT;
    robot_run(&robot, 4000);
    TEST_ASSERT_TRUE_MESSAGE(robot.x - x <= 265, "driven on by readings that are not fresh");
    finish();
}

void test_s2_a_silent_sonar_does_not_renew_its_move(void) {
    in_both_profiles(check_s2_a_silent_sonar_does_not_renew_its_move);
}

static void check_s6_stall_in_motion_leads_to_a_full_check_before_the_next_move(void) {
    start_driving();
    const int from = robot.commands;
    robot.mute = true;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_LINK_STALLED, 2000));
    TEST_ASSERT_FALSE(argus_invariants_broken(&robot.argus) != 0 || robot.argus.checked);
    robot_run(&robot, 1500); // longer than stale_ms in all: the gap is the link's, not the sonars'
    robot.mute = false;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_LINK_RESUMED, 2000));
    const int resumed = robot.commands;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_HEALTH_CHECK, 10000));
    TEST_ASSERT_EQUAL(0, moves_ahead(resumed));
    TEST_ASSERT_EQUAL_HEX16(0, argus_disabled(&robot.argus.knowledge));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 2000));
    robot_run(&robot, 2000);
    TEST_ASSERT_TRUE(moves_ahead(resumed) > 0);
    TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_STOP, from) > 0);
    finish();
}

void test_s6_stall_in_motion_leads_to_a_full_check_before_the_next_move(void) {
    in_both_profiles(check_s6_stall_in_motion_leads_to_a_full_check_before_the_next_move);
}

// A sonar that dies in the middle of it does not cut the full check short.
static void check_s6_the_check_after_a_stall_stays_a_full_one(void) {
    start_driving();
    robot.mute = true;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_LINK_STALLED, 2000));
    robot.mute = false;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_LINK_RESUMED, 2000));
    robot_run(&robot, 700);
    robot.fault[4] = ROBOT_OFF;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_DEAD, 2000));
    const uint32_t from = robot.argus.knowledge.sonar[2].readings;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_HEALTH_CHECK, 5000));
    TEST_ASSERT_TRUE(robot.argus.knowledge.sonar[2].readings - from >= 3);
    finish();
}

void test_s6_the_check_after_a_stall_stays_a_full_one(void) {
    with_profile(ARGUS_PROFILE_PAPER, check_s6_the_check_after_a_stall_stays_a_full_one);
}

static void check_s6_link_cut_and_restored_leads_to_a_full_check(void) {
    start_driving();
    robot_run(&robot, 3000); // nearer to where it began to count its place might be one since a restart
    argus_link_lost(&robot.argus, robot.start_ms + robot.t_ms);
    robot_drain(&robot);
    TEST_ASSERT_EQUAL(ARGUS_MODE_OFFLINE, robot.argus.mode);
    TEST_ASSERT_FALSE(robot.argus.checked);
    robot.moving = false;
    robot.mute = true;
    robot_run(&robot, 3000);
    robot.mute = false;
    const int from = robot.commands;
    argus_link_up(&robot.argus, robot.start_ms + robot.t_ms);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_HEALTH_CHECK, 15000));
    TEST_ASSERT_EQUAL(0, moves_ahead(from));
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_SESSION_DISLODGED, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 3000));
    finish();
}

void test_s6_link_cut_and_restored_leads_to_a_full_check(void) {
    in_both_profiles(check_s6_link_cut_and_restored_leads_to_a_full_check);
}

static void check_s3_velocity_is_never_used_to_drive(void) {
    start_driving();
    robot_run(&robot, 10000);
    for (int i = 0; i < robot.commands; i++) {
        const uint8_t c = robot.command[i].command;
        if (c == ARCOS_CMD_VEL || c == ARCOS_CMD_RVEL || c == ARCOS_CMD_VEL2) {
            TEST_ASSERT_EQUAL(0, robot.command[i].argument);
        }
    }
    finish();
}

void test_s3_velocity_is_never_used_to_drive(void) {
    in_both_profiles(check_s3_velocity_is_never_used_to_drive);
}

static void check_s4_heading_restored_after_every_sweep(void) {
    for (int policy = 0; policy < 2; policy++) {
        argus_config_t config = robot_config_of(profile);
        config.policy = policy;
        start_with(&config);
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
        robot.fault[2] = robot.fault[3] = robot.fault[6] = fault_that_puts_out();
        robot_run(&robot, 4000);
        TEST_ASSERT_TRUE(profile == ARGUS_PROFILE_ARGUS || robot_goal(&robot, 600, 300));
        for (int sweep = 0; sweep < 3; sweep++) {
            if (profile == ARGUS_PROFILE_ARGUS) { // what was seen a moment ago is not swept for
                robot_run(&robot, 8000);
                argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_MOVE, 200);
            }
            TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_SWEEPING, 20000));
            for (int i = 0; i < 3000 && !robot.argus.base.taken; i++) {
                robot_tick(&robot);
            }
            const double before = robot_heading_deg(&robot);
            const int turns = robot_count_commands(&robot, ARCOS_CMD_HEAD, 0);
            TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SWEEP, 60000));
            TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_HEAD, 0) > turns);
            TEST_ASSERT_FLOAT_WITHIN(2, 0, remainder(robot_heading_deg(&robot) - before, 360));
        }
        finish();
    }
}

void test_s4_heading_restored_after_every_sweep(void) {
    in_both_profiles(check_s4_heading_restored_after_every_sweep);
}

static void check_s4_heading_restored_after_a_verification(void) {
    start_idle();
    robot.fault[4] = ROBOT_SCALE;
    robot.fault_value[4] = 50;
    const double before = robot_heading_deg(&robot);
    TEST_ASSERT_TRUE(until_verifying(4));
    const int judged = profile == ARGUS_PROFILE_PAPER ? ARGUS_EV_SONAR_DISABLED : ARGUS_EV_HEALTH_CHECK;
    TEST_ASSERT_TRUE(robot_until_event(&robot, judged, 30000));
    TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_HEAD, 0) > 1);
    TEST_ASSERT_FLOAT_WITHIN(2, 0, remainder(robot_heading_deg(&robot) - before, 360));
    finish();
}

void test_s4_heading_restored_after_a_verification(void) {
    in_both_profiles(check_s4_heading_restored_after_a_verification);
}

static void check_s5_an_unsafe_configuration_never_drives(void) {
    argus_config_t config = robot_config_of(profile);
    config.speed_mm_s = 700;
    start_with(&config);
    robot_goal(&robot, 2000, 0);
    robot_run(&robot, 5000);
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_ACTIVE, 0);
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_GO, 0);
    robot_run(&robot, 8000);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, 0));
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_HEAD, 0));
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_ENABLE, 0));
    finish();
}

void test_s5_an_unsafe_configuration_never_drives(void) {
    in_both_profiles(check_s5_an_unsafe_configuration_never_drives);
}

static void check_s6_no_move_until_every_front_sonar_has_reported(void) {
    for (int sonar = 1; sonar <= 6; sonar++) {
        argus_config_t config = robot_config_of(profile);
        config.stale_ms = 10000;
        start_with(&config);
        robot.fault[sonar] = ROBOT_SILENT;
        TEST_ASSERT_TRUE(robot_goal(&robot, 2000, 0));
        robot_run(&robot, 8000);
        TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, 0));
        robot.fault[sonar] = ROBOT_OK;
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 30000));
        robot_run(&robot, 1000);
        TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_MOVE, 0) > 0);
        finish();
    }
}

void test_s6_no_move_until_every_front_sonar_has_reported(void) {
    in_both_profiles(check_s6_no_move_until_every_front_sonar_has_reported);
}

// A sonar that lies from the start is found before the first MOVE, whichever it is.
static void check_s6_no_move_before_the_suspect_is_verified(void) {
    for (int sonar = 1; sonar <= 6; sonar++) {
        const argus_config_t config = robot_config_of(profile);
        start_with(&config);
        robot.fault[sonar] = ROBOT_SCALE;
        robot.fault_value[sonar] = 50;
        TEST_ASSERT_TRUE(robot_goal(&robot, 2000, 0));
        for (int i = 0; i < 3000 && moves_ahead(0) == 0; i++) {
            robot_tick(&robot);
        }
        char text[40];
        snprintf(text, sizeof text, "sonar %d", sonar);
        TEST_ASSERT_TRUE_MESSAGE(is_covered_for(sonar), text);
        finish();
    }
}

void test_s6_no_move_before_the_suspect_is_verified(void) {
    with_profile(ARGUS_PROFILE_PAPER, check_s6_no_move_before_the_suspect_is_verified);
}

// Suspects found while the course is paused are not driven on by the operator's jog either.
static void check_s6_jog_while_paused_verifies_first(void) {
    start_idle();
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_STOP, 0);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 4000));
    robot.fault[4] = ROBOT_SCALE;
    robot.fault_value[4] = 50;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SONAR_SUSPECT, 5000));
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_MOVE, 100);
    for (int i = 0; i < 3000 && moves_ahead(0) == 0; i++) {
        robot_tick(&robot);
    }
    TEST_ASSERT_TRUE(is_covered_for(4));
    finish();
}

void test_s6_jog_while_paused_verifies_first(void) {
    with_profile(ARGUS_PROFILE_PAPER, check_s6_jog_while_paused_verifies_first);
}

// A suspicion whose verification is broken off stays open: it is verified before the robot drives on.
static void check_s6_a_verification_broken_off_is_taken_up_again(void) {
    start_idle();
    robot.fault[2] = ROBOT_SCALE;
    robot.fault_value[2] = 50;
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_VERIFYING, 5000));
    for (int i = 0; i < 300 && robot.argus.verifying.verify.phase != ARGUS_VERIFY_LEFT; i++) {
        robot_tick(&robot);
    }
    robot.fault[1] = ROBOT_OFF; // the witness
    TEST_ASSERT_TRUE(robot_goal(&robot, 3000, 0));
    for (int i = 0; i < 3000 && moves_ahead(0) == 0; i++) {
        robot_tick(&robot);
    }
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, robot.argus.knowledge.sonar[1].health);
    TEST_ASSERT_EQUAL(ARGUS_DISABLED, robot.argus.knowledge.sonar[2].health);
    finish();
}

void test_s6_a_verification_broken_off_is_taken_up_again(void) {
    with_profile(ARGUS_PROFILE_PAPER, check_s6_a_verification_broken_off_is_taken_up_again);
}

static void check_s7_backs_off_from_a_front_bumper_and_checks_anew(void) {
    start_driving();
    robot.bumpers_front = 1 << 3;
    robot_next_sip(&robot);
    const int from = robot.commands;
    robot_drain(&robot);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_BACKING, 3000));
    const double x = robot.x;
    robot_run(&robot, 1000);
    TEST_ASSERT_EQUAL(-150, robot_last_command(&robot, ARCOS_CMD_MOVE)->argument);
    robot.bumpers_front = 0;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_HEALTH_CHECK, 8000));
    TEST_ASSERT_EQUAL(0, moves_ahead(from));
    TEST_ASSERT_FLOAT_WITHIN(20, x - 150, robot.x);
    finish();
}

void test_s7_backs_off_from_a_front_bumper_and_checks_anew(void) {
    in_both_profiles(check_s7_backs_off_from_a_front_bumper_and_checks_anew);
}

// E_STOP may cut the motors: they are switched on again to back away, but never against the robot's own
// button.
static void check_s7_motors_cut_by_the_stop_are_enabled_to_back_away(void) {
    for (int button = 0; button < 2; button++) {
        start_driving();
        robot.e_stop_cuts_motors = true;
        robot.stop_button = button == 1;
        robot.bumpers_front = 1 << 3;
        const int from = robot.commands;
        robot_run(&robot, 4000);
        TEST_ASSERT_EQUAL(button == 0, robot_count_commands(&robot, ARCOS_CMD_ENABLE, from) > 0);
        TEST_ASSERT_EQUAL(button == 0, robot_count_commands(&robot, ARCOS_CMD_MOVE, from) > 0);
        finish();
    }
}

void test_s7_motors_cut_by_the_stop_are_enabled_to_back_away(void) {
    in_both_profiles(check_s7_motors_cut_by_the_stop_are_enabled_to_back_away);
}

// So near it stands in the way back of a robot that passes what is beside it.
static int blocks_mm(int sonar) {
    const int deg = abs(argus_robot_table.poses[sonar].heading_deg);
    return deg == 90 ? 97 + robot.argus.config.backoff_mm / 2 : deg == 130 ? 150 : deg == 150 ? 300 : 450;
}

static void check_s7_waits_with_an_event_each_10_s_while_the_rear_is_blocked(void) {
    for (int blocked = 8; blocked < 16; blocked++) {
        start_driving();
        robot.fault[blocked] = ROBOT_VALUE;
        robot.fault_value[blocked] =
            robot.argus.config.profile == ARGUS_PROFILE_ARGUS ? blocks_mm(blocked) : 450;
        robot_run(&robot, 500);
        robot.bumpers_front = 1 << 2;
        const int from = robot.commands;
        robot_run(&robot, 30500);
        TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_HEAD, from));
        for (int i = from; i < robot.commands; i++) {
            TEST_ASSERT_FALSE(robot.command[i].command == ARCOS_CMD_MOVE &&
                              robot.command[i].t_ms > robot.t_ms - 30000);
        }
        TEST_ASSERT_EQUAL(4, robot_count_events(&robot, ARGUS_EV_WAITING, 0)); // at once, 10, 20, 30 s
        finish();
    }
}

void test_s7_waits_with_an_event_each_10_s_while_the_rear_is_blocked(void) {
    in_both_profiles(check_s7_waits_with_an_event_each_10_s_while_the_rear_is_blocked);
}

// A rear sonar that has fallen silent does not read clear.
static void check_s7_a_rear_sonar_gone_silent_is_not_clear(void) {
    start_driving();
    robot.fault[12] = ROBOT_SILENT;
    robot_run(&robot, 5000);
    robot.bumpers_front = 1 << 2;
    const int from = robot.commands;
    robot_run(&robot, 8000);
    for (int i = from; i < robot.commands; i++) {
        TEST_ASSERT_FALSE(robot.command[i].command == ARCOS_CMD_MOVE && robot.command[i].argument < 0);
    }
    finish();
}

void test_s7_a_rear_sonar_gone_silent_is_not_clear(void) {
    in_both_profiles(check_s7_a_rear_sonar_gone_silent_is_not_clear);
}

// Somebody frees the bumper while the rear is blocked: a full health check, then on.
static void check_s7_a_freed_bumper_ends_the_wait(void) {
    start_driving();
    robot.fault[10] = ROBOT_VALUE;
    robot.fault_value[10] = 430;
    robot_run(&robot, 500);
    robot.bumpers_front = 1 << 2;
    robot_run(&robot, 5000);
    TEST_ASSERT_EQUAL(ARGUS_MODE_WAITING, robot.argus.mode);
    robot.bumpers_front = 0;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_HEALTH_CHECK, 8000));
    finish();
}

void test_s7_a_freed_bumper_ends_the_wait(void) {
    in_both_profiles(check_s7_a_freed_bumper_ends_the_wait);
}

static void check_s7_no_turn_while_the_swing_circle_is_blocked(void) {
    start_idle();
    robot.fault[7] = ROBOT_VALUE;
    robot.fault_value[7] = 220; // 363 mm from the centre
    robot.fault[10] = ROBOT_VALUE;
    robot.fault_value[10] = 300; // and no way back
    robot_run(&robot, 1000);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 20000)); // argus may want to look first
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_TURN, 90);
    robot_run(&robot, 12000);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_HEAD, 0));
    TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_TURN_BLOCKED, 0) > 0);
    for (int i = 0; i < robot.events; i++) {
        const bool tells = robot.event[i].id == ARGUS_EV_TURN_BLOCKED;
        TEST_ASSERT_TRUE(!tells || robot.event[i].sonar == 7 || robot.event[i].sonar == 10);
    }
    robot.fault[7] = ROBOT_OK;
    robot_run(&robot, 14000); // argus remembers for 5 s what was so near
    TEST_ASSERT_FLOAT_WITHIN(2, 90, robot_heading_deg(&robot));
    finish();
}

void test_s7_no_turn_while_the_swing_circle_is_blocked(void) {
    in_both_profiles(check_s7_no_turn_while_the_swing_circle_is_blocked);
}

// 370 mm are left by noise and by echoes that lie off the axis: `argus` wants 390.
static void check_s7_leaves_a_margin(void) {
    for (int blocked = 0; blocked < 2; blocked++) {
        start_idle();
        robot.noise_mm = 0;
        robot.fault[7] = ROBOT_VALUE;
        robot.fault_value[7] = blocked ? 247 : 249; // 389, 391 mm from the centre
        robot.fault[10] = ROBOT_VALUE;
        robot.fault_value[10] = 300; // and no way back
        robot_run(&robot, 600);
        argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_TURN, 30);
        robot_run(&robot, 1000);
        TEST_ASSERT_EQUAL(blocked, robot_count_events(&robot, ARGUS_EV_TURN_BLOCKED, 0));
        finish();
    }
}

void test_s7_leaves_a_margin(void) {
    with_profile(ARGUS_PROFILE_ARGUS, check_s7_leaves_a_margin);
}

// A sonar reads so until the manager has so many readings of it, then as before.
static void shows(int sonar, int mm, int times) {
    robot.fault[sonar] = ROBOT_VALUE;
    robot.fault_value[sonar] = mm;
    for (int seen = 0, before = -1; seen < times;) {
        const int readings = (int)robot.argus.knowledge.sonar[sonar].readings;
        robot_next_sip(&robot);
        robot_drain(&robot);
        const int now = (int)robot.argus.knowledge.sonar[sonar].readings;
        seen += now != readings && robot.argus.knowledge.sonar[sonar].reading_mm == mm ? 1 : 0;
        TEST_ASSERT_TRUE_MESSAGE(++before < 40, "it is not read");
    }
    robot.fault[sonar] = ROBOT_OK;
}

// Sonar 0 has just read 150 mm, and goes on to.
static void stand_beside_an_echo(void) {
    start_idle();
    robot.noise_mm = 0;
    robot.fault[0] = ROBOT_VALUE;
    robot.fault_value[0] = 150;
    for (int i = 0; i < 1000 && robot.argus.knowledge.sonar[0].reading_mm != 150; i++) {
        robot_tick(&robot);
    }
    TEST_ASSERT_EQUAL(150, robot.argus.knowledge.sonar[0].reading_mm);
}

// One echo may be crosstalk: it is read once more before it forbids a turn, also where it has raised a doubt.
// What is there is seen again; what jumps is not, and forbids it after one round; what one hears that has the
// name of a fault, or gaps, at once.
static void check_s7_one_echo_is_read_again(void) {
    enum { CROSSTALK, DOUBTED, THERE, JUMPING, NAMED, WITH_GAPS, CASES };
    for (int which = 0; which < CASES; which++) {
        const bool gone = which == CROSSTALK || which == DOUBTED;
        stand_beside_an_echo();
        robot.fault[0] = gone ? ROBOT_OK : ROBOT_VALUE;
        robot.argus.evidence.of[0].score[ARGUS_TEST_DROPOUT] = which == WITH_GAPS ? 100 : 0;
        if (which == DOUBTED || which == NAMED) { // looked at in vain; held by what the others say
            robot.argus.knowledge.sonar[0].health = ARGUS_SUSPECT;
            robot.argus.knowledge.sonar[0].kind = which == NAMED ? ARGUS_KIND_WRONG : ARGUS_KIND_NONE;
            robot.argus.algorithm1.verified |= 1;
            robot.argus.evidence.of[0].score[ARGUS_TEST_PEERS] = 400;
        }
        argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_TURN, 20);
        const uint32_t from_ms = robot.t_ms;
        bool read_again = false;
        for (uint32_t seen = robot.argus.knowledge.sonar[0].readings; robot.t_ms - from_ms < 900;) {
            robot_tick(&robot);
            read_again |= robot.argus.turning.again;
            if (which == JUMPING && robot.argus.knowledge.sonar[0].readings != seen) { // 60 and 220 in turn
                seen = robot.argus.knowledge.sonar[0].readings;
                robot.fault_value[0] = robot.fault_value[0] == 60 ? 220 : 60;
            }
        }
        const bool unsteady = which == NAMED || which == WITH_GAPS;
        snprintf(which_case, sizeof which_case, "case %d", which);
        TEST_ASSERT_EQUAL_MESSAGE(!gone, robot_count_events(&robot, ARGUS_EV_TURN_BLOCKED, 0) > 0,
                                  which_case);
        TEST_ASSERT_EQUAL_MESSAGE(gone, robot_heading_deg(&robot) > 1, which_case);
        TEST_ASSERT_TRUE_MESSAGE(which == THERE || read_again == !unsteady, which_case);
        finish();
    }
}

void test_s7_one_echo_is_read_again(void) {
    with_profile(ARGUS_PROFILE_ARGUS, check_s7_one_echo_is_read_again);
}

// Until the turn is tried again each sonar has been read.
static bool reads_all_again(void) {
    uint32_t before[SONARS];
    for (int i = 0; i < SONARS; i++) {
        before[i] = robot.argus.knowledge.sonar[i].readings;
    }
    for (int i = 0; i < 100 && robot.argus.turning.again; i++) {
        robot_tick(&robot);
    }
    for (int i = 0; i < SONARS; i++) {
        if (robot.argus.knowledge.sonar[i].readings == before[i]) {
            return false;
        }
    }
    return true;
}

// ... before a look, too, which begins on the heading where the robot stands: it comes as soon as there is
// room.
static void check_s7_one_echo_does_not_hold_up_a_look(void) {
    for (int phase = 0; phase < 16 * 24; phase++) {
        start_idle();
        robot.noise_mm = 0;
        argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_RETEST, 3);
        for (int i = 0; i < 10 * (phase / 16); i++) {
            robot_tick(&robot);
        }
        shows(phase % 16, 120, 1);
        snprintf(which_case, sizeof which_case, "sonar %d, SIP %d", phase % 16, phase / 16);
        for (int i = 0; i < 400; i++) {
            robot_tick(&robot);
            TEST_ASSERT_TRUE_MESSAGE(!robot.argus.turning.again || reads_all_again(), which_case);
        }
        TEST_ASSERT_EQUAL_MESSAGE(0, robot_count_events(&robot, ARGUS_EV_TURN_BLOCKED, 0), which_case);
        TEST_ASSERT_TRUE_MESSAGE(robot_count_events(&robot, ARGUS_EV_SONAR_VERIFYING, 0) > 0, which_case);
        TEST_ASSERT_TRUE_MESSAGE(robot_count_commands(&robot, ARCOS_CMD_HEAD, 0) > 0, which_case);
        finish();
    }
}

void test_s7_one_echo_does_not_hold_up_a_look(void) { // soak
    with_profile(ARGUS_PROFILE_ARGUS, check_s7_one_echo_does_not_hold_up_a_look);
}

// Not where something remembered, a bumper or the paper's rules forbid it.
static void check_s7_what_else_forbids_a_turn_is_not_read_again(void) {
    stand_beside_an_echo();
    robot.fault[0] = ROBOT_OK;
    if (profile == ARGUS_PROFILE_ARGUS) {
        const argus_point_t at = {(int32_t)robot.x + 300, 0};
        argus_echoes_touched(&robot.argus.echoes, at, robot.argus.now_ms);
    }
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_TURN, 20);
    robot_next_sip(&robot);
    robot_next_sip(&robot);
    robot_drain(&robot);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_TURN_BLOCKED, 0));
    TEST_ASSERT_FALSE(robot.argus.turning.again);
    finish();
}

void test_s7_what_else_forbids_a_turn_is_not_read_again(void) {
    in_both_profiles(check_s7_what_else_forbids_a_turn_is_not_read_again);
}

// 0 shows something 69 mm ahead of the centre and so far beside it; 400 mm off it is let be.
static void check_s7_backs_off_as_far_as_the_turn_asks_for(void) {
    static const struct {
        int reading_mm;
        int way_mm;
    } by[] = {{100, 275}, {150, 225}, {200, 150}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        start_idle();
        robot.noise_mm = 0;
        robot.fault[0] = ROBOT_VALUE;
        robot.fault_value[0] = by[i].reading_mm;
        robot_run(&robot, 600);
        argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_TURN, 30);
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_BACKING, 8000)); // argus may want to look first
        robot_run(&robot, 200);
        TEST_ASSERT_EQUAL(-by[i].way_mm, robot_last_command(&robot, ARCOS_CMD_MOVE)->argument);
        TEST_ASSERT_EQUAL(robot.argus.config.speed_mm_s,
                          robot_last_command(&robot, ARCOS_CMD_SETV)->argument);
        finish();
    }
}

void test_s7_backs_off_as_far_as_the_turn_asks_for(void) {
    with_profile(ARGUS_PROFILE_ARGUS, check_s7_backs_off_as_far_as_the_turn_asks_for);
}

// Something beside the bow: the robot backs away before it turns.
static void blocks_the_turn(void) {
    robot.fault[0] = ROBOT_VALUE;
    robot.fault_value[0] = 150;
    robot_run(&robot, 600);
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_TURN, 20);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_BACKING, 8000)); // argus may want to look first
}

// As fast as S5 allows with the rear's overhang: 163 + 64 = 227 mm at 200 mm/s.
static void check_s7_backs_off_at_a_speed_that_s5_allows(void) {
    for (int range = 227; range <= 228; range++) {
        argus_config_t config = robot_config_of(profile);
        config.object_range_mm = range;
        config.speed_mm_s = 200;
        start_with(&config);
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
        blocks_the_turn();
        robot_run(&robot, 200);
        TEST_ASSERT_EQUAL(range == 228 ? config.speed_mm_s : config.step_speed_mm_s,
                          robot_last_command(&robot, ARCOS_CMD_SETV)->argument);
        finish();
    }
}

void test_s7_backs_off_at_a_speed_that_s5_allows(void) {
    with_profile(ARGUS_PROFILE_ARGUS, check_s7_backs_off_at_a_speed_that_s5_allows);
}

// ... and farther than usual only where nothing is remembered beside the way.
static void check_s7_backs_no_farther_past_what_it_remembers(void) {
    for (int beside = 255; beside <= 265; beside += 10) {
        start_idle();
        robot.noise_mm = 0;
        const argus_point_t at = {(int32_t)robot.x - 600, beside};
        argus_echoes_touched(&robot.argus.echoes, at, robot.argus.now_ms);
        blocks_the_turn();
        robot_run(&robot, 200);
        TEST_ASSERT_EQUAL(beside > 260 ? -225 : -150, robot_last_command(&robot, ARCOS_CMD_MOVE)->argument);
        finish();
    }
}

void test_s7_backs_no_farther_past_what_it_remembers(void) {
    with_profile(ARGUS_PROFILE_ARGUS, check_s7_backs_no_farther_past_what_it_remembers);
}

// One round of all sonars, those that hear nothing too; one that has fallen silent is waited for in vain for
// two rounds at most.
static void check_s7_looks_all_round_after_backing_off(void) {
    for (int silent = 0; silent < 2; silent++) {
        start_idle();
        robot.noise_mm = 0;
        blocks_the_turn();
        robot.fault[9] = silent ? ROBOT_SILENT : ROBOT_OFF;
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_CHECKING, 5000));
        uint32_t before[SONARS];
        for (int i = 0; i < SONARS; i++) {
            before[i] = robot.argus.knowledge.sonar[i].readings;
        }
        const uint32_t from_ms = robot.t_ms;
        while (robot.argus.mode == ARGUS_MODE_CHECKING && robot.t_ms - from_ms < 3000) {
            robot_tick(&robot);
        }
        TEST_ASSERT_TRUE(robot.t_ms - from_ms <= (silent ? 900u : 600u));
        for (int i = 0; i < SONARS; i++) {
            TEST_ASSERT_EQUAL(!(silent && i == 9), robot.argus.knowledge.sonar[i].readings > before[i]);
        }
        finish();
    }
}

void test_s7_looks_all_round_after_backing_off(void) {
    with_profile(ARGUS_PROFILE_ARGUS, check_s7_looks_all_round_after_backing_off);
}

// Backwards it would push into what it has touched.
static void check_s7_does_not_back_onto_a_rear_bumper(void) {
    start_driving();
    robot.bumpers_rear = 1 << 3;
    const int from = robot.commands;
    robot_run(&robot, 5000);
    for (int i = from; i < robot.commands; i++) {
        TEST_ASSERT_FALSE(robot.command[i].command == ARCOS_CMD_MOVE && robot.command[i].argument < 0);
    }
    finish();
}

void test_s7_does_not_back_onto_a_rear_bumper(void) {
    in_both_profiles(check_s7_does_not_back_onto_a_rear_bumper);
}

static void turn_begins(void) {
    start_idle();
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_TURN, 170);
    for (int i = 0; i < 5000 && fabs(robot_heading_deg(&robot)) < 20; i++) {
        robot_tick(&robot);
    }
}

// What no sonar had seen when the turn began; one echo alone may be crosstalk. What ended a turn is not
// forgotten when the next one is asked for.
static void check_s7_a_turn_ends_when_something_shows_within_the_swing_circle(void) {
    for (int times = 1; times <= 2; times++) {
        turn_begins();
        shows(3, 150, times);
        TEST_ASSERT_EQUAL(times == 2, robot_count_events(&robot, ARGUS_EV_TURN_BLOCKED, 0) > 0);
        const int from = robot.commands;
        robot_run(&robot, 2500);
        TEST_ASSERT_EQUAL(times == 2, fabs(robot_heading_deg(&robot)) < 90);
        TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_HEAD, from));
        finish();
    }
}

// What was seen once before the turn, and once in it, is there.
static void check_s7_an_echo_before_the_turn_and_one_in_it_end_it(void) {
    for (int known = 0; known < 2; known++) {
        turn_begins();
        argus_knowledge_t seen = robot.argus.knowledge;
        seen.sonar[3].reading_mm = 150;
        const argus_point_t at = argus_to_course(&seen.pose, argus_echo_robot(&seen, 3));
        argus_echo_t *const slot = &robot.argus.echoes.at[0];
        slot->x_mm = (int16_t)at.x_mm;
        slot->y_mm = (int16_t)at.y_mm;
        slot->again = false;
        slot->seen_ms = robot.argus.now_ms;
        robot.argus.echoes.count = known ? 1 : 0;
        shows(3, 150, 1);
        TEST_ASSERT_EQUAL(known, robot_count_events(&robot, ARGUS_EV_TURN_BLOCKED, 0) > 0);
        finish();
    }
}

void test_s7_an_echo_before_the_turn_and_one_in_it_end_it(void) {
    with_profile(ARGUS_PROFILE_ARGUS, check_s7_an_echo_before_the_turn_and_one_in_it_end_it);
}

// One echo is one echo, also while the robot comes to rest.
static void check_s7_one_echo_at_the_end_of_a_turn_does_not_end_it(void) {
    for (int phase = 0; phase < 30; phase++) {
        turn_begins();
        for (int i = 0; i < 5000 && fabs(robot_heading_deg(&robot)) < 155; i++) {
            robot_tick(&robot);
        }
        for (int i = 0; i < 2 * phase; i++) {
            robot_tick(&robot);
        }
        shows(3, 150, 1);
        snprintf(which_case, sizeof which_case, "phase %d", phase);
        TEST_ASSERT_EQUAL_MESSAGE(0, robot_count_events(&robot, ARGUS_EV_TURN_BLOCKED, 0), which_case);
        finish();
    }
}

void test_s7_one_echo_at_the_end_of_a_turn_does_not_end_it(void) {
    with_profile(ARGUS_PROFILE_ARGUS, check_s7_one_echo_at_the_end_of_a_turn_does_not_end_it);
}

// 380 mm: 10 less than what a turn begins with, since readings scatter.
static void check_s7_how_near_ends_a_turn(void) {
    for (int mm = 208; mm <= 214; mm += 6) { // 376 and 382 mm from the centre
        turn_begins();
        shows(3, mm, 2);
        TEST_ASSERT_EQUAL(mm == 208, robot_count_events(&robot, ARGUS_EV_TURN_BLOCKED, 0) > 0);
        finish();
    }
}

void test_s7_how_near_ends_a_turn(void) {
    with_profile(ARGUS_PROFILE_ARGUS, check_s7_how_near_ends_a_turn);
}

void test_s7_a_turn_ends_when_something_shows_within_the_swing_circle(void) {
    with_profile(ARGUS_PROFILE_ARGUS, check_s7_a_turn_ends_when_something_shows_within_the_swing_circle);
}

// Hit while turned away to look: it may neither go on with the turn nor turn home.
static void check_s7_no_turn_home_while_a_bumper_is_pressed(void) {
    start_idle();
    robot.fault[3] = ROBOT_SCALE;
    robot.fault_value[3] = 50;
    robot.fault[10] = ROBOT_VALUE;
    robot.fault_value[10] = 430; // no way back
    TEST_ASSERT_TRUE(until_verifying(3));
    for (int i = 0; i < 500 && fabs(robot_heading_deg(&robot)) < 15; i++) {
        robot_tick(&robot);
    }
    robot.bumpers_front = 1 << 5;
    robot_next_sip(&robot);
    const int from = robot.commands;
    robot_run(&robot, 8000);
    robot.mute = true; // a stall of the link brings about a check, which turns home first
    robot_run(&robot, 1000);
    robot.mute = false;
    robot_run(&robot, 8000);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_HEAD, from));
    robot.bumpers_front = 0;
    robot_run(&robot, 20000);
    TEST_ASSERT_TRUE(profile != ARGUS_PROFILE_PAPER || is_covered_for(3));
    finish();
}

void test_s7_no_turn_home_while_a_bumper_is_pressed(void) {
    in_both_profiles(check_s7_no_turn_home_while_a_bumper_is_pressed);
}

static void check_s7_no_correction_of_heading_beside_a_wall_that_blocks_the_swing_circle(void) {
    start_driving();
    robot.fault[7] = ROBOT_VALUE;
    robot.fault_value[7] = 200;
    robot.th += 0.1; // 6 degrees off the bearing
    const int from = robot_count_commands(&robot, ARCOS_CMD_HEAD, 0);
    robot_run(&robot, 500); // sonar 7 has been seen by now
    const int seen = robot_count_commands(&robot, ARCOS_CMD_HEAD, 0);
    robot.th += 0.05;
    robot_run(&robot, 500);
    TEST_ASSERT_TRUE(seen >= from);
    finish(); // the watch names every HEAD in a blocked circle
}

void test_s7_no_correction_of_heading_beside_a_wall_that_blocks_the_swing_circle(void) {
    in_both_profiles(check_s7_no_correction_of_heading_beside_a_wall_that_blocks_the_swing_circle);
}

static void check_s8_operator_arguments_at_the_ends_of_the_range(void) {
    static const int32_t extreme[] = {INT32_MIN, INT32_MIN + 1, -1, 0, 1, INT32_MAX};
    for (int op = 0; op < 10; op++) {
        for (int i = 0; i < 6; i++) {
            start_idle();
            argus_operator(&robot.argus, robot.start_ms + robot.t_ms, (argus_op_t)op, extreme[i]);
            robot_run(&robot, 3000);
            finish();
        }
    }
}

void test_s8_operator_arguments_at_the_ends_of_the_range(void) {
    in_both_profiles(check_s8_operator_arguments_at_the_ends_of_the_range);
}

static void check_s8_impossible_sonar_numbers_and_readings(void) {
    start_idle();
    for (int number = 0; number < 256; number += 5) {
        for (int range = 0; range < 65536; range += 13107) {
            uint8_t data[35] = {0x32, [16] = 7, [19] = 1};
            uint8_t packet[60];
            data[20] = (uint8_t)number;
            data[21] = (uint8_t)range;
            data[22] = (uint8_t)(range >> 8);
            robot_deliver(&robot, packet, argus_frame_encode(packet, sizeof packet, data, sizeof data));
            robot_drain(&robot);
        }
    }
    finish();
}

void test_s8_impossible_sonar_numbers_and_readings(void) {
    in_both_profiles(check_s8_impossible_sonar_numbers_and_readings);
}
