// SPDX-License-Identifier: MIT
// A bent axis: whether a sonar sees what the others see some way aside of its bearing.
#include <string.h>

#include "argus/angle.h"
#include "evidence_said.h"

#define CEILING 3000
#define TOLD_CEILING 900
#define TOLD_LEAST 200 // less: what contradicts it says nothing of a bend

// A view of a wall fills cones that are 6 degrees apart alike, so bends between these show as well.
static const int16_t bend_cdeg[ARGUS_BENDS] = {-2400, -1800, -1200, 1200, 1800, 2400};

// Hundredths of a nat, that it is bent so far and not well, beyond what the verdict itself is worth. Rows:
// the verdict on its bearing; columns: ... on the bent one. DESIGN.md, Evidence, derives them.
static const int16_t bent_than_well[VERDICTS][VERDICTS] = {
    [AGREED] = {[AGREED] = 60, [CONTRADICTED] = -320},
    [CONTRADICTED] = {[QUIET] = 40, [AGREED] = 150, [CONTRADICTED] = -190},
};

// That it is bent and not faulty in another way.
static const int16_t bent_than_other[VERDICTS][VERDICTS] = {
    [AGREED] = {[AGREED] = 30, [CONTRADICTED] = -300},
    [CONTRADICTED] = {[QUIET] = 60, [AGREED] = 160, [CONTRADICTED] = -200},
};

static int16_t limited(const int32_t sum, const int32_t ceiling) {
    return (int16_t)argus_max(0, argus_min(ceiling, sum));
}

void argus_bend_weigh(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                      const argus_glimpse_t *const at, const argus_said_t verdict, const int32_t increment) {
    argus_peer_t *const peer = &self->peers.of[sonar];
    const int32_t percent = verdict == AGREED ? 100 : argus_unrest_percent(self, knowledge, sonar);
    for (int i = 0; i < ARGUS_BENDS; i++) {
        if (verdict == AGREED && peer->bend[i] == 0) {
            continue;
        }
        argus_glimpse_t aside = *at;
        aside.bearing_cdeg = (int16_t)argus_angle_wrap(at->bearing_cdeg + bend_cdeg[i]);
        const argus_said_t there = argus_peers_say(self, knowledge, sonar, &aside);
        const int32_t well = increment + bent_than_well[verdict][there] * percent / 100;
        const int32_t other = bent_than_other[verdict][there] * percent / 100;
        peer->bend[i] = limited(peer->bend[i] + well, CEILING);
        peer->bend_told[i] = limited(peer->bend_told[i] + other, TOLD_CEILING);
    }
}

void argus_bend_forget(argus_peer_t *const self) {
    memset(self->bend, 0, sizeof self->bend);
    memset(self->bend_told, 0, sizeof self->bend_told);
}

int32_t argus_bend(const argus_peers_t *const self, const int sonar) {
    int32_t most = 0;
    for (int i = 0; i < ARGUS_BENDS; i++) {
        const bool told = self->of[sonar].bend_told[i] >= TOLD_LEAST;
        most = told ? argus_max(most, self->of[sonar].bend[i]) : most;
    }
    return most;
}

int32_t argus_bend_told(const argus_peers_t *const self, const int sonar) {
    int32_t most = 0;
    for (int i = 0; i < ARGUS_BENDS; i++) {
        most = argus_max(most, self->of[sonar].bend_told[i]);
    }
    return most;
}
