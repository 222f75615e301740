// SPDX-License-Identifier: MIT
// Takes every reading through the tests and says what they amount to (profile argus).
#include "awareness/evidence.h"

#include <stddef.h>
#include <string.h>

#include "awareness/clutter.h"
#include "awareness/crosscheck.h"
#include "awareness/names.h"
#include "awareness/numbers.h"
#include "awareness/odds.h"
#include "awareness/own.h"
#include "awareness/scale.h"
#include "knowledge/angle.h"

#if ARGUS_LASER
static void restart_laser(argus_evidence_t *const self) {
    self->laser.count = 0;
}

// An operator's re-test of a sector is one of the laser.
static void forget_laser(argus_evidence_t *const self, const int sonar) {
    if ((self->laser.sectors >> sonar & 1u) != 0) {
        memset(&self->laser, 0, sizeof self->laser);
    }
}

static void take_laser(argus_evidence_t *const self, const argus_knowledge_t *const knowledge) {
    argus_laser_sip(&self->laser, knowledge);
}

argus_fault_kind_t argus_evidence_laser(const argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const bool sector = (self->laser.sectors >> sonar & 1u) != 0;
    return sector ? argus_laser_kind(&self->laser) : ARGUS_KIND_NONE;
}

int32_t argus_evidence_laser_news(const argus_evidence_t *const self) {
    return self->laser.news ? self->laser.fault : 0;
}
#else
static void restart_laser(argus_evidence_t *const self) {
    (void)self;
}

static void forget_laser(argus_evidence_t *const self, const int sonar) {
    (void)self, (void)sonar;
}

static void take_laser(argus_evidence_t *const self, const argus_knowledge_t *const knowledge) {
    (void)self, (void)knowledge;
}

argus_fault_kind_t argus_evidence_laser(const argus_evidence_t *const self, const int sonar) {
    (void)self, (void)sonar;
    return ARGUS_KIND_NONE;
}

int32_t argus_evidence_laser_news(const argus_evidence_t *const self) {
    (void)self;
    return 0;
}
#endif

void argus_evidence_init(argus_evidence_t *const self) {
    memset(self, 0, sizeof *self);
    self->caution = 100;
}

void argus_evidence_set_caution(argus_evidence_t *const self, const int32_t percent) {
    self->caution = (uint16_t)percent;
}

void argus_evidence_forget(argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    memset(&self->of[sonar], 0, sizeof self->of[sonar]);
    self->deaf[sonar] = (argus_rate_t){.all = 0};
    self->deaf_waits[sonar] = 0;
    self->told[sonar] = 0;
    memset(&self->pings[sonar], 0, sizeof self->pings[sonar]);
    forget_laser(self, sonar);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        self->of[i].against &= (argus_mask_t) ~(1u << sonar);
        self->told[i] &= (argus_mask_t) ~(1u << sonar);
    }
}

void argus_evidence_restart(argus_evidence_t *const self) {
    self->straight_sips = 0;
    self->before_ms = 0;
    memset(self->pings, 0, sizeof self->pings);
    restart_laser(self);
}

// Where the robot was when the pings of this SIP were sent, about: between its two last poses.
static argus_pose_t pose_of_pings(const argus_evidence_t *const self,
                                  const argus_knowledge_t *const knowledge) {
    argus_pose_t pose = knowledge->pose;
    const uint32_t passed_ms = knowledge->sip_ms - self->before_ms;
    const int32_t turn_cdeg = argus_angle_wrap(pose.heading_cdeg - self->before.heading_cdeg);
    const bool other_end = argus_abs(turn_cdeg) > ARGUS_ABOUT_CDEG;
    if (self->before_ms != 0 && passed_ms > 0 && passed_ms <= ARGUS_SIP_MOST_MS && !other_end) {
        const int32_t span = (int32_t)passed_ms;
        const int32_t ago = argus_min(ARGUS_PING_AGE_MS, span);
        pose.x_mm -= (pose.x_mm - self->before.x_mm) * ago / span;
        pose.y_mm -= (pose.y_mm - self->before.y_mm) * ago / span;
        pose.heading_cdeg = argus_angle_wrap(pose.heading_cdeg - turn_cdeg * ago / span);
    }
    return pose;
}

static argus_ping_t ray_of(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                           const argus_pose_t *const pose, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_ping_t ping = argus_ping_from(knowledge->robot, sonar, pose);
    ping.t_ms = (uint16_t)(knowledge->sip_ms & 0xFFFFu);
    ping.reading_mm = knowledge->sonar[sonar].reading_mm;
    ping.steady = self->straight_sips >= ARGUS_STEADY_SIPS;
    ping.rest = knowledge->still_sips >= ARGUS_REST_SIPS;
    return ping;
}

static void take(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                 const argus_pose_t *const pose, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_case_t *const c = &self->of[sonar];
    const bool sector = argus_robot_is_sector(knowledge->robot, sonar);
    if ((sector || knowledge->lists_all) && knowledge->sip_ms - c->counted_ms < ARGUS_REFRESH_MS) {
        return;
    }
    c->counted_ms = knowledge->sip_ms;
    c->out = argus_is_out(knowledge, sonar);
    const argus_ping_t now = ray_of(self, knowledge, pose, sonar);
    argus_own_take(self, knowledge, sonar, &now);
    if (!sector) {
        argus_scale_take(self, knowledge, sonar, &now);
    }
    c->last_mm = now.reading_mm;
    argus_pings_note(&self->pings[sonar], now);
    argus_crosscheck_take(self, knowledge, sonar);
}

static void grow_old(argus_evidence_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    if (knowledge->sip_ms - self->before_ms > ARGUS_PINGS_AGE_MS) { // their clock has gone round unseen
        for (int i = 0; i < ARGUS_SONARS; i++) {
            self->pings[i].count = 0;
        }
    }
    if (knowledge->sip_ms - self->faded_ms >= ARGUS_FADE_MS) {
        self->faded_ms = knowledge->sip_ms;
        argus_crosscheck_fade(self, knowledge);
        argus_odds_fade(self);
        for (int i = 0; i < knowledge->sonars; i++) {
            argus_pings_age(&self->pings[i], knowledge->sip_ms);
        }
    }
}

void argus_evidence_sip(argus_evidence_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    self->straight_sips = knowledge->rotating ? 0 : argus_one_more(self->straight_sips);
    self->asked = 0;
    grow_old(self, knowledge);
    const argus_pose_t pose = pose_of_pings(self, knowledge);
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((knowledge->fresh >> i & 1u) != 0) {
            take(self, knowledge, &pose, i);
        }
    }
    take_laser(self, knowledge);
    argus_clutter_sip(self, knowledge);
    self->before = knowledge->pose;
    self->before_ms = knowledge->sip_ms;
}

bool argus_evidence_suspects(const argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return argus_names_suspects(self, sonar);
}

bool argus_evidence_holds(const argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_case_t *const c = &self->of[sonar];
    int32_t most = c->score[ARGUS_TEST_PEERS] * 100 / argus_bounds[ARGUS_TEST_PEERS].naming;
    for (int i = 0; i < ARGUS_LAGS; i++) {
        most = argus_max(most, c->hypothesis[i].over_healthy * 100 / ARGUS_LATE_NAMING);
    }
    return argus_names_suspects(self, sonar) || most > ARGUS_HELD_PERCENT;
}

argus_fault_kind_t argus_evidence_names(const argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return argus_names_found(self, sonar);
}

argus_fault_kind_t argus_evidence_convicts(const argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return argus_names_convicts(self, sonar);
}

static const int8_t test_of[ARGUS_KEPT] = {
    [ARGUS_KEPT_WRONG] = ARGUS_TEST_PEERS,     [ARGUS_KEPT_OFF] = -1,
    [ARGUS_KEPT_STUCK] = ARGUS_TEST_STUCK,     [ARGUS_KEPT_GARBAGE] = ARGUS_TEST_GARBAGE,
    [ARGUS_KEPT_DROPOUT] = ARGUS_TEST_DROPOUT, [ARGUS_KEPT_LATE] = -1};

static int32_t naming_of(const argus_kept_t kept) {
    ARGUS_ASSERT((unsigned)kept < ARGUS_KEPT);
    return test_of[kept] >= 0 ? argus_bounds[test_of[kept]].naming : ARGUS_LATE_NAMING;
}

int16_t argus_evidence_kept(const argus_evidence_t *const self, const int sonar, const argus_kept_t kept) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT((unsigned)kept < ARGUS_KEPT);
    const argus_case_t *const c = &self->of[sonar];
    int32_t most = test_of[kept] >= 0 ? c->score[test_of[kept]] : 0;
    for (int i = 0; kept == ARGUS_KEPT_LATE && i < ARGUS_LAGS; i++) {
        most = argus_max(most, c->hypothesis[i].over_healthy);
    }
    return (int16_t)(most >= naming_of(kept) * ARGUS_SUSPECT_PERCENT / 100 ? most : 0);
}

void argus_evidence_restore(argus_evidence_t *const self, const int sonar, const argus_kept_t kept,
                            const int16_t score, const bool out) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT((unsigned)kept < ARGUS_KEPT);
    argus_case_t *const c = &self->of[sonar];
    const bool whole = out && kept != ARGUS_KEPT_WRONG; // together with others it would name
    const int32_t limit = naming_of(kept) * (whole ? 100 : ARGUS_SUSPECT_PERCENT) / 100 - 1;
    const int16_t half = (int16_t)argus_between(0, limit, score / 2);
    if (test_of[kept] >= 0) {
        c->score[test_of[kept]] = half;
    }
    for (int i = 0; kept == ARGUS_KEPT_LATE && i < ARGUS_LAGS; i++) {
        c->hypothesis[i].over_healthy = half; // it may be of any lag
    }
}

void argus_evidence_retract(argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_crosscheck_retract(self, sonar);
}

uint8_t argus_evidence_agreed(const argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return self->of[sonar].agreed;
}

void argus_evidence_agree_anew(argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    self->of[sonar].agreed = 0;
}

bool argus_evidence_repeats(const argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return self->of[sonar].score[ARGUS_TEST_STUCK] > 0;
}

bool argus_evidence_shows_gaps(const argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return self->of[sonar].score[ARGUS_TEST_DROPOUT] > 0;
}

uint8_t argus_evidence_silent_run(const argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return self->of[sonar].none_run;
}

int32_t argus_evidence_contradicted(const argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return self->of[sonar].score[ARGUS_TEST_PEERS];
}
