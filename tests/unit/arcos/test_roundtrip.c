// SPDX-License-Identifier: MIT
// Rule: the age is never less than that of the newest order which has arrived, whatever the robot shows.
#include "arcos/roundtrip.h"

#include <string.h>

#include "unity.h"

static argus_roundtrip_t trip;
static argus_session_t session;
static argus_config_t config;

void setUp(void) {
    argus_config_default(&config);
    config.baud = 0;
    argus_session_init(&session);
    memset(&session.sip, 0, sizeof session.sip);
    session.sip.has_anport = true;
    argus_roundtrip_begin(&trip, false);
}

// The number of the order that it sends with this SIP; -1: none.
static int sip(const uint32_t now_ms, const uint8_t shows) {
    uint8_t packet[ARGUS_PACKET_MAX];
    int number = -1;
    session.sip.anport = shows;
    argus_roundtrip_sip(&trip, &session, &config, now_ms);
    while (argus_outbox_fetch(&session.outbox, packet, sizeof packet) > 0) {
        number = packet[3] == ARCOS_CMD_ADSEL ? packet[5] : number;
    }
    return number;
}

void test_each_order_shows_in_the_next_sip(void) {
    uint8_t shows = 5; // of a session before
    for (uint32_t now_ms = 1000; now_ms < 60000; now_ms += 100) {
        const int sent = sip(now_ms, shows);
        TEST_ASSERT_EQUAL((shows + 1) % 8, sent);
        TEST_ASSERT_EQUAL(now_ms > 1000 ? 100 : 0, argus_roundtrip_ms(&trip, now_ms));
        shows = (uint8_t)sent;
    }
    TEST_ASSERT_EQUAL(200, argus_roundtrip_usual_ms(&trip, &config));
}

// Of each delay in whole cycles: the age is the delay, to a cycle, also where the numbers come round.
void test_the_age_is_that_of_the_delay(void) {
    for (int late = 1; late <= 30; late++) {
        uint8_t sent[600] = {0};
        setUp();
        uint8_t shows = 0;
        for (int k = 0; k < 600; k++) {
            const uint32_t now_ms = 5000 + 100u * (uint32_t)k;
            shows = k >= late && sent[k - late] != 0xFF ? sent[k - late] : shows;
            const int number = sip(now_ms, shows);
            sent[k] = (uint8_t)(number < 0 ? 0xFF : number);
            if (k > 2 * late + 60) {
                TEST_ASSERT_TRUE_MESSAGE(argus_roundtrip_ms(&trip, now_ms) >= 100 * late, "too young");
                TEST_ASSERT_TRUE_MESSAGE(argus_roundtrip_ms(&trip, now_ms) <= 100 * late + 2000 + 100 * late,
                                         "too old");
            }
        }
    }
}

void test_the_age_grows_while_nothing_shows(void) {
    const int first = sip(1000, 0);
    sip(1100, (uint8_t)first);
    for (uint32_t now_ms = 1200; now_ms < 4000; now_ms += 100) {
        sip(now_ms, (uint8_t)first);
        TEST_ASSERT_EQUAL(now_ms - 1000, argus_roundtrip_ms(&trip, now_ms));
    }
}

// A port that none of ours has chosen tells nothing.
void test_a_strange_port_shows_nothing(void) {
    for (uint32_t now_ms = 1000; now_ms < 9000; now_ms += 100) {
        sip(now_ms, 200);
        TEST_ASSERT_FALSE(argus_roundtrip_is_known(&trip));
        TEST_ASSERT_EQUAL(0, argus_roundtrip_ms(&trip, now_ms));
    }
    TEST_ASSERT_EQUAL(-1, sip(9000, 200)); // no longer tried
}

void test_where_no_port_shows_config_is_asked_for(void) {
    uint8_t packet[ARGUS_PACKET_MAX];
    int asked = 0;
    argus_roundtrip_begin(&trip, true);
    session.setup.told = true;
    for (uint32_t now_ms = 1000; now_ms < 9000; now_ms += 100) {
        session.sip.anport = 0;
        argus_roundtrip_sip(&trip, &session, &config, now_ms);
        while (argus_outbox_fetch(&session.outbox, packet, sizeof packet) > 0) {
            if (packet[3] == ARCOS_CMD_CONFIG) {
                asked++;
                session.setup.told_ms = now_ms + 70;
            }
        }
    }
    TEST_ASSERT_TRUE(asked > 15);
    TEST_ASSERT_INT_WITHIN(30, 100, argus_roundtrip_ms(&trip, 9000));
}

// Seven are under way and none shows: the last one goes again, each second, and no other.
void test_what_does_not_show_is_not_sent_on_and_on(void) {
    int sent = 0;
    for (uint32_t now_ms = 1000; now_ms < 1700; now_ms += 100) {
        sent += sip(now_ms, 0) >= 0 ? 1 : 0;
    }
    TEST_ASSERT_EQUAL(7, sent);
    for (uint32_t now_ms = 1700; now_ms < 2600; now_ms += 100) {
        TEST_ASSERT_EQUAL(-1, sip(now_ms, 0));
    }
    TEST_ASSERT_EQUAL(7, sip(2600, 0));
    TEST_ASSERT_EQUAL(-1, sip(2700, 0));
}

static void fill_outbox(void) {
    while (argus_outbox_plain(&session.outbox, ARCOS_CMD_PULSE)) {
    }
}

// What finds no room was not sent: it is no order under way, and no question.
void test_what_has_no_room_is_not_under_way(void) {
    for (int has_port = 0; has_port < 2; has_port++) {
        setUp();
        fill_outbox();
        session.sip.anport = (uint8_t)(has_port ? 0 : 200);
        for (uint32_t now_ms = 1000; now_ms < 2000; now_ms += 100) {
            argus_roundtrip_sip(&trip, &session, &config, now_ms);
            TEST_ASSERT_EQUAL(0, trip.waiting);
            TEST_ASSERT_FALSE(trip.asks);
        }
        argus_outbox_clear(&session.outbox);
        argus_roundtrip_sip(&trip, &session, &config, 2000);
        TEST_ASSERT_EQUAL(1, trip.waiting);
        TEST_ASSERT_TRUE(trip.asks);
    }
}
