// SPDX-License-Identifier: MIT
// Rule under attack (profile argus): the manager acts on evidence. Every kind of fault is found on the way
// and named, an open hall is none, a look ends on the heading that it began on, and a repaired sonar comes
// back on agreements alone.
#include "supervisor/manager.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "awareness/numbers.h"
#include "behaviour/looks.h"
#include "health.h"
#include "robot.h"
#include "supervisor/faults.h"
#include "supervisor/modes.h"
#include "unity.h"

#define SONARS (ARGUS_SONARS < 16 ? ARGUS_SONARS : 16) // that its robot has, of those that a build manages

#define RAD (3.14159265358979323846 / 180)

static robot_t robot;
static char text[400];

static void start(void) {
    const argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &config, 0xFFFF8000u);
    robot.noise_mm = 5;
}

// Things all round, so that turning shows another range on every bearing.
static void furnish(void) {
    robot_box(&robot, -2500, -2300, 3300, 2500);
    robot_box(&robot, 1800, 1200, 2300, 1700);
    robot_box(&robot, 2300, -2300, 3300, -1400);
    robot_box(&robot, -2500, 1500, -1500, 2500);
    robot.world = robot_world_segments;
}

static void start_in_a_room(void) {
    start();
    furnish();
}

static void finish(void) {
    TEST_ASSERT_EQUAL_STRING("", robot.violation);
}

static argus_health_t health(int sonar) {
    return robot.argus.knowledge.sonar[sonar].health;
}

static const char *told(const char *what, int sonar) {
    int used = snprintf(text, sizeof text, "%s, sonar %d, t %u ms, mode %s:", what, sonar,
                        (unsigned)robot.t_ms, argus_name(ARGUS_NAME_MODE, robot.argus.mode));
    for (int i = 0; i < SONARS; i++) {
        if (health(i) > ARGUS_HEALTHY && used < (int)sizeof text) {
            used += snprintf(text + used, sizeof text - (size_t)used, " %d %s %s", i,
                             argus_name(ARGUS_NAME_HEALTH, health(i)),
                             argus_name(ARGUS_NAME_KIND, robot.argus.knowledge.sonar[i].kind));
        }
    }
    return text;
}

// To and fro until `enough`, or for so long.
static bool drive_until(bool (*enough)(int sonar), int sonar, uint32_t ms) {
    static const argus_point_t there[] = {{1000, 0}, {0, 700}, {-900, 0}, {0, -700}};
    const uint32_t from = robot.t_ms;
    for (int i = 0; robot.t_ms - from < ms; i++) {
        robot_goal(&robot, there[i % 4].x_mm, there[i % 4].y_mm);
        while (robot.t_ms - from < ms && robot.argus.mission == ARGUS_MISSION_RUNNING) {
            if (enough(sonar)) {
                return true;
            }
            robot_tick(&robot);
        }
        if (robot.argus.mission != ARGUS_MISSION_RUNNING) {
            robot_run(&robot, 500);
        }
    }
    return enough(sonar);
}

static bool never(int sonar) {
    (void)sonar;
    return false;
}

static bool ask_for_a_look(int sonar) {
    const bool taken = argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_RETEST, sonar);
    robot_drain(&robot);
    return taken;
}

static void contradict(int sonar) {
    robot.argus.evidence.of[sonar].score[ARGUS_TEST_PEERS] = argus_bounds[ARGUS_TEST_PEERS].naming;
}

static void score_dropout(int sonar, int beside_naming) {
    robot.argus.evidence.of[sonar].score[ARGUS_TEST_DROPOUT] =
        (int16_t)(argus_bounds[ARGUS_TEST_DROPOUT].naming + beside_naming);
}

static bool is_disabled(int sonar) {
    return health(sonar) == ARGUS_DISABLED;
}

// DISABLED, or a suspect with the name of its fault: it is not relied on from there.
static bool is_found(int sonar) {
    return robot.argus.knowledge.sonar[sonar].kind != ARGUS_KIND_NONE;
}

static bool is_healthy(int sonar) {
    return health(sonar) == ARGUS_HEALTHY;
}

static int disabled_events_of_others(int sonar) {
    int count = 0;
    for (int i = 0; i < robot.events; i++) {
        count += robot.event[i].id == ARGUS_EV_SONAR_DISABLED && robot.event[i].sonar != sonar;
    }
    return count;
}

// A suspect may yet be called otherwise; what it is disabled for is what it has, but once: random values look
// now and then like late ones.
static void finds(robot_fault_t fault, int value, argus_fault_kind_t kind, bool (*found)(int sonar)) {
    static const int sonars[] = {2, 3, 5, 12};
    int wrong = 0;
    for (int i = 0; i < 4; i++) {
        start_in_a_room();
        robot.seed += (uint32_t)i * 7919u;
        drive_until(never, 0, 12000);
        robot.fault[sonars[i]] = fault;
        robot.fault_value[sonars[i]] = value;
        TEST_ASSERT_TRUE_MESSAGE(drive_until(found, sonars[i], 120000), told("not found", sonars[i]));
        drive_until(never, 0, 20000); // the kind may become clearer
        const bool right = robot.argus.knowledge.sonar[sonars[i]].kind == kind;
        wrong += !right && is_disabled(sonars[i]);
        TEST_ASSERT_TRUE_MESSAGE(wrong <= 1, told("kind", sonars[i]));
        TEST_ASSERT_EQUAL_MESSAGE(0, disabled_events_of_others(sonars[i]), told("others", sonars[i]));
        finish();
    }
}

static argus_suspicions_t suspicions(void) {
    argus_suspicions_t now;
    memset(&now, 0xAA, sizeof now);
    argus_suspicions(&robot.argus, &now);
    return now;
}

static bool is_half_convicted(int sonar) {
    return suspicions().percent[sonar] >= 50;
}

// What is shown of the evidence rises before the verdict, names it, and stays low for the others.
void test_a_suspicion_grows_to_a_verdict(void) {
    start_in_a_room();
    drive_until(never, 0, 12000);
    TEST_ASSERT_TRUE(suspicions().percent[3] < 50);
    robot.fault[3] = ROBOT_STUCK;
    TEST_ASSERT_TRUE(drive_until(is_half_convicted, 3, 120000));
    TEST_ASSERT_EQUAL_INT(ARGUS_KIND_STUCK, suspicions().kind[3]);
    TEST_ASSERT_FALSE(is_disabled(3));
    TEST_ASSERT_TRUE(drive_until(is_disabled, 3, 120000));
    TEST_ASSERT_EQUAL_INT(100, suspicions().percent[3]);
    TEST_ASSERT_EQUAL_INT(ARGUS_KIND_STUCK, suspicions().kind[3]);
    for (int i = 0; i < SONARS; i++) {
        TEST_ASSERT_TRUE_MESSAGE(i == 3 || suspicions().percent[i] < 80, told("the others", i));
        TEST_ASSERT_TRUE((suspicions().against[i] >> i & 1u) == 0);
    }
    finish();
}

void test_the_rules_of_the_paper_suspect_nothing(void) {
    const argus_suspicions_t none = {.kind = {ARGUS_KIND_NONE}};
    const argus_config_t config = robot_config();
    robot_init(&robot, &config, 0);
    robot_run(&robot, 3000);
    const argus_suspicions_t now = suspicions();
    TEST_ASSERT_EQUAL_MEMORY(&none, &now, sizeof none);
}

void test_off_is_found(void) {
    finds(ROBOT_OFF, 0, ARGUS_KIND_OFF, is_disabled);
}

void test_silent_is_found(void) {
    finds(ROBOT_SILENT, 0, ARGUS_KIND_SILENT, is_disabled);
}

void test_stuck_is_found(void) {
    finds(ROBOT_STUCK, 0, ARGUS_KIND_STUCK, is_disabled);
}

void test_wrong_is_found(void) {
    finds(ROBOT_SCALE, 50, ARGUS_KIND_WRONG, is_disabled);
}

void test_garbage_is_found(void) {
    finds(ROBOT_GARBAGE, 0, ARGUS_KIND_GARBAGE, is_disabled);
}

// Late by so many firings that its trail comes again clearly.
void test_slow_is_found(void) {
    finds(ROBOT_SLOW, 8, ARGUS_KIND_SLOW, is_found);
}

void test_intermittent_is_found(void) {
    finds(ROBOT_DROPOUT, 40, ARGUS_KIND_INTERMITTENT, is_found);
}

void test_healthy_in_a_room_for_ten_minutes(void) { // soak
    start_in_a_room();
    drive_until(never, 0, 600000);
    TEST_ASSERT_EQUAL_MESSAGE(0, robot_count_events(&robot, ARGUS_EV_SONAR_DISABLED, 0), told("room", -1));
    TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_GOAL_REACHED, 0) > 5);
    finish();
}

// What the paper's rule takes for six dead sonars.
void test_an_open_hall_is_driven_through(void) {
    start();
    robot_box(&robot, -30000, -30000, 30000, 30000);
    robot.world = robot_world_segments;
    TEST_ASSERT_TRUE(robot_goal(&robot, 6000, 0));
    TEST_ASSERT_TRUE_MESSAGE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 240000), told("hall", -1));
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_SONAR_DISABLED, 0));
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_SONAR_DEAD, 0));
    finish();
}

// S4: the heading of a look is the heading of the next step; and nothing translates in between.
void test_a_look_begins_and_ends_on_one_heading_and_place(void) {
    start_in_a_room();
    int seen = 0;
    TEST_ASSERT_TRUE(robot_goal(&robot, 1500, 600));
    for (int i = 0; i < 12000 && robot.argus.mission == ARGUS_MISSION_RUNNING; i++) {
        if (i % 1500 == 600) {
            ask_for_a_look(3);
        }
        robot_tick(&robot);
        if (robot.argus.mode != ARGUS_MODE_VERIFYING || !robot.argus.verifying.inquiry.active) {
            continue;
        }
        const double base = robot.argus.base.cdeg / 100.0;
        const double x = robot.x, y = robot.y;
        const int from = robot.commands;
        while (robot.argus.mode == ARGUS_MODE_VERIFYING) {
            robot_tick(&robot);
        }
        if (robot.argus.mode == ARGUS_MODE_CHECKING &&
            robot_until_event(&robot, ARGUS_EV_HEALTH_CHECK, 60000)) {
            seen++;
            TEST_ASSERT_FLOAT_WITHIN(3, 0, remainder(robot_heading_deg(&robot) - base, 360));
            TEST_ASSERT_FLOAT_WITHIN(5, 0, hypot(robot.x - x, robot.y - y));
            TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, from));
        }
    }
    TEST_ASSERT_TRUE(seen > 0);
    finish();
}

// No metre is preceded by a look that is not needed.
void test_the_first_metre_is_driven_without_a_look(void) {
    start_in_a_room();
    TEST_ASSERT_TRUE(robot_goal(&robot, 1500, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 40000));
    robot_run(&robot, 1000);
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_LOOK, 0));
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_HEAD, 0));
    TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_MOVE, 0) > 0);
    finish();
}

// A suspect behind is no reason to plan for what looks ahead, nor to say the plan again and again.
void test_a_suspect_behind_leaves_the_plan_alone(void) {
    start_in_a_room();
    robot.fault[12] = ROBOT_SCALE;
    robot.fault_value[12] = 60;
    drive_until(is_disabled, 12, 90000);
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_PLAN, 0));
    TEST_ASSERT_EQUAL_HEX16(0, robot.argus.plan.disabled);
    finish();
}

// ---- the way back

static void break_and_repair(int sonar) {
    robot.fault[sonar] = ROBOT_OFF;
    TEST_ASSERT_TRUE_MESSAGE(drive_until(is_disabled, sonar, 120000), told("not found", sonar));
    robot.fault[sonar] = ROBOT_OK;
}

// Drives until it is healthy again; `way`: what it was on the way, a bit each.
static void drive_back(int sonar, unsigned *way) {
    static const argus_point_t there[] = {{1000, 0}, {0, 700}, {-900, 0}, {0, -700}};
    for (int i = 0; i < 100 && !is_healthy(sonar); i++) {
        robot_goal(&robot, there[i % 4].x_mm, there[i % 4].y_mm);
        for (int n = 0; n < 3000 && robot.argus.mission == ARGUS_MISSION_RUNNING && !is_healthy(sonar); n++) {
            robot_tick(&robot);
            *way |= 1u << health(sonar);
        }
    }
}

void test_a_repaired_sonar_comes_back_over_probation(void) {
    static const int sonars[] = {1, 2, 5};
    for (int i = 0; i < 3; i++) {
        unsigned way = 0;
        start_in_a_room();
        break_and_repair(sonars[i]);
        drive_back(sonars[i], &way);
        TEST_ASSERT_EQUAL_MESSAGE(ARGUS_HEALTHY, health(sonars[i]), told("back", sonars[i]));
        TEST_ASSERT_TRUE_MESSAGE((way >> ARGUS_PROBATION & 1u) != 0, "straight from DISABLED to HEALTHY");
        TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, robot.argus.knowledge.sonar[sonars[i]].kind);
        TEST_ASSERT_EQUAL_HEX16(0, robot.argus.plan.disabled);
        finish();
    }
}

// Time alone clears no sonar.
void test_nobody_comes_back_by_standing_still(void) {
    start_in_a_room();
    break_and_repair(3);
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_STOP, 0);
    robot_run(&robot, 1000);
    const argus_health_t before = health(3);
    const int said = robot.events;
    robot_run(&robot, 300000);
    TEST_ASSERT_EQUAL(before, health(3));
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_SONAR_HEALTHY, said));
    finish();
}

// One that is still broken never becomes healthy, though it be on probation at times.
void test_a_broken_sonar_does_not_come_back(void) { // soak
    static const struct {
        robot_fault_t fault;
        int value;
    } faults[] = {{ROBOT_OFF, 0}, {ROBOT_SCALE, 50}, {ROBOT_STUCK, 0}, {ROBOT_GARBAGE, 0}, {ROBOT_SILENT, 0}};
    for (int i = 0; i < 5; i++) {
        start_in_a_room();
        robot.fault[3] = faults[i].fault;
        robot.fault_value[3] = faults[i].value;
        TEST_ASSERT_TRUE_MESSAGE(drive_until(is_disabled, 3, 120000), told("not found", 3));
        const int said = robot.events;
        drive_until(never, 0, 120000);
        for (int n = said; n < robot.events; n++) {
            TEST_ASSERT_FALSE_MESSAGE(robot.event[n].id == ARGUS_EV_SONAR_HEALTHY &&
                                          robot.event[n].sonar == 3,
                                      told("came back broken", 3));
        }
        finish();
    }
}

// Comes back with so many agreements?
static bool comes_back(int agreed) {
    argus_sonar_t *sonar = &robot.argus.knowledge.sonar[3];
    put_health(sonar, ARGUS_PROBATION, ARGUS_KIND_OFF, robot.argus.now_ms - 600000);
    robot.argus.evidence.of[3].agreed = (uint8_t)agreed;
    robot.argus.events.state =
        (uint8_t)argus_failure_of(robot.argus.knowledge.robot, argus_out(&robot.argus.knowledge));
    robot_next_sip(&robot); // at rest nothing new is compared
    return health(3) == ARGUS_HEALTHY;
}

// ... after it has failed once more.
static int agreements_wanted(void) {
    put_health(&robot.argus.knowledge.sonar[3], ARGUS_DISABLED, ARGUS_KIND_OFF, robot.argus.now_ms);
    for (int agreed = 0; agreed <= UINT8_MAX; agreed++) {
        if (comes_back(agreed)) {
            return agreed;
        }
    }
    return -1;
}

// Probation grows with each relapse, but not beyond what can be counted.
void test_a_relapse_doubles_the_agreements_wanted(void) { // soak
    start_in_a_room();
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    robot_run(&robot, 2000);
    const int once = agreements_wanted();
    TEST_ASSERT_TRUE(once > 0);
    TEST_ASSERT_EQUAL(2 * once, agreements_wanted());
    TEST_ASSERT_EQUAL(4 * once, agreements_wanted());
    int last = 4 * once;
    for (int i = 0; i < 300; i++) { // more often than a byte counts
        const int wanted = agreements_wanted();
        TEST_ASSERT_TRUE(wanted >= last);
        last = wanted;
    }
}

void test_a_relapse_is_counted(void) {
    start_in_a_room();
    for (int time = 1; time <= 2; time++) {
        unsigned way = 0;
        const int before = robot.argus.knowledge.sonar[1].disabled_times; // probation may have failed, too
        break_and_repair(1);
        TEST_ASSERT_EQUAL(before + 1, robot.argus.knowledge.sonar[1].disabled_times);
        drive_back(1, &way);
        TEST_ASSERT_EQUAL_MESSAGE(ARGUS_HEALTHY, health(1), told("back", time));
    }
    finish();
}

// ---- what comes in between

void test_a_link_that_stalls_during_a_look(void) {
    start_in_a_room();
    TEST_ASSERT_TRUE(robot_goal(&robot, 1500, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 40000));
    robot_run(&robot, 4000); // away from where it began to count
    ask_for_a_look(3);
    for (int i = 0; i < 3000 && fabs(robot_heading_deg(&robot)) < 15; i++) {
        robot_tick(&robot);
    }
    TEST_ASSERT_TRUE(robot.argus.verifying.inquiry.active);
    robot.mute = true;
    robot_run(&robot, 1500);
    TEST_ASSERT_FALSE(robot.argus.verifying.inquiry.active);
    robot.mute = false;
    const int from = robot.commands;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_LINK_RESUMED, 2000));
    for (int i = 0; i < SONARS; i++) { // whoever moved the robot in the gap: the pings begin anew
        TEST_ASSERT_TRUE(robot.argus.evidence.pings[i].count <= 1);
    }
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_HEALTH_CHECK, 60000));
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, from));
    TEST_ASSERT_FLOAT_WITHIN(3, 0, robot_heading_deg(&robot));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 90000));
    finish();
}

// A poor link stalls every few seconds: what was suspected before a gap is not begun again after it.
void test_faults_are_found_over_a_link_that_stalls_again_and_again(void) {
    static const struct {
        robot_fault_t fault;
        int value;
    } faults[] = {{ROBOT_OFF, 0}, {ROBOT_SCALE, 50}, {ROBOT_STUCK, 0}};
    for (int i = 0; i < 3; i++) {
        start_in_a_room();
        drive_until(never, 0, 12000);
        robot.fault[3] = faults[i].fault;
        robot.fault_value[3] = faults[i].value;
        for (int gap = 0; gap < 25 && !is_found(3); gap++) {
            drive_until(is_found, 3, 6000);
            robot.mute = true;
            robot_run(&robot, 900);
            robot.mute = false;
            robot_until_event(&robot, ARGUS_EV_LINK_RESUMED, 2000);
        }
        TEST_ASSERT_TRUE_MESSAGE(is_found(3), told("fault", i));
        TEST_ASSERT_EQUAL_MESSAGE(0, disabled_events_of_others(3), told("others", i));
        finish();
    }
}

void test_a_witness_that_dies_during_a_look(void) {
    start_in_a_room();
    robot_goal(&robot, 1500, 0);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 40000));
    robot_run(&robot, 1500);
    robot.fault[3] = ROBOT_OFF;
    ask_for_a_look(3);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_VERIFYING, 20000));
    robot.fault[2] = robot.fault[4] = ROBOT_SILENT;
    TEST_ASSERT_TRUE_MESSAGE(robot_until_event(&robot, ARGUS_EV_HEALTH_CHECK, 60000), told("look", 3));
    robot_run(&robot, 2000); // the look may be over before they count as silent
    TEST_ASSERT_TRUE(is_disabled(2) && is_disabled(4));
    robot_run(&robot, 60000);
    finish(); // the watch: no step without a plan for all that are not relied on
}

static void condemn(int sonar) {
    robot.argus.evidence.of[sonar].score[ARGUS_TEST_DROPOUT] = ARGUS_CEILING;
}

// S1: what convicts a sonar that looks ahead while the robot drives is planned for in the same call; it goes
// on as far as others have seen, which the watch compares.
void test_a_conviction_in_motion_is_planned_for_in_the_same_call(void) {
    for (int sonar = 1; sonar <= 6; sonar++) {
        start_in_a_room();
        robot_goal(&robot, 2000, 0);
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 40000));
        robot_run(&robot, 1500);
        TEST_ASSERT_EQUAL(ARGUS_MODE_DRIVING, robot.argus.mode);
        condemn(sonar);
        robot_next_sip(&robot);
        TEST_ASSERT_TRUE_MESSAGE(is_disabled(sonar), told("conviction", sonar));
        TEST_ASSERT_TRUE((robot.argus.plan.disabled >> sonar & 1u) != 0);
        robot_run(&robot, 30000);
        finish();
    }
}

// Returns where the commands after it begin.
static int lose_on_the_way(int first, int last) {
    start_in_a_room();
    robot_goal(&robot, 2000, 0);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 40000));
    robot_run(&robot, 1500);
    const int from = robot.commands;
    for (int sonar = first; sonar <= last; sonar++) {
        condemn(sonar);
    }
    robot_next_sip(&robot);
    TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_STOP, from) > 0);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, from));
    return from;
}

// S2: ... and stops it in the same call where no sonar is left to see.
void test_a_conviction_that_leaves_nobody_is_answered_by_stop_in_the_same_call(void) {
    const int from = lose_on_the_way(0, 15);
    robot_run(&robot, 30000);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, from));
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_REVERSED, 0));
    finish();
}

// ... where none is left in front, until the rear leads.
void test_with_the_front_convicted_the_robot_moves_with_its_rear_ahead_only(void) {
    const int from = lose_on_the_way(1, 6);
    robot_run(&robot, 8000);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_REVERSED, 0));
    TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_MOVE, from) > 0);
    for (int i = from; i < robot.commands; i++) {
        TEST_ASSERT_TRUE(robot.command[i].command != ARCOS_CMD_MOVE || robot.command[i].argument < 0);
    }
    argus_status_t status;
    argus_status(&robot.argus, &status);
    TEST_ASSERT_TRUE(status.reversed);
    TEST_ASSERT_EQUAL(ARGUS_IS_CATASTROPHIC, status.failure);
    TEST_ASSERT_INT_WITHIN(3, (int)robot_heading_deg(&robot), status.pose.heading_cdeg / 100);
    finish();
}

// S6: an operator's step waits for a look where none sees in the place of one that has a name; while the
// course is paused there is none before.
void test_a_jog_does_not_outrun_a_name(void) {
    start_in_a_room();
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_STOP, 0);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    for (int i = 0; i < 40; i++) {
        for (int sonar = 2; sonar <= 4; sonar++) {
            score_dropout(sonar, 60);
        }
        robot_next_sip(&robot);
    }
    TEST_ASSERT_TRUE_MESSAGE(is_found(2) && is_found(3) && is_found(4), told("jog", 3));
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_HEAD, 0));
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_MOVE, 200);
    TEST_ASSERT_TRUE_MESSAGE(robot_until_event(&robot, ARGUS_EV_SONAR_VERIFYING, 20000), told("jog", 3));
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, 0));
    robot_run(&robot, 20000);
    finish(); // the watch: no MOVE ahead beside a name that no other sees for
}

// S7: what is not relied on does not read clear, however far it reads.
void test_no_backing_away_with_a_rear_sonar_that_is_out_or_has_a_name(void) {
    static const argus_health_t out[] = {ARGUS_DISABLED, ARGUS_PROBATION, ARGUS_SUSPECT, ARGUS_SUSPECT};
    static const argus_fault_kind_t kind[] = {ARGUS_KIND_WRONG, ARGUS_KIND_WRONG, ARGUS_KIND_INTERMITTENT,
                                              ARGUS_KIND_NONE};
    for (int sonar = 8; sonar < SONARS; sonar++) {
        for (int i = 0; i < 4; i++) {
            start_in_a_room();
            TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
            put_health(&robot.argus.knowledge.sonar[sonar], out[i], kind[i], robot.argus.now_ms);
            if (out[i] == ARGUS_SUSPECT) { // or it would be cleared at once
                robot.argus.evidence.of[sonar].score[ARGUS_TEST_DROPOUT] =
                    (int16_t)(kind[i] != ARGUS_KIND_NONE ? argus_bounds[ARGUS_TEST_DROPOUT].convincing - 1
                                                         : argus_bounds[ARGUS_TEST_DROPOUT].naming - 1);
            }
            robot.bumpers_front = 1 << 2;
            robot_run(&robot, 8000);
            const bool relied_on = kind[i] == ARGUS_KIND_NONE;
            TEST_ASSERT_EQUAL(relied_on, robot_count_events(&robot, ARGUS_EV_BACKING, 0) > 0);
            finish();
        }
    }
}

// S7: ... and one that fails on the way back ends it.
void test_backing_away_ends_when_a_rear_sonar_fails(void) {
    for (int sonar = 8; sonar < SONARS; sonar++) {
        start_in_a_room();
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
        robot.bumpers_front = 1 << 2;
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_BACKING, 8000));
        const uint32_t stops = robot.argus.stops;
        put_health(&robot.argus.knowledge.sonar[sonar], ARGUS_DISABLED, ARGUS_KIND_WRONG, robot.argus.now_ms);
        robot_next_sip(&robot);
        robot_next_sip(&robot);
        TEST_ASSERT_TRUE(robot.argus.stops > stops);
        finish();
    }
}

// On the way, and from then on an echo within the swing circle behind it, which a sonar makes up.
static void hem_in_by(int sonar) {
    start_in_a_room();
    robot_goal(&robot, 1200, 0);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 40000));
    robot_run(&robot, 1500);
    robot.fault[sonar] = ROBOT_VALUE;
    robot.fault_value[sonar] = 100;
    robot_run(&robot, 500);
}

// It can neither turn nor back away: a suspect that does not look ahead is no reason to stop for it.
void test_hemmed_in_it_goes_on_with_a_suspect_behind(void) {
    for (int sonar = 9; sonar <= 14; sonar++) {
        hem_in_by(sonar);
        const int from = robot.commands;
        contradict(sonar);
        robot_run(&robot, 30000);
        TEST_ASSERT_TRUE_MESSAGE(robot_count_events(&robot, ARGUS_EV_GOAL_REACHED, 0) > 0,
                                 told("waits", sonar));
        TEST_ASSERT_EQUAL(1, robot_count_commands(&robot, ARCOS_CMD_STOP, from)); // at the goal
        finish();
    }
}

// ... nor is a turn home that it cannot make.
void test_hemmed_in_on_another_heading_it_goes_on_from_there(void) {
    start_in_a_room();
    robot_goal(&robot, 1200, 0);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 40000));
    ask_for_a_look(3);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_VERIFYING, 40000));
    while (fabs(robot_heading_deg(&robot)) < 15) {
        robot_tick(&robot);
    }
    robot_run(&robot, 500);
    robot.fault[12] = ROBOT_VALUE;
    robot.fault_value[12] = 100;
    const double x = robot.x, y = robot.y;
    robot_run(&robot, 30000);
    TEST_ASSERT_TRUE_MESSAGE(hypot(robot.x - x, robot.y - y) > 200, told("waits", 12));
    finish();
}

// S2: the sonars ahead hear nothing of a smooth wall that the robot slants into; the one abeam does. And a
// sonar that loses the wall in each look does not keep the robot looking for it.
void test_a_smooth_wall_beside_the_way_is_not_touched(void) {
    for (int side = -1; side <= 1; side += 2) {
        for (int slant = 6; slant <= 20; slant += 2) {
            start();
            robot.world = robot_world_smooth;
            robot.segments = 1;
            const double beside = 420 + 600 * tan(slant * RAD); // at the start, where it looks round
            const double wall[4] = {-4000, side * (beside + 4000 * tan(slant * RAD)), 4000,
                                    side * (beside - 4000 * tan(slant * RAD))};
            memcpy(robot.segment[0], wall, sizeof wall);
            robot_goal(&robot, 3500, 0);
            for (int minutes = 0; minutes == 0 || (minutes < 3 && robot.x <= 300); minutes++) {
                robot_run(&robot, 60000);
            }
            snprintf(text, sizeof text, "slant %d degrees, side %d: %.0f mm at the closest, %d stops", slant,
                     side, robot.closest_mm, robot_count_events(&robot, ARGUS_EV_OBJECT, 0));
            TEST_ASSERT_TRUE_MESSAGE(robot.closest_mm >= 5, text);
            TEST_ASSERT_TRUE_MESSAGE(robot.x > 300, text); // it did get there
            finish();
        }
    }
}

// Watching only: it may judge, but it does not turn to look, and it does not stop what it does not drive.
void test_passive_judges_and_moves_nothing(void) {
    start_in_a_room();
    argus_operator(&robot.argus, robot.start_ms, ARGUS_OP_PASSIVE, 0);
    robot_run(&robot, 5000);
    const int from = robot.commands;
    robot.fault[3] = ROBOT_STUCK;
    robot.fault[11] = ROBOT_SILENT;
    for (int i = 0; i < 60; i++) { // somebody else drives
        robot.motors = true;
        robot.turning = true;
        robot.heading += i % 8 < 4 ? 0.4 : -0.4;
        robot_run(&robot, 1500);
    }
    TEST_ASSERT_TRUE(is_disabled(3));
    TEST_ASSERT_TRUE(is_disabled(11));
    for (int i = from; i < robot.commands; i++) {
        const uint8_t c = robot.command[i].command;
        TEST_ASSERT_FALSE(c == ARCOS_CMD_MOVE || c == ARCOS_CMD_HEAD || c == ARCOS_CMD_STOP);
    }
    finish();
}

// The operator's STOP stays: no look of its own accord.
void test_no_look_after_the_operators_stop(void) {
    start_in_a_room();
    robot_goal(&robot, 1500, 0);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 40000));
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_STOP, 0);
    robot_run(&robot, 3000);
    const int from = robot.commands;
    robot.fault[3] = ROBOT_OFF;
    robot.fault[4] = ROBOT_GARBAGE;
    robot_run(&robot, 60000);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_HEAD, from));
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, from));
    finish();
}

void test_retest_takes_sonars_that_exist_and_a_session(void) {
    const argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    robot_init(&robot, &config, 0);
    TEST_ASSERT_FALSE(argus_operator(&robot.argus, 0, ARGUS_OP_RETEST, 3));
    furnish();
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    TEST_ASSERT_FALSE(argus_operator(&robot.argus, robot.t_ms, ARGUS_OP_RETEST, 16));
    TEST_ASSERT_FALSE(argus_operator(&robot.argus, robot.t_ms, ARGUS_OP_RETEST, 255));
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.t_ms, ARGUS_OP_RETEST, 3));
    robot_drain(&robot);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_HEALTH_CHECK, 60000));
    finish();
}

// ---- what the evidence names

// S6: what is named for a second is not relied on from then on, whatever the manager is about; not
// before, since most names of a healthy sonar pass sooner.
static void named_in_time(int sonar) {
    const int from = robot.events;
    const uint32_t from_ms = robot.t_ms;
    do {
        score_dropout(sonar, 60); // an echo takes little from it
        robot_next_sip(&robot);
    } while (robot_count_events(&robot, ARGUS_EV_SONAR_NAMED, from) == 0 && robot.t_ms - from_ms < 6000);
    TEST_ASSERT_EQUAL_MESSAGE(1, robot_count_events(&robot, ARGUS_EV_SONAR_NAMED, from),
                              told("named", sonar));
    TEST_ASSERT_UINT32_WITHIN_MESSAGE(150, 1100, robot.t_ms - from_ms, told("named", sonar));
    TEST_ASSERT_EQUAL(ARGUS_SUSPECT, health(sonar));
    TEST_ASSERT_EQUAL(ARGUS_KIND_INTERMITTENT, robot.argus.knowledge.sonar[sonar].kind);
    TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_SONAR_SUSPECT, from) > 0);
    TEST_ASSERT_EQUAL(sonar, robot_last_event(&robot, ARGUS_EV_SONAR_NAMED)->sonar);
}

void test_what_is_named_for_a_second_is_a_suspect(void) {
    for (int sonar = 0; sonar < SONARS; sonar++) {
        start_in_a_room();
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
        robot_run(&robot, 2000);
        named_in_time(sonar);
        start_in_a_room();
        TEST_ASSERT_TRUE(robot_goal(&robot, 1500, 0));
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 40000));
        named_in_time(sonar);
        robot_run(&robot, 5000);
        finish();
    }
}

// A name that goes within a second is never said.
void test_a_name_that_does_not_stand_is_not_said(void) {
    start_in_a_room();
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    robot_run(&robot, 2000);
    const int from = robot.events;
    for (int i = 0; i < 120; i++) {
        score_dropout(3, i % 8 < 4 ? 60 : -argus_bounds[ARGUS_TEST_DROPOUT].naming);
        robot_next_sip(&robot);
    }
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_SONAR_NAMED, from));
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, robot.argus.knowledge.sonar[3].kind);
    finish();
}

// So long that a name stands.
static void judge_for_a_while(void) {
    for (int i = 0; i <= 30; i++) {
        argus_judge_all(&robot.argus);
        robot.argus.now_ms += 100;
    }
}

// A sonar that was called off and is heard again has gaps: what is found for a while takes the place of a
// name.
void test_off_that_is_heard_again_is_renamed(void) {
    start_in_a_room();
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    robot_run(&robot, 2000);
    argus_sonar_t *const s = &robot.argus.knowledge.sonar[3];
    argus_case_t *const c = &robot.argus.evidence.of[3];
    c->score[ARGUS_TEST_PEERS] = 900;
    c->against = 3;
    c->silent_bits = 0xFF;
    c->none_run = 20;
    judge_for_a_while();
    TEST_ASSERT_EQUAL(ARGUS_KIND_OFF, s->kind);
    c->none_run = 0;
    argus_judge_all(&robot.argus);
    TEST_ASSERT_EQUAL(ARGUS_KIND_OFF, s->kind);
    judge_for_a_while();
    TEST_ASSERT_EQUAL(ARGUS_KIND_INTERMITTENT, s->kind);
    finish();
}

// Plans that change begin the round of POLLING anew, and 0 and 7 come late in it: what is silent since the
// last order is silent.
void test_who_is_passed_over_by_new_orders_is_not_silent(void) {
    for (int sonar = 0; sonar <= 8; sonar += sonar == 0 ? 7 : 1) {
        start_in_a_room();
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
        robot_run(&robot, 2000);
        robot.fault[sonar] = ROBOT_SILENT;
        for (int i = 0; i < 10; i++) {
            argus_share_slots(&robot.argus, &robot.argus.session.outbox, &robot.argus.firing);
            robot_run(&robot, 500);
        }
        TEST_ASSERT_EQUAL_MESSAGE(sonar == 8, is_disabled(sonar),
                                  told("passed over", sonar)); // not of this array
        robot_run(&robot, 1500);
        TEST_ASSERT_TRUE_MESSAGE(is_disabled(sonar), told("silent", sonar));
    }
}

// A sonar that was given up as stuck and shows another value is what the evidence names; one that is out for
// anything else keeps that until another conviction.
void test_stuck_that_shows_another_value_is_renamed(void) {
    static const argus_fault_kind_t kinds[] = {ARGUS_KIND_STUCK, ARGUS_KIND_OFF, ARGUS_KIND_GARBAGE};
    for (int i = 0; i < 3; i++) {
        for (int repeats = 0; repeats < 2; repeats++) {
            start_in_a_room();
            TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
            robot_run(&robot, 2000);
            argus_sonar_t *const s = &robot.argus.knowledge.sonar[3];
            argus_case_t *const c = &robot.argus.evidence.of[3];
            put_health(s, ARGUS_DISABLED, kinds[i], robot.argus.now_ms);
            c->score[ARGUS_TEST_STUCK] = (int16_t)(repeats ? 300 : 0);
            c->score[ARGUS_TEST_PEERS] = argus_bounds[ARGUS_TEST_PEERS].naming;
            c->against = 3;
            const int from = robot.events;
            argus_judge_all(&robot.argus);
            robot_drain(&robot);
            const bool renamed = kinds[i] == ARGUS_KIND_STUCK && !repeats;
            TEST_ASSERT_EQUAL(renamed ? ARGUS_KIND_WRONG : kinds[i], s->kind);
            TEST_ASSERT_EQUAL(ARGUS_DISABLED, s->health);
            TEST_ASSERT_EQUAL(renamed, robot_count_events(&robot, ARGUS_EV_SONAR_KIND, from));
        }
    }
}

// Into the look that is held for 3.
static void start_looking(void) {
    start_in_a_room();
    TEST_ASSERT_TRUE(robot_goal(&robot, 1500, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 40000));
    robot_run(&robot, 1000);
    ask_for_a_look(3);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_VERIFYING, 5000));
    for (int i = 0; i < 50 && !robot.argus.verifying.inquiry.active; i++) {
        robot_next_sip(&robot);
    }
    TEST_ASSERT_TRUE(robot.argus.verifying.inquiry.active);
}

void test_what_is_named_during_a_look_held_for_another_is_a_suspect_too(void) {
    static const int others[] = {0, 1, 5, 6, 12};
    for (int i = 0; i < 5; i++) {
        start_looking();
        named_in_time(others[i]);
        robot_run(&robot, 20000);
        finish(); // the watch: no step without a plan for all that are not relied on
    }
}

// What is only suspected is for the look to settle.
void test_what_is_not_named_during_a_look_is_no_suspect_yet(void) {
    start_looking();
    const int from = robot.events;
    score_dropout(6, -20);
    robot_next_sip(&robot);
    TEST_ASSERT_TRUE(argus_evidence_suspects(&robot.argus.evidence, 6));
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, health(6));
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_SONAR_NAMED, from));
    finish();
}

void test_what_is_pinned_is_not_made_a_suspect(void) {
    start_in_a_room();
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    robot_run(&robot, 2000);
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_PIN, 6);
    score_dropout(6, 60);
    robot_run(&robot, 300);
    TEST_ASSERT_EQUAL(ARGUS_HEALTHY, health(6));
    finish();
}

// ---- caution

static void start_with(int32_t caution) {
    argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    config.caution = caution;
    robot_init(&robot, &config, 0xFFFF8000u);
    robot.noise_mm = 5;
    furnish();
}

// How long it drives with a sonar that hangs, until that is disabled.
static uint32_t found_after_ms(int32_t caution) {
    start_with(caution);
    drive_until(never, 0, 12000);
    const uint32_t from = robot.t_ms;
    robot.fault[3] = ROBOT_STUCK;
    TEST_ASSERT_TRUE_MESSAGE(drive_until(is_disabled, 3, 240000), told("not found", (int)caution));
    TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, robot.argus.knowledge.sonar[3].kind);
    finish();
    return robot.t_ms - from;
}

void test_caution_is_how_much_evidence_a_verdict_takes(void) {
    const uint32_t bold = found_after_ms(50);
    const uint32_t usual = found_after_ms(100);
    const uint32_t wary = found_after_ms(400);
    TEST_ASSERT_TRUE(bold < usual);
    TEST_ASSERT_TRUE(usual < wary);
}

void test_caution_outlives_a_retest(void) {
    start_with(400);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    TEST_ASSERT_TRUE(argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_RETEST, 3));
    robot_run(&robot, 1000);
    TEST_ASSERT_EQUAL(400, robot.argus.evidence.caution);
}

// ---- old agreements

void test_whoever_is_disabled_begins_without_agreements(void) {
    for (int sonar = 0; sonar < SONARS; sonar++) {
        start_in_a_room();
        TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
        robot_run(&robot, 2000);
        robot.argus.evidence.of[sonar].agreed = 200;
        robot.fault[sonar] = ROBOT_SILENT;
        for (int i = 0; i < 600 && !is_disabled(sonar); i++) {
            robot_next_sip(&robot);
        }
        TEST_ASSERT_TRUE_MESSAGE(is_disabled(sonar), told("not found", sonar));
        TEST_ASSERT_EQUAL(0, robot.argus.evidence.of[sonar].agreed);
    }
}

static int count_restored(int sonar, int from) {
    int count = 0;
    for (int i = from; i < robot.events; i++) {
        const int id = robot.event[i].id;
        count +=
            robot.event[i].sonar == sonar && (id == ARGUS_EV_SONAR_PROBATION || id == ARGUS_EV_SONAR_HEALTHY);
    }
    return count;
}

// One that yields nothing does not come back for what others said of it before, nor of late.
static void stays_out(int sonar, bool again_and_again) {
    start_in_a_room();
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    robot_run(&robot, 2000);
    robot.argus.evidence.of[sonar].agreed = 200;
    robot.fault[sonar] = ROBOT_SILENT;
    TEST_ASSERT_TRUE_MESSAGE(drive_until(is_disabled, sonar, 60000), told("not found", sonar));
    const int from = robot.events;
    for (int i = 0; i < 20; i++) {
        if (again_and_again) {
            robot.argus.evidence.of[sonar].agreed = 200;
        }
        robot_run(&robot, 1000);
    }
    TEST_ASSERT_EQUAL_MESSAGE(0, count_restored(sonar, from), told("came back", sonar));
    TEST_ASSERT_EQUAL(ARGUS_KIND_SILENT, robot.argus.knowledge.sonar[sonar].kind);
    finish();
}

void test_a_silent_sonar_does_not_come_back_through_old_agreements(void) {
    for (int sonar = 0; sonar < SONARS; sonar++) {
        stays_out(sonar, false);
    }
}

void test_a_silent_sonar_does_not_come_back_whatever_agrees(void) {
    for (int sonar = 0; sonar < SONARS; sonar++) {
        stays_out(sonar, true);
    }
}

// The control: with the same agreements, but readings, it does.
void test_with_readings_the_same_agreements_bring_it_back(void) {
    start_in_a_room();
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    robot.fault[3] = ROBOT_SILENT;
    TEST_ASSERT_TRUE_MESSAGE(drive_until(is_disabled, 3, 60000), told("not found", 3));
    const int from = robot.events;
    robot.fault[3] = ROBOT_OK;
    robot_run(&robot, 10000);
    robot.argus.evidence.of[3].agreed = 200;
    robot_run(&robot, 1000);
    TEST_ASSERT_TRUE_MESSAGE(count_restored(3, from) > 0, told("stays out", 3));
    finish();
}

// A sonar that came back while nothing was commanded has its slot in every round again once the robot moves
// by itself (S5): the order of the old plan has it in one of thirteen.
void test_the_order_follows_a_plan_that_went_while_passive(void) {
    start_in_a_room();
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
    const int said = robot.commands;
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_DISABLE, 3);
    robot_run(&robot, 500);
    TEST_ASSERT_EQUAL_HEX16(1u << 3, robot.argus.plan.disabled);
    TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_POLLING, said) > 0);
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_PASSIVE, 0);
    robot_run(&robot, 500);
    put_health(&robot.argus.knowledge.sonar[3], ARGUS_HEALTHY, ARGUS_KIND_NONE, robot.argus.now_ms);
    argus_replan(&robot.argus); // as for every sonar that is restored
    robot_run(&robot, 3000);
    TEST_ASSERT_EQUAL_HEX16(0, robot.argus.plan.disabled);
    const int from = robot.commands;
    argus_operator(&robot.argus, robot.start_ms + robot.t_ms, ARGUS_OP_ACTIVE, 0);
    robot_run(&robot, 500);
    TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_POLLING, from) > 0);
    int slots = 0;
    for (int k = 0; k < robot.order_count[0]; k++) {
        slots += robot.order[0][k] == 3;
    }
    TEST_ASSERT_TRUE(8 * slots >= robot.order_count[0]);
    finish();
}
