// SPDX-License-Identifier: MIT
// Rule under attack: the way counts as seen only where a trusted sonar has looked, lately, and no farther
// than it heard nothing.
#include "knowledge/rays.h"

#include <string.h>

#include "knowledge/angle.h"
#include "unity.h"

#define HALF_MM 237
#define MOST_MM 1200
#define FRONT 0xFFu

static argus_knowledge_t k;
static argus_rays_t rays;

void setUp(void) {
    argus_knowledge_init(&k);
    memset(&rays, 0, sizeof rays);
    k.sip_ms = 100000;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        k.sonar[i].reported = true;
        k.sonar[i].reading_mm = 3000;
        k.sonar[i].health = ARGUS_HEALTHY;
    }
}

// All of `mask` are listed in one SIP.
static void ping(unsigned mask) {
    k.fresh = (argus_mask_t)mask;
    argus_rays_see(&rays, &k, 0);
}

static int32_t seen_mm(void) {
    return argus_rays_seen_mm(&rays, &k, HALF_MM, MOST_MM);
}

// Looks along the way and to either side of it, as a weaving robot does; then along it again.
static void weave(unsigned mask, int32_t cdeg) {
    const int32_t along = k.pose.heading_cdeg;
    for (int side = -1; side <= 1; side++) {
        k.pose.heading_cdeg = argus_angle_wrap(along + side * cdeg);
        ping(mask);
    }
    k.pose.heading_cdeg = along;
}

void test_nothing_is_seen_where_nobody_looked(void) {
    TEST_ASSERT_EQUAL_INT32(0, seen_mm());
    ping(FRONT);
    TEST_ASSERT_TRUE(seen_mm() > 1000);
    k.pose.heading_cdeg = 18000; // none looked there
    TEST_ASSERT_EQUAL_INT32(0, seen_mm());
}

void test_who_is_out_or_named_sees_nothing_and_who_is_only_doubted_does(void) {
    static const struct {
        argus_health_t health;
        argus_fault_kind_t kind;
        bool trusted;
    } rows[] = {{ARGUS_HEALTHY, ARGUS_KIND_NONE, true},   {ARGUS_SUSPECT, ARGUS_KIND_NONE, true},
                {ARGUS_SUSPECT, ARGUS_KIND_WRONG, false}, {ARGUS_DISABLED, ARGUS_KIND_OFF, false},
                {ARGUS_PROBATION, ARGUS_KIND_OFF, false}, {ARGUS_ABSENT, ARGUS_KIND_NONE, false}};
    for (size_t row = 0; row < sizeof rows / sizeof rows[0]; row++) {
        setUp();
        for (int i = 0; i < ARGUS_SONARS; i++) {
            k.sonar[i].health = rows[row].health;
            k.sonar[i].kind = rows[row].kind;
        }
        ping(FRONT);
        TEST_ASSERT_EQUAL(rows[row].trusted, seen_mm() > 0);
    }
}

// Any one or two neighbours of the six: the heading swung by half a pitch for each, the others see the way.
void test_a_weave_sees_for_one_or_two_that_are_out(void) {
    for (int first = 1; first <= 6; first++) {
        for (int second = first; second <= first + 1 && second <= 6; second++) {
            setUp();
            const unsigned living = FRONT & ~(1u << first | 1u << second);
            weave(living, 1000);
            TEST_ASSERT_EQUAL(first == second, seen_mm() == MOST_MM);
            weave(living, 2000);
            TEST_ASSERT_EQUAL_INT32(MOST_MM, seen_mm());
        }
    }
}

void test_straight_ahead_the_wedge_of_one_that_is_out_stays_unseen(void) {
    ping(FRONT & ~(1u << 3 | 1u << 4));
    TEST_ASSERT_TRUE(seen_mm() < 400);
}

void test_no_farther_than_the_echo(void) {
    for (int mm = 400; mm <= 1200; mm += 100) {
        setUp();
        for (int i = 0; i < ARGUS_SONARS; i++) {
            k.sonar[i].reading_mm = (uint16_t)mm;
        }
        weave(FRONT, 1000);
        TEST_ASSERT_TRUE(seen_mm() <= mm);
    }
}

void test_what_was_seen_is_forgotten_after_five_seconds(void) {
    ping(FRONT);
    k.sip_ms += 5000;
    TEST_ASSERT_TRUE(seen_mm() > 0);
    k.sip_ms += 1;
    TEST_ASSERT_EQUAL_INT32(0, seen_mm());
}

void test_what_a_sonar_saw_is_taken_back_and_nothing_else(void) {
    ping(FRONT);
    for (int i = 0; i <= 7; i++) {
        TEST_ASSERT_TRUE(seen_mm() > 0 || i > 1);
        argus_rays_forget(&rays, i);
    }
    TEST_ASSERT_EQUAL_INT32(0, seen_mm());
    ping(FRONT);
    argus_rays_forget_all(&rays);
    TEST_ASSERT_EQUAL_INT32(0, seen_mm());
}

// The way shortens as it is driven, and the log goes round without an end.
void test_as_far_as_seen_less_what_is_driven(void) {
    ping(FRONT);
    const int32_t before_mm = seen_mm();
    k.pose.x_mm += 400;
    TEST_ASSERT_TRUE(seen_mm() <= before_mm);
    for (int i = 0; i < 3 * ARGUS_RAYS_MAX; i++) {
        ping(1u << (i % 8));
    }
    TEST_ASSERT_EQUAL(ARGUS_RAYS_MAX, rays.count);
    TEST_ASSERT_TRUE(seen_mm() > 0);
}

void test_beyond_the_frame_nothing_is_logged(void) {
    k.pose.x_mm = 40000;
    ping(FRONT);
    TEST_ASSERT_EQUAL(0, rays.count);
}

void test_beyond_the_frame_to_the_side_nothing_is_logged(void) {
    k.pose.y_mm = 40000;
    ping(FRONT);
    TEST_ASSERT_EQUAL_INT(0, rays.count);
}
