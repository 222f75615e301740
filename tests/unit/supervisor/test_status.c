// SPDX-License-Identifier: MIT
// Rule under attack: each invariant of the state is checked on its own and reported once by its number; what
// is told of a sonar that is out is its verdict.
#include "supervisor/manager.h"

#include <string.h>

#include "health.h"
#include "robot.h"
#include "unity.h"

enum { QUEUES = 1, TASK, PLAN, DRIVING, HEALTH };

static robot_t robot;
static argus_t broken;

static void start(int32_t profile) {
    const argus_config_t config = robot_config_of(profile);
    robot_init(&robot, &config, 1234);
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
}

void setUp(void) {
    start(ARGUS_PROFILE_PAPER);
}

static argus_t *sound(void) {
    broken = robot.argus;
    TEST_ASSERT_EQUAL(0, argus_invariants_broken(&broken));
    return &broken;
}

static void is_broken(int number) {
    TEST_ASSERT_EQUAL(number, argus_invariants_broken(&broken));
}

void test_a_queue_beyond_its_end_is_found(void) {
    sound()->events.count = ARGUS_EVENT_QUEUE + 1;
    is_broken(QUEUES);
    sound()->events.head = ARGUS_EVENT_QUEUE;
    is_broken(QUEUES);
    sound()->session.outbox.length = ARGUS_OUTBOX_BYTES + 1;
    is_broken(QUEUES);
    sound()->session.parser.length = ARGUS_FRAME_TOTAL_MAX + 1;
    is_broken(QUEUES);
    sound()->events.count = ARGUS_EVENT_QUEUE; // full is no breach
    is_broken(0);
}

void test_a_course_or_echoes_beyond_their_end_are_found(void) {
    sound()->travel.task.count = ARGUS_WAYPOINTS_MAX + 1;
    is_broken(TASK);
    argus_t *const past = sound();
    past->travel.task.next = (uint8_t)(past->travel.task.count + 1);
    is_broken(TASK);
    sound()->echoes.count = ARGUS_POINTS_MAX + 1;
    is_broken(TASK);
    sound()->echoes.next = ARGUS_POINTS_MAX;
    is_broken(TASK);
}

void test_a_plan_for_what_does_not_look_ahead_is_found(void) {
    sound()->plan.count = ARGUS_ROTATIONS_MAX + 1;
    is_broken(PLAN);
    sound()->plan.disabled = 1u << 15;
    is_broken(PLAN);
}

static argus_t *in(argus_mode_t mode) {
    argus_t *const argus = sound();
    argus->mode = mode;
    argus->orders.passive = false;
    return argus;
}

// S6: whatever moves ahead, after a full check only, and never where it only watches.
void test_moving_unchecked_or_passive_is_found(void) {
    const argus_mode_t moving[] = {ARGUS_MODE_DRIVING, ARGUS_MODE_STEPPING, ARGUS_MODE_CREEPING};
    for (unsigned i = 0; i < sizeof moving / sizeof moving[0]; i++) {
        in(moving[i])->config.creep_mm_s = 50;
        broken.plan.complete = true;
        broken.checked = false;
        is_broken(DRIVING);
        broken.checked = true;
        broken.orders.passive = true;
        is_broken(DRIVING);
    }
    in(ARGUS_MODE_DRIVING);
    is_broken(0);
}

void test_creeping_where_it_is_not_allowed_is_found(void) {
    in(ARGUS_MODE_CREEPING)->config.creep_mm_s = 50;
    is_broken(0);
    broken.config.creep_mm_s = 0;
    is_broken(DRIVING);
}

// S1: normal driving only while no bearing is blind; a step only by a plan.
void test_driving_blind_or_stepping_without_a_plan_is_found(void) {
    const argus_mode_t moving[] = {ARGUS_MODE_DRIVING, ARGUS_MODE_STEPPING};
    for (unsigned i = 0; i < sizeof moving / sizeof moving[0]; i++) {
        in(moving[i])->plan.disabled = 1u << 3;
        broken.plan.complete = false;
        is_broken(DRIVING);
    }
    in(ARGUS_MODE_STEPPING)->plan.disabled = 1u << 3;
    broken.plan.complete = true;
    is_broken(0);
}

static void is_found(int sonar, argus_health_t health, argus_fault_kind_t kind) {
    sound()->knowledge.sonar[sonar].health = health;
    broken.knowledge.sonar[sonar].kind = kind;
    is_broken(HEALTH);
}

void test_a_sonar_in_no_possible_state_is_found(void) {
    is_found(3, ARGUS_HEALTHY, ARGUS_KIND_OFF); // a kind of one that is whole
    is_found(3, ARGUS_UNKNOWN, ARGUS_KIND_OFF);
    is_found(3, ARGUS_STALE, ARGUS_KIND_OFF);
    is_found(3, ARGUS_DISABLED, ARGUS_KIND_NONE); // given up without one
    is_found(3, (argus_health_t)(ARGUS_ABSENT + 1), ARGUS_KIND_NONE);
    if (ARGUS_SONARS > 16) {
        is_found(ARGUS_SONARS - 1, ARGUS_HEALTHY, ARGUS_KIND_NONE); // of a robot that has not got it
    }
    const argus_health_t named[] = {ARGUS_SUSPECT, ARGUS_PROBATION};
    for (unsigned i = 0; i < sizeof named / sizeof named[0]; i++) {
        sound()->knowledge.sonar[3].health = named[i];
        broken.knowledge.sonar[3].kind = ARGUS_KIND_WRONG;
        broken.events.state = argus_failure_of(broken.knowledge.robot, argus_out(&broken.knowledge));
        is_broken(0);
    }
}

void test_a_state_that_does_not_follow_from_the_sonars_is_found(void) {
    sound()->events.state = ARGUS_IS_CATASTROPHIC;
    is_broken(HEALTH);
}

void test_a_breach_is_reported_once(void) {
    argus_event_t event;
    int reported = 0;
    robot.argus.plan.disabled = 1u << 15;
    for (uint32_t ms = 10; ms <= 50; ms += 10) {
        argus_process(&robot.argus, robot.argus.now_ms + 10);
        while (argus_next_event(&robot.argus, &event)) {
            reported += event.id == ARGUS_EV_INVARIANT && event.value == PLAN;
        }
        robot.argus.plan.disabled |= 1u << 15;
    }
    TEST_ASSERT_EQUAL(1, reported);
}

// A queue that nobody reads: what is lost is counted, and reported when there is room again.
void test_lost_events_are_reported_with_their_number(void) {
    argus_event_t event;
    while (argus_next_event(&robot.argus, &event)) {
    }
    const int lost = 5;
    for (int i = 0; i < ARGUS_EVENT_QUEUE + lost; i++) {
        argus_emit(&robot.argus.events, ARGUS_EV_LINK_UP, 0);
    }
    int told = 0, others = 0;
    while (argus_next_event(&robot.argus, &event)) {
        told += event.id == ARGUS_EV_EVENTS_LOST ? (int)event.value : 0;
        others += event.id != ARGUS_EV_EVENTS_LOST;
    }
    TEST_ASSERT_EQUAL(lost, told);
    TEST_ASSERT_EQUAL(ARGUS_EVENT_QUEUE, others);
}

void test_a_sonar_that_is_out_is_faulty_beyond_doubt(void) {
    argus_suspicions_t suspicions;
    start(ARGUS_PROFILE_ARGUS);
    put_health(&robot.argus.knowledge.sonar[3], ARGUS_DISABLED, ARGUS_KIND_STUCK, robot.argus.now_ms);
    put_health(&robot.argus.knowledge.sonar[4], ARGUS_SUSPECT, ARGUS_KIND_STUCK, robot.argus.now_ms);
    argus_suspicions(&robot.argus, &suspicions);
    TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, suspicions.kind[3]);
    TEST_ASSERT_EQUAL(100, suspicions.percent[3]);
    TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, suspicions.kind[4]);
    TEST_ASSERT_LESS_THAN(100, suspicions.percent[4]);
}

// Full is no breach, of any of them.
void test_what_is_full_or_at_its_end_is_sound(void) {
    sound()->session.outbox.length = ARGUS_OUTBOX_BYTES;
    is_broken(0);
    sound()->session.parser.length = ARGUS_FRAME_TOTAL_MAX;
    is_broken(0);
    sound()->events.head = ARGUS_EVENT_QUEUE - 1;
    is_broken(0);
    argus_t *const course = sound();
    course->travel.task.count = ARGUS_WAYPOINTS_MAX;
    course->travel.task.next = ARGUS_WAYPOINTS_MAX;
    is_broken(0);
    sound()->echoes.count = ARGUS_POINTS_MAX;
    is_broken(0);
    sound()->echoes.next = ARGUS_POINTS_MAX - 1;
    is_broken(0);
    sound()->plan.count = ARGUS_ROTATIONS_MAX;
    is_broken(0);
}
