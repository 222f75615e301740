// SPDX-License-Identifier: MIT
// What the tests of a sonar amount to: a suspicion, a name, a conviction (profile argus).
#include "awareness/evidence_internal.h"
#include "knowledge/angle.h"

#define NAME_CONFLICTS 3 // a view is one of a pair: who is wrong takes a third
#define NAME_PARTNERS 2
#define OFF_RUN 5
#define OFF_RUN_LONG 12 // what echoed before is named off after so many readings without an echo
#define OFF_HOLLOW 3
#define VIEW_OFF_RUN 3
#define VIEW_ECHOES 6
#define HOLLOW_OF 4
#define CONVICT_CONFLICTS 4
#define CONVICT_BESIDE 3
#define VIEW_OUTWEIGHS 3   // so many times more views of it are contradicted than borne out,
#define OFF_OUTWEIGHS 2    // ... of one that is silent, since any echo clears it
#define CONVICT_EPISODES 3 // what moves about the robot does not contradict the same sonar again later
#define HELD 150           // hundredths of a nat that the peers must come down to before one is cleared
#define LATE_FIRST 430 // hundredths of a nat, all that speaks for late and against wrong together: at first
#define LATE_AFTER 880 // ... and once it is called wrong, and for a conviction
#define BENT_NAMING 1100
#define BENT_NAMING_BUSY 1500
#define BENT_CONTRADICTED 300
#define BENT_TOLD_NAMING 600 // ... while nothing does, of one that the bend tells so much of
#define BENT_TOLD 500
#define BENT_HOLLOW 5 // more silences than this, of the last eight contradicted readings, are no bent axis
#define HOLLOW_MOST 8

// How many others contradict it, of the last conflicts counted.
static int partners(const argus_case_t *const c) {
    uint32_t mask = 0;
    const int count = argus_min(c->conflicts, ARGUS_REFUTED);
    for (int i = 1; i <= count; i++) {
        const int partner = c->refuted[(c->refuted_next + ARGUS_REFUTED - i) % ARGUS_REFUTED].partner;
        mask |= partner == ARGUS_SCAN_PARTNER ? 0x30000u : (partner >= 0 ? 1u << partner : 0u);
    }
    return argus_count_bits(mask);
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

static bool is_named_by(const argus_case_t *const c, const argus_test_t test, const int32_t level) {
    const bool enough = test == ARGUS_TEST_OFF ? c->none_run >= OFF_RUN && c->misses > 0
                                               : test != ARGUS_TEST_VIEW || (c->conflicts >= NAME_CONFLICTS &&
                                                                             partners(c) >= NAME_PARTNERS);
    return c->score[test] >= level && enough;
}

// A faulty sonar's own echoes come and go after the robot has come to rest; those of others are of people.
static bool is_busy_beside(const argus_evidence_t *const self, const int sonar) {
    return (self->stirred & ~(1u << sonar)) != 0;
}

static bool is_busy_for(const argus_evidence_t *const self, const int sonar, const argus_test_t test) {
    return test == ARGUS_TEST_LAG ? is_busy_beside(self, sonar) : self->busy;
}

static int32_t naming_level(const argus_evidence_t *const self, const int sonar, const argus_test_t test) {
    return is_busy_for(self, sonar, test) ? argus_bounds[test].naming_busy : argus_bounds[test].naming;
}

static bool outweighs(const argus_case_t *const c, const argus_test_t test) {
    return (test == ARGUS_TEST_OFF ? OFF_OUTWEIGHS : VIEW_OUTWEIGHS) * c->borne_out <= c->conflicts;
}

// Who walks about contradicts, and does, while the robot turns and stops, what it did a moment ago.
static bool is_disturbed(const argus_evidence_t *const self, const int sonar, const argus_test_t test) {
    const bool wants_calm = rests_on_views(test) || test == ARGUS_TEST_LAG;
    return wants_calm && (self->crowded || is_busy_for(self, sonar, test));
}

// By its own readings alone, however late they look, nobody is given up.
static bool is_told_of(const argus_evidence_t *const self, const int sonar, const argus_test_t test) {
    return test != ARGUS_TEST_LAG || argus_peers_told(&self->peers, sonar) > 0;
}

static bool is_convicted_by(const argus_evidence_t *const self, const int sonar, const argus_test_t test) {
    const argus_case_t *const c = &self->of[sonar];
    const bool enough =
        !rests_on_views(test) || (outweighs(c, test) && c->conflicts >= CONVICT_CONFLICTS &&
                                  c->episodes >= CONVICT_EPISODES && beside_the_main(c) >= CONVICT_BESIDE);
    return c->score[test] >= argus_bounds[test].convincing && enough && !is_disturbed(self, sonar, test) &&
           is_told_of(self, sonar, test) && is_named_by(c, test, argus_bounds[test].naming);
}

// Late against wrong, in hundredths of a nat: what the changes of its own readings say, and what the others
// saw where it was some firings ago.
static int32_t lateness(const argus_evidence_t *const self, const int sonar) {
    return argus_peers_told(&self->peers, sonar) + self->of[sonar].score[ARGUS_TEST_LAG];
}

static argus_fault_kind_t late_or_wrong(const argus_evidence_t *const self, const int sonar,
                                        const int32_t late_from) {
    return lateness(self, sonar) >= late_from ? ARGUS_KIND_SLOW : ARGUS_KIND_WRONG;
}

// Off and wrong share a test; what the readings look like tells them apart, and a late sonar from both.
static argus_fault_kind_t kind_of_view(const argus_evidence_t *const self, const int sonar,
                                       const int32_t late_from) {
    const argus_case_t *const c = &self->of[sonar];
    if (c->none_run < VIEW_OFF_RUN && self->peers.of[sonar].borne_out &&
        argus_peers_hollow(&self->peers, sonar, HOLLOW_OF) == HOLLOW_OF) {
        return ARGUS_KIND_INTERMITTENT;
    }
    if (c->none_run == 0 && c->echoes >= VIEW_ECHOES) {
        return late_or_wrong(self, sonar, late_from);
    }
    if (c->score[ARGUS_TEST_DROPOUT] > 0) {
        return ARGUS_KIND_INTERMITTENT;
    }
    return c->none_run >= VIEW_OFF_RUN ? ARGUS_KIND_OFF : ARGUS_KIND_WRONG;
}

// Contradicted for silence only: off, unless they bore out an echo of it since they doubt it.
static argus_fault_kind_t kind_of_peers(const argus_evidence_t *const self, const int sonar,
                                        const int32_t late_from) {
    const argus_case_t *const c = &self->of[sonar];
    const int hollow = argus_peers_hollow(&self->peers, sonar, OFF_HOLLOW);
    if (hollow == OFF_HOLLOW) {
        const int run = self->peers.of[sonar].borne_out ? OFF_RUN_LONG : OFF_RUN;
        return c->none_run >= run ? ARGUS_KIND_OFF : ARGUS_KIND_INTERMITTENT;
    }
    return hollow > 0 && c->score[ARGUS_TEST_DROPOUT] > 0 ? ARGUS_KIND_INTERMITTENT
                                                          : late_or_wrong(self, sonar, late_from);
}

static argus_fault_kind_t kind_by(const argus_evidence_t *const self, const int sonar,
                                  const argus_test_t test, const int32_t late_from) {
    if (test == ARGUS_TEST_PEERS) {
        return kind_of_peers(self, sonar, late_from);
    }
    return test == ARGUS_TEST_VIEW ? kind_of_view(self, sonar, late_from)
                                   : (argus_fault_kind_t)kind_of_test[test];
}

// Who is wrong takes a third, among peers too.
static bool has_partners(const argus_evidence_t *const self, const int sonar) {
    return argus_peers_against(&self->peers, sonar) >= NAME_PARTNERS;
}

// The more definite tests come first.
static const uint8_t precedence[ARGUS_TESTS] = {ARGUS_TEST_OFF,     ARGUS_TEST_STUCK,   ARGUS_TEST_LAG,
                                                ARGUS_TEST_GARBAGE, ARGUS_TEST_DROPOUT, ARGUS_TEST_VIEW,
                                                ARGUS_TEST_PEERS};

static argus_fault_kind_t first_name(const argus_evidence_t *const self, const int sonar, const int tests) {
    for (int i = 0; i < tests; i++) {
        const argus_test_t test = (argus_test_t)precedence[i];
        const bool enough = test != ARGUS_TEST_PEERS || has_partners(self, sonar);
        if (is_named_by(&self->of[sonar], test, naming_level(self, sonar, test)) && enough) {
            return kind_by(self, sonar, test, LATE_FIRST);
        }
    }
    return ARGUS_KIND_NONE;
}

// In a turn a late sonar looks bent, and a bent one late: half as much that tells of a bend decides, since a
// bend is told of once in a place, a lag by every reading. One that mostly hears nothing is not bent.
static bool is_bent(const argus_evidence_t *const self, const int sonar, const int32_t level,
                    const int32_t told) {
    const argus_bend_t bend = argus_bend(&self->peers, sonar);
    return bend.well >= level && bend.told >= told && 2 * bend.told > lateness(self, sonar) &&
           has_partners(self, sonar) && argus_peers_hollow(&self->peers, sonar, HOLLOW_MOST) <= BENT_HOLLOW;
}

// Before a broad wall it is borne out again and again: where it mostly sees what others see aside, that it
// is contradicted on the whole is enough.
static bool looks_bent(const argus_evidence_t *const self, const int sonar) {
    const int32_t contradicted = self->of[sonar].score[ARGUS_TEST_PEERS];
    if (is_busy_beside(self, sonar)) {
        return contradicted >= BENT_CONTRADICTED && is_bent(self, sonar, BENT_NAMING_BUSY, 0);
    }
    return (contradicted >= BENT_CONTRADICTED && is_bent(self, sonar, BENT_NAMING, 0)) ||
           (contradicted >= 0 && is_bent(self, sonar, BENT_TOLD_NAMING, BENT_TOLD));
}

// What no test names may have a bent axis.
argus_fault_kind_t argus_evidence_names(const argus_evidence_t *const self, const int sonar) {
    const argus_fault_kind_t first = first_name(self, sonar, ARGUS_TESTS);
    return first == ARGUS_KIND_NONE && looks_bent(self, sonar) ? ARGUS_KIND_WRONG : first;
}

argus_fault_kind_t argus_evidence_relapses(const argus_evidence_t *const self, const int sonar) {
    return first_name(self, sonar, ARGUS_TESTS - 1);
}

argus_fault_kind_t argus_evidence_convicts(const argus_evidence_t *const self, const int sonar) {
    for (int i = 0; i < ARGUS_TESTS; i++) {
        const argus_test_t test = (argus_test_t)precedence[i];
        if (is_convicted_by(self, sonar, test)) {
            return kind_by(self, sonar, test, LATE_AFTER);
        }
    }
    return ARGUS_KIND_NONE;
}

bool argus_evidence_is_unsteady(const argus_evidence_t *const self, const int sonar) {
    static const uint8_t tests[] = {ARGUS_TEST_GARBAGE, ARGUS_TEST_DROPOUT, ARGUS_TEST_LAG};
    for (int i = 0; i < (int)sizeof tests; i++) {
        const argus_test_t test = (argus_test_t)tests[i];
        if (self->of[sonar].score[test] >= argus_bounds[test].suspicious &&
            !is_convicted_by(self, sonar, test)) {
            return true;
        }
    }
    return false;
}

static bool is_suspected_by(const argus_evidence_t *const self, const int sonar, const int tests) {
    for (int i = 0; i < tests; i++) {
        if (self->of[sonar].score[i] >= argus_bounds[i].suspicious) {
            return true;
        }
    }
    return false;
}

bool argus_evidence_keeps_out(const argus_evidence_t *const self, const int sonar) {
    return is_suspected_by(self, sonar, ARGUS_TEST_PEERS);
}

bool argus_evidence_suspects(const argus_evidence_t *const self, const int sonar) {
    return is_suspected_by(self, sonar, ARGUS_TESTS) || looks_bent(self, sonar);
}

bool argus_evidence_holds(const argus_evidence_t *const self, const int sonar) {
    return argus_evidence_suspects(self, sonar) || self->of[sonar].score[ARGUS_TEST_PEERS] > HELD ||
           argus_peers_late(&self->peers, sonar) > HELD;
}
