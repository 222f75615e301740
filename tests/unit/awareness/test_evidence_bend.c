// SPDX-License-Identifier: MIT
// Rule under attack (profile argus): a sonar is bent when it sees what the others see some way aside of its
// bearing; what they do not see there either, and a well sonar's reading here, speaks against it.
#include "awareness/evidence.h"

#include <stdio.h>
#include <string.h>

#include "awareness/evidence_said.h"
#include "health.h"
#include "knowledge/angle.h"
#include "scene.h"
#include "unity.h"

#define ME 3
#define WITNESS 5
#define START_MS 0xFFFF8000u // the clock wraps in every tour
#define NONE_MM 5000

static argus_knowledge_t k;
static argus_evidence_t e;
static argus_peer_t *me;
static scene_t s;
static char text[200];

void setUp(void) {
    scene_blank(&k, &e);
    me = &e.peers.of[ME];
}

static argus_glimpse_t here(int mm) {
    return (argus_glimpse_t){.t_ms = k.sip_ms, .reading_mm = (uint16_t)mm};
}

// The witness saw so far from here, so much aside of where ME looks.
static void saw_aside(int cdeg, int mm) {
    argus_peer_t *peer = &e.peers.of[WITNESS];
    argus_glimpse_t glimpse = here(mm);
    glimpse.bearing_cdeg = (int16_t)cdeg;
    peer->seen[peer->next] = glimpse;
    peer->next = (uint8_t)((peer->next + 1) % ARGUS_GLIMPSES);
    peer->count = (uint8_t)(peer->count + 1);
}

static void weigh(argus_said_t verdict, int mm, int increment) {
    const argus_glimpse_t at = here(mm);
    argus_bend_weigh(&e, &k, ME, &at, verdict, increment);
}

// ---- one reading

// Contradicted here and seen by another 18 degrees aside: bent so far, and not in another way.
void test_what_another_sees_aside_speaks_for_that_bend(void) {
    saw_aside(1800, 1500);
    weigh(CONTRADICTED, 1500, 277);
    static const int bend[ARGUS_BENDS] = {277, 277, 277, 277, 277 + 150, 277};
    static const int told[ARGUS_BENDS] = {0, 0, 0, 0, 160, 0};
    for (int i = 0; i < ARGUS_BENDS; i++) {
        TEST_ASSERT_EQUAL(bend[i], me->bend[i]);
        TEST_ASSERT_EQUAL(told[i], me->bend_told[i]);
    }
    TEST_ASSERT_EQUAL(0, argus_bend(&e.peers, ME).well); // told of too little as yet
    weigh(CONTRADICTED, 1500, 277);
    TEST_ASSERT_EQUAL(2 * (277 + 150), argus_bend(&e.peers, ME).well);
    TEST_ASSERT_EQUAL(2 * 160, argus_bend(&e.peers, ME).told);
}

// Both sums are those of one bend: much that is told of another says nothing of this one.
void test_the_sums_of_one_bend_go_together(void) {
    me->bend[0] = 1000;
    me->bend_told[0] = 200;
    me->bend[4] = 700;
    me->bend_told[4] = 900;
    me->bend[5] = 3000;
    me->bend_told[5] = 199;
    TEST_ASSERT_EQUAL(1000, argus_bend(&e.peers, ME).well);
    TEST_ASSERT_EQUAL(200, argus_bend(&e.peers, ME).told);
}

// What a bend was told of ends with its episode, by a reading and by time.
void test_nothing_is_left_of_a_bend_that_is_over(void) {
    saw_aside(1200, 3000);
    me->bend[3] = 400;
    me->bend_told[3] = 900;
    weigh(AGREED, 1500, -93);
    TEST_ASSERT_EQUAL(0, me->bend[3]);
    TEST_ASSERT_EQUAL(0, me->bend_told[3]);
    me->bend[3] = 600;
    me->bend_told[3] = 900;
    argus_bend_fade(me);
    TEST_ASSERT_EQUAL(590, me->bend[3]);
    TEST_ASSERT_EQUAL(900, me->bend_told[3]);
    for (int i = 0; i < 300; i++) {
        argus_bend_fade(me);
        TEST_ASSERT_TRUE(me->bend[3] >= 0);
    }
    TEST_ASSERT_EQUAL(0, me->bend_told[3]);
}

// Each side and each bend for itself, through the wrap of the bearings too.
void test_each_bend_has_its_own_bearing(void) {
    static const int cdeg[ARGUS_BENDS] = {-2400, -1800, -1200, 1200, 1800, 2400};
    for (int own = -18000; own < 18000; own += 1700) {
        for (int i = 0; i < ARGUS_BENDS; i++) {
            setUp();
            saw_aside(argus_angle_wrap(own + cdeg[i]), 900);
            argus_glimpse_t at = here(900);
            at.bearing_cdeg = (int16_t)own;
            argus_bend_weigh(&e, &k, ME, &at, CONTRADICTED, 100);
            for (int j = 0; j < ARGUS_BENDS; j++) {
                snprintf(text, sizeof text, "bearing %d, bend %d, asked %d", own, cdeg[i], cdeg[j]);
                TEST_ASSERT_EQUAL_MESSAGE(i == j ? 160 : 0, me->bend_told[j], text);
            }
        }
    }
}

void test_silence_on_both_sides_speaks_a_little_for_it(void) {
    saw_aside(-1200, NONE_MM);
    weigh(CONTRADICTED, NONE_MM, 277);
    TEST_ASSERT_EQUAL(277 + 40, me->bend[2]);
    TEST_ASSERT_EQUAL(60, me->bend_told[2]);
}

void test_what_nobody_sees_there_either_speaks_against_it(void) {
    saw_aside(1200, 3000);
    me->bend[3] = 500;
    me->bend_told[3] = 500;
    weigh(CONTRADICTED, 1500, 277);
    TEST_ASSERT_EQUAL(500 + 277 - 190, me->bend[3]);
    TEST_ASSERT_EQUAL(500 - 200, me->bend_told[3]);
}

// A reading that the others bear out: a wall may fill both cones; where it does not, the axis is straight.
void test_what_is_borne_out_counts_by_what_is_aside(void) {
    static const struct {
        int aside_mm; // 0: nobody looked there
        int bend;
        int told;
    } by[] = {{1500, 500 - 93 + 60, 500 + 30}, {3000, 500 - 93 - 320, 500 - 300}, {0, 500 - 93, 500}};
    for (int i = 0; i < 3; i++) {
        setUp();
        if (by[i].aside_mm > 0) {
            saw_aside(2400, by[i].aside_mm);
        }
        me->bend[5] = 500;
        me->bend_told[5] = 500;
        weigh(AGREED, 1500, -93);
        TEST_ASSERT_EQUAL(by[i].bend, me->bend[5]);
        TEST_ASSERT_EQUAL(by[i].told, me->bend_told[5]);
    }
}

// What is borne out is no bend, however often the others see the same aside and however little they are
// worth.
void test_nothing_grows_from_what_is_borne_out(void) {
    saw_aside(1200, 1500);
    for (int increment = -93; increment <= -41; increment += 4) {
        for (int from = 0; from < 2; from++) {
            me->bend[3] = (int16_t)from;
            for (int i = 0; i < 100; i++) {
                weigh(AGREED, 1500, increment);
            }
            TEST_ASSERT_TRUE(me->bend[3] <= from);
        }
    }
}

// As in every test, what speaks for one that is out counts four times, and caution scales what is added.
void test_who_is_out_and_caution_scale_what_is_added(void) {
    saw_aside(1200, 1500);
    me->bend[3] = 1000;
    e.of[ME].out = true;
    weigh(AGREED, 1500, -93);
    TEST_ASSERT_EQUAL(1000 - 4 * 33, me->bend[3]);
    e.of[ME].out = false;
    for (int percent = 25; percent <= 400; percent *= 2) {
        argus_evidence_set_caution(&e, percent);
        argus_bend_forget(me);
        weigh(CONTRADICTED, 1500, 277);
        TEST_ASSERT_EQUAL((277 + 150) * 100 / percent, me->bend[3]);
        TEST_ASSERT_EQUAL(160 * 100 / percent, me->bend_told[3]);
    }
}

void test_what_moves_about_makes_it_count_a_quarter(void) {
    saw_aside(1800, 1500);
    argus_note_unrest(&e, &k, WITNESS);
    weigh(CONTRADICTED, 1500, 277 / 4);
    TEST_ASSERT_EQUAL(277 / 4 + 150 / 4, me->bend[4]);
    TEST_ASSERT_EQUAL(160 / 4, me->bend_told[4]);
}

void test_the_sums_stay_within_their_bounds(void) {
    saw_aside(1800, 1500);
    saw_aside(-1800, 3000);
    for (int i = 0; i < 200; i++) {
        weigh(CONTRADICTED, 1500, 277);
        weigh(CONTRADICTED, 1500, 29);
        for (int b = 0; b < ARGUS_BENDS; b++) {
            TEST_ASSERT_TRUE(me->bend[b] >= 0 && me->bend[b] <= 3000);
            TEST_ASSERT_TRUE(me->bend_told[b] >= 0 && me->bend_told[b] <= 900);
        }
    }
    TEST_ASSERT_EQUAL(3000, me->bend[4]);
    TEST_ASSERT_EQUAL(900, me->bend_told[4]);
    argus_bend_forget(me);
    TEST_ASSERT_EQUAL(0, argus_bend(&e.peers, ME).well + me->bend_told[4]);
}

// One that comes back was mended: its axis is not held against it, and what it saw before against nobody.
void test_who_is_back_is_bent_no_more(void) {
    static const int reading_mm[ARGUS_SONARS];
    scene_init(&s, 1, START_MS);
    for (int back = 0; back < 2; back++) {
        const argus_health_t health = back ? ARGUS_HEALTHY : ARGUS_DISABLED;
        put_health(&s.k.sonar[ME], health, ARGUS_KIND_NONE, s.k.sip_ms);
        s.e.peers.of[ME].bend[1] = 2000;
        argus_seen_forget(&s.e.peers.of[ME]);
        for (int i = 0; i < 9; i++) {
            argus_seen_note(&s.e.peers.of[ME],
                            (argus_glimpse_t){.t_ms = START_MS, .x_mm = (uint16_t)(99 * i)});
        }
        scene_say(&s, 1u << ME, reading_mm);
        TEST_ASSERT_EQUAL(!back, s.e.peers.of[ME].bend[1] > 0);
        TEST_ASSERT_EQUAL(back ? 1 : 10, s.e.peers.of[ME].count);
    }
}

// ---- a room

static int named_wrong;
static int most;

// What becomes of one sonar in a tour of the office: how far its bend came, and whether it was ever wrong.
static void tour(unsigned seed, int sonar, int bent_deg, scene_fault_t fault) {
    scene_init(&s, seed, START_MS);
    scene_office(&s);
    s.bent_deg[sonar] = bent_deg;
    s.fault[sonar] = fault;
    most = 0;
    bool wrong = false;
    for (int leg = 0; leg < 6 && s.convicted[sonar] == ARGUS_KIND_NONE; leg++) {
        scene_tour(&s, 1);
        most = argus_max(most, argus_bend(&s.e.peers, sonar).well);
        wrong = wrong || argus_evidence_names(&s.e, sonar) == ARGUS_KIND_WRONG;
    }
    named_wrong += wrong || s.convicted[sonar] == ARGUS_KIND_WRONG;
}

// Of those with a bent axis nearly all come to what names one, and of those that are well hardly any.
void test_a_bent_axis_shows_in_a_room_and_only_there(void) { // soak
    static const int bends[] = {-25, -20, -15, 15, 20, 25};
    const scene_fault_t none = {ARGUS_KIND_NONE, 0};
    int bent = 0;
    int well = 0;
    named_wrong = 0;
    for (unsigned seed = 1; seed <= 48; seed++) {
        const int sonar = (int)(seed * 5 % ARGUS_SONARS);
        tour(seed, sonar, bends[seed % 6], none);
        bent += most >= 1100;
    }
    const int wrong = named_wrong;
    for (unsigned seed = 1; seed <= 48; seed++) {
        tour(seed, (int)(seed * 5 % ARGUS_SONARS), 0, none);
        well += most >= 1100;
    }
    snprintf(text, sizeof text, "of 48: %d bent, %d of them wrong at last; %d well", bent, wrong, well);
    puts(text);
    TEST_ASSERT_TRUE_MESSAGE(bent >= 40 && wrong >= 40 && well <= 2, text);
}

// A fault of another kind is seldom taken for a bent axis.
void test_other_faults_are_seldom_called_wrong_for_a_bend(void) { // soak
    static const scene_fault_t faults[] = {{ARGUS_KIND_SLOW, 3},
                                           {ARGUS_KIND_SLOW, 8},
                                           {ARGUS_KIND_INTERMITTENT, 50},
                                           {ARGUS_KIND_GARBAGE, 0},
                                           {ARGUS_KIND_OFF, 0}};
    named_wrong = 0;
    for (unsigned seed = 1; seed <= 60; seed++) {
        tour(seed, (int)(seed * 5 % ARGUS_SONARS), 0, faults[seed % 5]);
    }
    snprintf(text, sizeof text, "of 60 with other faults %d wrong at last", named_wrong);
    puts(text);
    TEST_ASSERT_TRUE_MESSAGE(named_wrong <= 3, text);
}
