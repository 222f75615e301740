// SPDX-License-Identifier: MIT
// Rule under attack: an order that is late by more than 150 ms beyond what is expected makes a stand, at that
// millisecond and not before; what was said already is not said twice.
#include "knowledge/latency.h"

#include <string.h>

#include "unity.h"

#define BEGIN_MS (UINT32_MAX - 500) // the clock wraps
#define USUAL_MS 200                // two cycles; no wire

static argus_latency_t late;
static argus_config_t config;
static argus_events_t events;

void setUp(void) {
    argus_config_default(&config);
    config.baud = 0;
    memset(&events, 0, sizeof events);
    argus_latency_open(&late, true);
    late.trip.begun = true;
    late.trip.shows = true;
    late.trip.seen_ms = BEGIN_MS;
    events.now_ms = BEGIN_MS;
}

static argus_lateness_t after(uint32_t ms) {
    events.now_ms = BEGIN_MS + ms;
    return argus_latency_process(&late, &config, &events);
}

// A SIP so long after the order whose effect it shows.
static argus_lateness_t sip(uint32_t trip_ms) {
    events.now_ms += 100;
    late.trip.seen_ms = events.now_ms - trip_ms;
    return argus_latency_sip(&late, &config, &events);
}

static int said(argus_event_id_t id) {
    int count = 0;
    argus_event_t event;
    while (argus_events_pop(&events, &event)) {
        count += event.id == id ? 1 : 0;
    }
    return count;
}

void test_a_stand_begins_at_151_ms_beyond(void) {
    TEST_ASSERT_EQUAL(ARGUS_LATE_AS_BEFORE, after(USUAL_MS + 150));
    TEST_ASSERT_TRUE(argus_latency_is_prompt(&late));
    TEST_ASSERT_EQUAL(ARGUS_LATE_STANDS, after(USUAL_MS + 151));
    TEST_ASSERT_FALSE(argus_latency_is_prompt(&late));
    TEST_ASSERT_EQUAL(ARGUS_LATE_AS_BEFORE, after(USUAL_MS + 152)); // it stands
    TEST_ASSERT_EQUAL(1, said(ARGUS_EV_LINK_SLOW));
}

void test_a_link_of_which_nothing_is_known_is_not_late(void) {
    late.trip.shows = false;
    late.trip.answers = false;
    TEST_ASSERT_EQUAL(ARGUS_LATE_AS_BEFORE, after(100000));
    TEST_ASSERT_TRUE(argus_latency_is_prompt(&late));
}

void test_a_level_is_said_once(void) {
    for (int i = 0; i < 20; i++) {
        sip(USUAL_MS + 10);
    }
    TEST_ASSERT_EQUAL(1, said(ARGUS_EV_LINK_SLOW));
    TEST_ASSERT_EQUAL_INT32(110, late.late_ms);
}

// From a stand it goes on slower, which is no news, and is prompt when half a minute of SIPs was.
void test_after_a_stand_slower_is_not_said_and_prompt_is(void) {
    for (int i = 0; i < 3; i++) {
        sip(USUAL_MS + 300);
    }
    TEST_ASSERT_TRUE(late.stands);
    TEST_ASSERT_EQUAL(1, said(ARGUS_EV_LINK_SLOW));
    argus_lateness_t news = ARGUS_LATE_AS_BEFORE;
    for (int i = 0; i < 6 && news != ARGUS_LATE_GOES_ON; i++) {
        news = sip(USUAL_MS);
    }
    TEST_ASSERT_EQUAL(ARGUS_LATE_GOES_ON, news);
    TEST_ASSERT_EQUAL(0, said(ARGUS_EV_LINK_SLOW));
    for (int i = 0; i < 61; i++) {
        sip(USUAL_MS);
    }
    TEST_ASSERT_EQUAL(1, said(ARGUS_EV_LINK_PROMPT));
    TEST_ASSERT_EQUAL_INT32(0, argus_latency_oldest_ms(&late));
}
