// SPDX-License-Identifier: MIT
// Rule under attack (S4, active verification): looks to either side of the heading, as many as are needed and
// no more, half a turn when one array is deaf, and back to the heading in the end.
#include "argus/inquiry.h"

#include <stdlib.h>
#include <string.h>

#include "argus/angle.h"
#include "awareness/evidence_internal.h"
#include "unity.h"

#define LOOKS_MAX 8
#define SIPS_MAX 60
#define SLOT_SIPS 3 // a sonar is listed in every third SIP

static argus_knowledge_t k;
static argus_evidence_t e;
static argus_inquiry_t inquiry;
static int32_t heading[LOOKS_MAX + 1];
static int looks;
static uint32_t sips;
static uint32_t longest_ms;
static unsigned mute;
static int32_t base_cdeg;

void setUp(void) {
    argus_knowledge_init(&k);
    argus_evidence_init(&e);
    argus_inquiry_init(&inquiry);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        k.sonar[i].reported = true;
        k.sonar[i].reading_mm = 1500;
        k.sonar[i].readings = 250; // the low byte wraps on the way
        k.sonar[i].health = ARGUS_HEALTHY;
    }
    k.sip_ms = UINT32_MAX - 3000; // the clock, too
    mute = 0;
    sips = 0;
}

static void sip(void) {
    sips++;
    k.sip_ms += 100;
    for (unsigned i = 0; i < ARGUS_SONARS; i++) {
        if ((sips + i) % SLOT_SIPS == 0 && (mute >> i & 1u) == 0) {
            k.sonar[i].readings++;
        }
    }
}

// Settled on the present heading: until it asks for another one.
static bool look_here(void) {
    const uint32_t from_ms = k.sip_ms;
    for (int i = 0; i < SIPS_MAX; i++) {
        sip();
        if (argus_inquiry_step(&inquiry, &k, &e)) {
            longest_ms = k.sip_ms - from_ms > longest_ms ? k.sip_ms - from_ms : longest_ms;
            return true;
        }
    }
    return false;
}

// Turns whither it wants until it is over.
static void inquire(uint16_t suspects, uint16_t out, int32_t base) {
    base_cdeg = base;
    looks = 0;
    longest_ms = 0;
    argus_inquiry_begin(&inquiry, suspects, out, base);
    TEST_ASSERT_TRUE(inquiry.active);
    while (inquiry.active) {
        TEST_ASSERT_TRUE_MESSAGE(looks <= LOOKS_MAX, "it does not end");
        heading[looks++] = argus_inquiry_heading_cdeg(&inquiry);
        TEST_ASSERT_TRUE_MESSAGE(look_here(), "it waits for ever");
    }
}

static int32_t relative(int look) {
    return argus_angle_wrap(heading[look] - base_cdeg);
}

static bool looked_at(int32_t cdeg) {
    for (int i = 0; i < looks; i++) {
        if (relative(i) == cdeg) {
            return true;
        }
    }
    return false;
}

static void suspect_openly(int sonar) {
    e.of[sonar].score[ARGUS_TEST_VIEW] = argus_bounds[ARGUS_TEST_VIEW].suspicious;
}

void test_one_pitch_to_either_side_and_back(void) {
    static const int32_t bases[] = {0, 17900, -17999, 18000, 9000};
    for (int i = 0; i < 5; i++) {
        setUp();
        inquire(0, 0, bases[i]);
        TEST_ASSERT_EQUAL(3, looks);
        TEST_ASSERT_EQUAL(-2000, relative(0));
        TEST_ASSERT_EQUAL(2000, relative(1));
        TEST_ASSERT_EQUAL(argus_angle_wrap(bases[i]), heading[2]);
    }
}

void test_headings_are_within_the_range_of_angles(void) {
    for (int32_t base = -17900; base <= 18000; base += 100) {
        setUp();
        suspect_openly(3);
        inquire(1u << 3, 0, base);
        for (int i = 0; i < looks; i++) {
            TEST_ASSERT_TRUE(heading[i] > -18000 && heading[i] <= 18000);
        }
        TEST_ASSERT_EQUAL(base, heading[looks - 1]);
    }
}

// While a suspicion is open it goes on looking; but not for ever, and home in any case.
void test_an_open_suspicion_is_looked_at_longer_but_not_for_ever(void) {
    inquire(1u << 3, 0, 1000);
    const int settled = looks;
    setUp();
    suspect_openly(3);
    inquire(1u << 3, 0, 1000);
    TEST_ASSERT_TRUE(looks > settled);
    TEST_ASSERT_TRUE(looks <= LOOKS_MAX);
    TEST_ASSERT_EQUAL(1000, heading[looks - 1]);
    for (int i = 0; i < looks - 1; i++) {
        for (int other = 0; other < i; other++) {
            TEST_ASSERT_TRUE_MESSAGE(heading[i] != heading[other], "the same look twice");
        }
    }
}

// A whole array that hears nothing: the other one is turned onto what it should hear.
void test_half_a_turn_when_one_array_is_deaf(void) {
    for (int deaf = 0; deaf < 2; deaf++) {
        setUp();
        for (int i = 0; i < 8; i++) {
            k.sonar[8 * deaf + i].reading_mm = 5000;
        }
        inquire((uint16_t)(deaf == 0 ? 1u << 3 : 1u << 12), 0, 0);
        TEST_ASSERT_TRUE(looked_at(18000));
        TEST_ASSERT_EQUAL(0, heading[looks - 1]);
    }
}

void test_no_half_turn_when_both_or_none_are_deaf(void) {
    inquire(1u << 3, 0, 0);
    TEST_ASSERT_FALSE(looked_at(18000));
    setUp();
    for (int i = 0; i < ARGUS_SONARS; i++) {
        k.sonar[i].reading_mm = 5000;
    }
    suspect_openly(3);
    inquire(1u << 3, 0, 0);
    TEST_ASSERT_FALSE(looked_at(18000));
}

// Each that is asked, or near to one that is, has to be heard anew on each heading.
void test_waits_for_new_readings_of_the_suspect_and_its_neighbours(void) {
    for (int sonar = 2; sonar <= 5; sonar++) {
        setUp();
        argus_inquiry_begin(&inquiry, (uint16_t)(1u << sonar), 0, 0);
        sip();
        TEST_ASSERT_FALSE(argus_inquiry_step(&inquiry, &k, &e));
        const uint32_t from = k.sonar[sonar].readings;
        const uint32_t beside = k.sonar[sonar - 1].readings;
        TEST_ASSERT_TRUE(look_here());
        TEST_ASSERT_TRUE(k.sonar[sonar].readings - from >= 2); // two that agree make a view
        TEST_ASSERT_TRUE(k.sonar[sonar - 1].readings - beside >= 2);
    }
}

void test_a_sonar_that_yields_nothing_is_not_waited_for_long(void) {
    mute = 1u << 3;
    inquire(1u << 3, 0, 0);
    TEST_ASSERT_EQUAL(0, heading[looks - 1]);
    TEST_ASSERT_TRUE(longest_ms <= 5000);
    setUp();
    mute = 0xFFFF;
    inquire(0, 0, 0);
    TEST_ASSERT_EQUAL(0, heading[looks - 1]);
}

void test_one_that_is_out_is_not_waited_for_at_all(void) {
    mute = 1u << 2;
    inquire(1u << 3, 0, 0);
    const uint32_t with_it = longest_ms;
    setUp();
    mute = 1u << 2;
    inquire(1u << 3, 1u << 2, 0);
    TEST_ASSERT_TRUE(longest_ms < with_it);
}

void test_more_suspects_may_be_taken_in_under_way(void) {
    argus_inquiry_begin(&inquiry, 1u << 1, 0, 0);
    TEST_ASSERT_EQUAL(0, inquiry.watched >> 12 & 1u);
    argus_inquiry_add(&inquiry, 1u << 12, 1u << 13);
    TEST_ASSERT_EQUAL_HEX16(1u << 1 | 1u << 12, inquiry.suspects);
    TEST_ASSERT_EQUAL(1, inquiry.watched >> 12 & 1u);
    TEST_ASSERT_EQUAL(1, inquiry.watched >> 1 & 1u);
    TEST_ASSERT_EQUAL(0, inquiry.watched >> 13 & 1u);
}

// The arrays do not look into each other's sectors: who is watched is of the suspect's own array.
void test_neighbours_are_of_the_same_array(void) {
    for (int sonar = 0; sonar < ARGUS_SONARS; sonar++) {
        argus_inquiry_begin(&inquiry, (uint16_t)(1u << sonar), 0, 0);
        TEST_ASSERT_EQUAL_HEX16(0, inquiry.watched & (sonar < 8 ? 0xFF00u : 0x00FFu));
        TEST_ASSERT_EQUAL(1, inquiry.watched >> sonar & 1u);
    }
}

// Whatever the evidence and the readings do in between: it ends, at home, within a bounded number of looks.
void test_it_ends_at_home_whatever_happens(void) {
    srand(6);
    for (int run = 0; run < 400; run++) {
        setUp();
        mute = (unsigned)rand() & 0xFFFFu;
        for (int i = 0; i < ARGUS_SONARS; i++) {
            k.sonar[i].reading_mm = (uint16_t)(rand() % 3 == 0 ? 5000 : 200 + rand() % 4800);
            k.sonar[i].health = (argus_health_t)(rand() % 6);
            for (int test = 0; test < ARGUS_TESTS; test++) {
                const argus_bounds_t *b = &argus_bounds[test];
                e.of[i].score[test] = (int16_t)(b->floor + rand() % (b->ceiling - b->floor + 1));
            }
            e.of[i].conflicts = (uint8_t)(rand() % 8);
        }
        const int32_t base = rand() % 36000 - 17999;
        inquire((uint16_t)rand(), (uint16_t)rand(), base);
        TEST_ASSERT_EQUAL(base, heading[looks - 1]);
    }
}
