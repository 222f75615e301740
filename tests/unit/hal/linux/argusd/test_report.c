// SPDX-License-Identifier: MIT
// Attacks: every event gives a JSON line with the seven promised keys in order, and a plain line; the worst
// status fits.
#include <stdio.h>
#include <string.h>

#include "report.h"
#include "unity.h"

static char line[REPORT_LINE_MAX];

void test_names_follow_the_ros_form(void) {
    char name[32];
    argus_event_t event = {.id = ARGUS_EV_SONAR_DEAD, .sonar = 3};
    report_name(&event, name, sizeof name);
    TEST_ASSERT_EQUAL_STRING("sonar/front/03", name);
    event.sonar = 11;
    report_name(&event, name, sizeof name);
    TEST_ASSERT_EQUAL_STRING("sonar/rear/11", name);
    event.sonar = ARGUS_NO_SONAR;
    report_name(&event, name, sizeof name);
    TEST_ASSERT_EQUAL_STRING("sonar", name);
    event.sonar = 99;
    report_name(&event, name, sizeof name);
    TEST_ASSERT_EQUAL_STRING("sonar", name);
}

void test_an_event_to_the_letter(void) {
    const argus_event_t event = {
        .id = ARGUS_EV_SONAR_DEAD, .sonar = 3, .state = ARGUS_IS_MINOR, .value = 5000};
    TEST_ASSERT_GREATER_THAN_size_t(0, report_event_json(&event, 12345, line, sizeof line));
    TEST_ASSERT_EQUAL_STRING(
        "{\"t\":12.345,\"event\":\"SONAR_DEAD\",\"id\":30,\"level\":2,\"name\":\"sonar/front/03\","
        "\"value\":5000,\"state\":\"IsMinor\"}",
        line);
    TEST_ASSERT_GREATER_THAN_size_t(0, report_event_plain(&event, 12345, false, line, sizeof line));
    TEST_ASSERT_EQUAL_STRING("   12.345 ERROR sonar/front/03 SONAR_DEAD 5000 mm: dead reading: STOP sent",
                             line);
}

void test_the_kind_of_a_fault_is_named(void) {
    const argus_event_t event = {.id = ARGUS_EV_SONAR_DISABLED, .sonar = 6, .value = ARGUS_KIND_WRONG};
    report_event_plain(&event, 0, false, line, sizeof line);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(line, "SONAR_DISABLED (wrong): not used any more"), line);
}

void test_colour_only_when_asked_for(void) {
    const argus_event_t event = {.id = ARGUS_EV_SONAR_DEAD, .sonar = 3};
    report_event_plain(&event, 0, true, line, sizeof line);
    TEST_ASSERT_NOT_NULL(strchr(line, '\033'));
    report_event_plain(&event, 0, false, line, sizeof line);
    TEST_ASSERT_NULL(strchr(line, '\033'));
}

void test_every_event_of_the_catalogue(void) {
    static const uint16_t ids[] = {
#define ID(id, name, level, subject, meaning) id,
        ARGUS_EVENT_TABLE(ID)
#undef ID
    };
    for (size_t i = 0; i < sizeof ids / sizeof ids[0]; i++) {
        const argus_event_t event = {.id = ids[i], .sonar = ARGUS_NO_SONAR, .value = -7};
        char expected[64];
        TEST_ASSERT_GREATER_THAN_size_t(0, report_event_json(&event, 0, line, sizeof line));
        snprintf(expected, sizeof expected, "\"event\":\"%s\",\"id\":%u,",
                 argus_name(ARGUS_NAME_EVENT, ids[i]), (unsigned)ids[i]);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(line, expected), line);
        TEST_ASSERT_GREATER_THAN_size_t(0, report_event_plain(&event, 0, false, line, sizeof line));
        TEST_ASSERT_NULL(strstr(line, "value:"));
    }
}

static void worst(view_t *view) {
    memset(view, 0, sizeof *view);
    view->t_ms = UINT64_MAX / 4;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        view->status.reading_mm[i] = INT16_MIN;
        view->status.age_ms[i] = UINT32_MAX - 1;
        view->status.health[i] = ARGUS_PROBATION;
        view->status.kind[i] = ARGUS_KIND_INTERMITTENT;
    }
    view->status.online = true;
    view->status.waypoints = UINT16_MAX;
    view->status.pose = (argus_pose_t){INT32_MIN, INT32_MIN, INT32_MIN};
    view->status.goal_mm = INT32_MIN;
    view->status.battery_dv = UINT16_MAX;
    view->status.plan.count = 200;
    view->status.sips = view->status.bad_checksums = view->status.skipped_bytes = UINT32_MAX;
    view->counters = (hal_link_counters_t){UINT32_MAX, UINT32_MAX, UINT32_MAX, UINT32_MAX};
    view->has_can = true;
    memset(view->can_errors, 0xFF, sizeof view->can_errors);
    view->can_sent = view->can_taken = view->can_refused = UINT32_MAX;
    memset(view->name, '\x01', sizeof view->name - 1);
    memset(view->subclass, '"', sizeof view->subclass - 1);
    memset(view->link, '\xff', sizeof view->link - 1);
}

void test_the_worst_status_fits(void) {
    static view_t view;
    worst(&view);
    const size_t length = report_status_json(&view, INT64_MIN, line, sizeof line);
    TEST_ASSERT_GREATER_THAN_size_t(0, length);
    TEST_ASSERT_EQUAL_size_t(length, strlen(line));
    TEST_ASSERT_TRUE(line[0] == '{' && line[length - 1] == '}');
    TEST_ASSERT_EQUAL_STRING_LEN("{\"t\":", line, 5);
    TEST_ASSERT_GREATER_THAN_size_t(0, report_status_plain(&view, line, sizeof line));
}

void test_can_is_told_where_there_is_one(void) {
    static view_t view;
    report_status_json(&view, 0, line, sizeof line);
    TEST_ASSERT_NULL(strstr(line, "\"can\""));
    view.has_can = true;
    view.can_errors[HAL_ISOTP_SEQUENCE] = 7;
    view.can_taken = 3;
    report_status_json(&view, 0, line, sizeof line);
    TEST_ASSERT_NOT_NULL_MESSAGE(
        strstr(
            line,
            "\"can\":{\"no_flow\":0,\"overflow\":0,\"timeout\":0,\"sequence\":7,\"bad_frame\":0,"
            "\"too_long\":0,\"no_buffers\":0,\"format\":0,\"down\":0,\"sent\":0,\"taken\":3,\"refused\":0}"),
        line);
}

static void shown_as(int id, int32_t value, const char *part) {
    const argus_event_t event = {.id = (uint8_t)id, .value = value, .sonar = ARGUS_NO_SONAR};
    TEST_ASSERT_GREATER_THAN_size_t(0, report_event_plain(&event, 0, false, line, sizeof line));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(line, part), line);
}

void test_a_value_has_its_unit_or_its_name(void) {
    shown_as(ARGUS_EV_STOPPED, -9298, " STOPPED -92.98 deg: ");
    shown_as(ARGUS_EV_STOPPED, -98, " STOPPED -0.98 deg: ");
    shown_as(ARGUS_EV_SONAR_SILENT, INT32_MAX, " SONAR_SILENT (never): ");
    shown_as(ARGUS_EV_SONAR_SILENT, 812, " SONAR_SILENT 812 ms: ");
    shown_as(ARGUS_EV_BATTERY_LOW, 113, " BATTERY_LOW 11.3 V: ");
    shown_as(ARGUS_EV_SPEED_EXCEEDED, 400, " SPEED_EXCEEDED 400 mm/s: ");
    shown_as(ARGUS_EV_GOAL_REACHED, 31, " GOAL_REACHED 31 mm: ");
    shown_as(ARGUS_EV_SONAR_NAMED, ARGUS_KIND_STUCK, " SONAR_NAMED (stuck): ");
    shown_as(ARGUS_EV_PLAN, 2, " PLAN 2: ");
    shown_as(ARGUS_EV_ACTIVE, 0, " ACTIVE: ");
}

void test_a_line_that_does_not_fit_is_none(void) {
    static view_t view;
    char small[64];
    const argus_event_t event = {.id = ARGUS_EV_SONAR_DEAD, .sonar = 3};
    TEST_ASSERT_EQUAL_size_t(0, report_status_json(&view, 0, small, sizeof small));
    TEST_ASSERT_EQUAL_size_t(0, report_event_json(&event, 0, small, sizeof small));
}

void test_the_list_has_every_event(void) {
    static char text[32768];
    FILE *const file = tmpfile();
    report_list_events(file);
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
#define LISTED(id, name, level, subject, meaning) TEST_ASSERT_NOT_NULL(strstr(text, " " #name " "));
    ARGUS_EVENT_TABLE(LISTED)
#undef LISTED
}
