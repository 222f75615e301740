// SPDX-License-Identifier: MIT
// Takes every reading through the tests and says what they amount to (profile argus).
#include "awareness/evidence.h"

#include <stddef.h>
#include <string.h>

#include "awareness/evidence_said.h"
#include "knowledge/angle.h"

#define REFRESH_MS 320u // a server that lists every sonar in every SIP lists one ping several times
#define STEADY_SIPS 2   // a SIP lists pings up to 140 ms old
#define REST_SIPS 3
#define UNSEEN_MM 1500u
#define USUAL_MS 2000u
#define UNREST_MS 8000u
#define UNREST_PERCENT 25
#define CALM_MS 30000u  // people are, or something moved, about the robot: nobody is convicted by others
#define NEVER INT16_MAX // what the peers say calls for looks, which convict

_Static_assert(ARGUS_TEST_PEERS == ARGUS_TESTS - 1, "what is kept and what convicts comes before the peers");

const argus_bounds_t argus_bounds[ARGUS_TESTS] = {
    [ARGUS_TEST_VIEW] = {300, 700, 700, 2200, -150, 2600},
    [ARGUS_TEST_OFF] = {300, 300, 300, 1500, 0, 2000},
    [ARGUS_TEST_STUCK] = {840, 1050, 1050, 1470, 0, 2000},
    [ARGUS_TEST_GARBAGE] = {400, 500, 650, 2800, 0, 3200}, // who walks into view makes as many leaps
    [ARGUS_TEST_DROPOUT] = {400, 500, 500, 2700, 0, 3000},
    [ARGUS_TEST_LAG] = {600, 900, 1400, 2200, 0, 3000},
    [ARGUS_TEST_PEERS] = {450, 650, 650, NEVER, -150, 2500},
};

static void forget_case(argus_case_t *const self) {
    const uint16_t caution = self->caution;
    memset(self, 0, sizeof *self);
    self->caution = caution;
    for (int i = 0; i < ARGUS_REFUTED; i++) {
        self->refuted[i].partner = -1;
    }
}

void argus_evidence_init(argus_evidence_t *const self) {
    memset(self, 0, sizeof *self);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        forget_case(&self->of[i]);
    }
    argus_evidence_set_caution(self, ARGUS_FULL_PERCENT);
}

void argus_evidence_set_caution(argus_evidence_t *const self, const int32_t percent) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        self->of[i].caution = (uint16_t)percent;
    }
}

void argus_evidence_forget(argus_evidence_t *const self, const int sonar) {
    forget_case(&self->of[sonar]);
    argus_peers_forget(&self->peers, sonar);
}

void argus_evidence_restart(argus_evidence_t *const self) {
    self->straight_sips = 0;
    argus_scan_restart(&self->scan);
    argus_peers_restart(&self->peers);
    argus_trend_restart(&self->trend);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        argus_case_t *const c = &self->of[i];
        c->score[ARGUS_TEST_PEERS] = 0; // who spoke against it is forgotten
        c->trail_count = 0;
        c->track = 0;
        c->none_run = 0;
        c->rest_gaps = 0;
        c->jump_track = 0;
        memset(c->view, 0, sizeof c->view);
    }
}

void argus_score(argus_case_t *const self, const argus_test_t test, const int32_t increment) {
    const argus_bounds_t *const bounds = &argus_bounds[test];
    const int32_t scaled = increment * ARGUS_FULL_PERCENT / self->caution;
    const int32_t sum = self->score[test] + (self->out && scaled < 0 ? ARGUS_OUT_TIMES * scaled : scaled);
    self->score[test] = (int16_t)argus_max(bounds->floor, argus_min(bounds->ceiling, sum));
}

void argus_note_unrest(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                       const int sonar) {
    self->of[sonar].unrest = true;
    self->of[sonar].unrest_ms = knowledge->sip_ms;
    if (!argus_is_out(knowledge, sonar)) {
        self->busy = true;
        self->busy_ms = knowledge->sip_ms;
    }
}

static bool moved_within(const argus_case_t *const self, const argus_knowledge_t *const knowledge,
                         const uint32_t ms) {
    return self->unrest && knowledge->sip_ms - self->unrest_ms < ms;
}

bool argus_is_unrest_before(const argus_case_t *const self, const argus_knowledge_t *const knowledge) {
    return moved_within(self, knowledge, UNREST_MS);
}

bool argus_is_unrest_beside(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                            const int sonar) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const argus_case_t *const c = &self->of[i];
        if (i != sonar && !argus_is_out(knowledge, i) && argus_is_unrest_before(c, knowledge)) {
            return true;
        }
    }
    return false;
}

bool argus_is_unrest(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                     const int sonar) {
    return argus_is_unrest_before(&self->of[sonar], knowledge) ||
           argus_is_unrest_beside(self, knowledge, sonar);
}

// What moves about the robot makes healthy sonars disagree.
int32_t argus_unrest_percent(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                             const int sonar) {
    return argus_is_unrest(self, knowledge, sonar) ? UNREST_PERCENT : 100;
}

static void take(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar) {
    argus_case_t *const c = &self->of[sonar];
    const bool repeated = knowledge->lists_all && knowledge->sip_ms - c->counted_ms < REFRESH_MS;
    if (repeated) {
        return;
    }
    c->counted_ms = knowledge->sip_ms;
    c->taken++;
    const bool out = argus_is_out(knowledge, sonar);
    if (c->out && !out) {
        argus_bend_forget(&self->peers.of[sonar]); // it was mended
        argus_seen_forget(&self->peers.of[sonar]);
    }
    c->out = out;
    argus_trend_reading(&self->trend, knowledge, sonar);
    const argus_trail_t now = {.reading_mm = knowledge->sonar[sonar].reading_mm,
                               .x_mm = (uint16_t)((uint32_t)knowledge->pose.x_mm & 0xFFFFu),
                               .y_mm = (uint16_t)((uint32_t)knowledge->pose.y_mm & 0xFFFFu),
                               .heading_cdeg = (int16_t)argus_built_heading_cdeg(knowledge),
                               .steady = self->straight_sips >= STEADY_SIPS,
                               .rest = knowledge->still_sips >= REST_SIPS};
    argus_peers_take(self, knowledge, sonar);
    const bool view = argus_trail_test(self, knowledge, sonar, &now);
    c->trail[c->trail_next] = now;
    c->trail_next = (uint8_t)((c->trail_next + 1) % ARGUS_TRAIL);
    c->trail_count = (uint8_t)argus_min(c->trail_count + 1, ARGUS_TRAIL);
    if (view) {
        argus_views_take(self, knowledge, sonar);
    }
    argus_views_scan(self, knowledge, sonar, argus_scan_take(&self->scan, knowledge, sonar));
}

static void note_crowd(argus_evidence_t *const self, const argus_knowledge_t *const knowledge) {
    if (argus_peers_crowded(&self->peers, knowledge)) {
        self->crowded = true;
        self->crowded_ms = knowledge->sip_ms;
    }
    self->crowded = self->crowded && knowledge->sip_ms - self->crowded_ms < CALM_MS;
}

static uint16_t stirred(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge) {
    unsigned mask = 0;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const bool counts = moved_within(&self->of[i], knowledge, CALM_MS) && !argus_is_out(knowledge, i);
        mask |= counts ? 1u << i : 0u;
    }
    return (uint16_t)mask;
}

void argus_evidence_sip(argus_evidence_t *const self, const argus_knowledge_t *const knowledge) {
    self->straight_sips = knowledge->rotating ? 0 : (uint8_t)argus_min(self->straight_sips + 1, UINT8_MAX);
    if (self->usual_run > 0 && knowledge->sip_ms - self->usual_ms >= USUAL_MS) {
        self->usual_run--;
        self->usual_ms = knowledge->sip_ms;
    }
    self->busy = self->busy && knowledge->sip_ms - self->busy_ms < CALM_MS;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if ((knowledge->fresh >> i & 1u) != 0) {
            take(self, knowledge, i);
        }
    }
    self->stirred = stirred(self, knowledge);
    note_crowd(self, knowledge);
    argus_trend_sip(&self->trend, knowledge);
    argus_peers_sip(self, knowledge);
}

argus_mask_t argus_evidence_unseen(const argus_evidence_t *const self,
                                   const argus_knowledge_t *const knowledge,
                                   const argus_config_t *const config) {
    (void)config;
    unsigned mask = 0;
    for (int i = ARGUS_FORWARD_FIRST; i <= ARGUS_FORWARD_LAST; i++) {
        const argus_case_t *const c = &self->of[i];
        mask |= c->none_run > 0 && knowledge->odometer_mm - c->alive_odometer_mm > UNSEEN_MM ? 1u << i : 0u;
    }
    return (argus_mask_t)(mask & ~(unsigned)argus_out(knowledge));
}

void argus_evidence_acquit(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                           const int sonar) {
    argus_case_t *const c = &self->of[sonar];
    const unsigned bit = ~(1u << sonar);
    self->lost &= (uint16_t)bit;
    self->jumped &= (uint16_t)bit;
    c->jump_track = 0;
    c->deaf_cdeg = 0;
    argus_trail_learn_run(self, sonar);
    c->alive_odometer_mm = knowledge->odometer_mm;
    c->alive_ms = knowledge->sip_ms;
}

argus_mask_t argus_evidence_lost(const argus_evidence_t *const self) {
    return self->lost;
}

argus_mask_t argus_evidence_jumped(const argus_evidence_t *const self) {
    return self->jumped;
}

void argus_evidence_note_loss(argus_evidence_t *const self, const argus_mask_t sonars) {
    self->lost |= sonars;
}

void argus_evidence_note_jump(argus_evidence_t *const self, const argus_mask_t sonars) {
    self->jumped |= sonars;
}

uint8_t argus_evidence_agreed(const argus_evidence_t *const self, const int sonar) {
    return self->of[sonar].agreed;
}

void argus_evidence_agree_anew(argus_evidence_t *const self, const int sonar) {
    self->of[sonar].agreed = 0;
}

bool argus_evidence_has_pairs(const argus_evidence_t *const self) {
    return self->agreements != 0;
}

bool argus_evidence_shows_gaps(const argus_evidence_t *const self, const int sonar) {
    return self->of[sonar].score[ARGUS_TEST_DROPOUT] > 0;
}

uint8_t argus_evidence_silent_run(const argus_evidence_t *const self, const int sonar) {
    return self->of[sonar].none_run;
}

int32_t argus_evidence_accused(const argus_evidence_t *const self, const int sonar) {
    return self->of[sonar].score[ARGUS_TEST_PEERS];
}

uint32_t argus_evidence_alive_age_ms(const argus_evidence_t *const self,
                                     const argus_knowledge_t *const knowledge, const int sonar) {
    return knowledge->sip_ms - self->of[sonar].alive_ms;
}

uint32_t argus_evidence_agreed_age_ms(const argus_evidence_t *const self,
                                      const argus_knowledge_t *const knowledge, const int sonar) {
    return knowledge->sip_ms - self->of[sonar].agreed_ms;
}

uint8_t argus_evidence_taken(const argus_evidence_t *const self, const int sonar) {
    return self->of[sonar].taken;
}

uint8_t argus_evidence_echo_bits(const argus_evidence_t *const self, const int sonar) {
    return self->of[sonar].echo_bits;
}

int argus_evidence_news(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                        int32_t *const metres) {
    const int sonar = argus_trend_news(&self->trend, knowledge);
    *metres = sonar < 0 ? 0 : argus_trend_horizon_m(&self->trend, sonar);
    return sonar;
}

void argus_evidence_forget_trend(argus_evidence_t *const self, const int sonar) {
    argus_trend_forget(&self->trend, sonar);
}
