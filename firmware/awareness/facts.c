// SPDX-License-Identifier: MIT
// Adds to the scores of a sonar, within their bounds.
#include "awareness/facts.h"

#include "awareness/levels.h"
#include "knowledge/angle.h"

const argus_bounds_t argus_bounds[ARGUS_TESTS] = {
    [ARGUS_TEST_STUCK] = {1300, 1800, 0},
    [ARGUS_TEST_GARBAGE] = {500, 2800, 0},
    [ARGUS_TEST_DROPOUT] = {800, 2700, 0},
    [ARGUS_TEST_PEERS] = {750, 2200, -150},
};

static int32_t scaled(const argus_evidence_t *const self, const int sonar, const int32_t increment) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int32_t times = self->of[sonar].out && increment < 0 ? ARGUS_OUT_TIMES : 1;
    return times * increment * 100 / self->caution;
}

static int16_t limited(const int32_t sum, const int32_t floor) {
    return (int16_t)argus_max(floor, argus_min(ARGUS_CEILING, sum));
}

void argus_score(argus_evidence_t *const self, const int sonar, const argus_test_t test,
                 const int32_t increment) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT((unsigned)test < ARGUS_TESTS);
    int16_t *const score = &self->of[sonar].score[test];
    *score = limited(*score + scaled(self, sonar, increment), argus_bounds[test].floor);
}

void argus_doubt(argus_evidence_t *const self, const int sonar, const int doubt, const int32_t well,
                 const int32_t told) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(doubt >= 0 && doubt < ARGUS_DOUBTS);
    argus_doubt_t *const d = &self->of[sonar].doubt[doubt];
    d->well = limited(d->well + scaled(self, sonar, well), 0);
    d->told = d->well > 0 ? limited(d->told + scaled(self, sonar, told), 0) : 0;
}
