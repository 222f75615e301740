// SPDX-License-Identifier: MIT
// Takes every reading through the tests and says what they amount to (profile argus).
#include "argus/evidence.h"

#include <stddef.h>
#include <string.h>

#include "argus/angle.h"
#include "evidence_internal.h"

#define CAUTION_PERCENT 100
#define REFRESH_MS 320u // a server that lists every sonar in every SIP lists one ping several times
#define STEADY_SIPS 2   // a SIP lists pings up to 140 ms old
#define REST_SIPS 3
#define NAME_CONFLICTS 3 // a view is one of a pair: who is wrong takes a third
#define NAME_PARTNERS 2
#define NAME_MISSES 2
#define OFF_RUN 5
#define LATE_TRIALS 4
#define LATE_TENTHS 8
#define LATE_LEAD 400
#define CONVICT_CONFLICTS 4
#define CONVICT_BESIDE 3
#define CONVICT_EPISODES 3 // what moves about the robot does not contradict the same sonar again later
#define UNSEEN_MM 1500u
#define USUAL_MS 2000u
#define UNREST_MS 8000u
#define CALM_MS 15000u // nobody is convicted by views before nothing has moved for so long

const argus_bounds_t argus_bounds[ARGUS_TESTS] = {
    [ARGUS_TEST_VIEW] =
        {.suspicious = 300, .naming = 700, .convincing = 2200, .floor = -150, .ceiling = 2600},
    [ARGUS_TEST_OFF] = {.suspicious = 300, .naming = 450, .convincing = 1500, .floor = 0, .ceiling = 2000},
    [ARGUS_TEST_STUCK] = {.suspicious = 840, .naming = 1050, .convincing = 1470, .floor = 0, .ceiling = 2000},
    [ARGUS_TEST_GARBAGE] =
        {.suspicious = 400, .naming = 650, .convincing = 2800, .floor = 0, .ceiling = 3200},
    [ARGUS_TEST_DROPOUT] =
        {.suspicious = 500, .naming = 750, .convincing = 2400, .floor = 0, .ceiling = 2800},
    [ARGUS_TEST_LAG] = {.suspicious = 300, .naming = 500, .convincing = 2600, .floor = 0, .ceiling = 3000},
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
    argus_evidence_set_caution(self, CAUTION_PERCENT);
}

void argus_evidence_set_caution(argus_evidence_t *const self, const int32_t percent) {
    for (int i = 0; i < ARGUS_SONARS; i++) {
        self->of[i].caution = (uint16_t)percent;
    }
}

void argus_evidence_forget(argus_evidence_t *const self, const int sonar) {
    forget_case(&self->of[sonar]);
}

void argus_evidence_restart(argus_evidence_t *const self) {
    self->straight_sips = 0;
    argus_scan_restart(&self->scan);
    argus_trend_restart(&self->trend);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        argus_case_t *const c = &self->of[i];
        c->trail_count = 0;
        c->track = 0;
        c->none_run = 0;
        c->jump_track = 0;
        memset(c->lag_doubt, 0, sizeof c->lag_doubt);
        memset(c->lag_run, 0, sizeof c->lag_run);
        memset(c->view, 0, sizeof c->view);
    }
}

void argus_score(argus_case_t *const self, const argus_test_t test, const int32_t increment) {
    const argus_bounds_t *const bounds = &argus_bounds[test];
    const int32_t scaled = increment * CAUTION_PERCENT / self->caution;
    const int32_t sum = self->score[test] + (self->out && scaled < 0 ? 4 * scaled : scaled);
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

bool argus_is_unrest_before(const argus_case_t *const self, const argus_knowledge_t *const knowledge) {
    return self->unrest && knowledge->sip_ms - self->unrest_ms < UNREST_MS;
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

static void take(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar) {
    argus_case_t *const c = &self->of[sonar];
    const bool repeated = knowledge->lists_all && knowledge->sip_ms - c->counted_ms < REFRESH_MS;
    if (repeated) {
        return;
    }
    c->counted_ms = knowledge->sip_ms;
    c->taken++;
    c->out = argus_is_out(knowledge, sonar);
    argus_trend_reading(&self->trend, knowledge, sonar);
    const argus_trail_t now = {.reading_mm = knowledge->sonar[sonar].reading_mm,
                               .x_mm = (uint16_t)((uint32_t)knowledge->pose.x_mm & 0xFFFFu),
                               .y_mm = (uint16_t)((uint32_t)knowledge->pose.y_mm & 0xFFFFu),
                               .heading_cdeg = (int16_t)knowledge->pose.heading_cdeg,
                               .steady = self->straight_sips >= STEADY_SIPS,
                               .rest = knowledge->still_sips >= REST_SIPS};
    const bool view = argus_trail_test(self, knowledge, sonar, &now);
    c->trail[c->trail_next] = now;
    c->trail_next = (uint8_t)((c->trail_next + 1) % ARGUS_TRAIL);
    c->trail_count = (uint8_t)argus_min(c->trail_count + 1, ARGUS_TRAIL);
    if (view) {
        argus_views_take(self, knowledge, sonar);
    }
    argus_views_scan(self, knowledge, sonar, argus_scan_take(&self->scan, knowledge, sonar));
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
    argus_trend_sip(&self->trend, knowledge);
}

// One lag explains most of what contradicted it after turns.
static bool is_late(const argus_case_t *const c) {
    int most = 0;
    for (int n = 1; n < ARGUS_TRAIL; n++) {
        most = argus_max(most, c->lag_votes[n]);
    }
    return (c->lag_trials >= LATE_TRIALS && most * 10 >= c->lag_trials * LATE_TENTHS) ||
           argus_trail_lag_lead(c) >= LATE_LEAD;
}

// Off and wrong share a test; what the readings look like tells them apart, and a late sonar from both.
static argus_fault_kind_t kind_of_view(const argus_case_t *const c) {
    if (c->none_run > 0 || c->echoes < 6) {
        return c->score[ARGUS_TEST_DROPOUT] > 0 ? ARGUS_KIND_INTERMITTENT
                                                : (c->none_run >= 3 ? ARGUS_KIND_OFF : ARGUS_KIND_WRONG);
    }
    return is_late(c) ? ARGUS_KIND_SLOW : ARGUS_KIND_WRONG;
}

// How many others contradict it, of the last conflicts counted.
static int partners(const argus_case_t *const c) {
    unsigned mask = 0;
    const int count = argus_min(c->conflicts, ARGUS_REFUTED);
    for (int i = 1; i <= count; i++) {
        const int partner = c->refuted[(c->refuted_next + ARGUS_REFUTED - i) % ARGUS_REFUTED].partner;
        mask |= partner == ARGUS_SCAN_PARTNER ? 0x30000u : (partner >= 0 ? 1u << partner : 0u);
    }
    int distinct = 0;
    for (; mask != 0; mask &= mask - 1) {
        distinct++;
    }
    return distinct;
}

static int partner_at(const argus_case_t *const c, const int back) {
    return c->refuted[(c->refuted_next + ARGUS_REFUTED - back) % ARGUS_REFUTED].partner;
}

static int conflicts_with(const argus_case_t *const c, const int partner, const int count) {
    int same = 0;
    for (int i = 1; i <= count; i++) {
        same += partner_at(c, i) == partner ? 1 : 0;
    }
    return same;
}

// Conflicts, of the last ones counted, with others than the partner of most of them: a liar beside it is one
// voice.
static int beside_the_main(const argus_case_t *const c) {
    const int count = argus_min(c->conflicts, ARGUS_REFUTED);
    int most = 0;
    for (int i = 1; i <= count; i++) {
        const int partner = partner_at(c, i);
        most = partner != ARGUS_SCAN_PARTNER ? argus_max(most, conflicts_with(c, partner, count)) : most;
    }
    return count - most;
}

static const uint8_t kind_of_test[ARGUS_TESTS] = {
    [ARGUS_TEST_OFF] = ARGUS_KIND_OFF,         [ARGUS_TEST_STUCK] = ARGUS_KIND_STUCK,
    [ARGUS_TEST_GARBAGE] = ARGUS_KIND_GARBAGE, [ARGUS_TEST_DROPOUT] = ARGUS_KIND_INTERMITTENT,
    [ARGUS_TEST_LAG] = ARGUS_KIND_SLOW,
};

static bool rests_on_views(const argus_test_t test) {
    return test == ARGUS_TEST_VIEW || test == ARGUS_TEST_OFF;
}

static bool is_named_by(const argus_case_t *const c, const argus_test_t test) {
    const bool enough = test == ARGUS_TEST_OFF ? c->none_run >= OFF_RUN && c->misses >= NAME_MISSES
                                               : test != ARGUS_TEST_VIEW || (c->conflicts >= NAME_CONFLICTS &&
                                                                             partners(c) >= NAME_PARTNERS);
    return c->score[test] >= argus_bounds[test].naming && enough;
}

static bool is_convicted_by(const argus_case_t *const c, const argus_test_t test, const bool busy) {
    const bool enough = !rests_on_views(test) ||
                        (!busy && 2 * c->borne_out <= c->conflicts && c->conflicts >= CONVICT_CONFLICTS &&
                         c->episodes >= CONVICT_EPISODES && beside_the_main(c) >= CONVICT_BESIDE);
    return c->score[test] >= argus_bounds[test].convincing && enough && is_named_by(c, test);
}

static argus_fault_kind_t kind_by(const argus_case_t *const c, const argus_test_t test) {
    return test == ARGUS_TEST_VIEW ? kind_of_view(c) : (argus_fault_kind_t)kind_of_test[test];
}

// The more definite tests come first.
static const uint8_t precedence[ARGUS_TESTS] = {ARGUS_TEST_OFF,     ARGUS_TEST_STUCK,   ARGUS_TEST_LAG,
                                                ARGUS_TEST_GARBAGE, ARGUS_TEST_DROPOUT, ARGUS_TEST_VIEW};

argus_fault_kind_t argus_evidence_names(const argus_evidence_t *const self, const int sonar) {
    for (int i = 0; i < ARGUS_TESTS; i++) {
        if (is_named_by(&self->of[sonar], (argus_test_t)precedence[i])) {
            return kind_by(&self->of[sonar], (argus_test_t)precedence[i]);
        }
    }
    return ARGUS_KIND_NONE;
}

argus_fault_kind_t argus_evidence_convicts(const argus_evidence_t *const self, const int sonar) {
    for (int i = 0; i < ARGUS_TESTS; i++) {
        if (is_convicted_by(&self->of[sonar], (argus_test_t)precedence[i], self->busy)) {
            return kind_by(&self->of[sonar], (argus_test_t)precedence[i]);
        }
    }
    return ARGUS_KIND_NONE;
}

bool argus_evidence_is_unsteady(const argus_evidence_t *const self, const int sonar) {
    static const uint8_t tests[] = {ARGUS_TEST_GARBAGE, ARGUS_TEST_DROPOUT, ARGUS_TEST_LAG};
    for (int i = 0; i < (int)sizeof tests; i++) {
        const argus_test_t test = (argus_test_t)tests[i];
        if (self->of[sonar].score[test] >= argus_bounds[test].suspicious &&
            !is_convicted_by(&self->of[sonar], test, self->busy)) {
            return true;
        }
    }
    return false;
}

bool argus_evidence_suspects(const argus_evidence_t *const self, const int sonar) {
    for (int i = 0; i < ARGUS_TESTS; i++) {
        if (self->of[sonar].score[i] >= argus_bounds[i].suspicious) {
            return true;
        }
    }
    return false;
}

uint16_t argus_evidence_unseen(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                               const argus_config_t *const config) {
    (void)config;
    unsigned mask = 0;
    for (int i = ARGUS_FORWARD_FIRST; i <= ARGUS_FORWARD_LAST; i++) {
        const argus_case_t *const c = &self->of[i];
        mask |= c->none_run > 0 && knowledge->odometer_mm - c->alive_odometer_mm > UNSEEN_MM ? 1u << i : 0u;
    }
    return (uint16_t)(mask & ~(unsigned)argus_out(knowledge));
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
