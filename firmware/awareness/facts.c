// SPDX-License-Identifier: MIT
// Adds to the scores of a sonar, within their bounds.
#include "awareness/facts.h"

#include "awareness/numbers.h"
#include "knowledge/angle.h"

const argus_bounds_t argus_bounds[ARGUS_TESTS] = {
#define ROW(name, usual, odd, even, naming, convincing, floor) \
    [ARGUS_TEST_##name] = {naming, convincing, floor},
    ARGUS_TEST_NUMBERS(ROW)
#undef ROW
};

static int32_t scaled(const argus_evidence_t *const self, const int sonar, const int32_t increment) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int32_t times = self->of[sonar].out && increment < 0 ? ARGUS_OUT_TIMES : 1;
    return times * increment * 100 / self->caution;
}

static int16_t limited(const int32_t sum, const int32_t floor) {
    return (int16_t)argus_between(floor, ARGUS_CEILING, sum);
}

void argus_score(argus_evidence_t *const self, const int sonar, const argus_test_t test,
                 const int32_t increment) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT((unsigned)test < ARGUS_TESTS);
    int16_t *const score = &self->of[sonar].score[test];
    *score = limited(*score + scaled(self, sonar, increment), argus_bounds[test].floor);
}

void argus_hypothesis_add(argus_evidence_t *const self, const int sonar, const int hypothesis,
                          const int32_t over_healthy, const int32_t over_other) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(hypothesis >= 0 && hypothesis < ARGUS_HYPOTHESES);
    argus_hypothesis_t *const d = &self->of[sonar].hypothesis[hypothesis];
    d->over_healthy = limited(d->over_healthy + scaled(self, sonar, over_healthy), 0);
    d->over_other = d->over_healthy > 0 ? limited(d->over_other + scaled(self, sonar, over_other), 0) : 0;
}
