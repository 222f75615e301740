// SPDX-License-Identifier: MIT
// Disturbance: what moves about the robot makes healthy sonars disagree.
#include "awareness/clutter.h"

#include "awareness/numbers.h"
#include "awareness/odds.h"

void argus_clutter_note(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                        const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    self->of[sonar].moved = true;
    self->of[sonar].moved_ms = knowledge->sip_ms;
}

bool argus_clutter_beside(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                          const int but, const uint32_t ms) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    for (int i = 0; i < knowledge->sonars; i++) {
        const bool counts = i != but && self->of[i].moved && !argus_is_out(knowledge, i);
        if (counts && knowledge->sip_ms - self->of[i].moved_ms < ms) {
            return true;
        }
    }
    return false;
}

void argus_clutter_sip(argus_evidence_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    for (int i = 0; i < knowledge->sonars; i++) {
        argus_case_t *const c = &self->of[i];
        c->moved = c->moved && knowledge->sip_ms - c->moved_ms < ARGUS_CALM_MS;
    }
    if (argus_odds_common_permille(self, knowledge, ARGUS_TEST_PEERS) > ARGUS_CROWD_PERMILLE) {
        self->crowded = true;
        self->crowded_ms = knowledge->sip_ms;
    }
    self->crowded = self->crowded && knowledge->sip_ms - self->crowded_ms < ARGUS_CALM_MS;
    self->busy = self->crowded || argus_clutter_beside(self, knowledge, -1, ARGUS_CALM_MS);
}
