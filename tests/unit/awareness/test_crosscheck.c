// SPDX-License-Identifier: MIT
// Rule under attack (profile argus): a reading counts against a sonar only where another one, that is relied
// on, lately heard something else on the same bearing from the same place; once, less where something moves.
#include "awareness/crosscheck.h"

#include <stdio.h>
#include <string.h>

#include "awareness/clutter.h"
#include "awareness/evidence.h"
#include "awareness/numbers.h"
#include "knowledge/angle.h"
#include "scene.h"
#include "unity.h"

#define ME 3
#define WITNESS 4
#define THIRD 5
#define NONE_MM 5000

typedef enum { NOTHING, AGAINST, FOR } verdict_t;

static argus_knowledge_t k;
static argus_evidence_t e;
static char text[200];

void setUp(void) {
    scene_blank(&k, &e);
}

static argus_ping_t here(int sonar) {
    argus_ping_t at = argus_ping_from(k.robot, sonar, &k.pose);
    at.t_ms = (uint16_t)(k.sip_ms & 0xFFFFu);
    at.steady = 1;
    return at;
}

// `by` heard so far from where ME is now, along ME's bearing.
static argus_ping_t *heard(int by, int mm) {
    argus_ping_t at = here(ME);
    at.reading_mm = (uint16_t)mm;
    at.weighed = 1; // it is not the one that is judged
    argus_pings_t *log = &e.pings[by];
    argus_pings_note(log, at);
    memset(log->looked, 0xFF, sizeof log->looked); // some of them are turned aside afterwards
    return argus_pings_mark(log, 1);
}

static int score_of(int sonar) {
    return e.of[sonar].score[ARGUS_TEST_PEERS];
}

static int takes(int sonar, argus_ping_t at, int mm) {
    const int before = score_of(sonar);
    at.reading_mm = (uint16_t)mm;
    argus_pings_note(&e.pings[sonar], at);
    argus_crosscheck_take(&e, &k, sonar);
    return score_of(sonar) - before;
}

// What one reading of ME adds to its score.
static int reads(int mm) {
    return takes(ME, here(ME), mm);
}

static verdict_t verdict(int mm) {
    const int change = reads(mm);
    return change > 0 ? AGAINST : change < 0 ? FOR : NOTHING;
}

static verdict_t compared(int witness_mm, int mm) {
    setUp();
    heard(WITNESS, witness_mm);
    return verdict(mm);
}

// ---- one reading against one other

void test_echoes_agree_within_the_tolerance_only(void) {
    for (int mm = 300; mm < 4900; mm += 230) {
        const int limit = ARGUS_AGREE_MM + mm * ARGUS_AGREE_PERCENT / 100;
        TEST_ASSERT_EQUAL(FOR, compared(mm, mm));
        TEST_ASSERT_EQUAL(FOR, compared(mm + limit > 4999 ? 4999 : mm + limit, mm));
        TEST_ASSERT_EQUAL(AGAINST, compared(mm / 2, mm > 4000 ? 4000 : mm + limit + 1));
    }
}

// Silence contradicts an echo that must be heard, on either side; beyond, the air decides; nearest, neither.
void test_silence_contradicts_what_must_be_heard(void) {
    TEST_ASSERT_EQUAL(AGAINST, compared(1500, NONE_MM));
    TEST_ASSERT_EQUAL(AGAINST, compared(NONE_MM, 1500));
    TEST_ASSERT_EQUAL(NOTHING, compared(ARGUS_FARTHEST_MM + 50, NONE_MM));
    TEST_ASSERT_EQUAL(NOTHING, compared(NONE_MM, ARGUS_FARTHEST_MM + 50));
    TEST_ASSERT_EQUAL(NOTHING, compared(ARGUS_NEAREST_MM - 10, NONE_MM));
    TEST_ASSERT_EQUAL(NOTHING, compared(NONE_MM, NONE_MM));
    TEST_ASSERT_EQUAL(NOTHING, compared(UINT16_MAX, NONE_MM));
}

// From so far ahead and aside, on a bearing so far off, so long ago.
static verdict_t compared_from(int32_t heading_cdeg, int ahead_mm, int aside_mm, int off_cdeg) {
    setUp();
    k.pose.heading_cdeg = heading_cdeg;
    argus_ping_t *then = heard(WITNESS, 3000);
    const int32_t c = argus_cos(then->bearing_cdeg), s = argus_sin(then->bearing_cdeg);
    then->x_mm = (uint16_t)(then->x_mm - (ahead_mm * c - aside_mm * s) / ARGUS_TRIG_ONE);
    then->y_mm = (uint16_t)(then->y_mm - (ahead_mm * s + aside_mm * c) / ARGUS_TRIG_ONE);
    then->bearing_cdeg = (int16_t)argus_angle_wrap(then->bearing_cdeg + off_cdeg);
    return verdict(1000);
}

void test_only_what_was_heard_there_on_the_bearing_compares(void) {
    for (int32_t heading = -17000; heading <= 18000; heading += 3500) {
        TEST_ASSERT_EQUAL(AGAINST, compared_from(heading, 0, 0, 0));
        TEST_ASSERT_EQUAL(AGAINST, compared_from(heading, 130, 40, 250));
        TEST_ASSERT_EQUAL(NOTHING, compared_from(heading, 0, 80, 0));
        TEST_ASSERT_EQUAL(NOTHING, compared_from(heading, 0, -80, 0));
        TEST_ASSERT_EQUAL(NOTHING, compared_from(heading, 300, 0, 0));
        TEST_ASSERT_EQUAL(NOTHING, compared_from(heading, -300, 0, 0));
        TEST_ASSERT_EQUAL(NOTHING, compared_from(heading, 0, 0, 350));
        TEST_ASSERT_EQUAL(NOTHING, compared_from(heading, 0, 0, -350));
        TEST_ASSERT_EQUAL(NOTHING, compared_from(heading, 0, 0, 18000));
    }
}

// The way along the bearing is taken into account.
void test_a_wall_comes_nearer_with_the_way(void) {
    setUp();
    argus_ping_t *then = heard(WITNESS, 1500);
    const int32_t c = argus_cos(then->bearing_cdeg), s = argus_sin(then->bearing_cdeg);
    then->x_mm = (uint16_t)(then->x_mm - 180 * c / ARGUS_TRIG_ONE);
    then->y_mm = (uint16_t)(then->y_mm - 180 * s / ARGUS_TRIG_ONE);
    TEST_ASSERT_EQUAL(FOR, verdict(1320));
}

// Of several pings of one sonar the latest decides; one before it that agrees excuses.
void test_the_latest_of_a_witness_decides(void) {
    heard(WITNESS, 3000);
    heard(WITNESS, 1000);
    TEST_ASSERT_EQUAL(FOR, verdict(1000));
    setUp();
    heard(WITNESS, 1000);
    heard(WITNESS, 3000);
    TEST_ASSERT_EQUAL(NOTHING, verdict(1000));
}

// Beside a step a reading may be of either side: what any sonar relied on heard there lately excuses it.
void test_what_was_heard_a_little_aside_lately_excuses(void) {
    for (int late = 0; late < 2; late++) {
        for (int out = 0; out < 2; out++) {
            setUp();
            argus_ping_t *aside = heard(THIRD, 1000);
            aside->bearing_cdeg = (int16_t)(aside->bearing_cdeg + 400);
            aside->t_ms = (uint16_t)(aside->t_ms - (late != 0 ? 15000 : 0));
            heard(WITNESS, 3000);
            k.sonar[THIRD].health = out != 0 ? ARGUS_DISABLED : ARGUS_HEALTHY;
            TEST_ASSERT_EQUAL(late == 0 && out == 0 ? NOTHING : AGAINST, verdict(1000));
        }
    }
}

// ---- several others

// As many as differ are enough to bear it out; fewer leave it undecided.
void test_a_reading_is_contradicted_where_nobody_bears_it_out(void) {
    for (int agree = 0; agree <= 3; agree++) {
        for (int differ = 0; differ <= 3; differ++) {
            setUp();
            for (int i = 0; i < agree; i++) {
                heard(6 + i, 1000);
            }
            for (int i = 0; i < differ; i++) {
                heard(10 + i, 3000);
            }
            const verdict_t expect =
                agree == 0 ? (differ > 0 ? AGAINST : NOTHING) : (agree >= differ ? FOR : NOTHING);
            snprintf(text, sizeof text, "%d agree, %d differ", agree, differ);
            TEST_ASSERT_EQUAL_MESSAGE(expect, verdict(1000), text);
            TEST_ASSERT_EQUAL_MESSAGE(expect == AGAINST ? differ : 0, argus_count_bits(e.of[ME].against),
                                      text);
        }
    }
}

void test_who_is_out_is_no_witness(void) {
    for (int health = ARGUS_UNKNOWN; health <= ARGUS_STALE; health++) {
        setUp();
        heard(WITNESS, 3000);
        k.sonar[WITNESS].health = (argus_health_t)health;
        const bool out = argus_is_out(&k, WITNESS);
        snprintf(text, sizeof text, "health %d", health);
        TEST_ASSERT_EQUAL_MESSAGE(out ? NOTHING : AGAINST, verdict(1000), text);
    }
}

// A witness that is contradicted as much itself says nothing: a faulty sonar drags down no other.
void test_a_witness_that_is_contradicted_as_much_says_nothing(void) {
    static const int score[] = {0, 300, 700, 2000};
    for (int w = 0; w < 4; w++) {
        for (int own = 0; own < 4; own++) {
            setUp();
            heard(WITNESS, 3000);
            e.of[WITNESS].score[ARGUS_TEST_PEERS] = (int16_t)score[w];
            e.of[ME].score[ARGUS_TEST_PEERS] = (int16_t)score[own];
            snprintf(text, sizeof text, "witness at %d, own %d", score[w], score[own]);
            const bool counts = score[w] < 500 || score[w] < score[own];
            TEST_ASSERT_EQUAL_MESSAGE(counts ? AGAINST : NOTHING, verdict(1000), text);
        }
    }
}

// ---- when

// What no other had heard when it was read is judged by what looks there later, once.
void test_what_is_read_is_judged_by_who_looks_there_later(void) {
    static const struct {
        int mine, theirs;
        verdict_t expect;
    } by[] = {
        {1000, 3000, AGAINST}, {1000, 1050, FOR}, {NONE_MM, 3000, AGAINST}, {NONE_MM, NONE_MM, NOTHING}};
    for (int i = 0; i < 4; i++) {
        setUp();
        e.of[ME].score[ARGUS_TEST_PEERS] = 100;
        TEST_ASSERT_EQUAL(NOTHING, verdict(by[i].mine));
        const argus_ping_t mine = here(ME);
        int after[2];
        for (int who = 0; who < 2; who++) {
            k.sip_ms += 300;
            argus_ping_t at = mine;
            at.t_ms = (uint16_t)(k.sip_ms & 0xFFFFu);
            takes(WITNESS + who, at, by[i].theirs);
            after[who] = score_of(ME) - 100;
        }
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].expect, after[0] > 0 ? AGAINST : after[0] < 0 ? FOR : NOTHING, text);
        TEST_ASSERT_EQUAL_MESSAGE(after[0], after[1], text);
    }
}

// What a reading adds after the same from there: so much later, farther and turned. `by` reads so as well.
static int goes_on(int by, int their_mm, int mm, uint32_t after_ms, int dx_mm, int32_t turn_cdeg) {
    k.sip_ms += after_ms;
    argus_ping_t at = here(ME);
    at.x_mm = (uint16_t)(at.x_mm + dx_mm);
    at.bearing_cdeg = (int16_t)argus_angle_wrap(at.bearing_cdeg + turn_cdeg);
    argus_ping_t theirs = at;
    theirs.reading_mm = (uint16_t)their_mm;
    theirs.weighed = 1;
    argus_pings_note(&e.pings[by], theirs);
    return takes(ME, at, mm);
}

static int again(uint32_t after_ms, int dx_mm, int32_t turn_cdeg) {
    setUp();
    heard(WITNESS, 3000);
    TEST_ASSERT_TRUE(reads(1000) > 0);
    return goes_on(WITNESS, 3000, 1000, after_ms, dx_mm, turn_cdeg);
}

// From one place on one bearing one reading counts in 4 s; elsewhere, elsewhither or later the next one.
void test_one_place_and_bearing_counts_once_in_a_while(void) {
    TEST_ASSERT_EQUAL(0, again(300, 50, 0));
    TEST_ASSERT_EQUAL(0, again(300, -50, 0));
    TEST_ASSERT_EQUAL(0, again(300, 10, 500));
    TEST_ASSERT_TRUE(again(300, ARGUS_PLACE_MM + 50, 0) > 0);
    TEST_ASSERT_TRUE(again(300, 10, 1000) > 0);
    TEST_ASSERT_TRUE(again(ARGUS_PLACE_MS + 100, 50, 0) > 0);
}

// An echo where another is silent counts once for each silence: that goes on until the other hears something.
void test_a_silence_that_goes_on_counts_once_against_an_echo(void) {
    const uint32_t later_ms = ARGUS_PLACE_MS + 100;
    heard(WITNESS, NONE_MM);
    TEST_ASSERT_TRUE(reads(1000) > 0);
    TEST_ASSERT_EQUAL(0, goes_on(WITNESS, NONE_MM, 1000, later_ms, 300, 0));
    takes(THIRD, here(THIRD), 2000);
    TEST_ASSERT_EQUAL(0, goes_on(WITNESS, NONE_MM, 1000, later_ms, 600, 0));
    TEST_ASSERT_TRUE(goes_on(THIRD, NONE_MM, 1000, later_ms, 600, 0) > 0);
    takes(WITNESS, here(WITNESS), 2000);
    TEST_ASSERT_TRUE(goes_on(WITNESS, NONE_MM, 1000, later_ms, 900, 0) > 0);
}

// ... and neither another's echo nor one's own silence is told so.
void test_only_silence_against_an_echo_is_told(void) {
    const uint32_t later_ms = ARGUS_PLACE_MS + 100;
    heard(WITNESS, 3000);
    TEST_ASSERT_TRUE(reads(1000) > 0);
    TEST_ASSERT_TRUE(goes_on(WITNESS, 3000, 1000, later_ms, 300, 0) > 0);
    TEST_ASSERT_TRUE(goes_on(WITNESS, NONE_MM, 1000, later_ms, 600, 0) > 0);
    TEST_ASSERT_TRUE(goes_on(WITNESS, 3000, NONE_MM, later_ms, 900, 0) > 0);
}

// ---- how much

// What speaks against counts less while something moves before a sonar in use; what speaks for it in full.
void test_in_unrest_contradictions_count_less(void) {
    heard(WITNESS, 3000);
    const int usual = reads(1000);
    setUp();
    heard(WITNESS, 1000);
    const int fine = reads(1000);
    for (int mover = 0; mover < 3; mover++) {
        for (int late = 0; late < 2; late++) {
            const int at[] = {ME, WITNESS, 12};
            setUp();
            argus_clutter_note(&e, &k, at[mover]);
            k.sip_ms += late != 0 ? ARGUS_UNREST_MS : 100;
            heard(WITNESS, 3000);
            TEST_ASSERT_EQUAL(late != 0 ? usual : usual * ARGUS_UNREST_PERCENT / 100, reads(1000));
        }
        setUp();
        argus_clutter_note(&e, &k, ME);
        heard(WITNESS, 1000);
        TEST_ASSERT_EQUAL(fine, reads(1000));
    }
}

// The more the others are contradicted, the less it means; what is said of itself does not count.
void test_where_many_are_contradicted_it_means_less(void) {
    int before = INT16_MAX;
    for (int percent = 5; percent <= 60; percent += 5) {
        setUp();
        e.of[7].rate[ARGUS_TEST_PEERS] = (argus_rate_t){16000, (uint16_t)(160 * percent)};
        e.of[ME].rate[ARGUS_TEST_PEERS] = (argus_rate_t){6000, 6000};
        heard(WITNESS, 3000);
        const int worth = reads(1000);
        TEST_ASSERT_TRUE(worth > 0 && worth < before);
        before = worth;
    }
}

// The part that is contradicted is a crowd, and for a while after it is over. Two sonars alone are none.
void test_a_crowd_is_more_than_two_sonars_that_are_contradicted(void) {
    e.of[5].rate[ARGUS_TEST_PEERS] = (argus_rate_t){1600, 1600};
    e.of[6].rate[ARGUS_TEST_PEERS] = (argus_rate_t){1600, 1600};
    argus_clutter_sip(&e, &k);
    TEST_ASSERT_FALSE(e.crowded || e.busy);
    e.of[7].rate[ARGUS_TEST_PEERS] = (argus_rate_t){1600, 800};
    argus_clutter_sip(&e, &k);
    TEST_ASSERT_TRUE(e.crowded && e.busy);
    e.of[7].rate[ARGUS_TEST_PEERS].odd = 0;
    k.sip_ms += ARGUS_CALM_MS - 1;
    argus_clutter_sip(&e, &k);
    TEST_ASSERT_TRUE(e.crowded);
    k.sip_ms += 1;
    argus_clutter_sip(&e, &k);
    TEST_ASSERT_FALSE(e.crowded || e.busy);
}

// What was said fades to nothing, and with it which sonar said it.
void test_what_the_others_say_fades(void) {
    e.of[ME].score[ARGUS_TEST_PEERS] = 900;
    e.of[ME].against = 6;
    e.of[ME].hypothesis[2] = (argus_hypothesis_t){500, 400};
    e.of[ME].score[ARGUS_TEST_STUCK] = 900;
    int seconds = 0;
    for (int was = 900; score_of(ME) > 0; was = score_of(ME)) {
        argus_crosscheck_fade(&e, &k);
        TEST_ASSERT_TRUE(score_of(ME) < was);
        TEST_ASSERT_TRUE(e.of[ME].hypothesis[2].over_healthy > 0 || e.of[ME].hypothesis[2].over_other == 0);
        seconds++;
    }
    TEST_ASSERT_TRUE(seconds > 100 && seconds < 600);
    TEST_ASSERT_EQUAL(0, e.of[ME].against);
    TEST_ASSERT_EQUAL(0, e.of[ME].hypothesis[2].over_healthy);
    TEST_ASSERT_EQUAL(900, e.of[ME].score[ARGUS_TEST_STUCK]);
}

// ---- hypotheses

// A bearing that is another one's tells of that axis offset; the hypotheses of a reading that is borne out
// grow by nothing.
void test_what_another_heard_aside_speaks_for_that_offset(void) {
    static const int offset_cdeg[ARGUS_OFFSETS] = {-2400, -1800, -1200, 1200, 1800, 2400};
    for (int b = 0; b < ARGUS_OFFSETS; b++) {
        setUp();
        argus_ping_t *aside = heard(THIRD, 1000);
        aside->bearing_cdeg = (int16_t)argus_angle_wrap(aside->bearing_cdeg + offset_cdeg[b]);
        heard(WITNESS, 3000);
        reads(1000);
        for (int i = 0; i < ARGUS_OFFSETS; i++) {
            const argus_hypothesis_t *d = &e.of[ME].hypothesis[ARGUS_LAGS + i];
            TEST_ASSERT_TRUE(i == b || d->over_healthy < e.of[ME].hypothesis[ARGUS_LAGS + b].over_healthy);
            TEST_ASSERT_EQUAL(i == b, d->over_other > 0);
        }
        const argus_case_t before = e.of[ME];
        k.pose.x_mm += 500;
        heard(WITNESS, 1000);
        reads(1000);
        for (int i = 0; i < ARGUS_HYPOTHESES; i++) {
            TEST_ASSERT_TRUE(e.of[ME].hypothesis[i].over_healthy <= before.hypothesis[i].over_healthy);
        }
    }
}

// What others heard where it looked some firings ago speaks for that lag.
void test_what_others_heard_where_it_looked_speaks_for_that_lag(void) {
    for (int lag = ARGUS_LEAST_LAG; lag < ARGUS_LEAST_LAG + ARGUS_LAGS; lag++) {
        setUp();
        for (int i = 0; i <= lag; i++) { // it turns: each firing on another bearing, the first with company
            argus_ping_t at = here(ME);
            at.reading_mm = 4700;
            at.weighed = 1;
            argus_pings_note(&e.pings[ME], at);
            if (i == 0) {
                heard(WITNESS, 1000);
            }
            k.pose.heading_cdeg = argus_angle_wrap(k.pose.heading_cdeg + 2000);
        }
        argus_pings_mark(&e.pings[ME], 1)->bearing_cdeg = 17000; // the last one before is nowhere near
        heard(WITNESS, 3000);
        reads(1000);
        for (int i = 0; i < ARGUS_LAGS; i++) {
            snprintf(text, sizeof text, "lag %d, hypothesis %d", lag, i);
            TEST_ASSERT_EQUAL_MESSAGE(i + ARGUS_LEAST_LAG == lag + 1, e.of[ME].hypothesis[i].over_healthy > 0,
                                      text);
        }
        if (lag + 1 < ARGUS_LEAST_LAG + ARGUS_LAGS) {
            TEST_ASSERT_TRUE(e.of[ME].hypothesis[lag + 1 - ARGUS_LEAST_LAG].over_other > 0);
        }
    }
}

// ---- after

// What a sonar that is out has said of others is taken back: the whole where no other says so.
void test_what_a_faulty_sonar_said_is_taken_back_when_it_is_out(void) {
    for (int other = 0; other < 2; other++) {
        setUp();
        argus_case_t *c = &e.of[ME];
        c->score[ARGUS_TEST_PEERS] = 700;
        c->against = (argus_mask_t)(1u << WITNESS | (other != 0 ? 1u : 0u));
        c->borne_out = true;
        c->silent_bits = 1;
        c->hypothesis[5] = (argus_hypothesis_t){900, 900};
        argus_crosscheck_retract(&e, WITNESS);
        TEST_ASSERT_EQUAL(other != 0 ? 700 : 0, score_of(ME));
        TEST_ASSERT_EQUAL(other, c->borne_out);
        TEST_ASSERT_EQUAL(other, argus_crosscheck_silences(c, 8));
        TEST_ASSERT_EQUAL(other * 900, c->hypothesis[5].over_healthy);
        TEST_ASSERT_EQUAL_HEX(other, c->against);
    }
}

// Echoes that are borne out in a row are the way back of one that is out; a contradiction begins it anew.
void test_the_way_back_is_of_echoes_that_are_borne_out(void) {
    k.sonar[ME].health = ARGUS_DISABLED;
    k.sonar[ME].kind = ARGUS_KIND_WRONG;
    for (int n = 1; n <= 3; n++) {
        k.pose.x_mm += 500;
        heard(WITNESS, 1000);
        reads(1000);
        TEST_ASSERT_EQUAL(n, e.of[ME].agreed);
    }
    k.pose.x_mm += 500;
    heard(WITNESS, 3000);
    reads(1000);
    TEST_ASSERT_EQUAL(0, e.of[ME].agreed);
}

// Where none looks, echoes that go on as the robot moves are the way back of one that its kind of fault
// forbids them; one value again and again is no proof of life.
void test_its_own_echoes_bring_back_who_could_not_have_had_them(void) {
    for (int kind = ARGUS_KIND_OFF; kind <= ARGUS_KIND_INTERMITTENT; kind++) {
        for (int same = 0; same < 2; same++) {
            setUp();
            k.sonar[ME].health = ARGUS_DISABLED;
            k.sonar[ME].kind = (argus_fault_kind_t)kind;
            e.of[ME].score[ARGUS_TEST_PEERS] = 2000;
            k.pose.heading_cdeg = 9000 - argus_robot_pose(k.robot, ME).heading_deg * 100; // along a wall
            for (int n = 0; n < 3; n++) {
                k.pose.x_mm += ARGUS_PLACE_MM + 50;
                reads(same != 0 ? 1000 : 1000 + 10 * n);
            }
            const bool others_only = kind == ARGUS_KIND_WRONG || kind == ARGUS_KIND_SLOW;
            TEST_ASSERT_EQUAL(others_only || same != 0 ? 0 : 2, e.of[ME].agreed);
            TEST_ASSERT_EQUAL(e.of[ME].agreed > 0, score_of(ME) < 2000);
        }
    }
}

// In the open silence together is the way back of one that made echoes up, of no other.
void test_silence_together_brings_back_who_made_echoes_up(void) {
    for (int kind = ARGUS_KIND_OFF; kind <= ARGUS_KIND_INTERMITTENT; kind++) {
        setUp();
        k.sonar[ME].health = ARGUS_DISABLED;
        k.sonar[ME].kind = (argus_fault_kind_t)kind;
        heard(WITNESS, NONE_MM);
        reads(NONE_MM);
        const bool made_up = kind == ARGUS_KIND_STUCK || kind == ARGUS_KIND_GARBAGE;
        TEST_ASSERT_EQUAL(made_up, e.of[ME].agreed);
    }
}

// ---- a silence of a whole array

// What it heard nothing of before it went dark says nothing of the array.
void test_only_what_an_array_misses_while_it_is_dark_is_held_against_it(void) {
    for (int before = 0; before < 2; before++) {
        setUp();
        e.dark = 1u << ME;
        e.dispute[0].since_ms = k.sip_ms - (before != 0 ? 0u : 500u);
        heard(WITNESS, 1500);
        reads(NONE_MM);
        TEST_ASSERT_EQUAL(before == 0, e.dispute[0].nats > 0);
        TEST_ASSERT_EQUAL_HEX(before == 0 ? 1u << WITNESS : 0u, e.dispute[0].by);
    }
}
