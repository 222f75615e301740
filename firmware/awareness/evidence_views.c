// SPDX-License-Identifier: MIT
// Bearing memory: what the sonars saw from where, and what two views of one bearing say of both.
#include <stddef.h>
#include <string.h>

#include "awareness/evidence_internal.h"
#include "knowledge/angle.h"

#define VIEW_AGE_MS 10000u
#define SAME_BEARING_CDEG 300
#define SAME_LATERAL_MM 50
#define SAME_ALONG_MM 150
#define CLOSE_BEARING_CDEG 150 // nearer pairs than this weigh in full
#define CLOSE_LATERAL_MM 30
#define CLOSE_ALONG_MM 50
#define LOOSE_PERCENT 60
#define FAINT_PERCENT 45 // of what healthy pairs miss in a tenth of the cases, not a twentieth
#define OFF_RUN 2
#define EPISODE_MS 6000u
#define SUPPORT_CDEG 2000 // an echo may come from anywhere in the cone of either
#define SUPPORT_REACH_MM 6000
#define AGAIN_PERCENT 35 // on a bearing and in a place that was counted with another partner
#define SAME_PLACE_MM 35
#define SAME_VIEW_CDEG 200
#define AIM_NEAREST_MM 250
#define AIM_FARTHEST_MM (ARGUS_PAIR_FARTHEST_MM - SAME_ALONG_MM)
#define AIM_TURN_CDEG 10000
#define COUNTED_MM 100
#define COUNTED_CDEG 800
#define STALE_MM 40

// Hundredths of a nat: a pair of views on one bearing, for the sonar that is the odd one out; see DESIGN.md,
// Evidence.
#define AGREES (-60)
#define DIFFERS 320
#define MISSES 320
#define HEARS_MORE 200
#define HEAD_START 100

typedef struct {
    int32_t along_mm; // the newer view's place before the older one's, on the bearing
    bool comparable;
    bool close;
} relation_t;

static relation_t relate(const argus_view_t *const now, const argus_view_t *const then) {
    relation_t relation = {0, false, false};
    const int32_t dx = now->x_mm - then->x_mm;
    const int32_t dy = now->y_mm - then->y_mm;
    const bool old = now->t_ms - then->t_ms > VIEW_AGE_MS;
    const bool far_off = argus_abs(dx) > SAME_ALONG_MM || argus_abs(dy) > SAME_ALONG_MM;
    if (!then->valid || old || far_off ||
        argus_angle_abs_diff(now->bearing_cdeg, then->bearing_cdeg) > SAME_BEARING_CDEG) {
        return relation;
    }
    const argus_shift_t shift = argus_pair_shift(dx, dy, now->bearing_cdeg);
    relation.along_mm = shift.along_mm;
    relation.comparable = shift.lateral_mm <= SAME_LATERAL_MM;
    relation.close = shift.lateral_mm <= CLOSE_LATERAL_MM && argus_abs(relation.along_mm) <= CLOSE_ALONG_MM &&
                     argus_angle_abs_diff(now->bearing_cdeg, then->bearing_cdeg) <= CLOSE_BEARING_CDEG;
    return relation;
}

static argus_outcome_t judge_pair(const argus_view_t *const now, const argus_view_t *const then,
                                  const int32_t along_mm) {
    return argus_pair_compare(now->reading_mm, then->reading_mm, along_mm);
}

// What a conflict here still adds, in hundredths: one place and bearing is one piece of evidence, whoever
// sees it.
static int32_t news_of(const argus_case_t *const self, const argus_view_t *const at, const int partner) {
    int32_t news = 100;
    for (int i = 0; i < ARGUS_REFUTED; i++) {
        const argus_refuted_t *const r = &self->refuted[i];
        const bool here =
            argus_abs(r->x_mm - at->x_mm) < COUNTED_MM && argus_abs(r->y_mm - at->y_mm) < COUNTED_MM;
        if (r->partner < 0 || !here ||
            argus_angle_abs_diff(r->bearing_cdeg, at->bearing_cdeg) >= COUNTED_CDEG) {
            continue;
        }
        if (r->partner == partner) {
            return 0;
        }
        news = AGAIN_PERCENT;
    }
    return news;
}

static void note_counted(argus_case_t *const self, const argus_view_t *const at, const int partner) {
    argus_refuted_t *const r = &self->refuted[self->refuted_next];
    self->refuted_next = (uint8_t)((self->refuted_next + 1) % ARGUS_REFUTED);
    r->x_mm = at->x_mm;
    r->y_mm = at->y_mm;
    r->bearing_cdeg = at->bearing_cdeg;
    r->partner = (int8_t)partner;
}

static void disagree(argus_case_t *const self, int32_t increment, const argus_view_t *const at,
                     const int partner, const bool misses, const bool calm, const uint32_t now_ms) {
    const int32_t news = news_of(self, at, partner);
    if (news == 0) {
        return;
    }
    note_counted(self, at, partner);
    if (self->score[ARGUS_TEST_VIEW] <= 0) {
        self->conflicts = 0;
        self->borne_out = 0;
        self->episodes = 0;
        self->misses = 0;
    }
    if (calm && (self->episodes == 0 || now_ms - self->conflict_ms >= EPISODE_MS)) {
        self->episodes = (uint8_t)argus_min(self->episodes + 1, UINT8_MAX);
        self->conflict_ms = now_ms;
    }
    argus_score(self, ARGUS_TEST_VIEW, increment * news / 100);
    if (misses && self->none_run >= OFF_RUN) {
        argus_score(self, ARGUS_TEST_OFF, increment * news / 100);
    }
    self->conflicts = (uint8_t)argus_min(self->conflicts + 1, UINT8_MAX);
    self->agreed = 0;
}

static void agree(argus_case_t *const self, const argus_knowledge_t *const knowledge) {
    argus_score(self, ARGUS_TEST_VIEW, AGREES);
    self->agreed = (uint8_t)argus_min(self->agreed + 1, UINT8_MAX);
    self->borne_out = (uint8_t)argus_min(self->borne_out + 1, UINT8_MAX);
    self->alive_odometer_mm = knowledge->odometer_mm;
    self->alive_ms = knowledge->sip_ms;
    self->agreed_ms = knowledge->sip_ms;
}

// Whom a disagreement is laid to: the one with the worse record bears it, two of like record share it. One
// that is out already is no witness.
static int32_t share_of(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                        const int sonar, const int partner) {
    if (argus_is_out(knowledge, partner)) {
        return argus_is_out(knowledge, sonar) ? 50 : 0;
    }
    if (argus_is_out(knowledge, sonar)) {
        return 100;
    }
    if (((self->lost | self->jumped) >> sonar & 1u) != ((self->lost | self->jumped) >> partner & 1u)) {
        return ((self->lost | self->jumped) >> sonar & 1u) != 0 ? 100 : 20;
    }
    const int32_t lead = self->of[sonar].score[ARGUS_TEST_VIEW] - self->of[partner].score[ARGUS_TEST_VIEW];
    if (lead >= HEAD_START) {
        return 100;
    }
    return lead <= -HEAD_START ? 20 : 50;
}

// Only then a disagreement makes an episode.
static bool is_calm(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                    const int sonar) {
    return !self->crowded && !argus_is_unrest(self, knowledge, sonar);
}

// One side of a disagreement; `misses`: it is the one that hears nothing.
static void bear(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                 const int partner, const argus_view_t *const at, const int32_t weight, const bool misses) {
    argus_case_t *const c = &self->of[sonar];
    const int32_t share =
        share_of(self, knowledge, sonar, partner) * argus_unrest_percent(self, knowledge, sonar) / 100;
    disagree(c, weight * share / 100, at, partner, misses, is_calm(self, knowledge, sonar),
             knowledge->sip_ms);
    c->misses = (uint8_t)argus_min(c->misses + misses, UINT8_MAX);
}

static int32_t weight_of(const argus_outcome_t outcome, const argus_outcome_t missing,
                         const int32_t percent) {
    const int32_t weight =
        outcome == ARGUS_PAIR_DIFFER ? DIFFERS : (outcome == missing ? MISSES : HEARS_MORE);
    return weight * percent / 100;
}

static void compare(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                    const argus_view_t *const now, const int other, const argus_view_t *const then) {
    const relation_t relation = relate(now, then);
    const argus_outcome_t outcome = judge_pair(now, then, relation.along_mm);
    argus_trend_pair(&self->trend, knowledge, sonar, now->reading_mm, other, then->reading_mm,
                     relation.along_mm);
    if (outcome == ARGUS_PAIR_AGREE) {
        self->agreements++;
        agree(&self->of[sonar], knowledge);
        agree(&self->of[other], knowledge);
    } else if (outcome == ARGUS_PAIR_QUIET) {
        argus_score(&self->of[sonar], ARGUS_TEST_OFF, ARGUS_BOTH_QUIET);
        argus_score(&self->of[other], ARGUS_TEST_OFF, ARGUS_BOTH_QUIET);
    } else if (outcome != ARGUS_PAIR_NOTHING) {
        const bool faint = argus_pair_is_faint(now->reading_mm, then->reading_mm, relation.along_mm);
        const int32_t percent = (relation.close ? 100 : LOOSE_PERCENT) * (faint ? FAINT_PERCENT : 100) / 100;
        self->disagreements++;
        bear(self, knowledge, sonar, other, now, weight_of(outcome, ARGUS_PAIR_NOW_MISSES, percent),
             outcome == ARGUS_PAIR_NOW_MISSES);
        bear(self, knowledge, other, sonar, then, weight_of(outcome, ARGUS_PAIR_THEN_MISSES, percent),
             outcome == ARGUS_PAIR_THEN_MISSES);
    }
}

static argus_view_t view_of(const argus_knowledge_t *const knowledge, const int sonar) {
    const argus_sonar_pose_t *const mount = &argus_sonar_pose[sonar];
    const argus_point_t robot = {mount->x_mm, mount->y_mm};
    const argus_pose_t pose = argus_built_pose(knowledge);
    const argus_point_t at = argus_to_course(&pose, robot);
    const argus_view_t view = {.x_mm = at.x_mm,
                               .y_mm = at.y_mm,
                               .bearing_cdeg = argus_angle_wrap(pose.heading_cdeg + mount->heading_deg * 100),
                               .t_ms = knowledge->sip_ms,
                               .reading_mm = knowledge->sonar[sonar].reading_mm,
                               .rest = argus_at_rest(knowledge),
                               .valid = true};
    return view;
}

// From the same place on the same bearing as the last one: only another reading makes it another view.
static bool is_same_place(const argus_case_t *const self, const argus_view_t *const now) {
    const argus_view_t *const last = &self->view[(self->view_next + ARGUS_VIEWS - 1) % ARGUS_VIEWS];
    const bool here = argus_abs(last->x_mm - now->x_mm) <= SAME_PLACE_MM &&
                      argus_abs(last->y_mm - now->y_mm) <= SAME_PLACE_MM &&
                      argus_angle_abs_diff(last->bearing_cdeg, now->bearing_cdeg) <= SAME_VIEW_CDEG;
    return last->valid && here && now->t_ms - last->t_ms < VIEW_AGE_MS / 2;
}

static bool has_changed(const argus_case_t *const self, const argus_view_t *const now) {
    const argus_view_t *const last = &self->view[(self->view_next + ARGUS_VIEWS - 1) % ARGUS_VIEWS];
    const argus_outcome_t outcome = judge_pair(now, last, 0);
    if (argus_pair_is_faint(now->reading_mm, last->reading_mm, 0)) { // comes and goes by itself
        return false;
    }
    return outcome == ARGUS_PAIR_DIFFER || outcome == ARGUS_PAIR_NOW_MISSES ||
           outcome == ARGUS_PAIR_THEN_MISSES;
}

// The latest view of another sonar that can be compared; NULL: none.
static const argus_view_t *latest_of(const argus_case_t *const other, const argus_view_t *const now) {
    for (int i = 1; i <= ARGUS_VIEWS; i++) {
        const argus_view_t *const then = &other->view[(other->view_next + ARGUS_VIEWS - i) % ARGUS_VIEWS];
        if (relate(now, then).comparable) {
            return then;
        }
    }
    return NULL;
}

void argus_views_scan(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                      const argus_scan_verdict_t verdict) {
    argus_case_t *const c = &self->of[sonar];
    const int32_t weight = argus_scan_weight(verdict);
    if (verdict == ARGUS_SCAN_AGREES) {
        const argus_view_t at = view_of(knowledge, sonar);
        const bool here = argus_abs(at.x_mm - c->agreed_x_mm) < COUNTED_MM &&
                          argus_abs(at.y_mm - c->agreed_y_mm) < COUNTED_MM;
        if (!here || argus_angle_abs_diff(at.bearing_cdeg, c->agreed_cdeg) >= COUNTED_CDEG) {
            argus_score(c, ARGUS_TEST_VIEW, weight);
            c->borne_out = (uint8_t)argus_min(c->borne_out + 1, UINT8_MAX);
            c->agreed_x_mm = at.x_mm;
            c->agreed_y_mm = at.y_mm;
            c->agreed_cdeg = at.bearing_cdeg;
            c->agreed_ms = at.t_ms;
        }
    } else if (verdict != ARGUS_SCAN_NOTHING) {
        const argus_view_t at = view_of(knowledge, sonar);
        disagree(c, weight * argus_unrest_percent(self, knowledge, sonar) / 100, &at, ARGUS_SCAN_PARTNER,
                 verdict == ARGUS_SCAN_MISSES, is_calm(self, knowledge, sonar), at.t_ms);
        c->misses = (uint8_t)argus_min(c->misses + (verdict == ARGUS_SCAN_MISSES), UINT8_MAX);
    }
}

static bool is_witness(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                       const int sonar) {
    const unsigned doubted = (unsigned)argus_out(knowledge) | self->lost | self->jumped;
    return (doubted >> sonar & 1u) == 0 && !argus_evidence_suspects(self, sonar);
}

// What it costs to look along a view's bearing, in hundredths of a degree of turn; INT32_MAX: it is no use.
static int32_t cost_of_aim(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                           const int sonar, const int other, const argus_view_t *const then) {
    const argus_sonar_pose_t *const mount = &argus_sonar_pose[sonar];
    const int32_t heading = argus_angle_wrap(then->bearing_cdeg - mount->heading_deg * 100);
    const argus_pose_t turned = {
        .x_mm = knowledge->pose.x_mm, .y_mm = knowledge->pose.y_mm, .heading_cdeg = heading};
    const argus_point_t robot = {mount->x_mm, mount->y_mm};
    const argus_point_t at = argus_to_course(&turned, robot);
    const argus_view_t there = {
        .x_mm = at.x_mm, .y_mm = at.y_mm, .bearing_cdeg = then->bearing_cdeg, .t_ms = knowledge->sip_ms};
    const int32_t turn = argus_angle_abs_diff(heading, argus_built_heading_cdeg(knowledge));
    const bool telling = then->reading_mm >= AIM_NEAREST_MM && then->reading_mm <= AIM_FARTHEST_MM &&
                         turn >= SAME_BEARING_CDEG && turn <= AIM_TURN_CDEG &&
                         relate(&there, then).comparable;
    return telling && news_of(&self->of[sonar], &there, other) == 100 ? turn + then->reading_mm : INT32_MAX;
}

bool argus_evidence_aim(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                        const int sonar, int32_t *const heading_cdeg) {
    int32_t least = INT32_MAX;
    for (int other = 0; other < ARGUS_SONARS; other++) {
        for (int i = 0; other != sonar && is_witness(self, knowledge, other) && i < ARGUS_VIEWS; i++) {
            const argus_view_t *const then = &self->of[other].view[i];
            const int32_t cost = cost_of_aim(self, knowledge, sonar, other, then);
            if (cost < least) {
                least = cost;
                *heading_cdeg =
                    argus_angle_wrap(then->bearing_cdeg - argus_sonar_pose[sonar].heading_deg * 100 +
                                     argus_robot_facing_cdeg(knowledge->robot));
            }
        }
    }
    return least < INT32_MAX;
}

static bool is_supported_by(const argus_view_t *const at, const argus_view_t *const by) {
    if (!by->valid || by->reading_mm >= ARGUS_NO_ECHO_MM || at->t_ms - by->t_ms > VIEW_AGE_MS) {
        return false;
    }
    const int32_t dx = by->x_mm + by->reading_mm * argus_cos(by->bearing_cdeg) / ARGUS_TRIG_ONE - at->x_mm;
    const int32_t dy = by->y_mm + by->reading_mm * argus_sin(by->bearing_cdeg) / ARGUS_TRIG_ONE - at->y_mm;
    return argus_abs(dx) < SUPPORT_REACH_MM && argus_abs(dy) < SUPPORT_REACH_MM &&
           argus_abs(argus_hypot(dx, dy) - at->reading_mm) <= argus_pair_limit_mm(at->reading_mm) &&
           argus_angle_abs_diff(argus_atan2(dy, dx), at->bearing_cdeg) <= SUPPORT_CDEG;
}

bool argus_views_support(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                         const int sonar) {
    const argus_view_t at = view_of(knowledge, sonar);
    for (int other = 0; other < ARGUS_SONARS; other++) {
        for (int i = 0; other != sonar && i < ARGUS_VIEWS; i++) {
            if (is_supported_by(&at, &self->of[other].view[i])) {
                return true;
            }
        }
    }
    return false;
}

void argus_views_take(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                      const int sonar) {
    argus_case_t *const c = &self->of[sonar];
    const argus_view_t now = view_of(knowledge, sonar);
    if (is_same_place(c, &now)) {
        if (!has_changed(c, &now)) {
            return;
        }
        if (now.rest && c->view[(c->view_next + ARGUS_VIEWS - 1) % ARGUS_VIEWS].rest) {
            argus_note_unrest(self, knowledge, sonar); // from where it stands nothing changes by itself
        }
    }
    c->view[c->view_next] = now;
    c->view_next = (uint8_t)((c->view_next + 1) % ARGUS_VIEWS);
    for (int other = 0; other < ARGUS_SONARS; other++) {
        const argus_view_t *const then = other != sonar ? latest_of(&self->of[other], &now) : NULL;
        if (then != NULL) {
            compare(self, knowledge, sonar, &now, other, then);
        }
    }
}
