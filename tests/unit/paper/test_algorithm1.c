// SPDX-License-Identifier: MIT
// Rule under attack: when a sonar becomes a suspect, and the hold-off.
#include "paper/algorithm1.h"

#include <string.h>

#include "health.h"
#include "knowledge/angle.h"
#include "knowledge/config.h"
#include "unity.h"

static argus_knowledge_t k;
static argus_algorithm1_t a;
static argus_config_t config;
static argus_sip_t sip;
static uint32_t now_ms;
static int reading[16];
static bool away;

void setUp(void) {
    away = false;
    argus_knowledge_init(&k);
    argus_algorithm1_init(&a);
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

static void take(unsigned listed) {
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
    argus_algorithm1_sip(&a, &k, away);
}

static uint16_t suspects(void) {
    return argus_algorithm1_suspects(&a, &k, &config);
}

// Before the next SIP, however far that is.
static void drive_mm(int mm) {
    for (; mm > 0; mm -= 100) {
        sip.x_raw = (uint16_t)(sip.x_raw + argus_min(mm, 100));
        argus_knowledge_odometry(&k, &sip, 1000, now_ms += 1000);
    }
}

static void turn_to(int heading_raw) {
    while (sip.heading_raw < heading_raw) {
        sip.heading_raw = (int16_t)argus_min(heading_raw, sip.heading_raw + 50);
        argus_knowledge_odometry(&k, &sip, 1000, now_ms += 1000);
    }
}

void test_a_suspect_takes_three_fresh_readings_of_its_own(void) {
    take(0xFFFF);
    reading[3] = 500;
    take(0x08);
    take(0x14); // its neighbours report: no reading of its own
    take(0x14);
    TEST_ASSERT_EQUAL_HEX16(0, suspects());
    take(0x08);
    TEST_ASSERT_EQUAL_HEX16(0, suspects());
    take(0x08);
    TEST_ASSERT_EQUAL_HEX16(0x08, suspects());
}

void test_one_reading_that_agrees_begins_the_count_anew(void) {
    take(0xFFFF);
    for (int round = 0; round < 3; round++) {
        reading[3] = 500;
        take(0x08);
        take(0x08);
        reading[3] = 1000;
        take(0x08);
        TEST_ASSERT_EQUAL_HEX16(0, suspects());
    }
}

void test_readings_while_rotating_do_not_count(void) {
    take(0xFFFF);
    reading[3] = 500;
    sip.vel_left_mm_s = -60;
    sip.vel_right_mm_s = 60;
    for (int i = 0; i < 5; i++) {
        take(0x08);
    }
    TEST_ASSERT_EQUAL_HEX16(0, suspects());
}

static void make_suspect(void) {
    reading[3] = 500;
    for (int i = 0; i < config.suspect_readings; i++) {
        take(0x08);
    }
    TEST_ASSERT_EQUAL_HEX16(0x08, suspects());
}

void test_a_cleared_sonar_is_held_off_for_a_metre(void) {
    take(0xFFFF);
    make_suspect();
    argus_algorithm1_cleared(&a, &k, 3, a.of[3].difference_mm);
    for (int mm = 0; mm < 950; mm += 50) {
        drive_mm(50);
        take(0x08);
        argus_algorithm1_moved(&a, 0);
        TEST_ASSERT_EQUAL_HEX16(0, suspects());
    }
    drive_mm(100);
    take(0x08);
    TEST_ASSERT_EQUAL_HEX16(0x08, suspects());
}

void test_a_cleared_sonar_is_held_off_for_30_degrees(void) {
    take(0xFFFF);
    make_suspect();
    argus_algorithm1_cleared(&a, &k, 3, a.of[3].difference_mm);
    argus_algorithm1_moved(&a, 0);
    turn_to(330); // 29.0 degrees
    for (int i = 0; i < 5; i++) {
        take(0x08);
    }
    TEST_ASSERT_EQUAL_HEX16(0, suspects());
    turn_to(345); // 30.3
    take(0x08);
    TEST_ASSERT_EQUAL_HEX16(0x08, suspects());
}

void test_a_cleared_sonar_whose_disparity_changes_by_more_than_2_tr(void) {
    take(0xFFFF);
    make_suspect(); // disparity 500
    argus_algorithm1_cleared(&a, &k, 3, a.of[3].difference_mm);
    reading[3] = 500 - 2 * argus_tolerance_mm(k.robot, 400); // tr(424) = 38, tr(400) = 36: a change of 72
    for (int i = 0; i < 4; i++) {
        take(0x08);
    }
    TEST_ASSERT_EQUAL_HEX16(0, suspects());
    reading[3] = 400; // a change of 100 > 72
    for (int i = 0; i < 4; i++) {
        take(0x08);
    }
    TEST_ASSERT_EQUAL_HEX16(0x08, suspects()); // also in the place where it was cleared
}

void test_1_0_0_is_the_bare_paper(void) {
    config.suspect_readings = 1;
    config.holdoff_mm = 0;
    config.holdoff_deg = 0;
    take(0xFFFF);
    make_suspect(); // after one reading
    argus_algorithm1_cleared(&a, &k, 3, a.of[3].difference_mm);
    take(0x08);
    TEST_ASSERT_EQUAL_HEX16(0, suspects()); // else it would be verified in this place for ever
    argus_algorithm1_moved(&a, 0);
    take(0x08);
    TEST_ASSERT_EQUAL_HEX16(0x08, suspects());
}

void test_a_disabled_sonar_is_no_suspect(void) {
    take(0xFFFF);
    make_suspect();
    put_health(&k.sonar[3], ARGUS_DISABLED, ARGUS_KIND_WRONG, now_ms);
    TEST_ASSERT_EQUAL_HEX16(0, suspects());
}

void test_restart_forgets_the_counts(void) {
    take(0xFFFF);
    make_suspect();
    argus_algorithm1_restart(&a);
    TEST_ASSERT_EQUAL_HEX16(0, suspects());
}

void test_readings_while_turned_away_do_not_count(void) {
    take(0xFFFF);
    reading[3] = 500;
    away = true;
    for (int i = 0; i < 5; i++) {
        take(0x08);
    }
    TEST_ASSERT_EQUAL_HEX16(0, suspects());
    away = false;
    make_suspect();
}

void test_what_is_settled_here_is_open_elsewhere_or_on_demand(void) {
    take(0xFFFF);
    make_suspect();
    argus_algorithm1_settle(&a, 3);
    TEST_ASSERT_EQUAL_HEX16(0, suspects());
    argus_algorithm1_moved(&a, 0x08);
    TEST_ASSERT_EQUAL_HEX16(0, suspects());
    argus_algorithm1_reopen(&a, 0x08);
    TEST_ASSERT_EQUAL_HEX16(0x08, suspects());
    argus_algorithm1_settle(&a, 3);
    argus_algorithm1_moved(&a, 0);
    TEST_ASSERT_EQUAL_HEX16(0x08, suspects());
    argus_algorithm1_dropped(&a, 3);
    TEST_ASSERT_EQUAL_HEX16(0, suspects());
}
