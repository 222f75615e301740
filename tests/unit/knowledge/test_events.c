// SPDX-License-Identifier: MIT
// Rule under attack: events come out in order, an overflow drops the newest and is counted, the catalogue has
// no twins.
#include "knowledge/events.h"

#include <ctype.h>
#include <stddef.h>
#include <string.h>

#include "unity.h"

static argus_events_t events;

static argus_event_t event_of(int32_t value) {
    const argus_event_t event = {.t_ms = 7, .id = ARGUS_EV_STEP, .sonar = ARGUS_NO_SONAR, .value = value};
    return event;
}

void test_first_in_first_out_round_the_ring(void) {
    argus_event_t out;
    int32_t next_in = 0;
    int32_t next_out = 0;
    memset(&events, 0, sizeof events);
    for (int round = 0; round < 50; round++) {
        for (int i = 0; i < 1 + round % 60; i++) {
            argus_events_push(&events, event_of(next_in++));
        }
        while (argus_events_pop(&events, &out)) {
            TEST_ASSERT_EQUAL(next_out++, out.value);
            TEST_ASSERT_EQUAL(ARGUS_EV_STEP, out.id);
            TEST_ASSERT_EQUAL(ARGUS_NO_SONAR, out.sonar);
        }
        TEST_ASSERT_EQUAL(next_in, next_out);
    }
    TEST_ASSERT_EQUAL(0, events.lost);
}

void test_an_overflow_drops_the_newest_and_counts(void) {
    argus_event_t out;
    memset(&events, 0xA5, sizeof events);
    memset(&events, 0, sizeof events);
    for (int32_t i = 0; i < ARGUS_EVENT_QUEUE + 9; i++) {
        argus_events_push(&events, event_of(i));
    }
    TEST_ASSERT_EQUAL(9, events.lost);
    for (int32_t i = 0; i < ARGUS_EVENT_QUEUE; i++) {
        TEST_ASSERT_TRUE(argus_events_pop(&events, &out));
        TEST_ASSERT_EQUAL(i, out.value);
    }
    TEST_ASSERT_FALSE(argus_events_pop(&events, &out));
    argus_events_push(&events, event_of(5));
    TEST_ASSERT_TRUE(argus_events_pop(&events, &out));
    TEST_ASSERT_EQUAL(5, out.value);
}

#define ROW(id, NAME, level, subject, meaning) {id, #NAME, ARGUS_LEVEL_##level, #subject, meaning},
static const struct {
    unsigned id;
    const char *name;
    argus_level_t level;
    const char *subject;
    const char *meaning;
} catalogue[] = {ARGUS_EVENT_TABLE(ROW)};
#define ROWS (sizeof catalogue / sizeof catalogue[0])

void test_the_catalogue_is_found_row_by_row(void) {
    for (size_t i = 0; i < ROWS; i++) {
        const uint16_t id = (uint16_t)catalogue[i].id;
        TEST_ASSERT_EQUAL_STRING(catalogue[i].name, argus_name(ARGUS_NAME_EVENT, id));
        TEST_ASSERT_EQUAL_STRING(catalogue[i].subject, argus_name(ARGUS_NAME_SUBJECT, id));
        TEST_ASSERT_EQUAL(catalogue[i].level, argus_event_level(id));
    }
    TEST_ASSERT_EQUAL_STRING("BUMPER", argus_name(ARGUS_NAME_EVENT, 22));
    TEST_ASSERT_EQUAL(ARGUS_LEVEL_ERROR, argus_event_level(22));
}

void test_ids_and_names_are_unique_and_said_in_words(void) {
    for (size_t i = 0; i < ROWS; i++) {
        for (size_t j = 0; j < i; j++) {
            TEST_ASSERT_NOT_EQUAL_MESSAGE(catalogue[i].id, catalogue[j].id, catalogue[i].name);
            TEST_ASSERT_NOT_EQUAL_MESSAGE(0, strcmp(catalogue[i].name, catalogue[j].name), catalogue[i].name);
        }
        TEST_ASSERT_GREATER_THAN_MESSAGE(3, strlen(catalogue[i].meaning), catalogue[i].name);
        for (const char *c = catalogue[i].name; *c != '\0'; c++) {
            TEST_ASSERT_TRUE_MESSAGE(isupper((unsigned char)*c) || *c == '_', catalogue[i].name);
        }
    }
}

void test_an_unknown_id_is_an_error_without_a_name(void) {
    for (unsigned id = 0; id <= UINT16_MAX; id++) {
        bool known = false;
        for (size_t i = 0; i < ROWS; i++) {
            known = known || catalogue[i].id == id;
        }
        if (!known) {
            TEST_ASSERT_EQUAL_STRING("?", argus_name(ARGUS_NAME_EVENT, (uint16_t)id));
            TEST_ASSERT_EQUAL(ARGUS_LEVEL_ERROR, argus_event_level((uint16_t)id));
        }
    }
}

void test_an_event_bears_the_time_and_the_state_and_none_is_none(void) {
    argus_event_t out;
    memset(&events, 0, sizeof events);
    events.now_ms = 4711;
    argus_emit_of(&events, ARGUS_EV_STEP, 5, -3);
    argus_emit_event(&events, (argus_event_t){.id = 0});
    TEST_ASSERT_TRUE(argus_events_pop(&events, &out));
    TEST_ASSERT_EQUAL_UINT32(4711, out.t_ms);
    TEST_ASSERT_EQUAL(5, out.sonar);
    TEST_ASSERT_EQUAL(-3, out.value);
    TEST_ASSERT_FALSE(argus_events_pop(&events, &out));
}
