// SPDX-License-Identifier: MIT
// The peers: every reading, in motion and in turns too, against what the others saw on its bearing from its
// place.
#include <stddef.h>
#include <string.h>

#include "awareness/evidence_said.h"
#include "knowledge/angle.h"

#define REMEMBERED_LEAST_MS 10000u
#define ASIDE_MS 10000u
#define SAME_BEARING_CDEG 300
#define BESIDE_CDEG 500 // at a step of what is seen a reading may be of either side
#define PING_AGE_MS 70  // a SIP lists pings 0 to 140 ms old
#define SIP_MOST_MS 300u
#define COUNTED_MM 100
#define COUNTED_CDEG 800
#define COUNTED_MS 4000u
#define FADE_MS 1000u
#define FADE_EIGHTHS 7
#define SCORE_FADES_S 60 // in the open nobody bears it out
#define ONE_VERDICT 16   // in the fading counts
#define LAG_TURN_CDEG 1000
#define LATE_CEILING 2000
#define HOLLOW_BITS 8
#define CROWD_PERCENT 35

typedef struct {
    uint8_t agree;
    uint8_t differ;
    uint8_t faint; // ... of those
    uint8_t quiet;
    bool excused;     // nobody agrees, but one of them saw the same a little aside
    uint16_t against; // those that differ, bit i: sonar i
} tally_t;

// Hundredths of a nat; DESIGN.md, Evidence, derives them. By the part of the other sonars' readings that is
// contradicted at the time, in steps of 5 % from 5 %.
#define PARTS 12
static const int16_t contradicts[PARTS] = {277, 208, 167, 139, 116, 98, 83, 69, 58, 47, 37, 29};
static const int16_t bears_out[PARTS] = {-93, -90, -87, -83, -79, -75, -70, -66, -60, -55, -48, -41};

// That a reading is so many firings late and not well. Rows: the verdict as of now; columns: as of then.
static const int16_t late_than_well[VERDICTS][VERDICTS] = {
    [UNSEEN] = {[AGREED] = 50, [CONTRADICTED] = -200},
    [QUIET] = {[CONTRADICTED] = -350},
    [AGREED] = {[CONTRADICTED] = -400},
    [CONTRADICTED] = {[QUIET] = 100, [AGREED] = 300, [CONTRADICTED] = -150, [SAME] = -150},
};

// That it is late and not wrong: who is wrong agrees with the past as seldom as with the present.
static const int16_t late_than_wrong[VERDICTS][VERDICTS] = {
    [AGREED] = {[CONTRADICTED] = -390},
    [CONTRADICTED] = {[QUIET] = 230, [AGREED] = 230, [CONTRADICTED] = -300, [SAME] = -150},
};

static argus_said_t compare(const int32_t now_mm, const int32_t then_mm, const int32_t along_mm) {
    static const uint8_t verdict[] = {[ARGUS_PAIR_QUIET] = QUIET,
                                      [ARGUS_PAIR_AGREE] = AGREED,
                                      [ARGUS_PAIR_DIFFER] = CONTRADICTED,
                                      [ARGUS_PAIR_NOW_MISSES] = CONTRADICTED,
                                      [ARGUS_PAIR_THEN_MISSES] = CONTRADICTED,
                                      [ARGUS_PAIR_NOTHING] = UNSEEN};
    const argus_said_t said = (argus_said_t)verdict[argus_pair_compare(now_mm, then_mm, along_mm)];
    return said == CONTRADICTED && argus_pair_is_faint(now_mm, then_mm, along_mm) ? FAINT : said;
}

// For how long things stand still before the others in use.
static uint32_t still_ms(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                         const int of) {
    uint32_t still = ARGUS_REMEMBERED_MS;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const argus_case_t *const c = &self->of[i];
        const uint32_t since_ms = knowledge->sip_ms - c->unrest_ms;
        if (i != of && c->unrest && since_ms < still && !argus_is_out(knowledge, i)) {
            still = since_ms;
        }
    }
    return still;
}

// Who looked from the place of a reading on its bearing. What was seen before something moved may be gone.
static argus_gaze_t gaze_of(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                            const int sonar, const argus_glimpse_t *const at) {
    const uint32_t still = still_ms(self, knowledge, sonar);
    const argus_gaze_t gaze = {.at = at,
                               .now_ms = knowledge->sip_ms,
                               .age_ms = still > REMEMBERED_LEAST_MS ? still : REMEMBERED_LEAST_MS,
                               .span_cdeg = SAME_BEARING_CDEG};
    return gaze;
}

// The latest glimpse of a peer decides.
static argus_said_t ask(const argus_peer_t *const peer, const argus_gaze_t *const gaze) {
    int32_t along_mm = 0;
    const int back = argus_seen_find(peer, gaze, 0, &along_mm);
    return back > 0 ? compare(gaze->at->reading_mm, argus_seen_at(peer, back)->reading_mm, along_mm) : UNSEEN;
}

static bool excuses(const argus_peer_t *const peer, const argus_gaze_t *const gaze) {
    int32_t along_mm = 0;
    for (int back = argus_seen_find(peer, gaze, 0, &along_mm); back > 0;
         back = argus_seen_find(peer, gaze, back, &along_mm)) {
        const argus_said_t said =
            compare(gaze->at->reading_mm, argus_seen_at(peer, back)->reading_mm, along_mm);
        if (said == AGREED || said == QUIET) {
            return true;
        }
    }
    return false;
}

// A suspect that is contradicted at least as much itself says nothing of another: neither a liar of those
// beside it, nor either of two that nobody else bears out.
static bool is_witness(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                       const int sonar, const int of) {
    const int32_t own = self->of[sonar].score[ARGUS_TEST_PEERS];
    return sonar != of && !argus_is_out(knowledge, sonar) &&
           (own < argus_bounds[ARGUS_TEST_PEERS].suspicious || own < self->of[of].score[ARGUS_TEST_PEERS]);
}

static bool is_excused(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                       const int sonar, const argus_glimpse_t *const now) {
    const argus_gaze_t aside = {
        .at = now, .now_ms = knowledge->sip_ms, .age_ms = ASIDE_MS, .span_cdeg = BESIDE_CDEG};
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if (is_witness(self, knowledge, i, sonar) && excuses(&self->peers.of[i], &aside)) {
            return true;
        }
    }
    return false;
}

static tally_t ask_all(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                       const int sonar, const argus_glimpse_t *const now) {
    const argus_gaze_t gaze = gaze_of(self, knowledge, sonar, now);
    tally_t tally = {.agree = 0};
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if (!is_witness(self, knowledge, i, sonar)) {
            continue;
        }
        const argus_said_t said = ask(&self->peers.of[i], &gaze);
        tally.quiet = (uint8_t)(tally.quiet + (said == QUIET));
        tally.agree = (uint8_t)(tally.agree + (said == AGREED));
        const bool differs = said == CONTRADICTED || said == FAINT;
        tally.differ = (uint8_t)(tally.differ + differs);
        tally.faint = (uint8_t)(tally.faint + (said == FAINT));
        tally.against = (uint16_t)(tally.against | (differs ? 1u << i : 0u));
    }
    const bool odd = tally.differ > 0 && tally.agree == 0 && tally.quiet == 0;
    tally.excused = odd && is_excused(self, knowledge, sonar, now);
    return tally;
}

// For the lags and bends, whose tables were measured without what is faint.
static argus_said_t verdict_of(const tally_t *const tally) {
    const int differ = tally->differ - tally->faint;
    if (tally->agree > 0) {
        return tally->agree >= differ ? AGREED : DIVIDED;
    }
    if (differ > 0) {
        return tally->quiet > 0 || tally->excused ? DIVIDED : CONTRADICTED;
    }
    return tally->quiet > 0 ? QUIET : UNSEEN;
}

argus_said_t argus_peers_say(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                             const int sonar, const argus_glimpse_t *const at) {
    const tally_t tally = ask_all(self, knowledge, sonar, at);
    return verdict_of(&tally);
}

// Of two in whichever order.
static uint32_t ms_between(const argus_glimpse_t *const a, const argus_glimpse_t *const b) {
    const uint32_t ms = a->t_ms - b->t_ms;
    return ms <= INT32_MAX ? ms : b->t_ms - a->t_ms;
}

// From one place and on one bearing, one reading counts.
static bool is_news(const argus_peer_t *const self, const argus_glimpse_t *const now) {
    for (int i = 0; i < ARGUS_COUNTED; i++) {
        const argus_glimpse_t *const then = &self->counted[i];
        if (then->t_ms != 0 && ms_between(now, then) < COUNTED_MS &&
            argus_abs(argus_trail_offset_mm(now->x_mm, then->x_mm)) < COUNTED_MM &&
            argus_abs(argus_trail_offset_mm(now->y_mm, then->y_mm)) < COUNTED_MM &&
            argus_seen_bearing_cdeg(now, then) < COUNTED_CDEG) {
            return false;
        }
    }
    return true;
}

// Which part of the readings of those in use, but this one, is contradicted at present; at the start one in
// twenty of six.
typedef struct {
    int32_t all;
    int32_t contradicted;
} part_t;

static part_t part_contradicted(const argus_peers_t *const self, const argus_knowledge_t *const knowledge,
                                const int but) {
    part_t part = {.all = 6 * ONE_VERDICT, .contradicted = 6 * ONE_VERDICT / 20 + 1};
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const bool counts = i != but && !argus_is_out(knowledge, i);
        part.all += counts ? self->of[i].verdicts : 0;
        part.contradicted += counts ? self->of[i].contradicted : 0;
    }
    return part;
}

bool argus_peers_crowded(const argus_peers_t *const self, const argus_knowledge_t *const knowledge) {
    const part_t part = part_contradicted(self, knowledge, ARGUS_SONARS);
    return part.contradicted * 100 > part.all * CROWD_PERCENT;
}

static void note_counted(argus_peer_t *const self, const argus_glimpse_t *const now, const bool odd) {
    self->counted[self->counted_next] = *now;
    self->counted_next = (uint8_t)((self->counted_next + 1) % ARGUS_COUNTED);
    self->verdicts = (uint16_t)(self->verdicts + ONE_VERDICT);
    if (odd) {
        const unsigned hollow = now->reading_mm >= ARGUS_NO_ECHO_MM ? 1u : 0u;
        self->hollow = (uint8_t)((unsigned)self->hollow << 1 | hollow);
        self->contradicted = (uint16_t)(self->contradicted + ONE_VERDICT);
    }
}

// In the open nothing else bears one out: who made echoes up is not silent where others are, again and again.
static bool made_echoes_up(const argus_knowledge_t *const knowledge, const int sonar) {
    const argus_fault_kind_t kind = knowledge->sonar[sonar].kind;
    return argus_is_out(knowledge, sonar) && (kind == ARGUS_KIND_STUCK || kind == ARGUS_KIND_GARBAGE);
}

// Whether one that is out failed in a way that seldom lets its echoes agree, and hardly twice in a row.
static bool shows_at_once(const argus_knowledge_t *const knowledge, const int sonar) {
    const argus_fault_kind_t kind = knowledge->sonar[sonar].kind;
    const bool was_mute = kind == ARGUS_KIND_OFF || kind == ARGUS_KIND_SILENT;
    return made_echoes_up(knowledge, sonar) || (argus_is_out(knowledge, sonar) && was_mute);
}

// What it read before it was given up does not bring it back.
static bool is_since(const argus_knowledge_t *const knowledge, const int sonar,
                     const argus_glimpse_t *const at) {
    return knowledge->sip_ms - at->t_ms <= knowledge->sip_ms - knowledge->sonar[sonar].since_ms;
}

static int32_t increment_of(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                            const int sonar, const bool odd) {
    const part_t of = part_contradicted(&self->peers, knowledge, sonar);
    const int32_t twentieths = (of.contradicted * 20 + of.all / 2) / of.all;
    const int32_t part = argus_max(0, argus_min(PARTS - 1, twentieths - 1));
    return odd ? contradicts[part] * argus_unrest_percent(self, knowledge, sonar) / 100 : bears_out[part];
}

static void count(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                  const argus_glimpse_t *const now, const uint16_t against) {
    argus_peer_t *const peer = &self->peers.of[sonar];
    argus_case_t *const c = &self->of[sonar];
    const int32_t increment = increment_of(self, knowledge, sonar, against != 0);
    argus_bend_weigh(self, knowledge, sonar, now, against != 0 ? CONTRADICTED : AGREED, increment);
    argus_score(c, ARGUS_TEST_PEERS, increment); // after that, since who is a witness depends on it
    const bool doubted = c->score[ARGUS_TEST_PEERS] > 0;
    const bool echo = now->reading_mm < ARGUS_NO_ECHO_MM;
    peer->against = doubted ? (uint16_t)(peer->against | against) : 0;
    peer->borne_out = doubted && peer->borne_out;
    if (is_since(knowledge, sonar, now) && shows_at_once(knowledge, sonar)) {
        c->agreed = (uint8_t)(against == 0 && echo ? argus_min(c->agreed + 1, UINT8_MAX) : 0);
    }
    note_counted(peer, now, against != 0);
}

// Nothing that the others may say would change what is known of this lag.
static bool is_idle(const argus_peer_t *const self, const argus_said_t verdict, const int lag) {
    return (verdict == AGREED || verdict == QUIET) && self->late[lag] == 0 && self->told[lag] == 0;
}

// What the others would say of this reading had it been made at the pose of its sonar so far back.
static argus_said_t verdict_as_of(const argus_evidence_t *const self,
                                  const argus_knowledge_t *const knowledge, const int sonar,
                                  const argus_glimpse_t *const now, const argus_glimpse_t *const then) {
    if (then == NULL) {
        return UNSEEN;
    }
    int32_t along_mm = 0;
    if (argus_seen_bearing_cdeg(now, then) < LAG_TURN_CDEG && argus_seen_from(now, then, &along_mm)) {
        return SAME;
    }
    argus_glimpse_t as_of = *then;
    as_of.reading_mm = now->reading_mm;
    return argus_peers_say(self, knowledge, sonar, &as_of);
}

int16_t argus_limited(const int32_t sum, const int32_t ceiling) {
    return (int16_t)argus_max(0, argus_min(ceiling, sum));
}

static void weigh_lag(argus_peer_t *const peer, const int lag, const argus_said_t now,
                      const argus_said_t as_of) {
    peer->late[lag] = argus_limited(peer->late[lag] + late_than_well[now][as_of], LATE_CEILING);
    peer->told[lag] = argus_limited(peer->told[lag] + late_than_wrong[now][as_of], ARGUS_TOLD_CEILING);
}

static void doubt_time(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                       const int sonar, const int back, const argus_said_t verdict) {
    argus_peer_t *const peer = &self->peers.of[sonar];
    const argus_glimpse_t now = *argus_seen_at(peer, back);
    for (int n = ARGUS_LEAST_LAG; n < ARGUS_TRAIL; n++) {
        if (!is_idle(peer, verdict, n)) {
            const argus_glimpse_t *const then = argus_seen_before(peer, back, n);
            weigh_lag(peer, n, verdict, verdict_as_of(self, knowledge, sonar, &now, then));
        }
    }
}

static int32_t most_of(const int16_t *const lags) {
    int32_t most = 0;
    for (int n = ARGUS_LEAST_LAG; n < ARGUS_TRAIL; n++) {
        most = argus_max(most, lags[n]);
    }
    return most;
}

int32_t argus_peers_late(const argus_peers_t *const self, const int sonar) {
    return most_of(self->of[sonar].late);
}

int32_t argus_peers_told(const argus_peers_t *const self, const int sonar) {
    return most_of(self->of[sonar].told);
}

int argus_peers_against(const argus_peers_t *const self, const int sonar) {
    return argus_count_bits(self->of[sonar].against);
}

int argus_peers_hollow(const argus_peers_t *const self, const int sonar, const int of_last) {
    return argus_count_bits(self->of[sonar].hollow & ((1u << argus_min(of_last, HOLLOW_BITS)) - 1u));
}

// Where the robot was when the pings of this SIP were sent, about: between its two last poses.
static argus_pose_t pose_of_pings(const argus_peers_t *const self, const argus_knowledge_t *const knowledge) {
    argus_pose_t pose = argus_built_pose(knowledge);
    const uint32_t passed_ms = knowledge->sip_ms - self->before_ms;
    if (self->before_ms != 0 && passed_ms > 0 && passed_ms <= SIP_MOST_MS) {
        const int32_t span = (int32_t)passed_ms;
        const int32_t ago = argus_min(PING_AGE_MS, span);
        const int32_t turn_cdeg = argus_angle_wrap(pose.heading_cdeg - self->before.heading_cdeg);
        pose.x_mm -= (pose.x_mm - self->before.x_mm) * ago / span;
        pose.y_mm -= (pose.y_mm - self->before.y_mm) * ago / span;
        pose.heading_cdeg = argus_angle_wrap(pose.heading_cdeg - turn_cdeg * ago / span);
    }
    return pose;
}

static argus_glimpse_t glimpse_of(const argus_peers_t *const self, const argus_knowledge_t *const knowledge,
                                  const int sonar) {
    const argus_pose_t pose = pose_of_pings(self, knowledge);
    const argus_sonar_pose_t *const mount = &argus_sonar_pose[sonar];
    const argus_point_t robot = {mount->x_mm, mount->y_mm};
    const argus_point_t at = argus_to_course(&pose, robot);
    const int32_t bearing_cdeg = argus_angle_wrap(pose.heading_cdeg + mount->heading_deg * 100);
    const argus_glimpse_t glimpse = {.t_ms = knowledge->sip_ms,
                                     .x_mm = (uint16_t)((uint32_t)at.x_mm & 0xFFFFu),
                                     .y_mm = (uint16_t)((uint32_t)at.y_mm & 0xFFFFu),
                                     .bearing_cdeg = (int16_t)bearing_cdeg,
                                     .reading_mm = knowledge->sonar[sonar].reading_mm};
    return glimpse;
}

static void count_silence(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                          const int sonar, const argus_glimpse_t *const at, const tally_t *const tally) {
    argus_case_t *const c = &self->of[sonar];
    const bool quiet = tally->quiet > 0 && tally->agree == 0 && tally->differ == 0;
    if (quiet && made_echoes_up(knowledge, sonar) && is_since(knowledge, sonar, at) &&
        is_news(&self->peers.of[sonar], at)) {
        c->agreed = (uint8_t)argus_min(c->agreed + 1, UINT8_MAX);
        argus_score(c, ARGUS_TEST_VIEW, ARGUS_BOTH_QUIET); // as two silent views
        note_counted(&self->peers.of[sonar], at, false);
    }
}

static void count_if_news(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                          const int sonar, const argus_glimpse_t *const at, const tally_t *const tally) {
    const bool odd = tally->agree == 0 && tally->differ > 0 && !tally->excused;
    const bool borne_out = tally->agree > 0 && tally->agree >= tally->differ;
    if ((odd || borne_out) && is_news(&self->peers.of[sonar], at)) {
        count(self, knowledge, sonar, at, odd ? tally->against : 0);
    }
}

// That it hears shows also where a silence of it has counted already; not by what it heard before it fell
// silent, and is judged later.
static void note_borne_out(argus_evidence_t *const self, const int sonar, const argus_glimpse_t *const at,
                           const tally_t *const tally, const bool fresh) {
    argus_peer_t *const peer = &self->peers.of[sonar];
    const bool agrees = tally->agree > 0 && tally->agree >= tally->differ;
    const bool echo = fresh && at->reading_mm < ARGUS_NO_ECHO_MM;
    peer->borne_out = peer->borne_out || (echo && agrees && self->of[sonar].score[ARGUS_TEST_PEERS] > 0);
}

static void weigh(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                  const int back, const bool fresh) {
    argus_peer_t *const peer = &self->peers.of[sonar];
    const argus_glimpse_t at = *argus_seen_at(peer, back);
    const tally_t tally = ask_all(self, knowledge, sonar, &at);
    const argus_said_t verdict = verdict_of(&tally);
    const bool seen = verdict != UNSEEN || tally.differ > 0;
    if (seen) {
        argus_seen_weigh(peer, back);
    }
    count_if_news(self, knowledge, sonar, &at, &tally);
    note_borne_out(self, sonar, &at, &tally, fresh);
    count_silence(self, knowledge, sonar, &at, &tally);
    const bool tells = verdict != DIVIDED && (fresh || verdict != UNSEEN);
    if (tells && !(verdict == CONTRADICTED && argus_is_unrest_beside(self, knowledge, sonar))) {
        doubt_time(self, knowledge, sonar, back, verdict);
    }
}

// What nobody could judge when it was read is judged by who looks there later.
static void look_back(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                      const int sonar) {
    const argus_glimpse_t now = *argus_seen_at(&self->peers.of[sonar], 1);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if (!is_witness(self, knowledge, sonar, i)) {
            continue;
        }
        const argus_peer_t *const peer = &self->peers.of[i];
        const argus_gaze_t gaze = gaze_of(self, knowledge, i, &now);
        int32_t along_mm = 0;
        const int back = argus_seen_find(peer, &gaze, 0, &along_mm);
        if (back > 0 && !argus_seen_is_weighed(peer, back)) {
            weigh(self, knowledge, i, back, false);
        }
    }
}

void argus_peers_take(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                      const int sonar) {
    argus_seen_note(&self->peers.of[sonar], glimpse_of(&self->peers, knowledge, sonar));
    weigh(self, knowledge, sonar, 1, true);
    look_back(self, knowledge, sonar);
}

// By a sixtieth, at least by one.
int16_t argus_faded(const int16_t score) {
    const int32_t by = score / SCORE_FADES_S;
    const int32_t least = (score > 0) - (score < 0);
    return (int16_t)(score - (by != 0 ? by : least));
}

void argus_peers_sip(argus_evidence_t *const self, const argus_knowledge_t *const knowledge) {
    argus_peers_t *const peers = &self->peers;
    peers->before = argus_built_pose(knowledge);
    peers->before_ms = knowledge->sip_ms;
    if (knowledge->sip_ms - peers->faded_ms < FADE_MS) {
        return;
    }
    peers->faded_ms = knowledge->sip_ms;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        argus_peer_t *const peer = &peers->of[i];
        int16_t *const score = &self->of[i].score[ARGUS_TEST_PEERS];
        peer->verdicts = (uint16_t)(peer->verdicts * FADE_EIGHTHS / 8);
        peer->contradicted = (uint16_t)(peer->contradicted * FADE_EIGHTHS / 8);
        *score = argus_faded(*score);
        argus_bend_fade(peer);
        peer->against = *score > 0 ? peer->against : 0;
        peer->borne_out = *score > 0 && peer->borne_out;
    }
}

// What a liar said of the others is taken back: where nobody else contradicts them, the whole of it.
void argus_evidence_retract(argus_evidence_t *const self, const int sonar) {
    const uint16_t bit = (uint16_t)(1u << sonar);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        argus_peer_t *const peer = &self->peers.of[i];
        if (peer->against == bit) {
            self->of[i].score[ARGUS_TEST_PEERS] = 0;
            peer->borne_out = false;
            peer->hollow = 0;
            memset(peer->late, 0, sizeof peer->late);
            memset(peer->told, 0, sizeof peer->told);
            argus_bend_forget(peer);
        }
        peer->against = (uint16_t)(peer->against & ~(unsigned)bit);
    }
}

void argus_peers_forget(argus_peers_t *const self, const int sonar) {
    memset(&self->of[sonar], 0, sizeof self->of[sonar]);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        self->of[i].against = (uint16_t)(self->of[i].against & ~(1u << sonar));
    }
}

void argus_peers_restart(argus_peers_t *const self) {
    memset(self, 0, sizeof *self);
}
