// SPDX-License-Identifier: MIT
// Attacks: what argusd writes about its state and events is read back as it was, by name and number, and
// lines of any other form change nothing.
#include "attach_state.h"

#include <string.h>

#include "report.h"
#include "unity.h"

static json_doc_t doc;
static char line[16384];
static view_t there;
static view_t here;

void setUp(void) {
    memset(&there, 0, sizeof there);
    memset(&here, 0, sizeof here);
    here.sonar = 7;
    there.t_ms = 12345;
    argus_status_t *const s = &there.status;
    s->mode = ARGUS_MODE_SWEEPING;
    s->mission = ARGUS_MISSION_RUNNING;
    s->failure = ARGUS_IS_MAJOR;
    s->active = s->online = s->motors = true;
    s->pose = (argus_pose_t){-1234, 567, -17999};
    s->goal_mm = 2222;
    s->waypoint = 1;
    s->waypoints = 3;
    s->battery_dv = 127;
    s->vel_left_mm_s = -50;
    s->bumpers_front = 4;
    s->sonars = 16;
    s->pinned = 1u << 3 | 1u << 15;
    s->plan = (argus_plan_t){.disabled = 8, .count = 2, .rotation_deg = {20, -20}, .complete = true};
    s->sips = 4000000000u;
    s->robot_name = s->robot_class = s->robot_subclass = "";
    for (int i = 0; i < ARGUS_SONARS; i++) {
        s->reading_mm[i] = (uint16_t)(1000 + i);
        s->age_ms[i] = i == 5 ? UINT32_MAX : (uint32_t)i;
        s->bearing_deg[i] = (int16_t)(90 - 20 * i);
        s->health[i] = (argus_health_t)(i % 7);
        s->kind[i] = (argus_fault_kind_t)(i % 8);
        there.injected[i] = (uint8_t)(i == 3 ? ARGUS_KIND_STUCK : 0);
    }
    strcpy(there.link, "serial:/dev/ttyUSB0@9600");
    strcpy(there.name, "P3DX \"1\"");
    there.link_up = true;
    there.course_mm = 3000;
    there.controlled = true;
}

static void read_line(size_t length) {
    TEST_ASSERT_TRUE(length > 0);
    TEST_ASSERT_TRUE(json_read(&doc, line, length));
}

// As many as the robot has, 16 at least; those beyond are absent.
static void assert_listed(const argus_status_t *a, const argus_status_t *b) {
    const size_t listed = (size_t)report_sonars(a);
    TEST_ASSERT_EQUAL_size_t(a->sonars < ARGUS_SONARS ? a->sonars : ARGUS_SONARS, listed);
    TEST_ASSERT_EQUAL_MEMORY(a->reading_mm, b->reading_mm, listed * sizeof a->reading_mm[0]);
    TEST_ASSERT_EQUAL_MEMORY(a->age_ms, b->age_ms, listed * sizeof a->age_ms[0]);
    TEST_ASSERT_EQUAL_MEMORY(a->bearing_deg, b->bearing_deg, listed * sizeof a->bearing_deg[0]);
    TEST_ASSERT_EQUAL_MEMORY(a->health, b->health, listed * sizeof a->health[0]);
    TEST_ASSERT_EQUAL_MEMORY(a->kind, b->kind, listed * sizeof a->kind[0]);
    TEST_ASSERT_EQUAL_MEMORY(there.injected, here.injected, listed * sizeof here.injected[0]);
    for (size_t i = listed; i < ARGUS_SONARS; i++) {
        TEST_ASSERT_EQUAL(ARGUS_ABSENT, b->health[i]);
        TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, b->age_ms[i]);
    }
}

static void assert_it_comes_back(void) {
    read_line(report_status_json(&there, 0, line, sizeof line));
    TEST_ASSERT_TRUE(attach_read_state(&doc, &here));
    const argus_status_t *const a = &there.status;
    const argus_status_t *const b = &here.status;
    TEST_ASSERT_EQUAL_UINT64(there.t_ms, here.t_ms);
    TEST_ASSERT_EQUAL_INT(a->mode, b->mode);
    TEST_ASSERT_EQUAL_INT(a->mission, b->mission);
    TEST_ASSERT_EQUAL_INT(a->failure, b->failure);
    TEST_ASSERT_TRUE(b->active && b->online && b->motors && !b->paused);
    TEST_ASSERT_EQUAL_MEMORY(&a->pose, &b->pose, sizeof a->pose);
    TEST_ASSERT_EQUAL_INT(2222, b->goal_mm);
    TEST_ASSERT_EQUAL_INT(-50, b->vel_left_mm_s);
    TEST_ASSERT_EQUAL_HEX(a->pinned, b->pinned);
    TEST_ASSERT_EQUAL_UINT32(a->sips, b->sips);
    TEST_ASSERT_EQUAL_INT(2, b->plan.count);
    TEST_ASSERT_EQUAL_INT(-20, b->plan.rotation_deg[1]);
    TEST_ASSERT_TRUE(b->plan.complete && b->plan.disabled != 0);
    assert_listed(a, b);
    TEST_ASSERT_EQUAL_STRING(there.link, here.link);
    TEST_ASSERT_EQUAL_STRING(there.name, here.name);
    TEST_ASSERT_TRUE(here.link_up && here.controlled);
    TEST_ASSERT_EQUAL_INT(7, here.sonar); // the screen's own
}

void test_a_state_comes_back_as_it_was(void) {
    assert_it_comes_back();
}

void test_that_of_a_robot_with_more_sonars_does_too(void) {
    there.status.sonars = 32;
    assert_it_comes_back();
}

void test_an_event_comes_back_as_it_was(void) {
    static const argus_event_t events[] = {
        {.id = ARGUS_EV_SONAR_DISABLED, .sonar = 3, .state = ARGUS_IS_MINOR, .value = ARGUS_KIND_OFF},
        {.id = ARGUS_EV_SONAR_STALE, .sonar = 11, .state = ARGUS_IS_NORMAL, .value = 1500},
        {.id = ARGUS_EV_PLAN_ROTATION, .sonar = ARGUS_NO_SONAR, .state = ARGUS_IS_CATASTROPHIC, .value = -20},
        {.id = ARGUS_EV_INJECTED, .sonar = 0, .value = 7},
    };
    for (size_t i = 0; i < sizeof events / sizeof events[0]; i++) {
        argus_event_t event;
        uint64_t t_ms = 0;
        read_line(report_event_json(&events[i], 4294967296123u, line, sizeof line));
        TEST_ASSERT_TRUE(attach_read_event(&doc, &event, &t_ms));
        TEST_ASSERT_EQUAL_UINT64(4294967296123u, t_ms);
        TEST_ASSERT_EQUAL_INT(events[i].id, event.id);
        TEST_ASSERT_EQUAL_INT(events[i].sonar, event.sonar);
        TEST_ASSERT_EQUAL_INT(events[i].state, event.state);
        TEST_ASSERT_EQUAL_INT(events[i].value, event.value);
        TEST_ASSERT_FALSE(attach_read_state(&doc, &here));
    }
}

void test_what_is_strange_is_no_state_and_breaks_nothing(void) {
    static const char *const strange[] = {"{}", "{\"id\":91.5}", "{\"id\":\"91\"}",
                                          "{\"id\":-1,\"event\":\"X\"}", "{\"id\":70000,\"event\":\"X\"}"};
    argus_event_t event;
    uint64_t t_ms = 0;
    for (size_t i = 0; i < sizeof strange / sizeof strange[0]; i++) {
        TEST_ASSERT_TRUE(json_read(&doc, strange[i], strlen(strange[i])));
        TEST_ASSERT_FALSE(attach_read_state(&doc, &here));
        TEST_ASSERT_FALSE(attach_read_event(&doc, &event, &t_ms));
    }
    static const char wild[] =
        "{\"id\":91,\"t\":\"x\",\"mode\":\"FLYING\",\"sonars\":99,\"pinned\":[-1,99,3,\"x\"],"
        "\"plan_deg\":[1,2,3,4,5,6,7,8],\"reading_mm\":[[1],{},null,1e9],\"health\":7,"
        "\"link\":5,\"age_ms\":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]}";
    TEST_ASSERT_TRUE(json_read(&doc, wild, sizeof wild - 1));
    TEST_ASSERT_TRUE(attach_read_state(&doc, &here));
    TEST_ASSERT_EQUAL_INT(ARGUS_SONARS, here.status.sonars);
    TEST_ASSERT_EQUAL_HEX(1u << 3, here.status.pinned);
    TEST_ASSERT_EQUAL_INT(ARGUS_ROTATIONS_MAX, here.status.plan.count);
}
