// SPDX-License-Identifier: MIT
// Rule under attack: an array that goes dark at once has failed; one that drives out of a door has not.
#include "awareness/common.h"

#include <string.h>

#include "awareness/evidence.h"
#include "awareness/odds.h"
#include "unity.h"

#define NONE 5000
#define FRONT 0x00FFu
#define REAR 0xFF00u

static argus_common_t c;
static argus_evidence_t e;
static argus_knowledge_t k;
static argus_sip_t sip;
static uint32_t now_ms;
static int x_mm;
static int strikes;
static int range_mm[16];

void setUp(void) {
    argus_common_init(&c);
    argus_evidence_init(&e);
    argus_knowledge_init(&k);
    memset(&sip, 0, sizeof sip);
    now_ms = 0xFFFFF000u;
    x_mm = 0;
    strikes = 0;
    for (int i = 0; i < 16; i++) {
        range_mm[i] = 1200 + 10 * i;
        k.sonar[i].health = ARGUS_HEALTHY;
    }
}

// Each SIP lists two of each array, so that each sonar comes every 400 ms.
static void drive(int sips, int speed_mm_s) {
    for (int i = 0; i < sips; i++) {
        static int at;
        now_ms += 100;
        x_mm += speed_mm_s / 10;
        sip.x_raw = (uint16_t)x_mm;
        sip.vel_left_mm_s = sip.vel_right_mm_s = (int16_t)speed_mm_s;
        sip.sonar_count = 0;
        for (int j = 0; j < 4; j++) {
            const int sonar = at % 4 * 2 + j % 2 + (j < 2 ? 0 : 8);
            sip.sonar[sip.sonar_count].number = (uint8_t)sonar;
            sip.sonar[sip.sonar_count++].range_mm = (uint16_t)range_mm[sonar];
        }
        at++;
        argus_knowledge_sip(&k, &sip, 1000, now_ms);
        argus_common_sip(&c, &e, &k);
        strikes += argus_common_strikes(&c, argus_robot_forward(k.robot));
    }
}

static void darken(unsigned sonars) {
    for (int i = 0; i < 16; i++) {
        range_mm[i] = (sonars >> i & 1u) != 0 ? NONE : range_mm[i];
    }
}

static unsigned convicted(void) {
    unsigned mask = 0;
    for (int i = 0; i < 16; i++) {
        mask |= argus_common_convicts(&c, i) ? 1u << i : 0u;
    }
    return mask;
}

void test_what_all_sonars_of_an_array_heard_ends_at_once(void) {
    drive(20, 200);
    darken(FRONT);
    drive(5, 200);
    TEST_ASSERT_EQUAL_MESSAGE(1, strikes, "within a round");
    TEST_ASSERT_EQUAL(0, convicted());
    TEST_ASSERT_TRUE(argus_common_excuses(&c, 12));
    TEST_ASSERT_FALSE(argus_common_excuses(&c, 3));
    drive(10, 0);
    TEST_ASSERT_EQUAL_HEX(FRONT, convicted());
    TEST_ASSERT_FALSE(argus_common_excuses(&c, 12));
    TEST_ASSERT_EQUAL_MESSAGE(1, strikes, "news once");
}

void test_the_rear_array_likewise_but_it_does_not_stop_the_robot(void) {
    drive(20, 200);
    darken(REAR);
    drive(20, 200);
    TEST_ASSERT_EQUAL(0, strikes);
    TEST_ASSERT_EQUAL_HEX(REAR, convicted());
}

// Whoever goes on hearing has not failed with them, and is not called what the dead say of it.
void test_most_of_an_array_that_fall_silent_at_once_are_convicted(void) {
    for (unsigned living = 0; living < 8; living++) {
        setUp();
        drive(20, 200);
        darken(FRONT & ~(1u << living));
        drive(5, 200);
        TEST_ASSERT_EQUAL(1, strikes);
        TEST_ASSERT_TRUE(argus_common_excuses(&c, (int)living));
        drive(10, 0);
        TEST_ASSERT_EQUAL_HEX(FRONT & ~(1u << living), convicted());
        TEST_ASSERT_FALSE(argus_common_excuses(&c, (int)living));
    }
}

static unsigned doubted(void) {
    unsigned mask = 0;
    for (int i = 0; i < 16; i++) {
        mask |= argus_common_doubts(&c, i) ? 1u << i : 0u;
    }
    return mask;
}

// Each of them missed so many of ten echoes that others heard.
static void make_deaf(unsigned sonars, int missed) {
    for (int i = 0; i < 16; i++) {
        for (int n = 0; n < 10 && (sonars >> i & 1u) != 0; n++) {
            for (int silences = n == 0 ? missed * 10 : 0; silences > 0; silences--) {
                argus_odds_note_deaf(&e, i, true);
            }
            argus_odds_note_deaf(&e, i, false);
        }
    }
}

// What sonars that are often silent lose at once may be a surface that they miss: it is reason for doubt, and
// proof when the robot has gone on and they hear nothing still. Standing there tells nothing more.
void test_deaf_ones_that_go_silent_together_are_given_up_when_the_way_goes_on(void) {
    make_deaf(FRONT, 4);
    drive(20, 200);
    darken(FRONT);
    drive(80, 0);
    TEST_ASSERT_EQUAL(0, convicted());
    TEST_ASSERT_EQUAL_HEX(FRONT, doubted());
    drive(30, 200);
    TEST_ASSERT_EQUAL_HEX(FRONT, convicted());
}

// A wall that only others hear tells less of an array whose sonars abeam often miss one; the rest of it does
// not matter.
void test_a_wall_beside_tells_less_where_those_abeam_are_deaf(void) {
    const unsigned abeam = 1u << 0 | 1u << 7;
    for (unsigned deaf = 0; deaf < 2; deaf++) {
        setUp();
        make_deaf(abeam, deaf != 0 ? 9 : 0);
        make_deaf(FRONT & ~abeam, deaf != 0 ? 0 : 9);
        make_deaf(REAR, 0);
        darken(FRONT);
        drive(140, 200);
        TEST_ASSERT_EQUAL_HEX(deaf != 0 ? 0u : FRONT, convicted());
    }
}

// ... on the side of that wall.
void test_a_wall_tells_by_those_on_its_own_side(void) {
    for (int deaf_left = 0; deaf_left < 2; deaf_left++) {
        setUp();
        make_deaf(deaf_left != 0 ? 1u << 0 : 1u << 7, 9);
        make_deaf((FRONT | REAR) & ~(deaf_left != 0 ? 1u << 0 : 1u << 7), 0);
        darken(FRONT);
        drive(40, 200);
        const int32_t left_mm = c.of[0].passed[1].mm, right_mm = c.of[0].passed[0].mm;
        TEST_ASSERT_TRUE(deaf_left != 0 ? left_mm < right_mm : right_mm < left_mm);
    }
}

// Five or six may be what a person leaves behind: they are given up when their silence lasts.
void test_five_of_an_array_are_given_up_later(void) {
    for (unsigned hearing = 2; hearing < 4; hearing++) {
        setUp();
        const unsigned dark = FRONT & ~((1u << hearing) - 1);
        drive(20, 200);
        darken(dark);
        drive(20, 200);
        TEST_ASSERT_EQUAL(1, strikes);
        TEST_ASSERT_EQUAL(0, convicted());
        drive(30, 0);
        TEST_ASSERT_EQUAL_HEX(dark, convicted());
    }
}

void test_four_of_an_array_may_be_behind_a_person(void) {
    for (unsigned first = 0; first < 5; first++) {
        setUp();
        drive(20, 200);
        darken(0xFu << first);
        drive(60, 200);
        TEST_ASSERT_EQUAL(0, convicted());
        TEST_ASSERT_EQUAL(0, strikes);
        TEST_ASSERT_FALSE(argus_common_excuses(&c, 12));
    }
}

void test_echoes_that_end_one_after_the_other_are_no_proof(void) {
    drive(20, 200);
    for (int i = 0; i < 4; i++) {
        darken(1u << i | 1u << (7 - i));
        drive(8, 200);
    }
    drive(20, 0);
    TEST_ASSERT_EQUAL(0, convicted());
    TEST_ASSERT_TRUE_MESSAGE(argus_common_excuses(&c, 12), "it may have");
}

void test_a_wall_that_goes_out_of_range_is_no_proof(void) {
    for (int i = 0; i < 16; i++) {
        range_mm[i] = 4900;
    }
    drive(20, 200);
    darken(REAR);
    drive(60, 200);
    TEST_ASSERT_EQUAL(0, convicted());
}

// Those ahead lost theirs some time ago, as in a turn; one abeam drives away from what it still heard.
void test_the_last_of_them_may_lose_a_far_echo(void) {
    range_mm[0] = 4900;
    drive(20, 200);
    for (int i = 1; i < 8; i += 3) {
        darken(7u << i & FRONT);
        drive(8, 200);
    }
    drive(12, 200);
    darken(FRONT);
    drive(20, 200);
    TEST_ASSERT_EQUAL(0, convicted());
}

void test_where_nothing_was_heard_nothing_ends(void) {
    darken(0xFFFFu & ~6u);
    drive(20, 200);
    darken(0xFFFFu);
    drive(200, 200);
    TEST_ASSERT_EQUAL(0, convicted());
}

void test_who_passes_a_wall_that_others_hear_is_convicted(void) {
    darken(FRONT);
    drive(30, 200);
    TEST_ASSERT_EQUAL(0, convicted());
    drive(30, 200);
    TEST_ASSERT_EQUAL_HEX(FRONT, convicted());
}

// So it proves nothing, but the array is not relied on until one of it has heard something.
void test_what_goes_along_on_one_side_may_be_a_person(void) {
    darken(FRONT | 0x0100u);
    drive(20, 200);
    TEST_ASSERT_EQUAL(0, doubted());
    drive(180, 200);
    TEST_ASSERT_EQUAL(0, convicted());
    TEST_ASSERT_EQUAL_HEX(FRONT, doubted());
    TEST_ASSERT_EQUAL(1, strikes);
    range_mm[5] = 2000;
    drive(8, 200);
    TEST_ASSERT_EQUAL(0, doubted());
}

// Two of those ahead heard something, and come nearer to it: they should hear it still. What only one heard
// may be crosstalk, what they pass by is not heard any more.
void test_what_was_heard_ahead_does_not_vanish(void) {
    static const struct {
        unsigned hear;
        int sips;
        int first_mm;
        bool doubted;
    } by[] = {{1u << 3 | 1u << 4, 12, 1500, true},
              {1u << 4, 12, 1500, false},
              {1u << 0 | 1u << 7, 12, 1500, false},
              {1u << 3 | 1u << 4, 60, 1500, false},
              {1u << 3 | 1u << 4, 12, 4700, false}}; // echoes from so far come and go
    for (size_t i = 0; i < sizeof by / sizeof by[0]; i++) {
        setUp();
        darken(0xFFFFu & ~by[i].hear);
        for (int k_sip = 0; k_sip < by[i].sips; k_sip++) {
            range_mm[0] = range_mm[7] = (by[i].hear & 0x81u) != 0 ? 1300 : NONE;
            range_mm[3] = range_mm[4] = NONE;
            for (int s = 3; s <= 4; s++) {
                range_mm[s] = (by[i].hear >> s & 1u) != 0 ? by[i].first_mm - 20 * k_sip : NONE;
            }
            drive(1, 200);
        }
        darken(0xFFFFu);
        drive(30, 200);
        TEST_ASSERT_EQUAL_HEX(by[i].doubted ? FRONT : 0u, doubted());
        TEST_ASSERT_EQUAL(0, convicted());
    }
}

// A touch alone is reason for doubt where all of an array heard nothing, and for none where one hears.
void test_what_the_body_met_should_have_been_heard(void) {
    drive(20, 200);
    argus_common_touched(&c, FRONT);
    drive(8, 0);
    TEST_ASSERT_EQUAL(0, doubted());
    darken(0xFFFFu);
    setUp();
    darken(0xFFFFu);
    drive(20, 200);
    argus_common_touched(&c, FRONT);
    drive(1, 0);
    TEST_ASSERT_EQUAL_HEX(FRONT, doubted());
    TEST_ASSERT_EQUAL(0, convicted());
}

// ... nor is what was driven between two readings that lie too far apart: what stood between them nobody
// knows.
void test_what_is_passed_between_readings_too_far_apart_does_not_count(void) {
    darken(FRONT);
    drive(80, 1100); // 440 mm from one reading to the next
    TEST_ASSERT_EQUAL(0, convicted());
    setUp();
    darken(FRONT);
    drive(80, 900);
    TEST_ASSERT_EQUAL_HEX(FRONT, convicted());
}

// One that is convicted already is no news when the doubt comes, too.
void test_a_doubt_of_what_is_convicted_is_no_news(void) {
    for (int proven = 0; proven < 2; proven++) {
        setUp();
        darken(FRONT);
        drive(20, 0);
        TEST_ASSERT_EQUAL(0, doubted());
        c.of[0].proven = proven != 0;
        argus_common_touched(&c, FRONT);
        drive(1, 0);
        TEST_ASSERT_EQUAL_HEX(FRONT, doubted());
        TEST_ASSERT_EQUAL(proven != 0 ? 0 : 1, strikes);
    }
}

void test_standing_beside_a_wall_is_no_way_along_it(void) {
    darken(FRONT);
    drive(600, 0);
    TEST_ASSERT_EQUAL(0, convicted());
}

static void turn_until_dark(unsigned sonars) {
    drive(20, 0);
    for (int i = 0; i < 30; i++) {
        sip.heading_raw = (int16_t)(sip.heading_raw + 68); // 60 degrees/s
        now_ms += 100;
        sip.vel_left_mm_s = -172;
        sip.vel_right_mm_s = 172;
        sip.sonar_count = 0;
        for (int j = 0; j < 4; j++) {
            const int sonar = i % 4 * 2 + j % 2 + (j < 2 ? 0 : 8);
            sip.sonar[sip.sonar_count].number = (uint8_t)sonar;
            sip.sonar[sip.sonar_count++].range_mm =
                (uint16_t)(i > 15 && (sonars >> sonar & 1u) != 0 ? NONE : 900);
        }
        argus_knowledge_sip(&k, &sip, 1000, now_ms);
        argus_common_sip(&c, &e, &k);
        TEST_ASSERT_FALSE(argus_common_strikes(&c, argus_robot_forward(k.robot)));
    }
}

// ... nor is it proved when the robot drives straight on.
void test_in_a_turn_anything_may_end(void) {
    for (unsigned all = 0; all < 2; all++) {
        setUp();
        turn_until_dark(FRONT & ~(all != 0 ? 0u : 1u));
        TEST_ASSERT_EQUAL(0, convicted());
        darken(FRONT & ~(all != 0 ? 0u : 1u));
        drive(10, 200);
        TEST_ASSERT_EQUAL(0, convicted());
    }
}

void test_who_hears_again_is_left_to_the_evidence(void) {
    drive(20, 200);
    darken(FRONT);
    drive(20, 0);
    TEST_ASSERT_EQUAL_HEX(FRONT, convicted());
    for (int i = 0; i < 8; i++) {
        k.sonar[i].health = ARGUS_DISABLED;
    }
    range_mm[3] = 800;
    drive(5, 0);
    TEST_ASSERT_EQUAL(0, convicted());
}

// An AmigoBot has one array for both ends: 0 to 5 look ahead and abeam, 6 and 7 astern.
#define AMIGO_AHEAD 0x3Fu
#define AMIGO_ALL 0xFFu

static void become_amigo_bot(void) {
    k.robot = argus_robot_find("amigo-sh");
    k.sonars = argus_robot_sonars(k.robot);
}

void test_an_echo_astern_shows_no_living_end_ahead(void) {
    become_amigo_bot();
    drive(20, 200);
    darken(AMIGO_AHEAD);
    drive(15, 200);
    TEST_ASSERT_EQUAL_HEX(AMIGO_AHEAD, convicted());
}

// Where nothing was heard before there is a doubt alone; an echo behind does not end it, one ahead does.
void test_an_echo_astern_ends_no_doubt_of_what_looks_ahead(void) {
    for (int ahead = 0; ahead < 2; ahead++) {
        setUp();
        become_amigo_bot();
        darken(AMIGO_ALL);
        drive(20, 200);
        argus_common_touched(&c, argus_robot_ahead(k.robot));
        drive(4, 200);
        TEST_ASSERT_TRUE(argus_common_doubts(&c, 2));
        range_mm[ahead != 0 ? 2 : 6] = 1500;
        drive(4, 200);
        TEST_ASSERT_EQUAL(ahead == 0, argus_common_doubts(&c, 2));
        TEST_ASSERT_FALSE(argus_common_doubts(&c, 6));
    }
}

// One astern that has heard something since lives; else all have failed together.
void test_what_looks_astern_fails_with_the_rest_unless_it_has_heard_since(void) {
    for (int lives = 0; lives < 2; lives++) {
        setUp();
        become_amigo_bot();
        drive(20, 200);
        darken(AMIGO_AHEAD);
        drive(lives != 0 ? 12 : 3, 200);
        darken(AMIGO_ALL);
        drive(30, 200);
        TEST_ASSERT_EQUAL_HEX(lives != 0 ? AMIGO_AHEAD : AMIGO_ALL, convicted());
    }
}
