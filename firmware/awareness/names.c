// SPDX-License-Identifier: MIT
// What the tests and hypotheses of a sonar amount to: a suspicion, a name, a conviction.
#include "awareness/names.h"

#include "awareness/crosscheck.h"
#include "awareness/numbers.h"
#include "knowledge/angle.h"

static int32_t suspicious(const int32_t naming) {
    return naming * ARGUS_SUSPECT_PERCENT / 100;
}

static bool has_partners(const argus_case_t *const self) {
    return argus_count_bits(self->against) >= ARGUS_PARTNERS;
}

static argus_hypothesis_t most_of(const argus_case_t *const self, const int from, const int to) {
    argus_hypothesis_t most = {0, 0};
    for (int i = from; i < to; i++) {
        most = self->hypothesis[i].over_healthy > most.over_healthy ? self->hypothesis[i] : most;
    }
    return most;
}

static argus_hypothesis_t late_of(const argus_case_t *const self) {
    return most_of(self, 0, ARGUS_LAGS);
}

static argus_hypothesis_t offset_of(const argus_case_t *const self) {
    return most_of(self, ARGUS_LAGS, ARGUS_HYPOTHESES);
}

// Without a third that says so, only three readings in a row that it has given before are enough.
static bool is_late(const argus_case_t *const self, const int32_t level) {
    const int32_t wanted = has_partners(self) ? level : argus_max(level, ARGUS_LATE_ALONE);
    return late_of(self).over_healthy >= wanted && self->score[ARGUS_TEST_PEERS] >= 0;
}

// In a turn a late sonar looks as if its axis were offset, and the other way round. Half as much decides for
// the offset: it shows once in a place, a lag in every reading.
static bool is_offset(const argus_case_t *const self, const int32_t level) {
    const argus_hypothesis_t offset = offset_of(self);
    return offset.over_healthy >= level && offset.over_other >= ARGUS_OFFSET_LEAD &&
           2 * offset.over_other > late_of(self).over_other && has_partners(self) &&
           self->score[ARGUS_TEST_PEERS] >= ARGUS_OFFSET_CONTRADICTED;
}

// Contradicted for silence only: off, unless they bore out an echo of it since they contradict it.
static argus_fault_kind_t kind_of_peers(const argus_case_t *const self) {
    const int silent = argus_crosscheck_silences(self, ARGUS_SILENT_OF);
    if (silent == ARGUS_SILENT_OF) {
        return self->none_run >= (self->borne_out ? ARGUS_OFF_RUN_LONG : ARGUS_OFF_RUN)
                   ? ARGUS_KIND_OFF
                   : ARGUS_KIND_INTERMITTENT;
    }
    if (silent > 0 && self->score[ARGUS_TEST_DROPOUT] > 0) {
        return ARGUS_KIND_INTERMITTENT;
    }
    return late_of(self).over_other >= ARGUS_LATE_LEAD ? ARGUS_KIND_SLOW : ARGUS_KIND_WRONG;
}

// It is contradicted for silence, too, and others bear its echoes out: it is deaf to some surfaces, as
// healthy ones are, one more than another. Then gaps between echoes of one thing tell, or a long silence.
static bool is_deaf(const argus_case_t *const self) {
    return self->borne_out && argus_crosscheck_silences(self, ARGUS_SILENT_OF) > 0 &&
           self->score[ARGUS_TEST_DROPOUT] == 0 &&
           !(self->none_run >= ARGUS_OFF_RUN_LONG && self->silent_bits == UINT8_MAX);
}

// It has heard nothing for a while, and wherever it lately did not, the others heard something. So less is
// wanted than where echoes are contradicted, which might be of another thing.
static bool is_silent(const argus_case_t *const self) {
    return self->none_run >= ARGUS_OFF_RUN && !self->borne_out &&
           self->score[ARGUS_TEST_PEERS] >= ARGUS_SILENT_CONTRADICTED &&
           argus_crosscheck_silences(self, ARGUS_SILENT_OF) == ARGUS_SILENT_OF && has_partners(self);
}

// The more definite tests come first.
static argus_fault_kind_t own_found(const argus_case_t *const self) {
    if (self->score[ARGUS_TEST_STUCK] >= argus_bounds[ARGUS_TEST_STUCK].naming) {
        return ARGUS_KIND_STUCK;
    }
    if (self->score[ARGUS_TEST_GARBAGE] >= argus_bounds[ARGUS_TEST_GARBAGE].naming) {
        return ARGUS_KIND_GARBAGE;
    }
    if (is_late(self, ARGUS_LATE_NAMING)) {
        return ARGUS_KIND_SLOW;
    }
    return self->score[ARGUS_TEST_DROPOUT] >= argus_bounds[ARGUS_TEST_DROPOUT].naming
               ? ARGUS_KIND_INTERMITTENT
               : ARGUS_KIND_NONE;
}

static argus_fault_kind_t peers_found(const argus_case_t *const self) {
    if (self->score[ARGUS_TEST_PEERS] >= argus_bounds[ARGUS_TEST_PEERS].naming && has_partners(self) &&
        !is_deaf(self)) {
        return kind_of_peers(self);
    }
    if (is_silent(self)) {
        return ARGUS_KIND_OFF;
    }
    return is_offset(self, ARGUS_OFFSET_NAMING) ? ARGUS_KIND_WRONG : ARGUS_KIND_NONE;
}

argus_fault_kind_t argus_names_found(const argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_case_t *const c = &self->of[sonar];
    const argus_fault_kind_t own = own_found(c);
    return own != ARGUS_KIND_NONE ? own : peers_found(c);
}

static bool is_convicted_by(const argus_case_t *const self, const argus_test_t test) {
    ARGUS_ASSERT((unsigned)test < ARGUS_TESTS);
    return self->score[test] >= argus_bounds[test].convincing;
}

// Not where it is contradicted for silence, too, and others bear its echoes out: it is deaf to some surfaces,
// as healthy ones are, one more than another.
static bool convicted_by_peers(const argus_case_t *const self) {
    const bool hears_some = self->borne_out && argus_crosscheck_silences(self, ARGUS_SILENT_OF) > 0;
    return !hears_some && is_convicted_by(self, ARGUS_TEST_PEERS);
}

// People who walk about contradict; and by its own readings alone, however late they look, no sonar is given
// up.
argus_fault_kind_t argus_names_convicts(const argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT((unsigned)sonar < ARGUS_SONARS);
    const argus_case_t *const c = &self->of[sonar];
    if (is_convicted_by(c, ARGUS_TEST_STUCK)) {
        return ARGUS_KIND_STUCK;
    }
    if (is_convicted_by(c, ARGUS_TEST_GARBAGE)) {
        return ARGUS_KIND_GARBAGE;
    }
    if (is_convicted_by(c, ARGUS_TEST_DROPOUT)) {
        return ARGUS_KIND_INTERMITTENT;
    }
    const bool again = c->episodes >= ARGUS_EPISODES && has_partners(c) && !self->busy;
    if (again && is_late(c, ARGUS_LATE_CONVINCING)) {
        return ARGUS_KIND_SLOW;
    }
    return again && convicted_by_peers(c) ? kind_of_peers(c) : ARGUS_KIND_NONE;
}

bool argus_names_suspects(const argus_evidence_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_case_t *const c = &self->of[sonar];
    for (int i = 0; i < ARGUS_TESTS; i++) {
        if (c->score[i] >= suspicious(argus_bounds[i].naming) && (i != ARGUS_TEST_PEERS || !is_deaf(c))) {
            return true;
        }
    }
    return is_late(c, suspicious(ARGUS_LATE_NAMING)) || is_offset(c, suspicious(ARGUS_OFFSET_NAMING));
}

// What is more, of what is `so_far` and a score of `level` of a verdict.
static int32_t at_least(const int32_t so_far, const int32_t score, const int32_t level) {
    return argus_max(so_far, score * 100 / level);
}

static argus_fault_kind_t kind_of_test(const argus_case_t *const self, const int test) {
    switch (test) {
    case ARGUS_TEST_STUCK:
        return ARGUS_KIND_STUCK;
    case ARGUS_TEST_GARBAGE:
        return ARGUS_KIND_GARBAGE;
    case ARGUS_TEST_DROPOUT:
        return ARGUS_KIND_INTERMITTENT;
    default:
        return kind_of_peers(self);
    }
}

argus_fault_kind_t argus_names_best(const argus_evidence_t *const self, const int sonar,
                                    uint8_t *const percent) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_case_t *const c = &self->of[sonar];
    argus_fault_kind_t best = ARGUS_KIND_NONE;
    int32_t most = 0;
    for (int i = 0; i < ARGUS_TESTS; i++) {
        const int32_t now = at_least(most, c->score[i], argus_bounds[i].convincing);
        best = now > most ? kind_of_test(c, i) : best;
        most = now;
    }
    const int32_t late = at_least(most, late_of(c).over_healthy, ARGUS_LATE_CONVINCING);
    best = late > most ? ARGUS_KIND_SLOW : best;
    *percent = (uint8_t)argus_min(late, 100);
    const argus_fault_kind_t found = argus_names_found(self, sonar);
    return found != ARGUS_KIND_NONE ? found : best;
}
