// SPDX-License-Identifier: MIT
// Whether a sonar hands out its echoes some firings late: it repeats readings that it has given before.
#include "awareness/lag.h"

#include <stddef.h>

#include "awareness/numbers.h"
#include "awareness/odds.h"
#include "knowledge/angle.h"

// How much a stretch of the past varies that comes again; 0: not once, since what has been read since is
// alike.
static int32_t known_again_mm(const argus_pings_t *const pings, const int32_t reading_mm, const int lag) {
    int32_t least = reading_mm;
    int32_t most = reading_mm;
    for (int i = 1; i < lag; i++) {
        const int32_t then_mm = argus_pings_before(pings, 1, i - 1)->reading_mm;
        if (argus_abs(then_mm - reading_mm) <= ARGUS_ALIKE_MM) {
            return 0;
        }
        least = argus_min(least, then_mm);
        most = argus_max(most, then_mm);
    }
    return reading_mm > ARGUS_CLIPPED_MM ? most - least : 0;
}

// Where the robot stands still a healthy one reads the same again, too.
static bool is_repeat(const argus_ping_t *const now, const argus_ping_t *const then) {
    return then != NULL && argus_ping_is_echo(now) && then->reading_mm == now->reading_mm &&
           (argus_ping_moved_mm(now, then) >= ARGUS_STILL_MM ||
            argus_ping_turned_cdeg(now, then) >= ARGUS_STILL_CDEG);
}

// When the lag begins it repeats as many readings as it is late. A repeat by chance is as likely as in the
// test of one value, and the less likely the more the readings vary.
static int32_t replay_of(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                         const int sonar, const argus_ping_t *const now, const int index) {
    const int lag = index + ARGUS_LEAST_LAG;
    uint8_t *const run = &self->of[sonar].lag_run[index];
    const argus_pings_t *const pings = &self->pings[sonar];
    if (!is_repeat(now, argus_pings_before(pings, 1, lag - 1))) {
        *run = 0;
        return 0;
    }
    const int32_t varies_mm = *run < lag ? known_again_mm(pings, now->reading_mm, lag) : 0;
    if (varies_mm == 0) {
        return 0;
    }
    *run = (uint8_t)argus_min(*run + 1, ARGUS_REPLAY_RUN_MOST);
    const int32_t chance = argus_odds_of(self, knowledge, sonar, ARGUS_TEST_STUCK, true) +
                           argus_ln(varies_mm) - argus_ln(ARGUS_ALIKE_MM);
    return *run >= ARGUS_REPLAY_RUN && *run < ARGUS_REPLAY_RUN_MOST
               ? chance * (*run == ARGUS_REPLAY_RUN ? 2 : 1)
               : 0;
}

void argus_lag_take(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                    const argus_ping_t *const now) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    for (int i = 0; i < ARGUS_LAGS; i++) {
        const int32_t gain = replay_of(self, knowledge, sonar, now, i);
        argus_hypothesis_add(self, sonar, i, gain, gain);
    }
}
