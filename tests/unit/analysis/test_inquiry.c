// SPDX-License-Identifier: MIT
// Rule under attack (S4, active verification): first a sonar that hears nothing is turned onto what another
// heard, a few times at most; then looks to either side of the heading, as many as are needed and no more,
// and back to the heading in the end.
#include "analysis/inquiry.h"

#include <stdlib.h>
#include <string.h>

#include "analysis/aim.h"
#include "awareness/numbers.h"
#include "health.h"
#include "knowledge/angle.h"
#include "unity.h"

#define SONARS (ARGUS_SONARS < 16 ? ARGUS_SONARS : 16) // that its robot has, of those that a build manages

#define AIMS_MAX 4
#define LOOKS_MAX (AIMS_MAX + 6)
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
static int aims; // looks that were turned onto something heard
static int aimed[LOOKS_MAX + 1];

void setUp(void) {
    argus_knowledge_init(&k);
    argus_evidence_init(&e);
    argus_inquiry_init(&inquiry);
    for (int i = 0; i < SONARS; i++) {
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
    for (unsigned i = 0; i < SONARS; i++) {
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
    aims = 0;
    longest_ms = 0;
    for (int i = 0; i < SONARS; i++) {
        k.sonar[i].health = (out >> i & 1u) != 0 ? ARGUS_DISABLED : k.sonar[i].health;
    }
    k.pose.heading_cdeg = base;
    argus_inquiry_begin(&inquiry, &k, &e, suspects, base);
    TEST_ASSERT_TRUE(inquiry.active);
    while (inquiry.active) {
        TEST_ASSERT_TRUE_MESSAGE(looks <= LOOKS_MAX, "it does not end");
        k.pose.heading_cdeg = argus_inquiry_heading_cdeg(&inquiry);
        aimed[looks] = inquiry.aiming ? inquiry.aimed : -1;
        aims += inquiry.aiming ? 1 : 0;
        heading[looks++] = k.pose.heading_cdeg;
        TEST_ASSERT_TRUE_MESSAGE(look_here(), "it waits for ever");
    }
}

static int32_t relative(int look) {
    return argus_angle_wrap(heading[look] - base_cdeg);
}

static void suspect_openly(int sonar) {
    e.of[sonar].score[ARGUS_TEST_PEERS] =
        (int16_t)(argus_bounds[ARGUS_TEST_PEERS].naming * ARGUS_SUSPECT_PERCENT / 100);
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

// Each that is asked, or near to one that is, has to be heard anew on each heading.
void test_waits_for_new_readings_of_the_suspect_and_its_neighbours(void) {
    for (int sonar = 2; sonar <= 5; sonar++) {
        setUp();
        argus_inquiry_begin(&inquiry, &k, &e, (uint16_t)(1u << sonar), 0);
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
    argus_inquiry_begin(&inquiry, &k, &e, 1u << 1, 0);
    TEST_ASSERT_EQUAL(0, inquiry.watched >> 12 & 1u);
    put_health(&k.sonar[13], ARGUS_DISABLED, ARGUS_KIND_OFF, 0);
    argus_inquiry_add(&inquiry, &k, 1u << 12);
    TEST_ASSERT_EQUAL_HEX16(1u << 1 | 1u << 12, inquiry.suspects);
    TEST_ASSERT_EQUAL(1, inquiry.watched >> 12 & 1u);
    TEST_ASSERT_EQUAL(1, inquiry.watched >> 1 & 1u);
    TEST_ASSERT_EQUAL(0, inquiry.watched >> 13 & 1u);
}

// The arrays do not look into each other's sectors: those watched are of the suspect's own array.
void test_neighbours_are_of_the_same_array(void) {
    for (int sonar = 0; sonar < SONARS; sonar++) {
        argus_inquiry_begin(&inquiry, &k, &e, (uint16_t)(1u << sonar), 0);
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
        for (int i = 0; i < SONARS; i++) {
            k.sonar[i].reading_mm = (uint16_t)(rand() % 3 == 0 ? 5000 : 200 + rand() % 4800);
            k.sonar[i].health = (argus_health_t)(rand() % 6);
            for (int test = 0; test < ARGUS_TESTS; test++) {
                const argus_bounds_t *b = &argus_bounds[test];
                e.of[i].score[test] = (int16_t)(b->floor + rand() % (ARGUS_CEILING - b->floor + 1));
            }
            e.of[i].against = (argus_mask_t)(rand() % 8);
        }
        const int32_t base = rand() % 36000 - 17999;
        inquire((uint16_t)rand(), (uint16_t)rand(), base);
        TEST_ASSERT_EQUAL(base, heading[looks - 1]);
    }
}

// ---- aims

// `sonar` has heard something at `mm` on the robot's heading `cdeg`.
static void heard(int sonar, int32_t cdeg, int mm) {
    const argus_pose_t pose = {k.pose.x_mm, k.pose.y_mm, cdeg};
    argus_ping_t at = argus_ping_from(k.robot, sonar, &pose);
    at.t_ms = (uint16_t)(k.sip_ms & 0xFFFFu);
    at.reading_mm = (uint16_t)mm;
    argus_pings_note(&e.pings[sonar], at);
}

static void falls_silent(int sonar) {
    e.of[sonar].none_run = 3;
}

// 3 hears nothing; on -20 degrees it would look where 4 has heard something, on +20 where 2 has.
static void three_falls_silent(void) {
    setUp();
    falls_silent(3);
    heard(4, 0, 1500);
}

static void comes_back(int sonar) {
    e.of[sonar].none_run = 0;
}

// Looks until it is settled on the next heading, which is returned.
static int32_t next_heading(void) {
    k.pose.heading_cdeg = argus_inquiry_heading_cdeg(&inquiry);
    TEST_ASSERT_TRUE_MESSAGE(look_here(), "it waits for ever");
    return argus_inquiry_heading_cdeg(&inquiry);
}

static void begin_on(unsigned suspects) {
    k.pose.heading_cdeg = 0;
    argus_inquiry_begin(&inquiry, &k, &e, (uint16_t)suspects, 0);
}

void test_a_silent_suspect_is_turned_first_onto_what_another_heard(void) {
    three_falls_silent();
    heard(5, 0, 700); // 40 degrees off: dearer
    begin_on(1u << 3);
    TEST_ASSERT_TRUE(inquiry.aiming);
    TEST_ASSERT_EQUAL(3, inquiry.aimed);
    TEST_ASSERT_EQUAL_INT32(-2000, argus_inquiry_heading_cdeg(&inquiry));
}

void test_a_suspect_that_is_named_or_hears_is_not_turned(void) {
    three_falls_silent();
    e.of[3].score[ARGUS_TEST_DROPOUT] = argus_bounds[ARGUS_TEST_DROPOUT].naming;
    begin_on(1u << 3);
    TEST_ASSERT_FALSE(inquiry.aiming);
    three_falls_silent();
    comes_back(3);
    begin_on(1u << 3);
    TEST_ASSERT_FALSE(inquiry.aiming);
}

static void is_contradicted(int sonar, int by) {
    e.of[sonar].score[ARGUS_TEST_PEERS] = (int16_t)by;
}

// One that is dead makes suspects of the living: it is turned whichever is suspected, or none.
void test_who_is_silent_is_turned_though_no_suspect(void) {
    three_falls_silent();
    begin_on(0);
    TEST_ASSERT_TRUE(inquiry.aiming);
    TEST_ASSERT_EQUAL(3, inquiry.aimed);
    three_falls_silent();
    comes_back(3);
    begin_on(0);
    TEST_ASSERT_FALSE(inquiry.aiming);
    three_falls_silent();
    k.sonar[3].health = ARGUS_DISABLED;
    begin_on(0);
    TEST_ASSERT_FALSE(inquiry.aiming);
}

// However much more the other one is contradicted.
void test_a_silent_suspect_is_turned_before_one_that_is_contradicted(void) {
    three_falls_silent();
    falls_silent(4);
    heard(5, 0, 1500); // where 4 looks on -20 degrees
    is_contradicted(4, 400);
    begin_on(1u << 3);
    TEST_ASSERT_TRUE(inquiry.aiming);
    TEST_ASSERT_EQUAL(3, inquiry.aimed);
}

// ... and while there are suspects, two of the four aims are kept for them.
void test_those_that_are_contradicted_leave_some_aims_to_the_suspects(void) {
    for (int suspects = 0; suspects < 2; suspects++) {
        three_falls_silent();
        is_contradicted(3, 400);
        heard(2, 0, 1500);
        heard(4, -40, 1500);
        heard(2, 40, 1500);
        k.pose.heading_cdeg = 0;
        argus_inquiry_begin(&inquiry, &k, &e, suspects ? 1u << 12 : 0, 0);
        inquiry.aims = 2;
        inquiry.marked = false;
        next_heading();
        TEST_ASSERT_EQUAL(suspects ? 2 : 3, inquiry.aims);
    }
}

// Once the aim has shown an echo, the looks to either side would show nothing more.
void test_an_aim_that_settles_it_ends_the_look(void) {
    three_falls_silent();
    begin_on(1u << 3);
    comes_back(3);
    TEST_ASSERT_EQUAL_INT32(0, next_heading());
    TEST_ASSERT_TRUE(inquiry.returning);
}

// It stays silent where another heard something: it has looked there now, and is not turned there again.
void test_an_aim_that_settles_nothing_is_followed_by_the_looks(void) {
    three_falls_silent();
    begin_on(1u << 3);
    heard(3, -2000, 5000);
    unsigned seen = 0;
    for (int i = 0; inquiry.active && i < LOOKS_MAX; i++) {
        const int32_t to = next_heading();
        TEST_ASSERT_FALSE(inquiry.active && inquiry.aiming);
        seen |= to == -2000 ? 1u : (to == 2000 ? 2u : 0u);
    }
    TEST_ASSERT_EQUAL(3, seen);
    TEST_ASSERT_FALSE(inquiry.active);
    TEST_ASSERT_EQUAL_INT32(0, k.pose.heading_cdeg);
}

// An echo that keeps others contradicting it is not settled by being heard.
void test_an_aim_that_leaves_the_suspect_open_is_followed_by_the_looks(void) {
    three_falls_silent();
    begin_on(1u << 3);
    comes_back(3);
    suspect_openly(3);
    TEST_ASSERT_TRUE(next_heading() == -2000);
    TEST_ASSERT_FALSE(inquiry.aiming || inquiry.returning);
}

// Three firings of the sonar, whatever it hears.
void test_an_aim_takes_three_readings(void) {
    three_falls_silent();
    begin_on(1u << 3);
    TEST_ASSERT_TRUE(inquiry.aiming);
    k.pose.heading_cdeg = argus_inquiry_heading_cdeg(&inquiry);
    sip();
    TEST_ASSERT_FALSE(argus_inquiry_step(&inquiry, &k, &e)); // settled from here
    const uint32_t from = k.sonar[3].readings;
    TEST_ASSERT_TRUE_MESSAGE(look_here(), "it waits for ever");
    TEST_ASSERT_EQUAL(3, k.sonar[3].readings - from);
}

void test_an_aimed_sonar_that_yields_nothing_is_not_waited_for_long(void) {
    three_falls_silent();
    mute = 1u << 3;
    inquire(1u << 3, 0, 0);
    TEST_ASSERT_TRUE(aims > 0);
    TEST_ASSERT_TRUE(longest_ms <= 5000);
    TEST_ASSERT_EQUAL(0, heading[looks - 1]);
}

// Everybody hears nothing, and there is something to aim at for each, wherever the robot looks.
static void all_fall_silent(void) {
    setUp();
    for (int i = 0; i < SONARS; i++) {
        falls_silent(i);
        e.of[i].none_run = 20;
        for (int n = 0; n < 8; n++) {
            heard(i, n * 2000, 1000 + 10 * i);
        }
    }
}

void test_suspects_are_aimed_so_often_and_no_more(void) {
    all_fall_silent();
    inquire(0xFFFF, 0, 0);
    TEST_ASSERT_EQUAL(AIMS_MAX, aims);
    TEST_ASSERT_EQUAL(0, heading[looks - 1]);
}

void test_a_suspect_is_aimed_where_something_was_heard(void) {
    int some = 0;
    for (int suspect = 1; suspect < SONARS; suspect++) {
        int32_t to = 0;
        all_fall_silent();
        begin_on(1u << suspect);
        const bool may = argus_aim(&e, &k, suspect, &to); // turning shifts some too far aside
        TEST_ASSERT_TRUE(inquiry.aiming);                 // if not at the suspect, at another that is silent
        TEST_ASSERT_EQUAL(may, inquiry.aimed == suspect);
        if (may) {
            TEST_ASSERT_EQUAL_INT32(to, argus_inquiry_heading_cdeg(&inquiry));
            some++;
        }
    }
    TEST_ASSERT_TRUE(some >= 6);
}

// There are not turns for all: the one that the others contradict most comes first.
void test_who_is_contradicted_most_is_aimed_first(void) {
    int some = 0;
    for (int worst = 0; worst < SONARS; worst++) {
        int32_t to = 0;
        all_fall_silent();
        e.of[worst].score[ARGUS_TEST_PEERS] = 200;
        e.of[(worst + 5) % SONARS].score[ARGUS_TEST_PEERS] = 100;
        const bool may = argus_aim(&e, &k, worst, &to);
        begin_on(0xFFFF);
        TEST_ASSERT_TRUE(inquiry.aiming);
        if (may) {
            TEST_ASSERT_EQUAL(worst, inquiry.aimed);
            some++;
        }
    }
    TEST_ASSERT_TRUE(some >= 6);
}

// Nor is one turned that hears.
void test_who_hears_is_not_aimed(void) {
    all_fall_silent();
    for (int i = 0; i < SONARS; i++) {
        comes_back(i);
    }
    inquire(0, 0, 0);
    TEST_ASSERT_EQUAL(0, aims);
}

static uint8_t byte(void) {
    return (uint8_t)rand();
}

static void any_state(unsigned seed) {
    srand(seed);
    setUp();
    mute = (unsigned)rand() & (unsigned)rand() & 0xFFFFu;
    for (int i = 0; i < SONARS; i++) {
        e.of[i].none_run = rand() % 2 == 0 ? byte() : 0;
        k.sonar[i].health = rand() % 3 == 0 ? (argus_health_t)(rand() % 6) : ARGUS_HEALTHY;
        if (rand() % 3 == 0) {
            e.of[i].score[rand() % ARGUS_TESTS] = (int16_t)(rand() % 2000);
        }
        for (int n = rand() % (8 + 1); n > 0; n--) {
            heard(i, rand() % 36000 - 17999, rand() % 5001);
        }
    }
}

// Whatever was heard and whichever hears: few aims, no heading that is none, and home in the end.
void test_aims_are_few_and_lead_home_whatever_the_state(void) {
    int aimed_at_all = 0;
    for (unsigned seed = 1; seed <= 1500; seed++) {
        any_state(seed);
        const int32_t base = rand() % 36000 - 17999;
        inquire((uint16_t)(rand() & rand()), 0, base);
        TEST_ASSERT_TRUE(aims <= AIMS_MAX);
        for (int i = 0; i < looks; i++) {
            TEST_ASSERT_TRUE(heading[i] > -18000 && heading[i] <= 18000);
        }
        TEST_ASSERT_EQUAL(base, heading[looks - 1]);
        aimed_at_all += aims;
    }
    TEST_ASSERT_TRUE_MESSAGE(aimed_at_all > 300, "hardly anything was aimed at: the test shows nothing");
}

// A suspect that yields nothing any more, and is out, would be turned for nothing.
void test_a_suspect_that_goes_out_during_the_look_is_not_aimed_again(void) {
    all_fall_silent();
    begin_on(1u << 3);
    TEST_ASSERT_TRUE(inquiry.aiming);
    mute = 1u << 3;
    k.sonar[3].health = ARGUS_DISABLED;
    for (int i = 0; inquiry.active && i < LOOKS_MAX; i++) {
        next_heading();
        TEST_ASSERT_FALSE(inquiry.active && inquiry.aiming && inquiry.aimed == 3);
    }
    TEST_ASSERT_FALSE(inquiry.active);
}
