// SPDX-License-Identifier: MIT
// Rule under attack: those in use that face forward fire twice in a round, the others of their arrays once,
// one that is out gives its slots away, and keeps one where it may show that it does well again.
#include "adjustment/firing.h"

#include <string.h>

#include "health.h"
#include "unity.h"

static argus_knowledge_t k;
static argus_outbox_t out;
static argus_firing_t firing;

void setUp(void) {
    argus_knowledge_init(&k);
    memset(&out, 0, sizeof out);
    memset(&firing, 0, sizeof firing);
}

// The order that goes out: numbers from 1.
static void expect(bool tries, const uint8_t *order, size_t count) {
    uint8_t packet[ARGUS_PACKET_MAX];
    argus_firing_share(&firing, &k, tries, &out, 4711);
    TEST_ASSERT_TRUE(firing.ordered);
    TEST_ASSERT_EQUAL_UINT32(4711, firing.ordered_ms);
    TEST_ASSERT_TRUE(argus_outbox_fetch(&out, packet, sizeof packet) > 0);
    TEST_ASSERT_EQUAL_UINT8(ARCOS_CMD_POLLING, packet[3]);
    TEST_ASSERT_EQUAL_UINT8(count, packet[5]);
    TEST_ASSERT_EQUAL_UINT8_ARRAY(order, packet + 6, count);
}

void test_those_that_face_forward_fire_twice(void) {
    static const uint8_t order[] = {2, 3, 4, 5, 6, 7, 1, 2, 3, 4, 5, 6, 7, 8};
    expect(false, order, sizeof order);
    expect(true, order, sizeof order);
}

void test_one_that_is_out_gives_its_slots_away_or_keeps_one(void) {
    static const uint8_t order[] = {2, 3, 5, 6, 7, 1, 2, 3, 5, 6, 7, 8, 4};
    put_health(&k.sonar[3], ARGUS_DISABLED, ARGUS_KIND_OFF, 0);
    put_health(&k.sonar[0], ARGUS_DISABLED, ARGUS_KIND_OFF, 0); // it does not face forward: it watches on
    expect(false, order, sizeof order - 1);
    expect(true, order, sizeof order);
}

void test_with_the_rear_ahead_the_rear_fires_twice(void) {
    static const uint8_t order[] = {10, 11, 12, 13, 14, 15, 9, 10, 11, 12, 13, 14, 15, 16};
    k.robot = argus_robot_other_end(k.robot);
    expect(false, order, sizeof order);
}
