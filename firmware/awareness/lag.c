// SPDX-License-Identifier: MIT
// Whether a sonar hands out its echoes some firings late: it repeats readings that it has given before.
#include "awareness/lag.h"

#include <stddef.h>

#include "awareness/levels.h"
#include "knowledge/angle.h"

#define SPREAD_MM 60 // a stretch that varies less is not known again
#define REPEATS 5
static const int16_t repeated[REPEATS] = {0, 0, 580, 870, 0}; // [i]: the i-th reading in a row given before

// A stretch of the past comes again once: what has been read since as well goes to and fro.
static bool is_known_again(const argus_pings_t *const pings, const uint16_t reading_mm, const int lag) {
    int32_t least = reading_mm;
    int32_t most = reading_mm;
    for (int i = 1; i <= lag; i++) {
        const int32_t then_mm = argus_pings_before(pings, 1, i - 1)->reading_mm;
        if (i < lag && then_mm == reading_mm) {
            return false;
        }
        least = argus_min(least, then_mm);
        most = argus_max(most, then_mm);
    }
    return reading_mm > ARGUS_CLIPPED_MM && most - least >= SPREAD_MM;
}

// When the lag begins it repeats as many readings as it is late.
static int32_t replay_of(uint8_t *const run, const argus_pings_t *const pings, const uint16_t reading_mm,
                         const int lag) {
    const argus_ping_t *const then = argus_pings_before(pings, 1, lag - 1);
    if (then == NULL || reading_mm >= ARGUS_NO_ECHO_MM || then->reading_mm != reading_mm) {
        *run = 0;
        return 0;
    }
    if (*run >= lag || !is_known_again(pings, reading_mm, lag)) {
        return 0;
    }
    *run = (uint8_t)argus_min(*run + 1, REPEATS - 1);
    return repeated[*run];
}

void argus_lag_take(argus_evidence_t *const self, const int sonar, const uint16_t reading_mm) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_case_t *const c = &self->of[sonar];
    for (int i = 0; i < ARGUS_LAGS; i++) {
        const int32_t gain = replay_of(&c->lag_run[i], &c->pings, reading_mm, i + ARGUS_LEAST_LAG);
        argus_doubt(self, sonar, i, gain, gain);
    }
}
