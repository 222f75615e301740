// SPDX-License-Identifier: MIT
// Rule under attack (profile argus): a fault is convicted by the test made for it and by nothing else; what
// is healthy is never convicted, whatever moves, is far, is smooth or echoes across.
#include "awareness/clutter.h"
#include "awareness/evidence.h"
#include "knowledge/angle.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "awareness/numbers.h"
#include "awareness/odds.h"
#include "health.h"
#include "scene.h"
#include "unity.h"

#define LEGS 8
#define SEEDS 3
#define START_MS 0xFFFF8000u // the clock wraps in every tour

static scene_t s;
static char text[480];

static const char *told(const char *what, int sonar, unsigned seed) {
    snprintf(text, sizeof text, "%s, sonar %d, seed %u: %s", what, sonar, seed, scene_text(&s));
    return text;
}

static void start(unsigned seed) {
    scene_init(&s, seed, START_MS);
    scene_office(&s);
}

// The fault begins on the way and is named; no other may be convicted beside it.
static void names(argus_fault_kind_t kind, int value) {
    static const int sonars[] = {2, 4, 11};
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        for (int i = 0; i < 3; i++) {
            start(seed * 16 + (unsigned)sonars[i]);
            scene_tour(&s, 2);
            scene_inject(&s, sonars[i], kind, value);
            bool named = false;
            for (int leg = 0; leg < LEGS; leg++) {
                scene_tour(&s, 1);
                named =
                    named || s.convicted[sonars[i]] == kind || argus_evidence_names(&s.e, sonars[i]) == kind;
            }
            TEST_ASSERT_TRUE_MESSAGE(named, told(argus_name(ARGUS_NAME_KIND, kind), sonars[i], seed));
            for (int k = 0; k < ARGUS_SONARS; k++) {
                TEST_ASSERT_TRUE_MESSAGE(k == sonars[i] || s.convicted[k] == ARGUS_KIND_NONE,
                                         told(argus_name(ARGUS_NAME_KIND, kind), k, seed));
            }
            TEST_ASSERT_EQUAL_STRING("", s.broken);
        }
    }
}

void test_off(void) {
    names(ARGUS_KIND_OFF, 0);
}

void test_stuck(void) { // soak
    names(ARGUS_KIND_STUCK, 0);
}

void test_stuck_at_a_value_far_from_what_it_read(void) { // soak
    names(ARGUS_KIND_STUCK, 1730);
}

void test_wrong_by_half(void) { // soak
    names(ARGUS_KIND_WRONG, 50);
}

void test_garbage(void) { // soak
    names(ARGUS_KIND_GARBAGE, 0);
}

void test_slow(void) { // soak
    names(ARGUS_KIND_SLOW, 6);
}

void test_intermittent(void) { // soak
    names(ARGUS_KIND_INTERMITTENT, 60);
}

static void stays_quiet(const char *what, void (*prepare)(void), void (*each_leg)(void)) {
    for (unsigned seed = 1; seed <= 2 * SEEDS; seed++) {
        start(seed);
        prepare();
        for (int leg = 0; leg < LEGS; leg++) {
            if (each_leg != NULL) {
                each_leg();
            }
            scene_tour(&s, 1);
        }
        TEST_ASSERT_TRUE_MESSAGE(scene_all_quiet(&s), told(what, -1, seed));
        TEST_ASSERT_EQUAL_STRING("", s.broken);
    }
}

static void as_it_is(void) {
}

static void rough_noise(void) {
    s.noise_mm = 20;
}

static void smooth_walls(void) {
    s.smooth_deg = 25;
}

static void much_crosstalk(void) {
    s.crosstalk_permille = 30;
}

// A person walks across the way again and again, nearer than every wall.
static void walk_across(void) {
    const double side = scene_random(&s, 2) == 0 ? 1 : -1;
    const double ahead = 700 + scene_random(&s, 900);
    const double speed = 600 + scene_random(&s, 900);
    const double along = s.th + side * 1.57;
    s.person_r = 200;
    s.person_x = s.x + ahead * cos(s.th) + 1500 * cos(along);
    s.person_y = s.y + ahead * sin(s.th) + 1500 * sin(along);
    s.person_vx = -speed * cos(along);
    s.person_vy = -speed * sin(along);
}

void test_healthy_in_an_office_with_noise_and_crosstalk(void) {
    stays_quiet("office", as_it_is, NULL);
}

void test_healthy_with_four_times_the_noise(void) { // soak
    stays_quiet("noise", rough_noise, NULL);
}

void test_healthy_with_three_times_the_crosstalk(void) {
    stays_quiet("crosstalk", much_crosstalk, NULL);
}

void test_healthy_between_smooth_walls(void) {
    stays_quiet("smooth", smooth_walls, NULL);
}

void test_healthy_while_somebody_walks_about(void) {
    stays_quiet("person", as_it_is, walk_across);
}

// 5000 everywhere says nothing against any: not a name, not even with a person who comes and goes.
void test_an_open_hall_convicts_nobody(void) {
    for (int person = 0; person < 2; person++) {
        scene_init(&s, 5, START_MS);
        for (int leg = 0; leg < LEGS; leg++) {
            if (person != 0) {
                walk_across();
            }
            scene_tour(&s, 1);
        }
        TEST_ASSERT_TRUE_MESSAGE(scene_all_quiet(&s), told("hall", -1, 5));
        TEST_ASSERT_TRUE(person != 0 || s.named == 0);
    }
}

// A sonar that hears nothing at all where all others hear nothing either is not suspected of it; from a hall
// into a room the same sonar is.
void test_off_shows_only_where_others_hear(void) {
    scene_init(&s, 7, START_MS);
    s.noise_mm = 5;
    s.fault[3].kind = ARGUS_KIND_OFF;
    scene_tour(&s, LEGS);
    TEST_ASSERT_TRUE(scene_all_quiet(&s));
    TEST_ASSERT_EQUAL_HEX16(0, s.named);
    scene_box(&s, s.x - 2500, s.y - 2500, s.x + 2500, s.y + 2500);
    scene_tour(&s, LEGS);
    TEST_ASSERT_TRUE(s.convicted[3] == ARGUS_KIND_OFF || argus_evidence_names(&s.e, 3) == ARGUS_KIND_OFF);
}

static void at_rest(uint32_t ms) {
    scene_run(&s, ms);
}

// The first run without an echo, the first jump: a look may settle them, they prove nothing.
void test_one_look_at_rest_convicts_nobody(void) {
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        start(seed);
        at_rest(3000);
        s.fault[3] = (scene_fault_t){ARGUS_KIND_OFF, 0};
        s.fault[5] = (scene_fault_t){ARGUS_KIND_WRONG, 50};
        at_rest(30000);
        TEST_ASSERT_TRUE_MESSAGE(scene_all_quiet(&s), told("at rest", 3, seed));
    }
}

// Of those that see one bearing the odd one is named, and none beside it.
void test_the_odd_one_of_three_is_named(void) {
    for (int sonar = 2; sonar <= 5; sonar++) {
        start((unsigned)sonar);
        s.crosstalk_permille = 0;
        at_rest(3000);
        s.fault[sonar] = (scene_fault_t){ARGUS_KIND_WRONG, 50};
        for (int i = 0; i < 4; i++) {
            scene_look(&s);
        }
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(1u << sonar, s.named, told("named", sonar, (unsigned)sonar));
    }
}

// Two that disagree, and no other: neither is named, however often and wherever they do.
void test_two_without_a_third_witness_name_nobody(void) {
    static const int pair[][2] = {{3, 4}, {7, 8}, {0, 15}, {1, 2}};
    for (int i = 0; i < 4; i++) {
        for (int wrong = 0; wrong < 2; wrong++) {
            start((unsigned)(10 + i));
            s.crosstalk_permille = 0;
            s.mute = ~(1u << pair[i][0] | 1u << pair[i][1]);
            s.fault[pair[i][wrong]] = (scene_fault_t){ARGUS_KIND_WRONG, 50};
            scene_tour(&s, LEGS);
            TEST_ASSERT_EQUAL_HEX16_MESSAGE(0, s.named, told("named", pair[i][wrong], (unsigned)(10 + i)));
            TEST_ASSERT_TRUE(scene_all_quiet(&s));
        }
    }
}

static int score_sum(int sonar) {
    int sum = 0;
    for (int test = 0; test < ARGUS_TESTS; test++) {
        sum += s.e.of[sonar].score[test];
    }
    return sum;
}

// The robot may have been moved in the gap, the sonars were not mended by it.
void test_restart_forgets_the_pings_and_keeps_what_they_told(void) {
    start(3);
    s.fault[3] = (scene_fault_t){ARGUS_KIND_WRONG, 50};
    scene_look(&s);
    scene_look(&s);
    TEST_ASSERT_TRUE(s.e.of[3].score[ARGUS_TEST_PEERS] > 0);
    static argus_case_t before[ARGUS_SONARS];
    memcpy(before, s.e.of, sizeof before);
    argus_evidence_restart(&s.e);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        TEST_ASSERT_EQUAL(0, s.e.pings[i].count);
    }
    TEST_ASSERT_EQUAL_MEMORY(before, s.e.of, sizeof before);
}

void test_forgetting_one_sonar_leaves_the_others_alone(void) {
    start(3);
    s.fault[3] = (scene_fault_t){ARGUS_KIND_WRONG, 50};
    scene_look(&s);
    scene_look(&s);
    const int other = score_sum(4);
    argus_evidence_forget(&s.e, 3);
    TEST_ASSERT_EQUAL(0, score_sum(3));
    TEST_ASSERT_EQUAL(other, score_sum(4));
    TEST_ASSERT_FALSE(argus_evidence_suspects(&s.e, 3));
}

static int reading[ARGUS_SONARS];

// ---- its own readings, by hand

// Drives straight at a wall; what sonar 3 says is `of` the firing number.
static void drive_at_wall(int count, int (*of)(int n)) {
    scene_init(&s, 1, START_MS);
    s.v_mm_s = 200;
    for (int n = 0; n < count; n++) {
        for (int sip = 0; sip < 3; sip++) { // one firing in three SIPs
            s.x += 20;
            reading[3] = of(n);
            scene_say(&s, sip == 0 ? 1u << 3 : 0u, reading);
        }
    }
}

static int true_to_the_way(int n) {
    return 3000 - 59 * n;
}

static int late_by_eight(int n) {
    return true_to_the_way(n < 12 ? n : n - 8);
}

static int the_same(int n) {
    (void)n;
    return 2000;
}

static int nearest(int n) {
    (void)n;
    return 100;
}

static int jumping(int n) {
    static const int mm[] = {700, 2900, 1500, 4200, 300, 3500, 2200, 1000, 4700};
    return mm[n * 4 % 9] + 13 * n; // none comes again
}

static int every_other_missing(int n) {
    return n > 5 && n % 2 == 0 ? 5000 : true_to_the_way(n);
}

void test_a_range_that_shrinks_with_the_way_is_evidence_of_nothing(void) {
    drive_at_wall(40, true_to_the_way);
    TEST_ASSERT_FALSE(argus_evidence_suspects(&s.e, 3));
}

void test_a_trail_that_comes_again_is_late(void) {
    drive_at_wall(22, late_by_eight);
    TEST_ASSERT_EQUAL(ARGUS_KIND_SLOW, argus_evidence_names(&s.e, 3));
}

void test_a_range_that_stays_though_the_robot_drives_is_stuck(void) {
    drive_at_wall(20, the_same);
    TEST_ASSERT_EQUAL(ARGUS_KIND_STUCK, argus_evidence_convicts(&s.e, 3));
}

// What clips at the nearest range stays there for many reasons.
void test_the_nearest_range_is_not_stuck(void) {
    drive_at_wall(40, nearest);
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_evidence_names(&s.e, 3));
}

void test_readings_that_match_none_before_are_garbage(void) {
    drive_at_wall(40, jumping);
    TEST_ASSERT_EQUAL(ARGUS_KIND_GARBAGE, argus_evidence_convicts(&s.e, 3));
}

// What reads at random is not without an echo five times in a row: in the open, too, garbage that was given
// up can end. (What speaks for it counts four times then.) A suspect may have gone silent as well: nothing
// ends.
void test_a_silence_takes_garbage_back_of_one_that_is_out(void) {
    for (int out = 0; out < 2; out++) {
        drive_at_wall(out != 0 ? 40 : 10, jumping);
        const int score = s.e.of[3].score[ARGUS_TEST_GARBAGE];
        TEST_ASSERT_EQUAL(out != 0, score >= argus_bounds[ARGUS_TEST_GARBAGE].convincing);
        TEST_ASSERT_TRUE(score >= argus_bounds[ARGUS_TEST_GARBAGE].naming);
        for (int n = 1; n <= 9; n++) { // four, an echo, four: it begins anew
            reading[3] = n == 5 ? 400 : 5000;
            scene_say(&s, 1u << 3, reading);
            s.e.of[3].score[ARGUS_TEST_GARBAGE] =
                n == 5 ? (int16_t)score : s.e.of[3].score[ARGUS_TEST_GARBAGE];
            TEST_ASSERT_EQUAL(score, s.e.of[3].score[ARGUS_TEST_GARBAGE]);
        }
        scene_say(&s, 1u << 3, reading);
        TEST_ASSERT_EQUAL(out != 0 ? score + 4 * argus_odds_of(&s.e, &s.k, 3, ARGUS_TEST_GARBAGE, false)
                                   : score,
                          s.e.of[3].score[ARGUS_TEST_GARBAGE]);
        for (int n = 0; n < 12; n++) {
            scene_say(&s, 1u << 3, reading);
        }
        TEST_ASSERT_EQUAL(out != 0 ? 0 : score, s.e.of[3].score[ARGUS_TEST_GARBAGE]);
    }
}

static int one_missing(int n) {
    return n == 9 ? 5000 : true_to_the_way(n);
}

static int three_missing(int n) {
    return n == 9 || n == 12 || n == 15 ? 5000 : true_to_the_way(n);
}

// In motion one gap is an edge that passes by, three name it, and no number of them convicts it.
void test_gaps_in_one_trail_name_it_and_in_motion_convict_nobody(void) {
    drive_at_wall(20, one_missing);
    TEST_ASSERT_TRUE(s.e.of[3].score[ARGUS_TEST_DROPOUT] > 0);
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_evidence_names(&s.e, 3));
    drive_at_wall(20, three_missing);
    TEST_ASSERT_EQUAL(ARGUS_KIND_INTERMITTENT, argus_evidence_names(&s.e, 3));
    drive_at_wall(40, every_other_missing);
    TEST_ASSERT_EQUAL(ARGUS_KIND_INTERMITTENT, argus_evidence_names(&s.e, 3));
    TEST_ASSERT_EQUAL(0, s.e.of[3].score[ARGUS_TEST_GARBAGE]);
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, s.convicted[3]);
}

// Nothing heard on another heading is no gap on this one.
void test_a_look_aside_that_hears_nothing_is_no_gap(void) {
    for (int aside = 0; aside < 2; aside++) {
        scene_init(&s, 1, START_MS);
        for (int n = 0; n < 24; n++) {
            const bool none = n > 7 && n % 8 < 3;
            s.th = none && aside != 0 ? 0.35 : 0;
            reading[3] = none ? 5000 : 1500;
            scene_say(&s, 1u << 3, reading);
        }
        TEST_ASSERT_EQUAL(aside == 0, s.e.of[3].score[ARGUS_TEST_DROPOUT] > 0);
    }
}

// While something moves about the robot it may have stood in between.
void test_a_gap_in_unrest_counts_for_nothing(void) {
    for (int unrest = 0; unrest < 2; unrest++) {
        scene_init(&s, 1, START_MS);
        for (int n = 0; n < 24; n++) {
            reading[3] = n > 7 && n % 8 < 3 ? 5000 : 1500;
            if (unrest != 0) {
                argus_clutter_note(&s.e, &s.k, 12);
            }
            scene_say(&s, 1u << 3, reading);
        }
        TEST_ASSERT_EQUAL(unrest == 0, s.e.of[3].score[ARGUS_TEST_DROPOUT] > 0);
        TEST_ASSERT_EQUAL(unrest == 0, s.e.of[3].gaps > 0);
    }
}

// However long the robot stands: in one place echoes may come and go by themselves.
void test_gaps_of_one_place_convict_nobody(void) {
    scene_init(&s, 1, START_MS);
    for (int n = 0; n < 600; n++) {
        reading[3] = n > 5 && n % 2 == 0 ? 5000 : 1500;
        s.w_rad_s = n % 100 < 4 ? 0.1 : 0; // and turns to look
        scene_say(&s, 1u << 3, reading);
    }
    TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, s.convicted[3]);
}

// At rest three count of one place: it takes a third place to convict.
void test_gaps_convict_at_rest_in_several_places(void) {
    scene_init(&s, 1, START_MS);
    int range = 3500;
    for (int place = 0; place < 6; place++) {
        for (int n = 0; n < 18; n++) {
            reading[3] = n > 5 && n % 3 == 0 ? 5000 : range;
            scene_say(&s, 1u << 3, reading);
        }
        TEST_ASSERT_EQUAL(ARGUS_KIND_INTERMITTENT, argus_evidence_names(&s.e, 3));
        TEST_ASSERT_TRUE(place > 1 || s.convicted[3] == ARGUS_KIND_NONE);
        s.v_mm_s = 600;
        for (int n = 0; n < 6; n++) {
            s.x += 60;
            range -= 59;
            reading[3] = range;
            scene_say(&s, 1u << 3, reading);
        }
        s.v_mm_s = 0;
    }
    TEST_ASSERT_EQUAL(ARGUS_KIND_INTERMITTENT, s.convicted[3]);
}

// At rest an unchanged reading is what is expected.
void test_the_same_reading_at_rest_is_not_stuck(void) {
    scene_init(&s, 1, START_MS);
    reading[3] = 1500;
    for (int i = 0; i < 2000; i++) {
        scene_say(&s, 1u << 3, reading);
    }
    TEST_ASSERT_EQUAL(0, s.e.of[3].score[ARGUS_TEST_STUCK]);
    TEST_ASSERT_FALSE(argus_evidence_suspects(&s.e, 3));
}

// A wall beside a straight way: the same range again and again, if a little noise lives in it.
void test_a_wall_along_the_way_is_not_stuck(void) {
    scene_init(&s, 9, START_MS);
    scene_box(&s, -3000, -900, 40000, 900);
    s.noise_mm = 2;
    s.v_mm_s = 200;
    scene_run(&s, 60000);
    TEST_ASSERT_TRUE_MESSAGE(scene_all_quiet(&s), told("corridor", 0, 9));
}

static int coarse_mm(unsigned *random) {
    *random = *random * 1103515245u + 12345u;
    return 600 + 10 * (int)(*random >> 16 & 1u);
}

// Readings in steps of 10 mm of walls that go along with the robot: every other one repeats the last. Healthy
// sonars are not stuck; one that never changes among them is.
void test_coarse_steps_beside_a_wall_are_not_stuck(void) {
    static const int aslant[] = {1, 6, 9, 14};
    for (int stuck = 0; stuck < 2; stuck++) {
        scene_init(&s, 1, START_MS);
        s.v_mm_s = 600;
        unsigned random = 12345;
        for (int n = 0; n < 600; n++) {
            for (int i = 0; i < 4; i++) {
                reading[aslant[i]] = coarse_mm(&random);
            }
            reading[6] = stuck != 0 ? 600 : reading[6];
            reading[7] = coarse_mm(&random); // abeam it shows that the wall comes and goes
            s.x += 60;
            scene_say(&s, 1u << 1 | 1u << 6 | 1u << 7 | 1u << 9 | 1u << 14, reading);
        }
        TEST_ASSERT_EQUAL_HEX16(stuck != 0 ? 1u << 6 : 0u, s.named);
    }
}

// Those abeam cannot be judged by their way along a wall, but they tell how often a steady view repeats
// itself.
void test_those_abeam_tell_how_coarse_the_steps_are(void) {
    static const int abeam[] = {0, 7, 8, 15};
    scene_init(&s, 1, START_MS);
    s.v_mm_s = 600;
    unsigned random = 12345;
    for (int n = 0; n < 1200; n++) {
        for (int i = 0; i < 5; i++) {
            reading[i < 4 ? abeam[i] : 14] = coarse_mm(&random);
        }
        s.x += 60;
        scene_say(&s, 1u << 0 | 1u << 7 | 1u << 8 | 1u << 14 | 1u << 15, reading);
    }
    TEST_ASSERT_EQUAL_HEX16(0, s.named);
}

// Without noise a wall along the way gives the very same range abeam, to that sonar alone. Only way along its
// own axis changes a range, or a turn.
void test_a_wall_without_noise_is_not_stuck_abeam(void) {
    static const int others[] = {1, 6, 9, 14};
    for (int abeam = 0; abeam < 2; abeam++) {
        const int same = abeam != 0 ? 7 : 6;
        scene_init(&s, 1, START_MS);
        s.v_mm_s = 600;
        for (int n = 0; n < 600; n++) {
            for (int i = 0; i < 4; i++) {
                reading[others[i]] = 600 + 10 * (n >> i & 1);
            }
            reading[7] = 600 + 10 * (n & 1);
            reading[same] = 600;
            s.x += 60;
            scene_say(&s, 1u << 1 | 1u << 6 | 1u << 7 | 1u << 9 | 1u << 14, reading);
        }
        TEST_ASSERT_EQUAL_HEX16(abeam != 0 ? 0u : 1u << 6, s.named);
    }
}

// A wall along the way keeps the range of a sonar aslant, too, at the rim of its cone. Where the one abeam
// does not show that the wall comes or goes, a reading that stays proves nothing; under a turn it does.
void test_a_wall_along_the_way_without_noise_is_not_stuck_aslant(void) {
    for (int abeam_mm = 480; abeam_mm <= 5000; abeam_mm += 4520) {
        for (int sonar = 1; sonar <= 6; sonar += 5) {
            scene_init(&s, 1, START_MS);
            s.v_mm_s = 600;
            for (int n = 0; n < 200; n++) {
                reading[0] = reading[7] = abeam_mm;
                reading[sonar] = 750;
                s.x += 60;
                scene_say(&s, 1u << 0 | 1u << 7 | 1u << sonar, reading);
            }
            TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, s.named, told("abeam", abeam_mm, sonar));
            for (int n = 0; n < 80; n++) { // what repeated so far is forgotten meanwhile
                s.th += 0.15;
                scene_say(&s, 1u << sonar, reading);
            }
            TEST_ASSERT_EQUAL_HEX32_MESSAGE(1u << sonar, s.named, told("turn", abeam_mm, sonar));
        }
    }
}

// Past square-on to a wall the range stays for some degrees of a slow turn.
void test_a_slow_turn_past_a_wall_is_not_stuck(void) {
    scene_init(&s, 1, START_MS);
    reading[3] = 900;
    for (int n = 0; n < 9; n++) {
        s.th += 0.035;
        scene_say(&s, 1u << 3, reading);
    }
    TEST_ASSERT_EQUAL_HEX32(0, s.named);
    for (int n = 0; n < 20; n++) {
        s.th += 0.035;
        scene_say(&s, 1u << 3, reading);
    }
    TEST_ASSERT_EQUAL_HEX32(1u << 3, s.named);
}

// ---- caution

// Firings until the evidence names it, or convicts it.
static int firings_until(int32_t caution, int (*of)(int n), bool conviction) {
    scene_init(&s, 1, START_MS);
    if (caution > 0) {
        argus_evidence_set_caution(&s.e, caution);
    }
    s.v_mm_s = 200;
    for (int n = 0; n < 200; n++) {
        for (int sip = 0; sip < 3; sip++) {
            s.x += 20;
            reading[3] = of(n);
            scene_say(&s, sip == 0 ? 1u << 3 : 0u, reading);
        }
        if (conviction ? s.convicted[3] != ARGUS_KIND_NONE : s.named != 0) {
            return n;
        }
    }
    return -1;
}

// The first reading of a stuck sonar says nothing, each one after it the same.
void test_twice_the_caution_takes_twice_the_evidence_and_half_of_it_half(void) {
    for (int conviction = 0; conviction < 2; conviction++) {
        const int usual = firings_until(100, the_same, conviction != 0);
        TEST_ASSERT_TRUE(usual > 2);
        TEST_ASSERT_INT_WITHIN(1, 2 * usual, firings_until(200, the_same, conviction != 0)); // it is rounded
        TEST_ASSERT_INT_WITHIN(3, 4 * usual, firings_until(400, the_same, conviction != 0));
        TEST_ASSERT_INT_WITHIN(1, usual / 2, firings_until(50, the_same, conviction != 0));
        TEST_ASSERT_EQUAL(usual, firings_until(0, the_same, conviction != 0)); // 100 is what it begins with
    }
}

static int counts_until(int sonar, argus_test_t test, int32_t increment, int level) {
    argus_case_t *c = &s.e.of[sonar];
    c->score[test] = 0;
    for (int n = 1; n < 1000; n++) {
        argus_score(&s.e, sonar, test, increment);
        if (c->score[test] >= level) {
            return n;
        }
    }
    return -1;
}

void test_caution_scales_the_evidence_of_every_test(void) {
    scene_init(&s, 1, START_MS);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        for (int test = 0; test < ARGUS_TESTS; test++) {
            const int level = argus_bounds[test].convincing;
            argus_evidence_set_caution(&s.e, 100);
            const int usual = counts_until(i, (argus_test_t)test, 40, level);
            argus_evidence_set_caution(&s.e, 200);
            TEST_ASSERT_INT_WITHIN(1, 2 * usual, counts_until(i, (argus_test_t)test, 40, level));
            argus_evidence_set_caution(&s.e, 50);
            TEST_ASSERT_INT_WITHIN(1, usual / 2, counts_until(i, (argus_test_t)test, 40, level));
        }
    }
}

// What speaks for a sonar is scaled alike: more caution does not clear sooner.
void test_caution_scales_what_speaks_for_a_sonar_too(void) {
    for (int out = 0; out < 2; out++) {
        scene_init(&s, 1, START_MS);
        argus_case_t *c = &s.e.of[3];
        c->out = out != 0;
        c->score[ARGUS_TEST_PEERS] = 1000;
        argus_score(&s.e, 3, ARGUS_TEST_PEERS, -60);
        const int usual = 1000 - c->score[ARGUS_TEST_PEERS];
        argus_evidence_set_caution(&s.e, 200);
        c->score[ARGUS_TEST_PEERS] = 1000;
        argus_score(&s.e, 3, ARGUS_TEST_PEERS, -60);
        TEST_ASSERT_EQUAL(usual, 2 * (1000 - c->score[ARGUS_TEST_PEERS]));
    }
}

void test_caution_outlives_forgetting_and_restart(void) {
    scene_init(&s, 1, START_MS);
    argus_evidence_set_caution(&s.e, 400);
    argus_evidence_forget(&s.e, 3);
    argus_evidence_restart(&s.e);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        argus_score(&s.e, i, ARGUS_TEST_STUCK, 400);
        TEST_ASSERT_EQUAL(100, s.e.of[i].score[ARGUS_TEST_STUCK]);
    }
}

void test_no_caution_leads_out_of_the_bounds(void) {
    for (int32_t caution = 25; caution <= 400; caution += 25) {
        scene_init(&s, 1, START_MS);
        argus_evidence_set_caution(&s.e, caution);
        argus_case_t *c = &s.e.of[3];
        for (int i = 0; i < 200; i++) {
            c->out = i % 3 == 0;
            for (int test = 0; test < ARGUS_TESTS; test++) {
                argus_score(&s.e, 3, (argus_test_t)test, i % 40 < 20 ? 430 : -300);
                TEST_ASSERT_TRUE(c->score[test] >= argus_bounds[test].floor);
                TEST_ASSERT_TRUE(c->score[test] <= ARGUS_CEILING);
            }
        }
    }
}

// ---- arithmetic

static void run_from(uint32_t start_ms, int32_t x_mm, int32_t y_mm) {
    scene_init(&s, 4, start_ms);
    s.k.pose.x_mm = x_mm;
    s.k.pose.y_mm = y_mm;
    scene_office(&s);
    s.fault[2] = (scene_fault_t){ARGUS_KIND_GARBAGE, 0};
    s.fault[5] = (scene_fault_t){ARGUS_KIND_WRONG, 60};
    scene_tour(&s, 5);
}

// The same tour elsewhere is the same tour: pings keep the place modulo 65,536 mm.
void test_the_place_changes_nothing(void) {
    static const int32_t places[][2] = {{32760, -32760}, {65530, 65530}, {-65530, 10}, {1000000, -1000000}};
    static argus_case_t want[ARGUS_SONARS];
    run_from(1000, 0, 0);
    memcpy(want, s.e.of, sizeof want);
    for (int i = 0; i < 4; i++) {
        run_from(1000, places[i][0], places[i][1]);
        for (int k = 0; k < ARGUS_SONARS; k++) {
            TEST_ASSERT_EQUAL_INT16_ARRAY(want[k].score, s.e.of[k].score, ARGUS_TESTS);
        }
    }
}

void test_the_clock_may_wrap_at_any_moment(void) {
    argus_fault_kind_t want[ARGUS_SONARS];
    run_from(1000, 0, 0);
    memcpy(want, s.convicted, sizeof want);
    TEST_ASSERT_EQUAL(ARGUS_KIND_GARBAGE, want[2]);
    for (uint32_t at = 1; at < 60000; at += 7013) {
        run_from(UINT32_MAX - at, 0, 0);
        TEST_ASSERT_EQUAL_MESSAGE(want[2], s.convicted[2], told("wrap", 2, at));
        TEST_ASSERT_TRUE_MESSAGE(s.convicted[5] != ARGUS_KIND_NONE, told("wrap", 5, at));
    }
}

static void shake(int i) {
    const int sonar = (int)scene_random(&s, ARGUS_SONARS);
    switch (scene_random(&s, 200)) {
    case 0:
        argus_evidence_restart(&s.e);
        break;
    case 1:
        argus_evidence_retract(&s.e, sonar);
        break;
    case 2:
        argus_evidence_forget(&s.e, sonar);
        break;
    case 3:
        put_health(&s.k.sonar[sonar], (argus_health_t)scene_random(&s, 6), ARGUS_KIND_NONE, s.k.sip_ms);
        break;
    case 4:
        s.k.pose.x_mm = (int32_t)scene_random(&s, 4000000) - 2000000;
        break;
    case 5:
        s.t_ms += scene_random(&s, 0x7FFFFFFFu);
        break;
    default:
        s.x += scene_random(&s, 200);
        s.th += scene_random(&s, 100) / 100.0;
        s.v_mm_s = i % 50 < 25 ? 0 : scene_random(&s, 700);
        s.w_rad_s = i % 7 == 0 ? scene_random(&s, 100) / 50.0 : 0;
        break;
    }
}

// Whatever the readings, the way and the times: every score stays within the bounds of its test.
static void scores_stay_within_their_bounds(unsigned seeds, int readings) {
    static const int extreme[] = {0, 1, 100, 105, 106, 4999, 5000, 5001, 32767, 32768, 65535};
    for (unsigned seed = 1; seed <= seeds; seed++) {
        scene_init(&s, seed, START_MS);
        for (int i = 0; i < readings; i++) {
            shake(i);
            for (int k = 0; k < ARGUS_SONARS; k++) {
                const int kind = (int)scene_random(&s, 4);
                reading[k] = kind == 0   ? extreme[scene_random(&s, 11)]
                             : kind == 1 ? reading[k]
                                         : (int)scene_random(&s, 5001);
            }
            scene_say(&s, scene_random(&s, 0x10000), reading);
            TEST_ASSERT_EQUAL_STRING_MESSAGE("", s.broken, told("bounds", i, seed));
        }
    }
}

void test_scores_stay_within_their_bounds(void) {
    scores_stay_within_their_bounds(1, 2000);
}

void test_scores_stay_within_their_bounds_whatever_is_read(void) { // soak
    scores_stay_within_their_bounds(5, 4000);
}
