// SPDX-License-Identifier: MIT
// Rule under attack (profile argus): a reading counts against a sonar only where another one, that is relied
// on, lately saw something else on the same bearing from the same place; once, less where something moves.
#include "awareness/evidence.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "awareness/evidence_internal.h"
#include "health.h"
#include "knowledge/angle.h"
#include "scene.h"
#include "unity.h"

#define ME 3
#define WITNESS 4
#define THIRD 5
#define AGAINST 277      // one reading, where as few are contradicted as at the start
#define AGAINST_BOTH 139 // ... where the reading of who contradicts it has just been, too
#define FOR (-93)
#define NONE_MM 5000
#define START_MS 0xFFFF8000u // the clock wraps in every tour

static argus_knowledge_t k;
static argus_evidence_t e;
static scene_t s;
static char text[300];

void setUp(void) {
    scene_blank(&k, &e);
}

static void face(int sonar, int32_t bearing_cdeg) {
    k.pose.heading_cdeg = argus_angle_wrap(bearing_cdeg - argus_sonar_poses[sonar].heading_deg * 100);
}

static argus_glimpse_t here(int sonar) {
    const argus_sonar_pose_t *mount = &argus_sonar_poses[sonar];
    const argus_point_t robot = {mount->x_mm, mount->y_mm};
    const argus_point_t at = argus_to_course(&k.pose, robot);
    return (argus_glimpse_t){
        .t_ms = k.sip_ms,
        .x_mm = (uint16_t)((uint32_t)at.x_mm & 0xFFFFu),
        .y_mm = (uint16_t)((uint32_t)at.y_mm & 0xFFFFu),
        .bearing_cdeg = (int16_t)argus_angle_wrap(k.pose.heading_cdeg + mount->heading_deg * 100),
    };
}

static argus_glimpse_t *remember(int sonar, argus_glimpse_t glimpse) {
    argus_peer_t *peer = &e.peers.of[sonar];
    argus_glimpse_t *at = &peer->seen[peer->next];
    *at = glimpse;
    peer->weighed |= (uint64_t)1 << peer->next; // it is not the one that is judged
    peer->next = (uint8_t)((peer->next + 1) % ARGUS_GLIMPSES);
    peer->count = (uint8_t)argus_min(peer->count + 1, ARGUS_GLIMPSES);
    return at;
}

// `by` saw so far from where ME looks now, and along ME's bearing.
static argus_glimpse_t *saw(int by, int mm) {
    argus_glimpse_t glimpse = here(ME);
    glimpse.reading_mm = (uint16_t)mm;
    return remember(by, glimpse);
}

static int score_of(int sonar) {
    return e.of[sonar].score[ARGUS_TEST_PEERS];
}

// What one reading of ME adds to its score.
static int reads(int mm) {
    const int before = score_of(ME);
    k.sonar[ME].reading_mm = (uint16_t)mm;
    argus_peers_take(&e, &k, ME);
    return score_of(ME) - before;
}

// Another one reads so much on ME's bearing, from where ME was.
static void looks_there(int sonar, const argus_glimpse_t *mine, int mm) {
    face(sonar, 0);
    k.pose.x_mm += (int16_t)(mine->x_mm - here(sonar).x_mm);
    k.pose.y_mm += (int16_t)(mine->y_mm - here(sonar).y_mm);
    k.sonar[sonar].reading_mm = (uint16_t)mm;
    argus_peers_take(&e, &k, sonar);
}

static int compared(int witness_mm, int mm) {
    setUp();
    face(ME, 0);
    saw(WITNESS, witness_mm);
    return reads(mm);
}

// ME stands so far ahead along the bearing and so far aside of where the witness saw.
static int compared_from(int32_t bearing_cdeg, int dx_mm, int dy_mm, int witness_mm, int mm) {
    setUp();
    face(ME, bearing_cdeg);
    argus_glimpse_t *then = saw(WITNESS, witness_mm);
    then->x_mm = (uint16_t)(then->x_mm - dx_mm);
    then->y_mm = (uint16_t)(then->y_mm - dy_mm);
    return reads(mm);
}

// ---- one reading against one glimpse

// An echo within 80 mm and 5 % of what the other saw bears it out, any other contradicts.
void test_echoes_agree_within_the_tolerance_only(void) {
    TEST_ASSERT_EQUAL(FOR, compared(1500, 1500));
    TEST_ASSERT_EQUAL(FOR, compared(1130, 1000));
    TEST_ASSERT_EQUAL(AGAINST, compared(1131, 1000));
    TEST_ASSERT_EQUAL(FOR, compared(1000, 1130));
    TEST_ASSERT_EQUAL(AGAINST, compared(1000, 1131));
    TEST_ASSERT_EQUAL(FOR, compared(4900, 4900));
    TEST_ASSERT_EQUAL(AGAINST, compared(4900, 1000));
}

// What stands nearer than a sonar can tell is compared with nothing.
void test_the_nearest_range_says_nothing(void) {
    TEST_ASSERT_EQUAL(AGAINST, compared(150, 1000));
    TEST_ASSERT_EQUAL(0, compared(149, 1000));
    TEST_ASSERT_EQUAL(AGAINST, compared(150, NONE_MM));
    TEST_ASSERT_EQUAL(0, compared(149, NONE_MM));
    TEST_ASSERT_EQUAL(0, compared_from(0, 200, 0, 349, 1500)); // passed by now
}

void test_silence_on_both_sides_says_nothing(void) {
    TEST_ASSERT_EQUAL(0, compared(NONE_MM, NONE_MM));
    TEST_ASSERT_EQUAL(0, compared(UINT16_MAX, NONE_MM));
    TEST_ASSERT_EQUAL(0, e.peers.of[ME].verdicts);
}

// Beyond 4,600 mm the air decides whether an echo is heard; nearer, silence contradicts, on either side.
void test_silence_contradicts_an_echo_that_is_near_only(void) {
    TEST_ASSERT_EQUAL(AGAINST, compared(4600, NONE_MM));
    TEST_ASSERT_EQUAL(0, compared(4601, NONE_MM));
    TEST_ASSERT_EQUAL(AGAINST, compared(NONE_MM, 4600));
    TEST_ASSERT_EQUAL(0, compared(NONE_MM, 4601));
    TEST_ASSERT_EQUAL(AGAINST, compared_from(0, 100, 0, 4700, NONE_MM));
    TEST_ASSERT_EQUAL(0, compared_from(0, 100, 0, 4701, NONE_MM));
    TEST_ASSERT_EQUAL(AGAINST, compared_from(0, 100, 0, NONE_MM, 4500));
    TEST_ASSERT_EQUAL(0, compared_from(0, 100, 0, NONE_MM, 4501));
}

// The tables of the lags know nothing of silences beyond 4,000 mm: those count against the reading alone.
void test_a_faint_silence_tells_nothing_of_lags(void) {
    for (int mm = 4000; mm <= 4001; mm++) {
        setUp();
        face(ME, 0);
        saw(THIRD, mm)->bearing_cdeg = 9000;
        saw(ME, mm)->bearing_cdeg = 9000;
        saw(ME, mm)->bearing_cdeg = 9000;
        saw(WITNESS, NONE_MM);
        TEST_ASSERT_EQUAL(AGAINST, reads(mm)); // two firings ago it would have agreed
        TEST_ASSERT_EQUAL(mm == 4000 ? 300 : 50, argus_peers_late(&e.peers, ME));
        TEST_ASSERT_EQUAL(1, argus_peers_against(&e.peers, ME));
    }
}

// ... and what was judged so is not judged again by the next one who looks there.
void test_a_faint_silence_has_been_weighed(void) {
    setUp();
    face(ME, 0);
    saw(WITNESS, NONE_MM);
    TEST_ASSERT_EQUAL(AGAINST, reads(4500));
    const argus_glimpse_t mine = *(&e.peers.of[ME].seen[e.peers.of[ME].next - 1]);
    k.sip_ms += 5000;
    looks_there(THIRD, &mine, NONE_MM);
    TEST_ASSERT_EQUAL(AGAINST, score_of(ME));
}

// The way along the bearing is taken off, whichever way it points.
void test_the_way_along_the_bearing_is_taken_into_account(void) {
    static const struct {
        int32_t bearing_cdeg;
        int dx;
        int dy;
    } ahead[] = {{0, 200, 0}, {9000, 0, 200}, {-9000, 0, -200}, {18000, -200, 0}, {4500, 141, 141}};
    for (int i = 0; i < 5; i++) {
        const int32_t bearing = ahead[i].bearing_cdeg;
        const int dx = ahead[i].dx, dy = ahead[i].dy;
        snprintf(text, sizeof text, "bearing %d", (int)bearing);
        TEST_ASSERT_EQUAL_MESSAGE(FOR, compared_from(bearing, dx, dy, 1700, 1500), text);
        TEST_ASSERT_EQUAL_MESSAGE(AGAINST, compared_from(bearing, dx, dy, 1500, 1500), text);
        TEST_ASSERT_EQUAL_MESSAGE(FOR, compared_from(bearing, -dx, -dy, 1500, 1700), text);
        TEST_ASSERT_EQUAL_MESSAGE(AGAINST, compared_from(bearing, -dx, -dy, 1500, 1500), text);
    }
}

// 200 mm along and 60 mm aside is the same place, a millimetre more is not.
void test_only_glimpses_from_the_same_place_compare(void) {
    for (int sign = -1; sign <= 1; sign += 2) {
        TEST_ASSERT_EQUAL(AGAINST, compared_from(0, sign * 200, 0, 3000, 1000));
        TEST_ASSERT_EQUAL(0, compared_from(0, sign * 201, 0, 3000, 1000));
        TEST_ASSERT_EQUAL(AGAINST, compared_from(0, 0, sign * 60, 3000, 1000));
        TEST_ASSERT_EQUAL(0, compared_from(0, 0, sign * 61, 3000, 1000));
        TEST_ASSERT_EQUAL(AGAINST, compared_from(9000, sign * 60, 0, 3000, 1000));
        TEST_ASSERT_EQUAL(0, compared_from(9000, sign * 61, 0, 3000, 1000));
        TEST_ASSERT_EQUAL(0, compared_from(9000, 0, sign * 201, 3000, 1000));
        TEST_ASSERT_EQUAL(AGAINST, compared_from(4500, sign * 150, sign * 150, 3000, 1000));
        TEST_ASSERT_EQUAL(0, compared_from(4500, sign * 150, sign * -150, 3000, 1000));
        TEST_ASSERT_EQUAL(AGAINST, compared_from(-4500, sign * 150, sign * -150, 3000, 1000));
    }
}

// 3 degrees is the same bearing, more is not, at every heading, half a turn from the origin too.
void test_only_glimpses_on_the_same_bearing_compare(void) {
    static const struct {
        int32_t off;
        int expect;
    } by[] = {{300, AGAINST}, {-300, AGAINST}, {301, 0}, {-301, 0}, {18000, 0}, {9000, 0}};
    for (int32_t bearing = -17900; bearing <= 18000; bearing += 100) {
        for (int i = 0; i < 6; i++) {
            setUp();
            face(ME, bearing);
            argus_glimpse_t *then = saw(WITNESS, 3000);
            then->bearing_cdeg = (int16_t)argus_angle_wrap(then->bearing_cdeg + by[i].off);
            snprintf(text, sizeof text, "bearing %d, off by %d", (int)bearing, (int)by[i].off);
            TEST_ASSERT_EQUAL_MESSAGE(by[i].expect, reads(1000), text);
        }
    }
}

// What was seen 40 s ago counts, before that it does not, whatever the clock.
static void looked_ago(uint32_t ago_ms, int expect) {
    static const uint32_t clocks[] = {1, 2000, 9999, 10000, 40000, 40001, 500000, 0x80000000u, UINT32_MAX};
    const bool unrest = e.of[WITNESS].unrest;
    const uint32_t moved_ms = k.sip_ms - e.of[WITNESS].unrest_ms;
    for (int i = 0; i < 9; i++) {
        setUp();
        k.sip_ms = clocks[i];
        e.of[WITNESS].unrest = unrest;
        e.of[WITNESS].unrest_ms = k.sip_ms - moved_ms;
        face(ME, 0);
        saw(WITNESS, 3000)->t_ms -= ago_ms;
        snprintf(text, sizeof text, "clock %u, %u ms ago", (unsigned)clocks[i], (unsigned)ago_ms);
        TEST_ASSERT_EQUAL_MESSAGE(expect, reads(1000), text);
    }
}

void test_glimpses_older_than_forty_seconds_do_not_compare(void) {
    looked_ago(40000, AGAINST);
    looked_ago(40001, 0);
}

// Before what moves nothing is known of what stands still: what was seen since counts, and ten seconds
// always.
void test_what_was_seen_before_something_moved_is_old(void) {
    static const uint32_t moved[][2] = {{8001, 10000}, {15000, 15000}, {39000, 39000}, {50000, 40000}};
    for (int i = 0; i < 4; i++) {
        for (uint32_t late = 0; late < 2; late++) {
            setUp();
            e.of[WITNESS].unrest = true;
            e.of[WITNESS].unrest_ms = k.sip_ms - moved[i][0];
            looked_ago(moved[i][1] + late, late == 0 ? AGAINST : 0);
        }
    }
}

// ... before any other sonar in use, and whoever looks first; what moves before itself may be its fault.
void test_who_saw_something_move_makes_old_what_all_saw(void) {
    static const struct {
        int who; // saw something move 15 s ago
        bool out;
        bool counts; // what was seen 20 s ago
    } by[] = {{WITNESS, false, false}, {THIRD, false, false}, {15, false, false},
              {THIRD, true, true},     {ME, false, true},     {ME, true, true}};
    for (int i = 0; i < 6; i++) {
        for (int later = 0; later < 2; later++) {
            setUp();
            face(ME, 0);
            argus_glimpse_t mine = here(ME);
            if (later != 0) {
                reads(1000);
            } else {
                saw(WITNESS, 3000);
            }
            k.sip_ms += 20000;
            e.of[by[i].who].unrest = true;
            e.of[by[i].who].unrest_ms = k.sip_ms - 15000;
            k.sonar[by[i].who].health = by[i].out && by[i].who != ME ? ARGUS_DISABLED : ARGUS_HEALTHY;
            if (later != 0) {
                looks_there(WITNESS, &mine, 3000);
            } else {
                reads(1000);
            }
            snprintf(text, sizeof text, "case %d, later %d", i, later);
            TEST_ASSERT_EQUAL_MESSAGE(by[i].counts, score_of(ME) > 0, text);
        }
    }
}

// The place is kept modulo 65,536 mm: the seam changes nothing, and half the world away is not here.
void test_the_seam_of_the_coordinates_changes_nothing(void) {
    static const int32_t seams[] = {0, 32768, 65536, -32768, -65536, 131072, 1000000, -1000000};
    for (int i = 0; i < 8; i++) {
        for (int off = -300; off <= 300; off += 25) {
            setUp();
            k.pose.x_mm = seams[i] + off;
            k.pose.y_mm = -seams[i] - off;
            face(ME, 0);
            argus_glimpse_t *then = saw(WITNESS, 1700);
            then->x_mm = (uint16_t)(then->x_mm - 200);
            snprintf(text, sizeof text, "x %d", (int)k.pose.x_mm);
            TEST_ASSERT_EQUAL_MESSAGE(FOR, reads(1500), text);
        }
    }
    TEST_ASSERT_EQUAL(0, compared_from(0, 32768, 0, 3000, 1000));
    TEST_ASSERT_EQUAL(0, compared_from(0, 0, 32768, 3000, 1000));
}

// Of several glimpses of one sonar the latest decides; where it contradicts, one before it that agrees makes
// it undecided.
void test_the_latest_glimpse_of_a_witness_decides(void) {
    face(ME, 0);
    saw(WITNESS, 2000);
    saw(WITNESS, 3000);
    saw(WITNESS, 1000)->bearing_cdeg = 2000; // elsewhere
    TEST_ASSERT_EQUAL(AGAINST, reads(1000));
    setUp();
    face(ME, 0);
    saw(WITNESS, 3000);
    saw(WITNESS, 1000);
    TEST_ASSERT_EQUAL(FOR, reads(1000));
    setUp();
    face(ME, 0);
    saw(WITNESS, 1000);
    saw(WITNESS, 3000);
    TEST_ASSERT_EQUAL(0, reads(1000));
}

// Beside a step of what is seen a reading may be of either side: any other sonar, 5 degrees off or less, that
// saw the same excuses it; silence excuses silence; one that is no witness excuses nothing.
void test_what_another_saw_a_little_aside_is_not_contradicted(void) {
    static const struct {
        int off_cdeg;
        int aside_mm; // what it saw there
        int mm;       // what ME reads
        int expect;
    } by[] = {{500, 1000, 1000, 0},          {-500, 1000, 1000, 0},
              {501, 1000, 1000, AGAINST},    {-501, 1000, 1000, AGAINST},
              {400, 1130, 1000, 0},          {400, 1131, 1000, AGAINST},
              {400, NONE_MM, NONE_MM, 0},    {400, NONE_MM, 1000, AGAINST},
              {400, 1000, NONE_MM, AGAINST}, {501, NONE_MM, NONE_MM, AGAINST}};
    for (int i = 0; i < 10; i++) {
        for (int who = WITNESS; who <= THIRD; who++) {
            for (int out = 0; out < 2; out++) {
                setUp();
                face(ME, 0);
                saw(who, by[i].aside_mm)->bearing_cdeg = (int16_t)by[i].off_cdeg;
                saw(WITNESS, 3000);
                k.sonar[THIRD].health = out != 0 ? ARGUS_DISABLED : ARGUS_HEALTHY;
                const int expect = out != 0 && who == THIRD ? AGAINST : by[i].expect;
                snprintf(text, sizeof text, "case %d, by %d, out %d", i, who, out);
                TEST_ASSERT_EQUAL_MESSAGE(expect, reads(by[i].mm), text);
            }
        }
    }
}

// A step is looked at anew: what was seen aside longer ago than ten seconds excuses nothing.
void test_what_was_seen_aside_long_ago_excuses_nothing(void) {
    for (uint32_t late = 0; late < 2; late++) {
        setUp();
        face(ME, 0);
        argus_glimpse_t *aside = saw(THIRD, 1000);
        aside->bearing_cdeg = 400;
        aside->t_ms -= 10000u + late;
        saw(WITNESS, 3000);
        TEST_ASSERT_EQUAL(late == 0 ? 0 : AGAINST, reads(1000));
    }
}

// What nobody had seen when it was read is judged by the next sonar that looks there, as if it had looked
// before; once.
void test_what_is_read_is_judged_by_who_looks_there_later(void) {
    static const struct {
        int mine;
        int theirs;
        int expect;
    } by[] = {{1000, 3000, AGAINST_BOTH},
              {1000, 1050, FOR},
              {NONE_MM, 3000, AGAINST_BOTH},
              {NONE_MM, NONE_MM, 0},
              {1000, NONE_MM, AGAINST_BOTH}};
    for (int i = 0; i < 5; i++) {
        setUp();
        e.of[ME].score[ARGUS_TEST_PEERS] = 100;
        face(ME, 0);
        TEST_ASSERT_EQUAL(0, reads(by[i].mine));
        const argus_glimpse_t mine = here(ME);
        for (int who = WITNESS; who <= THIRD; who++) {
            memset(e.peers.of[ME].counted, 0,
                   sizeof e.peers.of[ME].counted); // not that place keeps it at one
            k.sip_ms += 300;
            looks_there(who, &mine, by[i].theirs);
            snprintf(text, sizeof text, "case %d, after sonar %d", i, who);
            TEST_ASSERT_EQUAL_MESSAGE(100 + by[i].expect, score_of(ME), text);
            TEST_ASSERT_EQUAL_HEX16_MESSAGE(by[i].expect > 0 ? 1u << WITNESS : 0u, e.peers.of[ME].against,
                                            text);
        }
    }
}

// ... nor does it tell of lags again and again: who looks there and can say nothing changes nothing.
void test_who_can_say_nothing_changes_nothing(void) {
    static const int theirs[] = {149, NONE_MM}; // too near, silence far beyond what must be heard
    for (int i = 0; i < 2; i++) {
        setUp();
        face(ME, 0);
        saw(THIRD, 4700)->bearing_cdeg = 9000;
        saw(ME, 4700)->bearing_cdeg = 9000;
        saw(ME, 4700)->bearing_cdeg = 9000;
        reads(4700); // which two firings ago would have agreed
        TEST_ASSERT_EQUAL(50, argus_peers_late(&e.peers, ME));
        const argus_glimpse_t mine = here(ME);
        const argus_peer_t was = e.peers.of[ME];
        for (int n = 0; n < 30; n++) {
            looks_there(WITNESS, &mine, theirs[i]);
        }
        TEST_ASSERT_EQUAL_MEMORY(&was, &e.peers.of[ME], sizeof was);
    }
}

// In the open: who made echoes up is silent there only when it does well again. From one place once; where
// another one hears something it begins anew.
void test_being_silent_together_brings_back_who_made_echoes_up(void) {
    static const argus_fault_kind_t kinds[] = {ARGUS_KIND_STUCK,  ARGUS_KIND_GARBAGE, ARGUS_KIND_OFF,
                                               ARGUS_KIND_SILENT, ARGUS_KIND_WRONG,   ARGUS_KIND_SLOW};
    for (int i = 0; i < (int)(sizeof kinds / sizeof kinds[0]); i++) {
        setUp();
        put_health(&k.sonar[ME], ARGUS_DISABLED, kinds[i], k.sip_ms);
        e.of[ME].out = true;
        e.of[ME].score[ARGUS_TEST_VIEW] = 600;
        face(ME, 0);
        k.sip_ms += 300;
        saw(WITNESS, NONE_MM);
        reads(NONE_MM);
        reads(NONE_MM);
        const bool counts = kinds[i] == ARGUS_KIND_STUCK || kinds[i] == ARGUS_KIND_GARBAGE;
        TEST_ASSERT_EQUAL_MESSAGE(counts, e.of[ME].agreed, argus_name(ARGUS_NAME_KIND, kinds[i]));
        TEST_ASSERT_EQUAL(counts ? 520 : 600, e.of[ME].score[ARGUS_TEST_VIEW]);
        k.pose.x_mm += 150;
        saw(WITNESS, NONE_MM);
        reads(NONE_MM);
        TEST_ASSERT_EQUAL(counts ? 2 : 0, e.of[ME].agreed);
        k.pose.x_mm += 150;
        saw(WITNESS, NONE_MM);
        saw(THIRD, 1500);
        reads(NONE_MM);
        TEST_ASSERT_EQUAL(0, e.of[ME].agreed);
    }
}

// One that was given up is not brought back by what it read before that.
void test_what_it_read_before_it_was_given_up_does_not_bring_it_back(void) {
    for (int after = 0; after < 2; after++) {
        setUp();
        face(ME, 0);
        k.sip_ms = START_MS;
        reads(1000);
        const argus_glimpse_t mine = here(ME);
        k.sonar[ME].health = ARGUS_DISABLED;
        k.sonar[ME].kind = ARGUS_KIND_OFF;
        k.sonar[ME].since_ms = after != 0 ? START_MS : START_MS + 1;
        k.sip_ms += 2000;
        looks_there(WITNESS, &mine, 1000);
        TEST_ASSERT_EQUAL(after, e.of[ME].agreed);
    }
}

// ... for forty seconds, and from its place on its bearing only.
void test_what_is_read_is_not_judged_from_elsewhere_or_too_late(void) {
    static const struct {
        uint32_t later_ms;
        int dx_mm;
        int32_t turn_cdeg;
        int expect;
    } by[] = {{40000, 0, 0, AGAINST_BOTH},
              {40001, 0, 0, 0},
              {300, 200, 0, AGAINST_BOTH},
              {300, 201, 0, 0},
              {300, 0, 301, 0}};
    for (int i = 0; i < 5; i++) {
        setUp();
        face(ME, 0);
        reads(1000);
        const argus_glimpse_t mine = here(ME);
        k.sip_ms += by[i].later_ms;
        face(WITNESS, by[i].turn_cdeg);
        k.pose.x_mm += (int16_t)(mine.x_mm - here(WITNESS).x_mm) + by[i].dx_mm;
        k.pose.y_mm += (int16_t)(mine.y_mm - here(WITNESS).y_mm);
        k.sonar[WITNESS].reading_mm = 3000;
        argus_peers_take(&e, &k, WITNESS);
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].expect, score_of(ME), text);
    }
}

// 64 glimpses of a sonar are remembered, in a ring.
void test_the_last_glimpses_are_remembered(void) {
    for (int since = 0; since < 2 * ARGUS_GLIMPSES; since++) {
        setUp();
        face(ME, 0);
        for (int i = 0; i < 20; i++) { // the ring is not at its beginning
            saw(WITNESS, 1000)->bearing_cdeg = 9000;
        }
        saw(WITNESS, 3000);
        for (int i = 0; i < since; i++) {
            saw(WITNESS, 1000)->bearing_cdeg = 9000;
        }
        snprintf(text, sizeof text, "%d since", since);
        TEST_ASSERT_EQUAL_MESSAGE(since < ARGUS_GLIMPSES ? AGAINST : 0, reads(1000), text);
    }
}

// A reading is a glimpse for the others, from then on: what ME read contradicts what the next one reads.
void test_what_is_read_is_a_glimpse_for_the_others(void) {
    for (int i = 0; i < 3 * ARGUS_GLIMPSES; i++) {
        face(ME, 0);
        reads(i % 2 == 0 ? 2000 : 3000); // alike they would be one glimpse
        TEST_ASSERT_EQUAL(argus_min(i + 1, ARGUS_GLIMPSES), e.peers.of[ME].count);
    }
    const argus_glimpse_t mine = here(ME);
    looks_there(WITNESS, &mine, 1000);
    TEST_ASSERT_EQUAL(AGAINST, score_of(WITNESS));
    TEST_ASSERT_EQUAL_HEX16(1u << ME, e.peers.of[WITNESS].against);
}

// Nobody is his own witness.
void test_what_a_sonar_saw_itself_says_nothing(void) {
    for (int sonar = 0; sonar < ARGUS_SONARS; sonar++) {
        setUp();
        for (int i = 0; i < 4; i++) {
            face(sonar, 0);
            k.sip_ms += 5000;
            k.sonar[sonar].reading_mm = i % 2 == 0 ? 3000 : 1000;
            argus_peers_take(&e, &k, sonar);
            TEST_ASSERT_EQUAL(0, score_of(sonar));
        }
    }
}

// ---- several witnesses

// As many as differ are enough to bear it out; fewer leave it undecided.
void test_a_reading_is_contradicted_where_nobody_bears_it_out(void) {
    for (int agree = 0; agree <= 3; agree++) {
        for (int differ = 0; differ <= 3; differ++) {
            setUp();
            face(ME, 0);
            for (int i = 0; i < agree; i++) {
                saw(6 + i, 1000);
            }
            for (int i = 0; i < differ; i++) {
                saw(10 + i, 3000);
            }
            const int expect = agree == 0 ? (differ > 0 ? AGAINST : 0) : (agree >= differ ? FOR : 0);
            snprintf(text, sizeof text, "%d agree, %d differ", agree, differ);
            TEST_ASSERT_EQUAL_MESSAGE(expect, reads(1000), text);
            TEST_ASSERT_EQUAL_MESSAGE(expect == AGAINST ? differ : 0, argus_peers_against(&e.peers, ME),
                                      text);
        }
    }
}

// Who contradicts is kept as long as the score is above 0.
void test_those_against_are_forgotten_with_the_score(void) {
    face(ME, 0);
    for (int i = 0; i < 3; i++) {
        e.of[ME].score[ARGUS_TEST_PEERS] = 100;
        e.peers.of[ME].against = 1u << 12;
        saw(WITNESS, 3000);
        TEST_ASSERT_EQUAL(AGAINST, reads(1000));
        TEST_ASSERT_EQUAL_HEX16(1u << 12 | 1u << WITNESS, e.peers.of[ME].against);
        e.of[ME].score[ARGUS_TEST_PEERS] = (int16_t)(-FOR + 1 - i);
        k.sip_ms += 4000;
        saw(WITNESS, 1000);
        TEST_ASSERT_EQUAL(FOR, reads(1000));
        TEST_ASSERT_EQUAL(i == 0 ? 2 : 0, argus_peers_against(&e.peers, ME));
        k.sip_ms += 10001; // what agreed excuses nothing any more
    }
}

// That an echo of it was borne out is kept as long as the score is above 0.
void test_an_echo_borne_out_is_forgotten_with_the_score(void) {
    static const struct {
        int score; // before
        int mm;
        bool borne_out; // after
    } step[] = {{500, 3000, false},    {500, NONE_MM, false},  {500, 1000, true},
                {500, NONE_MM, true},  {-FOR + 1, 1000, true}, {-FOR, 1000, false},
                {500, NONE_MM, false}, {500, 1000, true},      {0, 1000, false}};
    for (int i = 0; i < 9; i++) {
        k.sip_ms += 4000;
        face(ME, 0);
        saw(WITNESS, 1000);
        e.of[ME].score[ARGUS_TEST_PEERS] = (int16_t)step[i].score;
        TEST_ASSERT_EQUAL(step[i].mm == 1000 ? FOR : AGAINST, reads(step[i].mm));
        snprintf(text, sizeof text, "step %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(step[i].borne_out, e.peers.of[ME].borne_out, text);
    }
}

// Where a silence has counted an echo does not count as well, but it tells that the sonar hears; not if more
// contradict it than bear it out, nor of one that nobody doubts.
void test_an_echo_borne_out_tells_though_it_does_not_count(void) {
    static const struct {
        int score;
        int witness_mm;
        int third_mm;
        int fourth_mm;
        bool borne_out;
    } by[] = {{500, 1000, 1000, 1000, true},
              {500, 1000, 1000, 3000, true},
              {500, 1000, 3000, 3000, false},
              {500, 3000, 3000, 3000, false},
              {0, 1000, 1000, 1000, false}};
    for (int i = 0; i < 5; i++) {
        for (int echo = 0; echo < 2; echo++) {
            setUp();
            face(ME, 0);
            saw(WITNESS, 1000);
            TEST_ASSERT_EQUAL(AGAINST, reads(NONE_MM));
            e.of[ME].score[ARGUS_TEST_PEERS] = (int16_t)by[i].score;
            k.sip_ms += 300;
            saw(WITNESS, by[i].witness_mm);
            saw(THIRD, by[i].third_mm);
            saw(THIRD + 1, by[i].fourth_mm);
            snprintf(text, sizeof text, "case %d, echo %d", i, echo);
            TEST_ASSERT_EQUAL_MESSAGE(0, reads(echo != 0 ? 1000 : NONE_MM), text);
            TEST_ASSERT_EQUAL_MESSAGE(echo != 0 && by[i].borne_out, e.peers.of[ME].borne_out, text);
        }
    }
}

// Whom nobody looked after, or only one who hears as little, is borne out by nobody.
void test_an_echo_that_nobody_saw_tells_nothing(void) {
    for (int far = 0; far < 2; far++) {
        setUp();
        face(ME, 0);
        if (far != 0) {
            saw(WITNESS, NONE_MM);
        }
        e.of[ME].score[ARGUS_TEST_PEERS] = 500;
        reads(4700); // farther than silence tells
        TEST_ASSERT_FALSE(e.peers.of[ME].borne_out);
    }
}

// What it heard before it fell silent says nothing of now.
void test_an_echo_that_is_judged_later_does_not_tell_that_it_hears(void) {
    for (int counts = 0; counts < 2; counts++) {
        setUp();
        face(ME, 0);
        reads(1000);
        const argus_glimpse_t mine = here(ME);
        e.of[ME].score[ARGUS_TEST_PEERS] = 500;
        e.peers.of[ME].counted[0] = mine; // its place has counted already
        e.peers.of[ME].counted[0].t_ms -= counts != 0 ? 4000u : 0u;
        k.sip_ms += 300;
        looks_there(WITNESS, &mine, 1000);
        TEST_ASSERT_EQUAL(500 + (counts != 0 ? FOR : 0), score_of(ME));
        TEST_ASSERT_FALSE(e.peers.of[ME].borne_out);
    }
}

void test_a_sonar_that_is_out_is_no_witness(void) {
    static const struct {
        argus_health_t health;
        int expect;
    } by[] = {{ARGUS_UNKNOWN, AGAINST}, {ARGUS_HEALTHY, AGAINST}, {ARGUS_SUSPECT, AGAINST},
              {ARGUS_STALE, AGAINST},   {ARGUS_DISABLED, 0},      {ARGUS_PROBATION, 0}};
    for (int i = 0; i < 6; i++) {
        setUp();
        face(ME, 0);
        saw(WITNESS, 3000);
        k.sonar[WITNESS].health = by[i].health;
        TEST_ASSERT_EQUAL_MESSAGE(by[i].expect, reads(1000), "a state of the witness");
    }
}

// A witness that is itself contradicted, at least as much, says nothing: the liar accuses nobody.
void test_a_witness_that_is_contradicted_as_much_says_nothing(void) {
    static const struct {
        int witness;
        int own;
        int expect;
    } by[] = {{0, 0, AGAINST},     {449, 0, AGAINST},   {450, 0, 0},     {450, 449, 0},        {450, 450, 0},
              {450, 451, AGAINST}, {449, 449, AGAINST}, {2400, 2000, 0}, {2000, 2001, AGAINST}};
    for (int i = 0; i < 9; i++) {
        setUp();
        face(ME, 0);
        saw(WITNESS, 3000);
        e.of[WITNESS].score[ARGUS_TEST_PEERS] = (int16_t)by[i].witness;
        e.of[ME].score[ARGUS_TEST_PEERS] = (int16_t)by[i].own;
        snprintf(text, sizeof text, "witness at %d, own %d", by[i].witness, by[i].own);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].expect, reads(1000), text);
    }
}

// ---- what counts once

static int repeats(uint32_t after_ms, int dx_mm, int dy_mm, int32_t turn_cdeg) {
    setUp();
    face(ME, 0);
    saw(WITNESS, 3000);
    TEST_ASSERT_EQUAL(AGAINST, reads(1000));
    k.sip_ms += after_ms;
    k.pose.x_mm += dx_mm;
    k.pose.y_mm += dy_mm;
    const argus_glimpse_t was = here(ME);
    k.pose.heading_cdeg = argus_angle_wrap(k.pose.heading_cdeg + turn_cdeg);
    const argus_glimpse_t is = here(ME); // turned about the transducer
    k.pose.x_mm -= (int16_t)(is.x_mm - was.x_mm);
    k.pose.y_mm -= (int16_t)(is.y_mm - was.y_mm);
    saw(WITNESS, 3000);
    return reads(1000);
}

// From one place and on one bearing one reading counts in 4 s; elsewhere, elsewhither or later the next one.
void test_one_place_and_bearing_counts_once_in_four_seconds(void) {
    TEST_ASSERT_EQUAL(0, repeats(0, 0, 0, 0));
    TEST_ASSERT_EQUAL(0, repeats(3999, 0, 0, 0));
    TEST_ASSERT_EQUAL(AGAINST, repeats(4000, 0, 0, 0));
    for (int sign = -1; sign <= 1; sign += 2) {
        TEST_ASSERT_EQUAL(0, repeats(100, sign * 99, 0, 0));
        TEST_ASSERT_EQUAL(AGAINST, repeats(100, sign * 100, 0, 0));
        TEST_ASSERT_EQUAL(0, repeats(100, 0, sign * 99, 0));
        TEST_ASSERT_EQUAL(AGAINST, repeats(100, 0, sign * 100, 0));
        TEST_ASSERT_EQUAL(0, repeats(100, 0, 0, sign * 799));
        TEST_ASSERT_EQUAL(AGAINST, repeats(100, 0, 0, sign * 800));
    }
}

// Six are remembered: the seventh makes room for the first.
void test_the_places_that_counted_last_are_remembered(void) {
    for (int others = 0; others < 9; others++) {
        setUp();
        for (int i = 0; i <= others; i++) {
            face(ME, i * 2000);
            saw(WITNESS, 3000);
            TEST_ASSERT_NOT_EQUAL(0, reads(1000));
        }
        face(ME, 0);
        saw(WITNESS, 3000);
        snprintf(text, sizeof text, "%d others", others);
        TEST_ASSERT_EQUAL_MESSAGE(others >= ARGUS_COUNTED, reads(1000) != 0, text);
    }
}

// What speaks for a sonar counts once as well.
void test_bearing_out_counts_once_too(void) {
    face(ME, 0);
    e.of[ME].score[ARGUS_TEST_PEERS] = 500;
    saw(WITNESS, 1000);
    TEST_ASSERT_EQUAL(FOR, reads(1000));
    TEST_ASSERT_EQUAL(0, reads(1000));
    TEST_ASSERT_EQUAL(16, e.peers.of[ME].verdicts);
    TEST_ASSERT_EQUAL(0, e.peers.of[ME].contradicted);
}

// ---- what it counts

// What speaks against counts a quarter while something moves before or beside it, what speaks for it in full.
void test_in_unrest_contradictions_count_a_quarter(void) {
    static const int at[] = {ME, WITNESS, 12};
    for (int i = 0; i < 3; i++) {
        for (int late = 0; late < 2; late++) {
            setUp();
            argus_note_unrest(&e, &k, at[i]);
            k.sip_ms += 7999u + (unsigned)late;
            face(ME, 0);
            saw(WITNESS, 3000);
            TEST_ASSERT_EQUAL(late == 0 ? AGAINST * 25 / 100 : AGAINST, reads(1000));
        }
        setUp();
        argus_note_unrest(&e, &k, at[i]);
        face(ME, 0);
        saw(WITNESS, 1000);
        TEST_ASSERT_EQUAL(FOR, reads(1000));
    }
}

// The more the others are contradicted, the less it means: the log of 0.8 over their part, from 5 % to 60 %.
void test_where_many_are_contradicted_it_means_less(void) {
    static const int bears_out[] = {-93, -90, -87, -83, -79, -75, -70, -66, -60, -55, -48, -41};
    for (int step = 0; step < 12; step++) {
        for (int agrees = 0; agrees < 2; agrees++) {
            setUp();
            face(ME, 0);
            e.of[ME].score[ARGUS_TEST_PEERS] = 500;
            e.peers.of[7].verdicts = 1504; // 1600 with those of the start
            e.peers.of[7].contradicted = (uint16_t)(80 * (step + 1) - 5);
            e.peers.of[ME].verdicts = e.peers.of[ME].contradicted = 6000; // its own say nothing
            saw(WITNESS, agrees != 0 ? 1000 : 3000);
            const int against = (int)lround(100 * log(0.8 / (0.05 * (step + 1))));
            snprintf(text, sizeof text, "step %d", step);
            TEST_ASSERT_EQUAL_MESSAGE(agrees != 0 ? bears_out[step] : against, reads(1000), text);
        }
    }
}

// At the start, as if one in twenty of six readings had been contradicted; the part is rounded.
void test_the_first_contradictions_are_weighed_by_what_is_usual(void) {
    static const struct {
        int contradicted;
        int expect;
    } by[] = {{0, 277}, {2, 277}, {3, 208}, {6, 208}, {7, 167}, {11, 167}, {12, 139}};
    for (int i = 0; i < 7; i++) {
        setUp();
        face(ME, 0);
        saw(WITNESS, 3000);
        e.peers.of[7].contradicted = (uint16_t)by[i].contradicted;
        snprintf(text, sizeof text, "%d sixteenths", by[i].contradicted);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].expect, reads(1000), text);
    }
}

// However many are contradicted, and however few: the table has an end.
void test_the_part_that_is_contradicted_has_bounds(void) {
    face(ME, 0);
    saw(WITNESS, 3000);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        e.peers.of[i].verdicts = e.peers.of[i].contradicted = UINT16_MAX;
    }
    TEST_ASSERT_EQUAL(29, reads(1000));
    setUp();
    face(ME, 0);
    saw(WITNESS, 3000);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        e.peers.of[i].verdicts = UINT16_MAX;
    }
    TEST_ASSERT_EQUAL(AGAINST, reads(1000));
}

// Among people more than 35 % of all that the sonars in use read is contradicted, whoever reads it; of 1,600
// sixteenths, those of the start among them (5 contradicted).
void test_a_crowd_is_told_by_the_part_that_is_contradicted(void) {
    for (int who = 0; who < ARGUS_SONARS; who++) {
        setUp();
        e.peers.of[who].verdicts = 1504;
        e.peers.of[who].contradicted = 555;
        TEST_ASSERT_FALSE(argus_peers_crowded(&e.peers, &k));
        e.peers.of[who].contradicted = 556;
        TEST_ASSERT_TRUE(argus_peers_crowded(&e.peers, &k));
        put_health(&k.sonar[who], ARGUS_DISABLED, ARGUS_KIND_OFF, 0);
        TEST_ASSERT_FALSE(argus_peers_crowded(&e.peers, &k)); // a liar makes none
    }
}

// ... and it is one for 30 s from then on.
void test_a_crowd_lasts_for_30_s(void) {
    k.fresh = 0;
    k.sip_ms = START_MS;
    e.peers.of[7].verdicts = 1504;
    e.peers.of[7].contradicted = 1504;
    e.peers.faded_ms = k.sip_ms;
    argus_evidence_sip(&e, &k);
    TEST_ASSERT_TRUE(e.crowded);
    e.peers.of[7].contradicted = 0;
    k.sip_ms = START_MS + 29999u;
    argus_evidence_sip(&e, &k);
    TEST_ASSERT_TRUE(e.crowded);
    k.sip_ms++;
    argus_evidence_sip(&e, &k);
    TEST_ASSERT_FALSE(e.crowded);
}

// Every verdict counts 16 and fades by an eighth a second.
void test_the_verdicts_of_the_others_fade(void) {
    face(ME, 0);
    saw(WITNESS, 3000);
    reads(1000);
    TEST_ASSERT_EQUAL(16, e.peers.of[ME].verdicts);
    TEST_ASSERT_EQUAL(16, e.peers.of[ME].contradicted);
    e.peers.of[ARGUS_SONARS - 1].verdicts = 800;
    e.peers.faded_ms = k.sip_ms - 999;
    argus_peers_sip(&e, &k);
    TEST_ASSERT_EQUAL(16, e.peers.of[ME].verdicts);
    k.sip_ms++;
    argus_peers_sip(&e, &k);
    TEST_ASSERT_EQUAL(14, e.peers.of[ME].verdicts);
    TEST_ASSERT_EQUAL(14, e.peers.of[ME].contradicted);
    TEST_ASSERT_EQUAL(700, e.peers.of[ARGUS_SONARS - 1].verdicts);
    argus_peers_sip(&e, &k);
    TEST_ASSERT_EQUAL(14, e.peers.of[ME].verdicts);
}

// What they say of a sonar fades by a sixtieth a second, either way, where nobody says more; who said it is
// forgotten with it.
void test_what_the_others_say_fades(void) {
    static const struct {
        int before;
        int after;
    } by[] = {{2500, 2459}, {600, 590}, {119, 118}, {60, 59},   {59, 58},
              {1, 0},       {0, 0},     {-1, 0},    {-59, -58}, {-150, -148}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        setUp();
        e.of[ME].score[ARGUS_TEST_PEERS] = (int16_t)by[i].before;
        e.of[ME].score[ARGUS_TEST_VIEW] = 700;
        e.peers.of[ME].against = 1u << WITNESS;
        e.peers.of[ME].borne_out = true;
        e.peers.of[ME].bend[1] = 600;
        k.sip_ms = e.peers.faded_ms + 999;
        argus_peers_sip(&e, &k);
        TEST_ASSERT_EQUAL(by[i].before, e.of[ME].score[ARGUS_TEST_PEERS]);
        k.sip_ms++;
        argus_peers_sip(&e, &k);
        TEST_ASSERT_EQUAL(by[i].after, e.of[ME].score[ARGUS_TEST_PEERS]);
        TEST_ASSERT_EQUAL(700, e.of[ME].score[ARGUS_TEST_VIEW]);
        TEST_ASSERT_EQUAL(by[i].after > 0, argus_peers_against(&e.peers, ME));
        TEST_ASSERT_EQUAL(by[i].after > 0, e.peers.of[ME].borne_out);
        TEST_ASSERT_EQUAL(590, e.peers.of[ME].bend[1]);
    }
}

// What counts for the peers counts for the bends of the axis, each reading once.
void test_a_counted_reading_is_asked_aside_as_well(void) {
    face(ME, 0);
    saw(WITNESS, 1500);
    argus_glimpse_t *aside = saw(WITNESS, 3000);
    aside->bearing_cdeg = 1800;
    TEST_ASSERT_EQUAL(AGAINST, reads(3000));
    TEST_ASSERT_EQUAL(AGAINST + 150, e.peers.of[ME].bend[4]);
    TEST_ASSERT_EQUAL(160, e.peers.of[ME].bend_told[4]);
    TEST_ASSERT_EQUAL(0, reads(3000)); // no news
    TEST_ASSERT_EQUAL(AGAINST + 150, e.peers.of[ME].bend[4]);
}

// What a sonar that is out has said of others is taken back: the whole where nobody else says so.
void test_what_a_liar_said_is_taken_back_when_it_is_out(void) {
    for (int other = 0; other < 2; other++) {
        setUp();
        e.of[ME].score[ARGUS_TEST_PEERS] = 700;
        argus_peer_t *peer = &e.peers.of[ME];
        peer->against = (uint16_t)(1u << WITNESS | (other != 0 ? 1u : 0u));
        peer->borne_out = true;
        peer->hollow = 1;
        peer->late[5] = peer->told[5] = 900;
        peer->bend[2] = peer->bend_told[2] = 900;
        argus_evidence_retract(&e, WITNESS);
        TEST_ASSERT_EQUAL(other != 0 ? 700 : 0, e.of[ME].score[ARGUS_TEST_PEERS]);
        TEST_ASSERT_EQUAL(other, peer->borne_out);
        TEST_ASSERT_EQUAL(other, argus_peers_hollow(&e.peers, ME, 8));
        TEST_ASSERT_EQUAL(other * 900, argus_peers_late(&e.peers, ME));
        TEST_ASSERT_EQUAL(other * 900, argus_peers_told(&e.peers, ME));
        TEST_ASSERT_EQUAL(other * 900, peer->bend[2]);
        TEST_ASSERT_EQUAL(other * 900, peer->bend_told[2]);
        TEST_ASSERT_EQUAL(other, argus_peers_against(&e.peers, ME));
    }
    setUp();
    e.of[ME].score[ARGUS_TEST_PEERS] = 700;
    e.peers.of[ME].against = 1u;
    argus_evidence_retract(&e, WITNESS);
    TEST_ASSERT_EQUAL(700, e.of[ME].score[ARGUS_TEST_PEERS]);
    TEST_ASSERT_EQUAL(1, argus_peers_against(&e.peers, ME));
}

// An echo that others bear out is a step on the way back of one that was dead, stuck or noisy, of no other.
void test_who_is_out_comes_back_on_echoes_that_are_borne_out(void) {
    static const struct {
        int health;
        int kind;
        int reading_mm;
        int agreed;
    } by[] = {{ARGUS_DISABLED, ARGUS_KIND_OFF, 3000, 1},   {ARGUS_DISABLED, ARGUS_KIND_SILENT, 3000, 1},
              {ARGUS_DISABLED, ARGUS_KIND_STUCK, 3000, 1}, {ARGUS_PROBATION, ARGUS_KIND_GARBAGE, 3000, 1},
              {ARGUS_DISABLED, ARGUS_KIND_WRONG, 3000, 0}, {ARGUS_DISABLED, ARGUS_KIND_SLOW, 3000, 0},
              {ARGUS_PROBATION, ARGUS_KIND_NONE, 3000, 0}, {ARGUS_DISABLED, ARGUS_KIND_INTERMITTENT, 3000, 0},
              {ARGUS_SUSPECT, ARGUS_KIND_STUCK, 3000, 0},  {ARGUS_DISABLED, ARGUS_KIND_STUCK, 1000, 0},
              {ARGUS_DISABLED, ARGUS_KIND_OFF, NONE_MM, 0}};
    for (int i = 0; i < (int)(sizeof by / sizeof by[0]); i++) {
        setUp();
        face(ME, 0);
        saw(WITNESS, 3000);
        k.sonar[ME].health = (argus_health_t)by[i].health;
        k.sonar[ME].kind = (argus_fault_kind_t)by[i].kind;
        reads(by[i].reading_mm);
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_MESSAGE(by[i].agreed, e.of[ME].agreed, text);
    }
}

// ... in a row: garbage agrees by chance now and then.
void test_a_contradiction_begins_the_way_back_anew(void) {
    static const argus_fault_kind_t kinds[] = {ARGUS_KIND_OFF, ARGUS_KIND_SILENT, ARGUS_KIND_STUCK,
                                               ARGUS_KIND_GARBAGE, ARGUS_KIND_WRONG};
    for (int i = 0; i < 5; i++) {
        setUp();
        face(ME, 0);
        saw(WITNESS, 3000);
        k.sonar[ME].health = ARGUS_PROBATION;
        k.sonar[ME].kind = kinds[i];
        e.of[ME].agreed = 3;
        reads(1000);
        TEST_ASSERT_EQUAL(kinds[i] == ARGUS_KIND_WRONG ? 3 : 0, e.of[ME].agreed);
    }
}

// What one that is out reads does not tell what is usual among the others.
void test_who_is_out_does_not_count_for_what_is_usual(void) {
    for (int out = 0; out < 2; out++) {
        setUp();
        face(ME, 0);
        saw(WITNESS, 3000);
        e.peers.of[7].verdicts = e.peers.of[7].contradicted = 6000;
        k.sonar[7].health = out != 0 ? ARGUS_DISABLED : ARGUS_SUSPECT;
        TEST_ASSERT_EQUAL(out != 0 ? AGAINST : 29, reads(1000));
    }
}

// Which of the contradicted readings had no echo, the last first; those borne out are not among them.
void test_hollow_counts_the_contradicted_readings_without_an_echo(void) {
    static const int mm[] = {NONE_MM, 1000, NONE_MM, NONE_MM, 3000, NONE_MM};
    static const int want[] = {0, 1, 2, 3, 3, 4, 4, 4, 4, 4};
    for (int i = 0; i < 6; i++) {
        k.sip_ms += 4000;
        face(ME, 0);
        saw(WITNESS, 3000);
        reads(mm[i]); // 3000: borne out
    }
    for (int of = 0; of < 10; of++) {
        TEST_ASSERT_EQUAL(want[of], argus_peers_hollow(&e.peers, ME, of));
    }
    for (int i = 0; i < 12; i++) {
        k.sip_ms += 4000;
        saw(WITNESS, 3000);
        reads(NONE_MM);
    }
    TEST_ASSERT_EQUAL(8, argus_peers_hollow(&e.peers, ME, 8));
    TEST_ASSERT_EQUAL(8, argus_peers_hollow(&e.peers, ME, 100));
    TEST_ASSERT_EQUAL(3, argus_peers_hollow(&e.peers, ME, 3));
    TEST_ASSERT_EQUAL(0, argus_peers_hollow(&e.peers, WITNESS, 8));
}

// ---- where the ping was sent

static argus_glimpse_t pinged(argus_pose_t before, argus_pose_t now, uint32_t passed_ms) {
    setUp();
    k.pose = before;
    k.sip_ms -= passed_ms;
    argus_peers_sip(&e, &k);
    k.sip_ms += passed_ms;
    k.pose = now;
    reads(1000);
    return e.peers.of[ME].seen[0];
}

static void pinged_at(argus_pose_t want, argus_pose_t before, argus_pose_t now, uint32_t passed_ms) {
    const argus_glimpse_t got = pinged(before, now, passed_ms);
    k.pose = want;
    const argus_glimpse_t expect = here(ME);
    snprintf(text, sizeof text, "%u ms passed", (unsigned)passed_ms);
    TEST_ASSERT_EQUAL_MESSAGE(expect.x_mm, got.x_mm, text);
    TEST_ASSERT_EQUAL_MESSAGE(expect.y_mm, got.y_mm, text);
    TEST_ASSERT_EQUAL_MESSAGE(expect.bearing_cdeg, got.bearing_cdeg, text);
    TEST_ASSERT_EQUAL_MESSAGE(1000, got.reading_mm, text);
}

// The pings of a SIP are some 70 ms old; a gap tells nothing of where the robot was.
void test_the_place_of_a_ping_is_between_the_last_two_poses(void) {
    const argus_pose_t from = {65500, -20, 17900}, to = {65600, -220, -17900};
    pinged_at((argus_pose_t){65530, -80, 17960}, from, to, 100);
    pinged_at((argus_pose_t){65565, -150, -17970}, from, to, 200);
    pinged_at(from, from, to, 70);
    pinged_at(from, from, to, 30);
    pinged_at((argus_pose_t){65577, -174, -17946}, from, to, 300);
    pinged_at(to, from, to, 301);
    pinged_at(to, from, to, 100000);
    pinged_at(to, from, to, 0);
    setUp(); // the first SIP of a session
    k.pose = to;
    k.sip_ms = 100;
    const argus_glimpse_t expect = here(ME);
    reads(1000);
    TEST_ASSERT_EQUAL(expect.x_mm, e.peers.of[ME].seen[0].x_mm);
    TEST_ASSERT_EQUAL(expect.bearing_cdeg, e.peers.of[ME].seen[0].bearing_cdeg);
}

// ---- the lags

#define LAG 5
#define BEFORE 500 // of both sums, so that both ways show
enum { UNSEEN, QUIET, AGREED, CONTRADICTED, DIVIDED, SAME, HALVED };

// Seen on that bearing: what makes an echo of 1000, or no echo at all, come to the verdict.
static void seen_on(int32_t bearing_cdeg, int verdict, bool silent) {
    static const int echo[][3] = {{0}, {0}, {1000}, {3000}, {1000, 3000, 3000}, {0}, {1000, 3000}};
    static const int none[][3] = {{0}, {NONE_MM}, {0}, {3000}, {NONE_MM, 3000, 3000}, {0}, {0}};
    for (int i = 0; i < 3; i++) {
        argus_glimpse_t glimpse = here(ME);
        glimpse.bearing_cdeg = (int16_t)bearing_cdeg;
        glimpse.reading_mm = (uint16_t)(silent ? none : echo)[verdict][i];
        if (glimpse.reading_mm > 0) {
            remember(WITNESS + i, glimpse);
        }
    }
}

// ME looked to 90 degrees five readings ago and to nowhere that anybody saw at the other times.
static void was_elsewhere(int32_t lag_cdeg, int32_t other_cdeg) {
    for (int back = ARGUS_TRAIL; back >= 1; back--) {
        argus_glimpse_t glimpse = here(ME);
        glimpse.bearing_cdeg = (int16_t)(back == LAG ? lag_cdeg : other_cdeg);
        glimpse.reading_mm = NONE_MM;
        remember(ME, glimpse);
    }
    for (int n = 0; n < ARGUS_TRAIL; n++) {
        e.peers.of[ME].late[n] = e.peers.of[ME].told[n] = BEFORE;
    }
}

static void weigh(int now, int then) {
    setUp();
    face(ME, 0);
    const bool silent = now == QUIET || then == QUIET;
    seen_on(0, now, silent);
    seen_on(9000, then, silent);
    was_elsewhere(then == SAME ? 0 : 9000, -9000);
    reads(silent ? NONE_MM : 1000);
}

// What agrees as of then and not as of now speaks for a lag; what is contradicted then speaks against it.
void test_a_lag_is_weighed_by_what_was_seen_then_and_now(void) {
    static const struct {
        int now;
        int then;
        int late;
        int told;
    } row[] = {
        {UNSEEN, UNSEEN, 0, 0},
        {UNSEEN, AGREED, 50, 0},
        {UNSEEN, CONTRADICTED, -200, 0},
        {UNSEEN, DIVIDED, 0, 0},
        {UNSEEN, SAME, 0, 0},
        {UNSEEN, HALVED, 50, 0}, // as many agree as differ
        {HALVED, CONTRADICTED, -400, -390},
        {UNSEEN, QUIET, 0, 0},
        {QUIET, UNSEEN, 0, 0},
        {QUIET, QUIET, 0, 0},
        {QUIET, CONTRADICTED, -350, 0},
        {QUIET, DIVIDED, 0, 0},
        {DIVIDED, QUIET, 0, 0},
        {DIVIDED, AGREED, 0, 0},
        {AGREED, UNSEEN, 0, 0},
        {AGREED, AGREED, 0, 0},
        {AGREED, CONTRADICTED, -400, -390},
        {AGREED, SAME, 0, 0},
        {CONTRADICTED, UNSEEN, 0, 0},
        {CONTRADICTED, QUIET, 100, 230},
        {CONTRADICTED, AGREED, 300, 230},
        {CONTRADICTED, CONTRADICTED, -150, -300},
        {CONTRADICTED, DIVIDED, 0, 0},
        {CONTRADICTED, SAME, -150, -150},
        {DIVIDED, CONTRADICTED, 0, 0},
        {DIVIDED, SAME, 0, 0},
    };
    for (int i = 0; i < (int)(sizeof row / sizeof row[0]); i++) {
        weigh(row[i].now, row[i].then);
        const argus_peer_t *peer = &e.peers.of[ME];
        snprintf(text, sizeof text, "now %d, then %d", row[i].now, row[i].then);
        for (int n = 0; n < ARGUS_TRAIL; n++) {
            TEST_ASSERT_EQUAL_MESSAGE(BEFORE + (n == LAG ? row[i].late : 0), peer->late[n], text);
            TEST_ASSERT_EQUAL_MESSAGE(BEFORE + (n == LAG ? row[i].told : 0), peer->told[n], text);
        }
        TEST_ASSERT_EQUAL(BEFORE + argus_max(0, row[i].late), argus_peers_late(&e.peers, ME));
        TEST_ASSERT_EQUAL(BEFORE + argus_max(0, row[i].told), argus_peers_told(&e.peers, ME));
    }
}

// From nothing known of a lag: what speaks for it is taken in, what speaks against it leaves nothing.
void test_a_lag_of_which_nothing_is_known_is_weighed_too(void) {
    for (int now = UNSEEN; now <= SAME; now++) {
        for (int told_first = 0; told_first < 2; told_first++) {
            setUp();
            face(ME, 0);
            seen_on(0, now, false);
            seen_on(9000, now == AGREED ? CONTRADICTED : AGREED, false);
            was_elsewhere(9000, -9000);
            memset(e.peers.of[ME].late, 0, sizeof e.peers.of[ME].late);
            memset(e.peers.of[ME].told, 0, sizeof e.peers.of[ME].told);
            e.peers.of[ME].told[LAG] = told_first != 0 ? BEFORE : 0;
            reads(1000);
            const bool unseen = now == UNSEEN || now == QUIET || now == SAME; // an echo is never quiet
            const int expect = unseen ? 50 : (now == CONTRADICTED ? 300 : 0);
            snprintf(text, sizeof text, "now %d, told first %d", now, told_first);
            TEST_ASSERT_EQUAL_MESSAGE(expect, e.peers.of[ME].late[LAG], text);
            const int more = now == CONTRADICTED ? 230 : (now == AGREED ? -390 : 0);
            const int left = argus_max(0, (told_first != 0 ? BEFORE : 0) + more);
            TEST_ASSERT_EQUAL_MESSAGE(left, e.peers.of[ME].told[LAG], text);
        }
    }
}

// One sum alone is reason to ask as well.
void test_a_lag_known_of_one_sum_only_is_weighed(void) {
    setUp();
    face(ME, 0);
    seen_on(0, AGREED, false);
    seen_on(9000, CONTRADICTED, false);
    was_elsewhere(9000, -9000);
    e.peers.of[ME].told[LAG] = 0;
    reads(1000);
    TEST_ASSERT_EQUAL(BEFORE - 400, e.peers.of[ME].late[LAG]);
}

// Each lag is weighed for itself, however many others agree.
void test_each_lag_is_weighed_for_itself(void) {
    for (int others = 0; others <= 3; others++) {
        setUp();
        face(ME, 0);
        seen_on(0, CONTRADICTED, false);
        seen_on(9000, AGREED, false);
        seen_on(-9000, CONTRADICTED, false);
        was_elsewhere(9000, -9000);
        for (int back = LAG + 1; back <= LAG + others; back++) {
            argus_peer_t *peer = &e.peers.of[ME];
            peer->seen[(peer->next + ARGUS_GLIMPSES - back) % ARGUS_GLIMPSES].bearing_cdeg = 9000;
        }
        reads(1000);
        for (int n = 2; n < ARGUS_TRAIL; n++) {
            const bool agrees = n >= LAG && n <= LAG + others;
            snprintf(text, sizeof text, "%d others, lag %d", others, n);
            TEST_ASSERT_EQUAL_MESSAGE(BEFORE + (agrees ? 230 : -300), e.peers.of[ME].told[n], text);
            TEST_ASSERT_EQUAL_MESSAGE(BEFORE + (agrees ? 300 : -150), e.peers.of[ME].late[n], text);
        }
    }
}

// Lags of none and of one firing are within the age of a SIP: nobody is late for them.
void test_a_lag_of_one_firing_is_none(void) {
    e.peers.of[ME].late[0] = e.peers.of[ME].late[1] = 2000;
    e.peers.of[ME].told[0] = e.peers.of[ME].told[1] = 900;
    TEST_ASSERT_EQUAL(0, argus_peers_late(&e.peers, ME));
    TEST_ASSERT_EQUAL(0, argus_peers_told(&e.peers, ME));
    for (int n = 2; n < ARGUS_TRAIL; n++) {
        e.peers.of[ME].late[n] = (int16_t)(100 * n);
        e.peers.of[ME].told[n] = (int16_t)(10 * n);
        TEST_ASSERT_EQUAL(100 * n, argus_peers_late(&e.peers, ME));
        TEST_ASSERT_EQUAL(10 * n, argus_peers_told(&e.peers, ME));
        TEST_ASSERT_EQUAL(0, argus_peers_late(&e.peers, WITNESS));
    }
}

// A robot that stood saw the same thing in many firings: each counts when the lag is looked back for, from
// the reading that is judged, whether at once or by who looks there later.
void test_a_lag_counts_the_firings_of_a_robot_that_stood(void) {
    for (int later = 0; later < 2; later++) {
        for (int stood = 1; stood <= 9; stood++) {
            setUp();
            face(ME, 9000);
            argus_glimpse_t then = here(ME);
            then.reading_mm = 1000;
            remember(WITNESS, then); // where ME looked before it turned
            face(ME, 0);
            const argus_glimpse_t now = here(ME);
            if (later == 0) {
                saw(WITNESS, 3000);
            }
            face(ME, 9000);
            reads(NONE_MM);
            face(ME, -9000);
            for (int i = 1; i < stood; i++) {
                reads(NONE_MM);
            }
            face(ME, 0);
            for (int n = 0; n < ARGUS_TRAIL; n++) {
                e.peers.of[ME].late[n] = e.peers.of[ME].told[n] = 0;
            }
            reads(1000);
            if (later != 0) {
                face(ME, -4500);
                reads(NONE_MM); // what is judged is not the last
                looks_there(WITNESS, &now, 3000);
            }
            snprintf(text, sizeof text, "later %d, stood %d", later, stood);
            for (int n = 2; n < ARGUS_TRAIL; n++) {
                const int late = later != 0 ? 50 + 300 : 300; // seen then at first, contradicted now as well
                TEST_ASSERT_EQUAL_MESSAGE(n == stood ? late : 0, e.peers.of[ME].late[n], text);
            }
        }
    }
}

// Where it looked ten degrees aside is another bearing, less is the same one.
void test_a_lag_shows_only_where_the_sonar_looked_elsewhere(void) {
    for (int sign = -1; sign <= 1; sign += 2) {
        for (int more = 0; more < 2; more++) {
            setUp();
            face(ME, 0);
            seen_on(0, CONTRADICTED, false);
            seen_on(sign * (999 + more), AGREED, false);
            was_elsewhere(sign * (999 + more), -9000);
            reads(1000);
            TEST_ASSERT_EQUAL(BEFORE + (more != 0 ? 300 : -150), e.peers.of[ME].late[LAG]);
        }
    }
}

// The same bearing from another place is another view: nobody knows what it would have shown.
void test_a_lag_is_not_refuted_from_another_place(void) {
    for (int away = 0; away < 2; away++) {
        setUp();
        face(ME, 0);
        seen_on(0, CONTRADICTED, false);
        was_elsewhere(0, -9000);
        argus_peer_t *peer = &e.peers.of[ME];
        for (int i = 0; i < peer->count; i++) {
            peer->seen[i].x_mm = (uint16_t)(peer->seen[i].x_mm + (away != 0 ? 201 : 0));
        }
        reads(1000);
        TEST_ASSERT_EQUAL(BEFORE - (away != 0 ? 0 : 150), peer->late[LAG]);
    }
}

// What moves beside a sonar may move before it: a contradiction then says nothing of its lag.
void test_in_unrest_beside_it_a_contradiction_weighs_no_lag(void) {
    static const int at[] = {WITNESS, ME, -1};
    for (int i = 0; i < 3; i++) {
        for (int now = AGREED; now <= CONTRADICTED; now++) {
            setUp();
            face(ME, 0);
            seen_on(0, now, false);
            seen_on(9000, CONTRADICTED, false);
            was_elsewhere(9000, -9000);
            if (at[i] >= 0) {
                argus_note_unrest(&e, &k, at[i]);
            }
            reads(1000);
            const int weight = now == AGREED ? -400 : (at[i] == WITNESS ? 0 : -150);
            TEST_ASSERT_EQUAL(BEFORE + weight, e.peers.of[ME].late[LAG]);
        }
    }
}

// Both sums have a floor of 0 and a ceiling.
void test_the_sums_of_the_lags_are_bounded(void) {
    for (int up = 0; up < 2; up++) {
        for (int i = 0; i < 12; i++) {
            argus_peer_t *peer = &e.peers.of[ME];
            const int16_t late = peer->late[LAG], told = peer->told[LAG];
            setUp();
            face(ME, 0);
            seen_on(0, CONTRADICTED, false);
            seen_on(9000, up != 0 ? AGREED : CONTRADICTED, false);
            seen_on(-9000, CONTRADICTED, false);
            was_elsewhere(9000, -9000);
            if (i > 0) {
                peer->late[LAG] = late;
                peer->told[LAG] = told;
            }
            reads(1000);
        }
        TEST_ASSERT_EQUAL(up != 0 ? 2000 : 0, e.peers.of[ME].late[LAG]);
        TEST_ASSERT_EQUAL(up != 0 ? 900 : 0, e.peers.of[ME].told[LAG]);
    }
}

// ---- forgetting

static bool is_blank(int sonar) {
    static const argus_peer_t blank;
    return memcmp(&blank, &e.peers.of[sonar], sizeof blank) == 0;
}

static void fill(void) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        memset(&e.peers.of[i], 0x55, sizeof e.peers.of[i]);
        e.of[i].score[ARGUS_TEST_PEERS] = 800;
    }
    e.peers.before_ms = e.peers.faded_ms = 77;
}

// Forgetting one sonar leaves the others alone.
void test_forgetting_clears_one_sonar(void) {
    fill();
    e.peers.of[WITNESS].against = 1u << ME | 1u << THIRD;
    argus_evidence_forget(&e, ME);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        TEST_ASSERT_EQUAL(i == ME, is_blank(i));
        TEST_ASSERT_EQUAL(i == ME ? 0 : 800, score_of(i));
    }
    TEST_ASSERT_EQUAL(77, e.peers.before_ms);
    TEST_ASSERT_EQUAL_HEX16(1u << THIRD, e.peers.of[WITNESS].against); // nor what it has said
}

// A restart forgets the glimpses and lags of all, the pose before, and what rested on them: a score without
// those who spoke would be cleared in the next look.
void test_a_restart_clears_all_glimpses(void) {
    fill();
    argus_evidence_restart(&e);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        TEST_ASSERT_TRUE(is_blank(i));
        TEST_ASSERT_EQUAL(0, score_of(i));
    }
    TEST_ASSERT_EQUAL(0, e.peers.before_ms);
    TEST_ASSERT_EQUAL(0, e.peers.faded_ms);
}

// ---- in the room

static int top[ARGUS_SONARS];
static int late[ARGUS_SONARS];
static int told[ARGUS_SONARS];
static uint16_t two_against;           // reached naming with two others against it
static int doubted[ARGUS_SONARS];      // how often it was seen contradicted
static int doubted_late[ARGUS_SONARS]; // ... and then told to be late and not wrong

#define CONTRADICTED_FROM 300
#define LATE_FROM 430

static void watch(void) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const int score = s.e.of[i].score[ARGUS_TEST_PEERS];
        top[i] = argus_max(top[i], score);
        late[i] = argus_max(late[i], argus_peers_late(&s.e.peers, i));
        told[i] = argus_max(told[i], argus_peers_told(&s.e.peers, i));
        const bool named = score >= argus_bounds[ARGUS_TEST_PEERS].naming;
        doubted[i] += score >= CONTRADICTED_FROM;
        doubted_late[i] += score >= CONTRADICTED_FROM && argus_peers_told(&s.e.peers, i) >= LATE_FROM;
        two_against |= (uint16_t)(named && argus_peers_against(&s.e.peers, i) >= 2 ? 1u << i : 0u);
    }
}

static void start(unsigned seed, int sonar, argus_fault_kind_t kind, int value) {
    scene_init(&s, seed, START_MS);
    scene_office(&s);
    s.fault[sonar] = (scene_fault_t){kind, value};
    memset(top, 0, sizeof top);
    memset(late, 0, sizeof late);
    memset(told, 0, sizeof told);
    memset(doubted, 0, sizeof doubted);
    memset(doubted_late, 0, sizeof doubted_late);
    two_against = 0;
}

// As scene_tour, watched at every step.
static void tour(int legs) {
    for (int leg = 0; leg < legs; leg++) {
        for (int i = 0; i < 3; i++) {
            scene_turn(&s, i == 1 ? 40 : -20);
            watch();
            scene_run(&s, 1000);
            watch();
        }
        scene_drive(&s, 300 + scene_random(&s, 900));
        watch();
        scene_turn(&s, (scene_random(&s, 2) == 0 ? 1 : -1) * (25 + (double)scene_random(&s, 90)));
        watch();
    }
}

static const char *what(int sonar, unsigned seed) {
    snprintf(text, sizeof text, "sonar %d, seed %u: top %d, late %d, told %d, %s", sonar, seed, top[sonar],
             late[sonar], told[sonar], scene_text(&s));
    return text;
}

// Wrong by half, too near or too far: named by the peers within a tour, whichever sonar it is.
void test_a_wrong_sonar_reaches_naming_within_a_tour(void) { // soak
    for (int percent = 50; percent <= 150; percent += 100) {
        for (int sonar = 0; sonar < ARGUS_SONARS; sonar++) {
            const unsigned seed = (unsigned)(sonar * 4 + 1);
            start(seed, sonar, ARGUS_KIND_WRONG, percent);
            tour(5);
            TEST_ASSERT_TRUE_MESSAGE(top[sonar] >= argus_bounds[ARGUS_TEST_PEERS].naming, what(sonar, seed));
            TEST_ASSERT_TRUE_MESSAGE((s.named >> sonar & 1u) != 0, what(sonar, seed));
            TEST_ASSERT_EQUAL_STRING("", s.broken);
        }
    }
}

#define BESIDE_AT_MOST 1 // of 12 runs: one here; of 240 of other seeds 11 had one other that reached it

// A liar of the ring is named itself, and hardly anybody beside it. (Each of 0, 7, 8 and 15 has one other
// that looks as it does and hardly anybody else: there the two are not told apart so well.)
void test_a_liar_hardly_gets_those_beside_it_named(void) { // soak
    static const int liars[] = {1, 2, 3, 4, 5, 6, 9, 10, 11, 12, 13, 14};
    int others = 0;
    for (int i = 0; i < 12; i++) {
        const unsigned seed = (unsigned)(7 + i);
        start(seed, liars[i], ARGUS_KIND_WRONG, i % 2 == 0 ? 50 : 150);
        tour(6);
        TEST_ASSERT_TRUE_MESSAGE((two_against >> liars[i] & 1u) != 0, what(liars[i], seed));
        others += argus_count_bits(two_against & ~(1u << liars[i]));
        TEST_ASSERT_TRUE_MESSAGE(others <= BESIDE_AT_MOST, what(liars[i], seed));
    }
}

#define TOURS 24
#define AT_MOST \
    7 // sonars of 16 * TOURS that reach naming; of 400 tours of other seeds 47, 41 with two against

// Nobody moves, nobody lies: in one tour of ten one sonar of sixteen reaches the naming score.
void test_in_a_healthy_office_few_reach_naming(void) { // soak
    int reached = 0;
    int with_two = 0;
    for (unsigned seed = 1; seed <= TOURS; seed++) {
        start(seed, 0, ARGUS_KIND_NONE, 0);
        tour(6);
        for (int i = 0; i < ARGUS_SONARS; i++) {
            reached += top[i] >= argus_bounds[ARGUS_TEST_PEERS].naming;
            with_two += two_against >> i & 1;
        }
    }
    snprintf(text, sizeof text, "%d of %d reached naming, %d with two against", reached, 16 * TOURS,
             with_two);
    TEST_ASSERT_TRUE_MESSAGE(reached <= AT_MOST, text);
    TEST_ASSERT_TRUE_MESSAGE(with_two <= reached, text);
}

// Two that disagree, and nobody else: neither is named.
void test_two_alone_are_never_named_by_the_peers(void) {
    static const int pair[][2] = {{3, 4}, {7, 8}, {0, 15}, {1, 2}};
    for (int i = 0; i < 4; i++) {
        for (int liar = 0; liar < 2; liar++) {
            const unsigned seed = (unsigned)(20 + i);
            start(seed, pair[i][liar], ARGUS_KIND_WRONG, 50);
            s.mute = ~(1u << pair[i][0] | 1u << pair[i][1]);
            tour(8);
            TEST_ASSERT_EQUAL_HEX16_MESSAGE(0, s.named, what(pair[i][liar], seed));
            TEST_ASSERT_TRUE_MESSAGE(i == 3 || top[pair[i][0]] + top[pair[i][1]] > 0, what(pair[i][0], seed));
            TEST_ASSERT_TRUE(argus_peers_against(&s.e.peers, pair[i][0]) <= 1);
        }
    }
}

// The sonars of the ring that others look after in turns.
static const int ring[] = {2, 3, 4, 5, 10, 11, 12, 13};

#define TOLD_SEEDS 3

// How often, of all times that a sonar of the ring was seen contradicted, it was told to be late, percent.
static int told_late_percent(argus_fault_kind_t kind, int value, int *least_late) {
    int all = 0;
    int late_of_all = 0;
    for (int i = 0; i < 8 * TOLD_SEEDS; i++) {
        const int sonar = ring[i % 8];
        start((unsigned)(30 + i), sonar, kind, value);
        tour(8);
        all += doubted[sonar];
        late_of_all += doubted_late[sonar];
        *least_late = argus_min(*least_late, late[sonar]);
    }
    snprintf(text, sizeof text, "kind %d, value %d: told late %d of %d times, late and not well at least %d",
             (int)kind, value, late_of_all, all, *least_late);
    TEST_ASSERT_TRUE_MESSAGE(all >= 8 * TOLD_SEEDS * 20, text); // it is seen so often at all
    return late_of_all * 100 / all;
}

// Late sonars reach high sums at turns, both against well and against wrong.
void test_a_late_sonar_is_told_from_well_and_from_wrong(void) { // soak
    static const int lags[] = {3, 5, 8};
    for (int n = 0; n < 3; n++) {
        int least_late = INT16_MAX;
        const int percent = told_late_percent(ARGUS_KIND_SLOW, lags[n], &least_late);
        TEST_ASSERT_TRUE_MESSAGE(percent >= 90, text);
        TEST_ASSERT_TRUE_MESSAGE(least_late >= 1400, text);
    }
}

// What is wrong is contradicted as much, and seldom told to be late.
void test_a_wrong_sonar_is_seldom_told_to_be_late(void) { // soak
    for (int value = 50; value <= 150; value += 100) {
        int least_late = INT16_MAX;
        const int percent = told_late_percent(ARGUS_KIND_WRONG, value, &least_late);
        TEST_ASSERT_TRUE_MESSAGE(percent <= 15, text);
    }
}

// Nobody lies: hardly any of the ring is ever contradicted and told to be late.
void test_the_healthy_are_hardly_ever_told_to_be_late(void) { // soak
    int told_late = 0;
    for (unsigned seed = 1; seed <= TOURS; seed++) {
        start(30 + seed, 0, ARGUS_KIND_NONE, 0);
        tour(8);
        for (int i = 0; i < ARGUS_SONARS; i++) {
            told_late += doubted_late[i] > 0;
        }
    }
    snprintf(text, sizeof text, "%d of %d sonars", told_late, 16 * TOURS);
    TEST_ASSERT_TRUE_MESSAGE(told_late <= 2, text);
}

// PEERS names and never convicts, however long others see something else.
void test_the_peers_never_convict(void) {
    argus_evidence_init(&e);
    e.of[ME].echoes = 8;
    for (int i = 0; i < 500; i++) {
        k.sip_ms += 4000;
        face(ME, i * 3000);
        saw(WITNESS, 3000);
        saw(THIRD, 3000);
        reads(1000);
        TEST_ASSERT_EQUAL(ARGUS_KIND_NONE, argus_evidence_convicts(&e, ME));
    }
    TEST_ASSERT_EQUAL(argus_bounds[ARGUS_TEST_PEERS].ceiling, score_of(ME));
    TEST_ASSERT_EQUAL(ARGUS_KIND_WRONG, argus_evidence_names(&e, ME));
}

static int scores[ARGUS_SONARS];

static void clocked(uint32_t start_ms, int32_t x_mm) {
    scene_init(&s, 5, start_ms);
    s.k.pose.x_mm = x_mm;
    scene_office(&s);
    s.fault[5] = (scene_fault_t){ARGUS_KIND_WRONG, 50};
    s.fault[12] = (scene_fault_t){ARGUS_KIND_SLOW, 5};
    tour(3);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        scores[i] = s.e.of[i].score[ARGUS_TEST_PEERS] * 10000 + argus_peers_late(&s.e.peers, i);
    }
}

// When and where a session begins changes nothing: the clock may wrap on the way, the place modulo 65,536 mm.
void test_the_wraps_of_clock_and_place_change_nothing(void) {
    int want[ARGUS_SONARS];
    clocked(1000, 0);
    memcpy(want, scores, sizeof want);
    TEST_ASSERT_TRUE(want[5] > 9000000);
    for (int i = 0; i < 4; i++) {
        clocked(UINT32_MAX - 10000u * (unsigned)(i + 1) - 18u, 32000 + i * 500);
        snprintf(text, sizeof text, "case %d", i);
        TEST_ASSERT_EQUAL_INT_ARRAY_MESSAGE(want, scores, ARGUS_SONARS, text);
    }
}
