// SPDX-License-Identifier: MIT
// Attacks: a survey proves what others contradict on one bearing, whichever sonar it is, and no healthy one.
#include <string.h>

#include "survey_views.h"
#include "unity.h"

#define SONARS 16
#define ALL 0xFFFFu

static const int16_t bearing_deg[SONARS] = {90,  50,   30,   10,   -10, -30, -50, -90,
                                            -90, -130, -150, -170, 170, 150, 130, 90};
static survey_views_t views;
static argus_status_t status;
static uint16_t (*spoil)(int sonar, int heading, uint16_t right_mm);

void setUp(void) {
    memset(&views, 0, sizeof views);
    memset(&status, 0, sizeof status);
    status.sonars = SONARS;
    memcpy(status.bearing_deg, bearing_deg, sizeof bearing_deg);
    spoil = NULL;
}

// A room with a corner, from its middle: any shape that is one number a bearing.
static uint16_t room_mm(int world_deg) {
    const int turned = ((world_deg % 360) + 360) % 360;
    return (uint16_t)(800 + turned * 7 % 1900);
}

static void survey(void) {
    for (int h = 0; h < SURVEY_HEADINGS; h++) {
        for (int i = 0; i < SONARS; i++) {
            const uint16_t right_mm = room_mm(h * 30 + bearing_deg[i]);
            status.reading_mm[i] = spoil == NULL ? right_mm : spoil(i, h, right_mm);
        }
        survey_views_note(&views, (int16_t)(h * 30 + (h % 3) - 1), &status, ALL); // turns end a degree beside
    }
}

static argus_fault_kind_t proved(int sonar) {
    const survey_match_t match = survey_views_match(&views, &status, sonar, ALL);
    return survey_proves(&match);
}

static void all_but(int broken, argus_fault_kind_t kind) {
    for (int i = 0; i < SONARS; i++) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(i == broken ? kind : ARGUS_KIND_NONE, proved(i),
                                      i == broken ? "broken" : "healthy");
    }
}

void test_a_healthy_ring_is_proved_nothing_and_agrees(void) {
    survey();
    for (int i = 0; i < SONARS; i++) {
        const survey_match_t match = survey_views_match(&views, &status, i, ALL);
        TEST_ASSERT_EQUAL_INT(SURVEY_HEADINGS, match.compared);
        TEST_ASSERT_EQUAL_INT(SURVEY_HEADINGS, match.agreed);
    }
    all_but(-1, ARGUS_KIND_NONE);
}

static int victim;

static uint16_t dead(int sonar, int heading, uint16_t right_mm) {
    (void)heading;
    return sonar == victim ? ARGUS_NO_ECHO_MM : right_mm;
}

static uint16_t offset(int sonar, int heading, uint16_t right_mm) {
    (void)heading;
    return (uint16_t)(sonar == victim ? right_mm + 400 : right_mm);
}

static uint16_t now_and_then(int sonar, int heading, uint16_t right_mm) {
    return sonar == victim && heading % 3 == 0 ? ARGUS_NO_ECHO_MM : right_mm;
}

void test_each_dead_sonar_is_proved_and_no_other(void) {
    spoil = dead;
    for (victim = 0; victim < SONARS; victim++) {
        memset(&views, 0, sizeof views);
        survey();
        all_but(victim, ARGUS_KIND_OFF);
    }
}

void test_each_sonar_with_an_offset_is_proved_and_no_other(void) {
    spoil = offset;
    for (victim = 0; victim < SONARS; victim++) {
        memset(&views, 0, sizeof views);
        survey();
        all_but(victim, ARGUS_KIND_WRONG);
    }
}

void test_echoes_missed_now_and_then_prove_nothing(void) {
    spoil = now_and_then;
    for (victim = 0; victim < SONARS; victim++) {
        memset(&views, 0, sizeof views);
        survey();
        all_but(-1, ARGUS_KIND_NONE);
    }
}

static uint16_t open_field(int sonar, int heading, uint16_t right_mm) {
    (void)sonar;
    (void)heading;
    (void)right_mm;
    return ARGUS_NO_ECHO_MM;
}

void test_an_open_field_and_few_headings_prove_nothing(void) {
    spoil = open_field;
    survey();
    all_but(-1, ARGUS_KIND_NONE);
    TEST_ASSERT_EQUAL_INT(0, survey_views_match(&views, &status, 3, ALL).compared);
    victim = 3;
    spoil = dead;
    memset(&views, 0, sizeof views);
    survey();
    views.headings = 1;
    all_but(-1, ARGUS_KIND_NONE);
}

void test_one_that_is_not_trusted_is_no_witness(void) {
    spoil = dead;
    victim = 3;
    survey();
    const survey_match_t none = survey_views_match(&views, &status, 3, 1u << 3);
    TEST_ASSERT_EQUAL_INT(0, none.compared);
    const survey_match_t one = survey_views_match(&views, &status, 3, 1u << 6);
    TEST_ASSERT_LESS_THAN_INT(2, one.compared); // it saw a bearing twice at the seam of the circle only
    TEST_ASSERT_EQUAL_INT(ARGUS_KIND_NONE, survey_proves(&one));
}

void test_more_headings_than_there_is_room_for_are_passed_over(void) {
    survey();
    survey();
    TEST_ASSERT_EQUAL_INT(SURVEY_HEADINGS, views.headings);
}
