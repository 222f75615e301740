// SPDX-License-Identifier: MIT
// Rule under attack: on its way the robot asks, SIP by SIP, for what the state calls for: it stops where it
// cannot go on, sweeps only where that shows more, counters a short wheel only where it may turn, and an
// operator's step is one MOVE.
#include "behaviour/travel.h"

#include "behaviour/reverse.h"
#include "behaviour/state.h"
#include "echo.h"
#include "health.h"
#include "knowledge/angle.h"
#include "robot.h"
#include "unity.h"

static robot_t robot;
static argus_t *core;
static argus_intent_t intent;

static void begin_with(int32_t profile, int32_t creep_mm_s) {
    argus_config_t config = robot_config_of(profile);
    config.creep_mm_s = creep_mm_s;
    robot_init(&robot, &config, 1000);
    robot.world = robot_world_segments;
    robot_box(&robot, -4000, -4000, 8000, 4000);
    TEST_ASSERT_TRUE(robot_goal(&robot, 6000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 10000));
    robot_run(&robot, 3000);
    core = &robot.argus;
}

void setUp(void) {
    begin_with(ARGUS_PROFILE_ARGUS, 0);
}

static void run(void (*mode)(const argus_t *, argus_travel_t *, argus_intent_t *)) {
    intent = (argus_intent_t){0};
    core->travel.beside_sip = core->knowledge.sips; // the check beside is made
    mode(core, &core->travel, &intent);
}

static void put_before(int ahead_mm) {
    const argus_point_t ahead = {ahead_mm, 0};
    argus_touches_add(&core->echoes.touches, argus_to_course(&core->knowledge.pose, ahead));
}

void test_without_motors_each_mode_of_the_way_stops(void) {
    core->knowledge.flags = (uint16_t)(core->knowledge.flags & ~(unsigned)ARCOS_FLAG_MOTORS);
    run(argus_run_driving);
    TEST_ASSERT_EQUAL(ARGUS_STOP_STOP, intent.stop);
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act);
    run(argus_run_sweeping);
    TEST_ASSERT_EQUAL(ARGUS_STOP_STOP, intent.stop);
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act);
    run(argus_run_creeping);
    TEST_ASSERT_EQUAL(ARGUS_STOP_STOP, intent.stop);
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act);
}

void test_a_sweep_that_fails_is_checked(void) {
    core->base.taken = true;
    core->motion.failed = true;
    run(argus_run_sweeping);
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act);
    TEST_ASSERT_TRUE(intent.full);
}

// S2: what was touched stands there whatever the sonars hear: before the check range no step is made.
void test_s2_after_a_sweep_what_was_touched_ahead_stops_the_step(void) {
    core->base.taken = true;
    core->motion.settled = true;
    core->motion.failed = false;
    core->motion.mark = (argus_mark_t){0};
    core->travel.swept = true;
    core->travel.drive.done = true;
    core->travel.drive.smallest_mm = 4000;
    put_before(core->knowledge.robot->sonar_face_mm + core->config.check_range_mm - 50);
    run(argus_run_sweeping);
    TEST_ASSERT_EQUAL(ARGUS_EV_OBJECT, intent.event);
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act);
    TEST_ASSERT_EQUAL(ARGUS_WAY_REFUSE, intent.way);
}

// S6: one that an operator wants looked at again is, before the next step.
void test_s6_after_a_sweep_an_open_suspect_is_checked_before_the_step(void) {
    for (int suspect = 0; suspect < 2; suspect++) {
        const argus_config_t paper = robot_config_of(ARGUS_PROFILE_PAPER);
        setUp();
        core->rules = argus_profile(&paper);
        core->base.taken = true;
        core->motion.settled = true;
        core->motion.mark = (argus_mark_t){0};
        core->travel.swept = true;
        core->travel.drive.done = true;
        core->travel.drive.smallest_mm = 4000;
        if (suspect != 0) {
            put_health(&core->knowledge.sonar[4], ARGUS_SUSPECT, ARGUS_KIND_NONE, core->now_ms);
        }
        run(argus_run_sweeping);
        TEST_ASSERT_EQUAL(suspect != 0 ? ARGUS_DO_CHECK : ARGUS_DO_STEP, intent.act);
        TEST_ASSERT_FALSE(intent.full);
    }
}

// ---- a short wheel

static void shorten(int permille) {
    core->wheel.short_pm = (int16_t)permille;
    core->wheel.odometer_mm = core->knowledge.odometer_mm;
}

void test_a_short_wheel_is_countered_by_little(void) {
    run(argus_run_driving);
    const bool steered = intent.steers;
    TEST_ASSERT_EQUAL(ARGUS_DO_DRIVE, intent.act);
    TEST_ASSERT_FALSE(steered); // it is on its bearing
    for (int side = -1; side <= 1; side += 2) {
        shorten(side * 50);
        run(argus_run_driving);
        TEST_ASSERT_EQUAL(ARGUS_DO_DRIVE, intent.act);
        TEST_ASSERT_TRUE(intent.steers);
        const int32_t by_cdeg = intent.cdeg - core->knowledge.pose.heading_cdeg;
        TEST_ASSERT_TRUE(side > 0 ? by_cdeg < 0 : by_cdeg > 0);
        TEST_ASSERT_TRUE(argus_abs(by_cdeg) < 1000);
    }
}

// Where it may not turn by even so little, it is let bend.
void test_s7_a_short_wheel_is_not_countered_where_the_body_would_meet_something(void) {
    shorten(50);
    const int32_t beside_mm = argus_robot_half_width_mm(core->knowledge.robot) + 5;
    for (int side = -1; side <= 1; side += 2) {
        const argus_pose_t *const pose = &core->knowledge.pose;
        for (int x = -300; x <= 200; x += 50) {
            place_echo(&core->echoes, &core->knowledge, pose->x_mm + x, pose->y_mm + side * beside_mm);
            core->echoes.at[core->echoes.count - 1].again = true;
        }
    }
    const argus_guard_t guard = argus_guard(core);
    TEST_ASSERT_FALSE(argus_guard_may_turn(&guard));
    run(argus_run_driving);
    TEST_ASSERT_FALSE(intent.steers);
}

// ... but where the circle is not free and the little that it takes is, it is.
void test_s7_a_short_wheel_is_countered_by_a_nudge(void) {
    shorten(50);
    argus_guard_t guard = argus_guard(core);
    bool found = false;
    for (int x = 0; x <= 300 && !found; x += 10) {
        for (int y = 200; y <= 400 && !found; y += 10) {
            const argus_point_t at = argus_to_course(&core->knowledge.pose, (argus_point_t){x, y});
            core->echoes.count = 0;
            place_echo(&core->echoes, &core->knowledge, at.x_mm, at.y_mm);
            core->echoes.at[0].again = true;
            guard = argus_guard(core);
            found = !argus_guard_may_turn(&guard) && argus_guard_may_nudge(&guard, -500);
        }
    }
    TEST_ASSERT_TRUE(found);
    run(argus_run_driving);
    TEST_ASSERT_EQUAL(ARGUS_DO_DRIVE, intent.act);
    TEST_ASSERT_TRUE(intent.steers);
    TEST_ASSERT_NOT_EQUAL_INT32(core->knowledge.pose.heading_cdeg, intent.cdeg);
}

// ---- a turn at rest

static void rest_off_its_bearing(int32_t cdeg) {
    core->motion.settled = true;
    core->motion.failed = false;
    core->knowledge.still_sips = 10;
    core->travel.aimed = false;
    core->knowledge.pose.heading_cdeg = argus_angle_wrap(core->knowledge.pose.heading_cdeg + cdeg);
}

static void put_beside(int x_mm, int beside_mm) {
    for (int side = -1; side <= 1; side += 2) {
        const argus_point_t at = argus_to_course(
            &core->knowledge.pose,
            (argus_point_t){x_mm, side * (argus_robot_half_width_mm(core->knowledge.robot) + beside_mm)});
        place_echo(&core->echoes, &core->knowledge, at.x_mm, at.y_mm);
        core->echoes.at[core->echoes.count - 1].again = true;
    }
}

// Hemmed in on both sides it may not even nudge: straight ahead leads out, and no turn is asked for.
void test_out_of_a_place_too_narrow_for_a_nudge_it_goes_straight_ahead(void) {
    rest_off_its_bearing(3000);
    core->echoes.count = 0;
    for (int x = -200; x < 0; x += 40) {
        put_beside(x, 5);
    }
    const argus_guard_t guard = argus_guard(core);
    TEST_ASSERT_TRUE(argus_guard_swing_is_blocked(&guard));
    TEST_ASSERT_FALSE(argus_guard_may_nudge(&guard, 500) || argus_guard_may_nudge(&guard, -500));
    const int32_t heading_cdeg = core->knowledge.pose.heading_cdeg;
    run(argus_run_driving);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
    TEST_ASSERT_TRUE(core->travel.task.avoiding && core->travel.task.has_leg);
    TEST_ASSERT_INT32_WITHIN(20, heading_cdeg, argus_task_bearing_cdeg(&core->travel.task, &core->knowledge));
}

// Pushed while its MOVE is over, it is not at rest, and there is nothing to brake.
void test_a_robot_that_is_pushed_is_waited_for(void) {
    for (int over = 0; over < 2; over++) {
        setUp();
        rest_off_its_bearing(6000);
        core->motion.kind = ARGUS_MOTION_MOVE;
        core->motion.settled = over != 0;
        core->knowledge.still_sips = 0;
        run(argus_run_driving);
        TEST_ASSERT_EQUAL(over != 0 ? ARGUS_DO_NOTHING : ARGUS_DO_BRAKE, intent.act);
    }
}

// An operator's step begins at rest: what is under way ends first.
void test_an_operators_step_ends_the_motion_under_way(void) {
    core->travel.jog_mm = 120;
    core->travel.aimed = false;
    TEST_ASSERT_EQUAL(ARGUS_MOTION_MOVE, core->motion.kind);
    TEST_ASSERT_FALSE(core->motion.settled);
    run(argus_run_driving);
    TEST_ASSERT_EQUAL(ARGUS_DO_BRAKE, intent.act);
}

// ---- which end leads

static void hear_nothing_for(uint32_t way_mm) {
    core->reverse.odometer_mm = core->knowledge.odometer_mm - way_mm;
    for (int i = 0; i < core->knowledge.sonars; i++) {
        core->knowledge.sonar[i].echo_mm = core->knowledge.odometer_mm - way_mm;
        core->knowledge.sonar[i].reading_mm = 5000;
    }
}

// An end that has led for long without an echo is looked at by the other one, where the rules let that lead.
void test_an_end_that_heard_nothing_goes_on_where_no_other_may_lead(void) {
    for (int may = 0; may < 2; may++) {
        setUp();
        argus_profile_t rules = *argus_rules(core);
        rules.may_reverse = may != 0;
        core->rules = &rules;
        hear_nothing_for(5000);
        const argus_guard_t guard = argus_guard(core);
        TEST_ASSERT_TRUE(argus_guard_has_led(&guard));
        run(argus_run_driving);
        TEST_ASSERT_EQUAL(may != 0 && argus_robot_other_end(core->knowledge.robot) != NULL,
                          intent.act == ARGUS_DO_CHECK);
    }
}

// The ends change at rest alone.
void test_the_front_leads_on_once_the_robot_rests(void) {
    const argus_robot_t *const other = argus_robot_other_end(core->knowledge.robot);
    if (other == NULL) {
        TEST_IGNORE_MESSAGE("a small build manages one end");
    }
    argus_knowledge_turn_about(&core->knowledge, other);
    core->reverse = (argus_reverse_t){.odometer_mm = core->knowledge.odometer_mm, .done = true};
    hear_nothing_for(0);
    core->travel.aimed = true;
    core->knowledge.pose.heading_cdeg = argus_angle_wrap(core->knowledge.pose.heading_cdeg - 18000);
    TEST_ASSERT_TRUE(argus_should_hand_back(core));
    for (int rests = 0; rests < 2; rests++) {
        core->knowledge.still_sips = (uint16_t)(rests * 10);
        run(argus_run_driving);
        TEST_ASSERT_EQUAL(rests != 0, intent.act == ARGUS_DO_TURN_ABOUT);
    }
}

// ---- what is not seen

// Where no sonar ahead is left, there is none for which the heading would be swung.
void test_without_a_sonar_ahead_it_does_not_weave(void) {
    for (int left = 0; left < 2; left++) {
        setUp();
        const argus_mask_t ahead = argus_robot_forward(core->knowledge.robot);
        for (int i = 0; i < core->knowledge.sonars; i++) {
            if ((ahead >> i & 1u) != 0 && (left == 0 || i == 3)) {
                put_health(&core->knowledge.sonar[i], ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
            }
        }
        const argus_guard_t guard = argus_guard(core);
        TEST_ASSERT_TRUE(argus_guard_is_blind(&guard));
        const int16_t side = core->travel.weave.side;
        run(argus_run_driving);
        TEST_ASSERT_EQUAL(ARGUS_DO_DRIVE, intent.act);
        TEST_ASSERT_EQUAL(left != 0, core->travel.weave.side != side);
    }
}

static void see_nothing_of_the_way(void) {
    put_health(&core->knowledge.sonar[3], ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
    put_health(&core->knowledge.sonar[4], ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
    argus_rays_forget_all(&core->rays);
}

void test_a_way_that_is_not_seen_is_stopped_before_and_then_swept(void) {
    see_nothing_of_the_way();
    core->plan.disabled = 3u << 3;
    run(argus_run_driving);
    TEST_ASSERT_EQUAL(ARGUS_DO_BRAKE, intent.act);
    core->travel.aimed = true;
    core->motion.kind = ARGUS_MOTION_STOP; // which is at work
    core->motion.settled = false;
    run(argus_run_driving);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
    core->travel.aimed = true;
    core->motion.settled = true;
    run(argus_run_driving);
    TEST_ASSERT_EQUAL(ARGUS_DO_SWEEP, intent.act);
}

// Where none is out, no sweep shows more: only a look would, and it is waited for the room that takes.
void test_a_way_that_only_a_look_could_show_is_waited_for(void) {
    see_nothing_of_the_way();
    core->plan.disabled = 0;
    core->travel.aimed = true;
    core->motion.settled = true;
    run(argus_run_driving);
    TEST_ASSERT_EQUAL(ARGUS_DO_WAIT, intent.act);
    TEST_ASSERT_EQUAL(ARGUS_WAIT_TURN, intent.why);
}

// ---- creeping

static void begin_creeping(void) {
    begin_with(ARGUS_PROFILE_ARGUS, 50);
    core->session.robot.front_bumpers = 5;
    core->reflexes.touched_unheard = true;
    core->knowledge.heard = 0;
    core->mode = ARGUS_MODE_CREEPING;
    core->travel.aimed = true;
    core->travel.heeded_ms = core->now_ms;
    const argus_guard_t guard = argus_guard(core);
    TEST_ASSERT_TRUE(argus_guard_may_creep(&guard));
}

void test_without_motors_it_does_not_creep_on(void) {
    begin_creeping();
    core->knowledge.flags = (uint16_t)(core->knowledge.flags & ~(unsigned)ARCOS_FLAG_MOTORS);
    TEST_ASSERT_TRUE(argus_guard(core).creeps);
    run(argus_run_creeping);
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act);
    TEST_ASSERT_EQUAL(ARGUS_STOP_STOP, intent.stop);
}

void test_it_creeps_on_by_a_short_way(void) {
    begin_creeping();
    run(argus_run_creeping);
    TEST_ASSERT_EQUAL(ARGUS_DO_CREEP, intent.act);
    TEST_ASSERT_EQUAL_INT32(150, intent.mm);
    TEST_ASSERT_FALSE(intent.steers);
}

void test_it_creeps_to_nothing_that_was_touched(void) {
    begin_creeping();
    put_before(core->knowledge.robot->sonar_face_mm + 150);
    run(argus_run_creeping);
    TEST_ASSERT_EQUAL(ARGUS_EV_OBJECT, intent.event);
    TEST_ASSERT_EQUAL(ARGUS_DO_CHECK, intent.act);
    TEST_ASSERT_EQUAL(ARGUS_STOP_HALT, intent.stop);
}

void test_a_robot_that_does_not_obey_does_not_creep(void) {
    begin_creeping();
    core->knowledge.still_sips = 5;
    core->motion.kind = ARGUS_MOTION_MOVE;
    core->motion.settled = false;
    core->travel.heeded_ms = core->now_ms - 3000u;
    run(argus_run_creeping);
    TEST_ASSERT_EQUAL(ARGUS_DO_WAIT, intent.act);
    TEST_ASSERT_EQUAL(ARGUS_WAIT_MOTORS, intent.why);
    core->travel.heeded_ms = core->now_ms - 2999u;
    run(argus_run_creeping);
    TEST_ASSERT_EQUAL(ARGUS_DO_CREEP, intent.act);
}

void test_it_steers_while_it_creeps_only_off_its_bearing_and_where_it_may_turn(void) {
    begin_creeping();
    core->knowledge.pose.heading_cdeg = 500;
    run(argus_run_creeping);
    TEST_ASSERT_EQUAL(ARGUS_DO_CREEP, intent.act);
    TEST_ASSERT_TRUE(intent.steers);
    TEST_ASSERT_TRUE(argus_abs(intent.cdeg) < 200);
    put_beside(-100, 20);
    run(argus_run_creeping);
    TEST_ASSERT_EQUAL(ARGUS_DO_CREEP, intent.act);
    TEST_ASSERT_FALSE(intent.steers);
}

// ---- an operator's step

void test_an_operators_step_is_one_move(void) {
    begin_creeping();
    core->travel.jog_mm = 120;
    core->motion.kind = ARGUS_MOTION_MOVE;
    core->motion.settled = false;
    run(argus_run_creeping);
    TEST_ASSERT_EQUAL(ARGUS_DO_NOTHING, intent.act);
    core->motion.settled = true;
    run(argus_run_creeping);
    TEST_ASSERT_EQUAL(ARGUS_DO_DECIDE, intent.act);
    TEST_ASSERT_EQUAL_INT32(0, core->travel.jog_mm);
}

void test_an_operators_step_without_room_is_over_before_it_began(void) {
    core->travel.jog_mm = 120;
    core->travel.aimed = true;
    for (int i = 1; i <= 6; i++) {
        core->knowledge.sonar[i].reading_mm = (uint16_t)core->config.object_range_mm;
        core->knowledge.sonar[i].odometer_mm = core->knowledge.odometer_mm;
    }
    run(argus_run_driving);
    TEST_ASSERT_EQUAL(ARGUS_DO_DECIDE, intent.act);
    TEST_ASSERT_EQUAL_INT32(0, core->travel.jog_mm);
}
