// SPDX-License-Identifier: MIT
// Rule under attack: what one SIP shows (dead, silent, object, bumper).
#include "awareness/alarms.h"

#include <string.h>

#include "health.h"
#include "knowledge/config.h"
#include "unity.h"

static argus_knowledge_t k;
static argus_config_t config;
static argus_sip_t sip;
static uint32_t now_ms;
static int reading[16];

void setUp(void) {
    argus_knowledge_init(&k);
    argus_config_default(&config);
    argus_config_follow(&config, argus_config_follows(&config), argus_robot_default());
    config.profile = ARGUS_PROFILE_PAPER;
    memset(&sip, 0, sizeof sip);
    sip.flags = 7;
    now_ms = 0xFFFFFE00u;
    argus_knowledge_reopen(&k, now_ms);
    for (int i = 0; i < 16; i++) {
        reading[i] = 1000;
    }
}

static argus_alarm_t take(unsigned listed) {
    now_ms += 100;
    sip.sonar_count = 0;
    for (int i = 0; i < 16; i++) {
        if ((listed >> i & 1u) != 0) {
            sip.sonar[sip.sonar_count].number = (uint8_t)i;
            sip.sonar[sip.sonar_count].range_mm = (uint16_t)reading[i];
            sip.sonar_count++;
        }
    }
    argus_knowledge_sip(&k, &sip, 1000, now_ms);
    return argus_alarms(&k, &config);
}

void test_dead_on_the_six_only(void) {
    for (int i = 0; i < 16; i++) {
        reading[i] = 5000;
    }
    TEST_ASSERT_EQUAL_HEX16(0x7E, take(0xFFFF).dead);
    TEST_ASSERT_EQUAL_HEX16(0, take(0).dead); // not listed: nothing new
    TEST_ASSERT_EQUAL_HEX16(0x08, take(0x08).dead);
    put_health(&k.sonar[3], ARGUS_DISABLED, ARGUS_KIND_OFF, now_ms);
    TEST_ASSERT_EQUAL_HEX16(0x76, take(0xFFFF).dead);
    reading[2] = 65535;
    TEST_ASSERT_EQUAL_HEX16(0x04, take(0x04).dead);
    reading[2] = 4999;
    TEST_ASSERT_EQUAL_HEX16(0, take(0x04).dead);
}

void test_objects_along_the_motion(void) {
    for (int i = 0; i < 16; i++) {
        reading[i] = 250 - i;
    }
    TEST_ASSERT_EQUAL_HEX16(0, take(0xFFFF).object); // at rest
    sip.vel_left_mm_s = sip.vel_right_mm_s = 100;
    TEST_ASSERT_EQUAL_HEX16(0x7E, take(0xFFFF).object);
    TEST_ASSERT_EQUAL(6, take(0xFFFF).object_sonar);
    TEST_ASSERT_EQUAL(244, take(0xFFFF).object_mm);
    sip.vel_left_mm_s = sip.vel_right_mm_s = -100;
    TEST_ASSERT_EQUAL_HEX16(0x7E00, take(0xFFFF).object);
    sip.vel_left_mm_s = 100; // on the spot
    TEST_ASSERT_EQUAL_HEX16(0, take(0xFFFF).object);
    sip.vel_right_mm_s = 100;
    put_health(&k.sonar[6], ARGUS_DISABLED, ARGUS_KIND_OFF, now_ms);
    TEST_ASSERT_EQUAL(5, take(0xFFFF).object_sonar);
    for (int i = 0; i < 16; i++) {
        reading[i] = 251;
    }
    TEST_ASSERT_EQUAL_HEX16(0, take(0xFFFF).object);
    reading[2] = 250;
    TEST_ASSERT_EQUAL_HEX16(0x04, take(0xFFFF).object);
}

void test_bumpers_and_stalls(void) {
    TEST_ASSERT_FALSE(take(0).bumper);
    sip.bumpers_rear = 2;
    TEST_ASSERT_TRUE(take(0).bumper);
    sip.bumpers_rear = 0;
    sip.bumpers_front = 32;
    TEST_ASSERT_TRUE(take(0).bumper);
    sip.stall_right = true;
    TEST_ASSERT_TRUE(take(0).stall);
}

void test_a_slot_without_readings_is_silent_after_stale_ms(void) {
    take(0xFFFF);
    for (int i = 1; i <= 30; i++) {
        const unsigned listed = 0xFFFFu & ~(1u << 4);
        TEST_ASSERT_EQUAL_HEX16(i * 100 > config.stale_ms ? 1u << 4 : 0, take(listed).silent);
    }
}

void test_a_sonar_that_never_reported_is_silent_after_stale_ms(void) {
    argus_knowledge_reopen(&k, now_ms);
    for (int i = 1; i <= 30; i++) {
        TEST_ASSERT_EQUAL_HEX16(i * 100 > config.stale_ms ? 1u << 2 : 0, take(0xFFFBu).silent);
    }
}

void test_a_gap_of_the_link_makes_no_sonar_silent(void) {
    take(0xFFFF);
    now_ms += 3000;
    TEST_ASSERT_EQUAL_HEX16(0, take(0).silent);
    for (int i = 1; i <= 14; i++) {
        TEST_ASSERT_EQUAL_HEX16(0, take(0).silent);
    }
    TEST_ASSERT_EQUAL_HEX16(0x7E, take(0).silent | take(0).silent);
}

// 19 is in the upper deck of a PeopleBot, at 10 degrees and 89 mm behind 3 and 4: an object counts from
// there.
void test_an_upper_deck_counts_from_the_lower_faces(void) {
#if ARGUS_SONARS > 16
    k.robot = argus_robot_find("peoplebot-sh");
    k.sonars = 32;
    k.sonar[19].reported = true;
    k.sonar[19].health = ARGUS_HEALTHY;
    k.fresh = 1u << 19;
    k.vel_left_mm_s = k.vel_right_mm_s = 200;
    k.sonar[19].reading_mm = (uint16_t)(config.object_range_mm + 87);
    const argus_alarm_t alarm = argus_alarms(&k, &config);
    TEST_ASSERT_EQUAL_HEX32(1u << 19, alarm.object);
    TEST_ASSERT_EQUAL(config.object_range_mm, alarm.object_mm);
    k.sonar[19].reading_mm++;
    TEST_ASSERT_EQUAL_HEX32(0, argus_alarms(&k, &config).object);
    k.sonar[19].reading_mm = 20; // within the deck
    TEST_ASSERT_EQUAL(0, argus_alarms(&k, &config).object_mm);
    k.vel_left_mm_s = k.vel_right_mm_s = -200;
    TEST_ASSERT_EQUAL_HEX32(0, argus_alarms(&k, &config).object);
#else
    TEST_IGNORE_MESSAGE("this build has no room for an upper deck");
#endif
}
