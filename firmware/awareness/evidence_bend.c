// SPDX-License-Identifier: MIT
// A bent axis: whether a sonar sees what the others see some way aside of its bearing.
#include <string.h>

#include "awareness/evidence_said.h"
#include "knowledge/angle.h"

#define CEILING 3000
#define TOLD_LEAST 200 // less: what contradicts it says nothing of a bend

// A wall fills cones that are 6 degrees apart alike, so bends between these show as well.
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

// What is borne out never speaks for a fault, whatever is seen aside.
static int32_t worth_of(const argus_case_t *const c, const argus_said_t verdict, const argus_said_t aside,
                        const int32_t increment, const int32_t percent) {
    const int32_t sum = increment + bent_than_well[verdict][aside] * percent / ARGUS_FULL_PERCENT;
    const int32_t worth = verdict == AGREED ? argus_min(0, sum) : sum;
    return (c->out && worth < 0 ? ARGUS_OUT_TIMES * worth : worth) * ARGUS_FULL_PERCENT / c->caution;
}

static void add(argus_peer_t *const peer, const int bend, const int32_t well, const int32_t told) {
    peer->bend[bend] = argus_limited(peer->bend[bend] + well, CEILING);
    const int32_t sum = peer->bend[bend] > 0 ? peer->bend_told[bend] + told : 0; // its episode is over
    peer->bend_told[bend] = argus_limited(sum, ARGUS_TOLD_CEILING);
}

void argus_bend_weigh(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                      const argus_glimpse_t *const at, const argus_said_t verdict, const int32_t increment) {
    const argus_case_t *const c = &self->of[sonar];
    argus_peer_t *const peer = &self->peers.of[sonar];
    const int32_t percent =
        verdict == AGREED ? ARGUS_FULL_PERCENT : argus_unrest_percent(self, knowledge, sonar);
    for (int i = 0; i < ARGUS_BENDS; i++) {
        if (verdict == AGREED && peer->bend[i] == 0) {
            continue;
        }
        argus_glimpse_t aside = *at;
        aside.bearing_cdeg = (int16_t)argus_angle_wrap(at->bearing_cdeg + bend_cdeg[i]);
        const argus_said_t there = argus_peers_say(self, knowledge, sonar, &aside);
        add(peer, i, worth_of(c, verdict, there, increment, percent),
            bent_than_other[verdict][there] * percent / c->caution);
    }
}

void argus_bend_fade(argus_peer_t *const self) {
    for (int i = 0; i < ARGUS_BENDS; i++) {
        self->bend[i] = argus_faded(self->bend[i]);
        self->bend_told[i] = self->bend[i] > 0 ? self->bend_told[i] : (int16_t)0;
    }
}

void argus_bend_forget(argus_peer_t *const self) {
    memset(self->bend, 0, sizeof self->bend);
    memset(self->bend_told, 0, sizeof self->bend_told);
}

argus_bend_t argus_bend(const argus_peers_t *const self, const int sonar) {
    const argus_peer_t *const peer = &self->of[sonar];
    argus_bend_t most = {.well = 0};
    for (int i = 0; i < ARGUS_BENDS; i++) {
        if (peer->bend_told[i] >= TOLD_LEAST && peer->bend[i] > most.well) {
            most.well = peer->bend[i];
            most.told = peer->bend_told[i];
        }
    }
    return most;
}
