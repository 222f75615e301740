// SPDX-License-Identifier: MIT
// What the other sonars say of each ping, as it stands and as each hypothesis maps it.
#include "awareness/crosscheck.h"

#include <limits.h>
#include <stddef.h>
#include <string.h>

#include "awareness/clutter.h"
#include "awareness/gen_likelihoods.h"
#include "awareness/numbers.h"
#include "awareness/odds.h"
#include "awareness/scan.h"
#include "knowledge/angle.h"

// DIVIDED: the others contradict each other. SAME: the map leaves it where it is.
typedef enum { UNSEEN, QUIET, AGREED, CONTRADICTED, DIVIDED, SAME, SAYINGS } verdict_t;
#define TELLING (CONTRADICTED + 1) // verdicts on a ping as it stands that tell of a fault at all

typedef struct {
    uint8_t agree;
    uint8_t differ;
    uint8_t quiet;
    bool heard;           // one that differs heard something
    bool excused;         // one of them heard the same a little aside
    argus_mask_t against; // those that differ
} tally_t;

// What two verdicts say for the map: on a ping as it stands (rows) and as mapped (columns). It is said
// against a healthy sonar, and against any other fault.
typedef struct {
    int16_t over_healthy[TELLING][SAYINGS];
    int16_t over_other[TELLING][SAYINGS];
} worth_t;

// Measured: `argus-sim bench likelihoods`.
static const worth_t lag_worth = {ARGUS_LAG_OVER_HEALTHY, ARGUS_LAG_OVER_OTHER};
static const worth_t offset_worth = {ARGUS_OFFSET_OVER_HEALTHY, ARGUS_OFFSET_OVER_OTHER};

// -2400, -1800, -1200, 1200, ...: half of them to either side.
static int32_t offset_cdeg(const int offset) {
    const int half = ARGUS_OFFSETS / 2;
    const int steps = offset < half ? offset + 1 - half : offset - half;
    const int32_t least = offset < half ? -2 * ARGUS_OFFSET_STEP_CDEG : 2 * ARGUS_OFFSET_STEP_CDEG;
    return least + steps * ARGUS_OFFSET_STEP_CDEG;
}

static verdict_t compare_silence(const int32_t now_mm, const int32_t then_mm, const int32_t along_mm) {
    if (now_mm >= ARGUS_NO_ECHO_MM && then_mm >= ARGUS_NO_ECHO_MM) {
        return QUIET;
    }
    const int32_t expected = then_mm >= ARGUS_NO_ECHO_MM ? now_mm + along_mm : then_mm - along_mm;
    if (expected < ARGUS_NEAREST_MM || expected > ARGUS_FARTHEST_MM) {
        return UNSEEN;
    }
    return CONTRADICTED;
}

// What one reading says of another on its bearing, made `along_mm` ahead of it.
static verdict_t compare(const int32_t now_mm, const int32_t then_mm, const int32_t along_mm) {
    if (now_mm >= ARGUS_NO_ECHO_MM || then_mm >= ARGUS_NO_ECHO_MM) {
        return compare_silence(now_mm, then_mm, along_mm);
    }
    const int32_t expected = then_mm - along_mm;
    if (expected < ARGUS_NEAREST_MM) {
        return UNSEEN;
    }
    const int32_t limit = ARGUS_AGREE_MM + argus_min(expected, now_mm) * ARGUS_AGREE_PERCENT / 100;
    return argus_abs(expected - now_mm) <= limit ? AGREED : CONTRADICTED;
}

// A suspect that is contradicted at least as much itself says nothing of another. So a faulty sonar does not
// drag down those beside it, and of two that no third bears out neither is named. Nor does one whose ranges
// do not change as the way does.
bool argus_crosscheck_is_witness(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                                 const int sonar, const int of) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int32_t own = self->of[sonar].score[ARGUS_TEST_PEERS];
    const int32_t suspicious = argus_bounds[ARGUS_TEST_PEERS].naming * ARGUS_SUSPECT_PERCENT / 100;
    const bool alike =
        argus_robot_is_sector(knowledge->robot, sonar) == argus_robot_is_sector(knowledge->robot, of);
    return sonar != of && alike && !argus_is_out(knowledge, sonar) && (self->off_scale >> sonar & 1u) == 0 &&
           (own < suspicious || own < self->of[of].score[ARGUS_TEST_PEERS]);
}

static void add(tally_t *const tally, const verdict_t said, const int from, const bool heard) {
    const bool differs = said == CONTRADICTED;
    tally->heard = tally->heard || (differs && heard);
    tally->agree = (uint8_t)(tally->agree + (said == AGREED));
    tally->quiet = (uint8_t)(tally->quiet + (said == QUIET));
    tally->differ = (uint8_t)(tally->differ + differs);
    tally->against |= differs ? (argus_mask_t)(1u << from) : 0u;
}

// A silence that may be one of a whole array's: it would only repeat itself.
static bool is_mute(const argus_evidence_t *const self, const int sonar, const argus_ping_t *const then) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return (self->mute >> sonar & 1u) != 0 && !argus_ping_is_echo(then);
}

// What one ping says of another; of two sectors that overlap the nearest may differ.
static verdict_t answer(const argus_line_t *const line, const argus_ping_t *const then,
                        const int32_t along_mm, const bool sector) {
    const verdict_t said = compare(line->ping->reading_mm, then->reading_mm, along_mm);
    return said == CONTRADICTED && sector && argus_ping_is_echo(line->ping) ? UNSEEN : said;
}

// One of the last seconds may excuse. True: older pings of this sonar can add nothing any more, as an excuse
// counts once, and only where nobody agrees.
static bool excuse(tally_t *const tally, const verdict_t said, const bool lately) {
    tally->excused = tally->excused || (lately && (said == AGREED || said == QUIET));
    return tally->excused || tally->agree > 0 || !lately;
}

// One other sonar, by its pings `beside` the line: its latest one on the bearing decides. How far back that
// is, 0: it did not look there.
static int ask(const argus_evidence_t *const self, tally_t *const tally, const argus_line_t *const line,
               const int from, const uint32_t beside, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(from >= 0 && from < ARGUS_SONARS);
    const argus_pings_t *const pings = &self->pings[from];
    const argus_ping_t *const at = line->ping;
    const bool sector = argus_robot_is_sector(knowledge->robot, from);
    uint32_t left = beside;
    int latest = 0;
    for (int back = argus_pings_near(pings, &left, line); back > 0;
         back = argus_pings_near(pings, &left, line)) {
        const argus_ping_t *const then = argus_pings_at(pings, back);
        const argus_shift_t shift = argus_line_shift(line, then);
        if (shift.lateral_mm > ARGUS_SAME_LATERAL_MM || is_mute(self, from, then)) {
            continue;
        }
        const verdict_t said = answer(line, then, shift.along_mm, sector);
        if (latest == 0 && argus_ping_turned_cdeg(at, then) <= ARGUS_SAME_CDEG) {
            latest = back;
            add(tally, said, from, argus_ping_is_echo(then));
        }
        const bool lately = argus_ping_age_ms(then, knowledge->sip_ms) <= ARGUS_BESIDE_MS;
        if (excuse(tally, said, lately) && latest > 0) {
            break;
        }
    }
    return latest;
}

static tally_t ask_all(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                       const int sonar, const argus_ping_t *const at) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const argus_line_t line = argus_ping_line(at);
    tally_t tally = {.agree = 0};
    for (int i = 0; i < knowledge->sonars; i++) {
        const uint32_t beside = argus_pings_beside(&self->pings[i], &line);
        if (beside != 0 && argus_crosscheck_is_witness(self, knowledge, i, sonar)) {
            ask(self, &tally, &line, i, beside, knowledge);
        }
    }
    return tally;
}

static verdict_t verdict_of(const tally_t *const tally) {
    if (tally->agree > 0) {
        return tally->agree >= tally->differ ? AGREED : DIVIDED;
    }
    if (tally->differ > 0) {
        return tally->quiet > 0 || tally->excused ? DIVIDED : CONTRADICTED;
    }
    return tally->quiet > 0 ? QUIET : UNSEEN;
}

// Of those that contradict an echo by their silence: whether each has told so since it heard something last.
static bool have_told(const argus_evidence_t *const self, const int sonar, uint32_t left) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    bool have = true;
    while (left != 0 && have) {
        have = (self->told[argus_take_highest(&left)] >> sonar & 1u) != 0;
    }
    return have;
}

// A silence that goes on is one piece of evidence against an echo, however often it is asked: it may be of
// one that is deaf to a surface, or dead.
static verdict_t unless_told(const argus_evidence_t *const self, const int sonar,
                             const tally_t *const tally) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const verdict_t verdict = verdict_of(tally);
    return verdict == CONTRADICTED && !tally->heard && have_told(self, sonar, tally->against) ? DIVIDED
                                                                                              : verdict;
}

// They have told now, by their silence alone.
static void tell(argus_evidence_t *const self, const int sonar, uint32_t left) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    while (left != 0) {
        self->told[argus_take_highest(&left)] |= (argus_mask_t)(1u << sonar);
    }
}

// From one place and on one bearing, one reading counts.
static bool is_news(const argus_pings_t *const pings, const argus_ping_t *const now, const int32_t place_mm) {
    for (int i = 1; i <= pings->count; i++) {
        const argus_ping_t *const then = argus_pings_at(pings, i);
        const int32_t apart_ms = (int16_t)(now->t_ms - then->t_ms);
        if (apart_ms > ARGUS_PLACE_MS) {
            break;
        }
        if (then->counted && argus_abs(apart_ms) < ARGUS_PLACE_MS &&
            argus_ping_is_within(now, then, place_mm) &&
            argus_ping_turned_cdeg(now, then) < ARGUS_PLACE_CDEG) {
            return false;
        }
    }
    return true;
}

// Where one was silent and another heard something: how often this happens to the healthy, as some sonars are
// deafer than others, permille. An echo that several miss is missed as often as the best of them misses one.
static int32_t deafness_of(const argus_evidence_t *const self, const int sonar, const argus_ping_t *const at,
                           const tally_t *const tally) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    if (!argus_ping_is_echo(at)) {
        return argus_odds_deaf_permille(self, sonar);
    }
    int32_t least = tally->heard ? 0 : 1000;
    uint32_t left = tally->against;
    while (left != 0 && least > 0) {
        least = argus_min(least, argus_odds_deaf_permille(self, argus_take_highest(&left)));
    }
    return least;
}

// What moves about the robot makes healthy sonars disagree.
static int32_t worth_of(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                        const int sonar, const bool odd, const int32_t deaf_permille) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int32_t adds = argus_odds_where(self, knowledge, sonar, ARGUS_TEST_PEERS, odd, deaf_permille);
    const bool unrest = argus_clutter_beside(self, knowledge, -1, ARGUS_UNREST_MS);
    return odd && unrest ? adds * ARGUS_UNREST_PERCENT / 100 : adds;
}

static void note_contradicted(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                              const int sonar, const argus_ping_t *const at, const argus_mask_t against) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_case_t *const c = &self->of[sonar];
    const bool again = c->episodes > 0 && knowledge->sip_ms - c->episode_ms < ARGUS_EPISODE_MS;
    if (!again && !self->crowded && !argus_clutter_beside(self, knowledge, -1, ARGUS_UNREST_MS)) {
        c->episodes = argus_one_more(c->episodes);
        c->episode_ms = knowledge->sip_ms;
    }
    c->silent_bits = (uint8_t)((unsigned)c->silent_bits << 1 | (argus_ping_is_echo(at) ? 0u : 1u));
    c->against |= against;
    c->agreed = 0;
}

// Its whole array hears nothing, and others have heard something where it has not.
static void note_dispute(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                         const int sonar, const argus_ping_t *const at, const argus_mask_t against,
                         const int32_t worth) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int array = argus_robot_array_of(sonar);
    const argus_mask_t others = (argus_mask_t)(against & ~(unsigned)self->dark);
    if ((self->dark >> sonar & 1u) == 0 || others == 0 || argus_ping_is_echo(at)) {
        return;
    }
    argus_dispute_t *const dispute = &self->dispute[array];
    const uint32_t age_ms = (uint32_t)argus_ping_age_ms(at, knowledge->sip_ms);
    if (age_ms < knowledge->sip_ms - dispute->since_ms) {
        dispute->nats = (int16_t)argus_min(dispute->nats + worth, ARGUS_CEILING);
        dispute->by |= others;
    }
}

static void begin_anew(argus_case_t *const self) {
    self->against = 0;
    self->episodes = 0;
    self->borne_out = false;
}

// What it read before it was given up does not bring it back.
static bool is_since(const argus_knowledge_t *const knowledge, const int sonar,
                     const argus_ping_t *const at) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const uint32_t age_ms = (uint32_t)argus_ping_age_ms(at, knowledge->sip_ms);
    return age_ms <= knowledge->sip_ms - knowledge->sonar[sonar].since_ms;
}

static void count(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                  const argus_ping_t *const at, const argus_mask_t against, const int32_t worth) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_case_t *const c = &self->of[sonar];
    argus_score(self, sonar, ARGUS_TEST_PEERS, worth);
    note_dispute(self, knowledge, sonar, at, against, worth);
    argus_odds_note(self, sonar, ARGUS_TEST_PEERS, against != 0);
    if (against == 0 || !argus_ping_is_echo(at)) {
        argus_odds_note_deaf(self, sonar, against != 0);
    }
    if (against != 0) {
        note_contradicted(self, knowledge, sonar, at, against);
    } else if (is_since(knowledge, sonar, at)) {
        ARGUS_ASSERT(argus_ping_is_echo(at)); // silences that agree are quiet
        c->agreed = argus_one_more(c->agreed);
    }
    if (c->score[ARGUS_TEST_PEERS] <= 0) {
        begin_anew(c);
    }
}

static verdict_t as_late(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                         const int sonar, const int back, const int lag) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(back >= 1);
    const argus_ping_t *const now = argus_pings_at(&self->pings[sonar], back);
    const argus_ping_t *const then = argus_pings_before(&self->pings[sonar], back, lag);
    if (then == NULL) {
        return UNSEEN;
    }
    if (argus_ping_turned_cdeg(now, then) < ARGUS_LAG_SAME_CDEG &&
        argus_ping_is_within(now, then, ARGUS_SAME_ALONG_MM) &&
        argus_ping_shift(now, then).lateral_mm <= ARGUS_SAME_LATERAL_MM) {
        return SAME;
    }
    argus_ping_t mapped = *then;
    mapped.reading_mm = now->reading_mm;
    const tally_t tally = ask_all(self, knowledge, sonar, &mapped);
    return verdict_of(&tally);
}

static verdict_t as_offset(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                           const int sonar, const argus_ping_t *const at, const int offset) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_ping_t mapped = *at;
    mapped.bearing_cdeg = (int16_t)argus_angle_wrap(at->bearing_cdeg + offset_cdeg(offset));
    const tally_t tally = ask_all(self, knowledge, sonar, &mapped);
    return verdict_of(&tally);
}

// A SIP that lists all sonars, most of them contradicted, must not take long: the next ones tell as much.
static bool may_ask(argus_evidence_t *const self) {
    const bool may = self->asked < ARGUS_ASKED_MOST;
    self->asked = (uint8_t)(self->asked + (may ? 1 : 0));
    return may;
}

// A sector has no hypothesis of its own: a laser is late or turned as a whole. Every reading tells of a lag,
// a contradicted one no more than it tells at all.
static void weigh_lags(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                       const int sonar, const int back, const verdict_t verdict, const int32_t worth) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS && verdict < TELLING);
    const int32_t most = verdict == CONTRADICTED ? worth : ARGUS_CEILING;
    const int lags = argus_robot_is_sector(knowledge->robot, sonar) ? 0 : ARGUS_LAGS;
    for (int i = 0; i < lags; i++) {
        const bool asks = verdict == CONTRADICTED || self->of[sonar].hypothesis[i].over_healthy > 0;
        if (asks && may_ask(self)) {
            const verdict_t mapped = as_late(self, knowledge, sonar, back, i + ARGUS_LEAST_LAG);
            argus_hypothesis_add(self, sonar, i, argus_min(most, lag_worth.over_healthy[verdict][mapped]),
                                 lag_worth.over_other[verdict][mapped]);
        }
    }
}

// A wall fills the cones on both sides: of an axis offset one reading of a place tells. What is borne out
// never speaks for a fault, whatever is seen aside.
static void weigh_offsets(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                          const int sonar, const argus_ping_t *const at, const verdict_t verdict,
                          const int32_t increment) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int offsets = argus_robot_is_sector(knowledge->robot, sonar) ? 0 : ARGUS_OFFSETS;
    for (int i = 0; i < offsets; i++) {
        const int hypothesis = ARGUS_LAGS + i;
        const bool idle = verdict == AGREED && self->of[sonar].hypothesis[hypothesis].over_healthy == 0;
        if (idle || !may_ask(self)) {
            continue;
        }
        const verdict_t mapped = as_offset(self, knowledge, sonar, at, i);
        const int32_t well = increment + offset_worth.over_healthy[verdict][mapped];
        argus_hypothesis_add(self, sonar, hypothesis, verdict == AGREED ? argus_min(0, well) : well,
                             offset_worth.over_other[verdict][mapped]);
    }
}

// A sonar that is out reads what its kind of fault cannot. That is an echo that goes on from the last as the
// robot moves. For one that made echoes up, it is silence together with others. One that is wrong or late
// needs the others.
static bool is_beyond(const argus_fault_kind_t kind, const argus_ping_t *const now,
                      const argus_ping_t *const before, const verdict_t verdict) {
    const bool made_up = kind == ARGUS_KIND_STUCK || kind == ARGUS_KIND_GARBAGE;
    if (!argus_ping_is_echo(now)) {
        return made_up && verdict == QUIET;
    }
    const bool own = kind != ARGUS_KIND_WRONG && kind != ARGUS_KIND_SLOW;
    return own && verdict == UNSEEN && before != NULL && now->reading_mm != before->reading_mm &&
           argus_ping_goes_on(now, before);
}

static void count_own(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                      const int back, const verdict_t verdict) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_case_t *const c = &self->of[sonar];
    argus_ping_t *const at = argus_pings_mark(&self->pings[sonar], back);
    const argus_ping_t *const before = argus_pings_at(&self->pings[sonar], back + 1);
    if (argus_is_out(knowledge, sonar) && is_beyond(knowledge->sonar[sonar].kind, at, before, verdict) &&
        is_since(knowledge, sonar, at) && is_news(&self->pings[sonar], at, ARGUS_PLACE_MM)) {
        const int32_t adds = argus_odds_of(self, knowledge, sonar, ARGUS_TEST_PEERS, false);
        argus_score(self, sonar, ARGUS_TEST_PEERS, adds);
        c->agreed = argus_one_more(c->agreed);
        at->counted = 1;
    }
}

// The axis first: which sonar is a witness depends on what is counted.
static void count_news(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                       const int sonar, argus_ping_t *const at, const verdict_t verdict,
                       const tally_t *const tally, const int32_t worth) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_mask_t against = verdict == CONTRADICTED ? tally->against : (argus_mask_t)0;
    weigh_offsets(self, knowledge, sonar, at, verdict, worth);
    tell(self, sonar, tally->heard ? (argus_mask_t)0 : against);
    count(self, knowledge, sonar, at, against, worth);
    at->counted = 1;
}

static int32_t worth_as(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                        const int sonar, const argus_ping_t *const at, const tally_t *const tally,
                        const verdict_t verdict) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    if (verdict == CONTRADICTED) {
        return worth_of(self, knowledge, sonar, true, deafness_of(self, sonar, at, tally));
    }
    ARGUS_ASSERT(verdict == AGREED);
    return worth_of(self, knowledge, sonar, false, 0);
}

// From one place one reading counts; less far apart where a laser contradicts.
static int32_t place_of(const argus_knowledge_t *const knowledge, const tally_t *const tally) {
    const bool scan = (tally->against & argus_robot_sectors(knowledge->robot)) != 0;
    return scan ? ARGUS_SCAN_PLACE_MM : ARGUS_PLACE_MM;
}

// A fresh echo that others bear out, also where a silence at this place has counted already.
static void bear_out(argus_case_t *const c, const verdict_t verdict) {
    if (verdict == AGREED) {
        c->borne_out = c->borne_out || c->score[ARGUS_TEST_PEERS] > 0;
    }
}

static void weigh(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                  const int back, const tally_t *const tally, const bool fresh) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(back >= 1);
    argus_ping_t *const at = argus_pings_mark(&self->pings[sonar], back);
    const verdict_t verdict = unless_told(self, sonar, tally);
    at->weighed = verdict != UNSEEN;
    count_own(self, knowledge, sonar, back, verdict);
    const bool tells = verdict == AGREED || verdict == CONTRADICTED;
    const bool news = tells && is_news(&self->pings[sonar], at, place_of(knowledge, tally));
    const bool weighs = news || verdict == CONTRADICTED;
    const int32_t worth = weighs ? worth_as(self, knowledge, sonar, at, tally, verdict) : 0;
    if (news) {
        count_news(self, knowledge, sonar, at, verdict, tally, worth);
    }
    if (fresh) {
        bear_out(&self->of[sonar], verdict);
    }
    if (verdict != DIVIDED) {
        weigh_lags(self, knowledge, sonar, back, verdict, worth);
    }
}

// What no other could judge when it was read is judged by those that look there later.
static void look_back(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                      const uint8_t *const latest) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    for (int i = 0; i < knowledge->sonars; i++) {
        if (latest[i] > 0 && argus_crosscheck_is_witness(self, knowledge, sonar, i)) {
            const argus_ping_t *const at = argus_pings_at(&self->pings[i], latest[i]);
            if (!at->weighed) {
                const tally_t tally = ask_all(self, knowledge, i, at);
                weigh(self, knowledge, i, latest[i], &tally, false);
            }
        }
    }
}

// A laser's scan as a witness of a sonar ------------------------------------------------------------------

// What it returns a sonar hears, or something nearer: that may be below the plane of the scan. So a laser
// never contradicts what is nearer, and where it returns nothing it says nothing. A scan is many rays: it
// counts for two, the sector and one beside it.
static void ask_laser(const argus_knowledge_t *const knowledge, const int sonar,
                      const argus_ping_t *const now, tally_t *const tally) {
    int32_t mm = 0;
    if (argus_robot_sectors(knowledge->robot) == 0 || argus_robot_is_sector(knowledge->robot, sonar)) {
        return;
    }
    const int sector = argus_scan_heard(knowledge, sonar, &mm);
    if (sector < 0 || mm < ARGUS_NEAREST_MM || mm > ARGUS_SURE_MM) {
        return;
    }
    const int32_t limit_mm = ARGUS_AGREE_MM + mm * ARGUS_AGREE_PERCENT / 100;
    if (now->reading_mm > mm + limit_mm) {
        add(tally, CONTRADICTED, sector, true);
        tally->against |= (argus_mask_t)(1u << (sector + 1 < knowledge->sonars ? sector + 1 : sector - 1));
    } else if (now->reading_mm >= mm - limit_mm) {
        add(tally, AGREED, sector, true);
    }
}

void argus_crosscheck_take(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                           const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const argus_ping_t *const now = argus_pings_at(&self->pings[sonar], 1);
    const argus_line_t line = argus_ping_line(now);
    uint8_t latest[ARGUS_SONARS] = {0};
    tally_t tally = {.agree = 0};
    for (int i = 0; i < knowledge->sonars; i++) {
        const uint32_t beside = i != sonar ? argus_pings_beside(&self->pings[i], &line) : 0;
        if (beside != 0) {
            tally_t unheard = {.excused = true}; // where it looked is asked, not what it says
            const bool witness = argus_crosscheck_is_witness(self, knowledge, i, sonar);
            latest[i] = (uint8_t)ask(self, witness ? &tally : &unheard, &line, i, beside, knowledge);
        }
    }
    ask_laser(knowledge, sonar, now, &tally);
    self->told[sonar] = argus_ping_is_echo(now) ? (argus_mask_t)0 : self->told[sonar];
    weigh(self, knowledge, sonar, 1, &tally, true);
    look_back(self, knowledge, sonar, latest);
}

// By a sixtieth, at least by one.
static int16_t faded(const int16_t score) {
    const int32_t by = score / ARGUS_FADES_S;
    return (int16_t)(score - (by != 0 ? by : (score > 0) - (score < 0)));
}

void argus_crosscheck_fade(argus_evidence_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    for (int i = 0; i < knowledge->sonars; i++) {
        argus_case_t *const c = &self->of[i];
        c->score[ARGUS_TEST_PEERS] = faded(c->score[ARGUS_TEST_PEERS]);
        if (c->score[ARGUS_TEST_PEERS] <= 0) {
            begin_anew(c);
        }
        for (int d = 0; d < ARGUS_HYPOTHESES; d++) {
            c->hypothesis[d].over_healthy = faded(c->hypothesis[d].over_healthy);
            c->hypothesis[d].over_other =
                c->hypothesis[d].over_healthy > 0 ? c->hypothesis[d].over_other : (int16_t)0;
        }
    }
}

void argus_crosscheck_retract(argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_mask_t bit = (argus_mask_t)(1u << sonar);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        argus_case_t *const c = &self->of[i];
        if (c->against == bit) { // no other contradicts it: the whole of it
            c->score[ARGUS_TEST_PEERS] = 0;
            c->silent_bits = 0;
            memset(c->hypothesis, 0, sizeof c->hypothesis);
            begin_anew(c);
        }
        c->against &= (argus_mask_t)~bit;
    }
}

int argus_crosscheck_silences(const argus_case_t *const self, const int of_last) {
    return argus_count_bits(self->silent_bits & ((1u << argus_min(of_last, CHAR_BIT)) - 1u));
}
