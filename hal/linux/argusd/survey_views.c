// SPDX-License-Identifier: MIT
// Compares each reading with those of the sonars that the robot turned onto the same bearing.
#include "survey_views.h"

#include <stdlib.h>

#define SAME_DEG 5       // half the least difference of two bearings of a P3-DX, modulo a step of 30 degrees
#define CLOSE_MM 200     // what two places of sonars on the body make of one distance,
#define CLOSE_PERCENT 5  // ... and two cones
#define WITNESSES 2      // that agree with each other
#define NEAR_MM 4000     // an echo beyond is missed now and then
#define COMPARED 6       // headings that make a proof,
#define PROOF_PERCENT 80 // ... and the share of them that must speak against it

void survey_views_note(survey_views_t *self, int16_t heading_deg, const argus_status_t *status,
                       argus_mask_t fresh) {
    if (self->headings == SURVEY_HEADINGS) {
        return;
    }
    self->heading_deg[self->headings] = heading_deg;
    for (int i = 0; i < status->sonars; i++) {
        self->mm[self->headings][i] = (fresh >> i & 1u) != 0 ? status->reading_mm[i] : 0;
    }
    self->headings++;
}

static bool looks_alike(int one_deg, int other_deg) {
    const int apart_deg = abs(one_deg - other_deg) % 360;
    return apart_deg <= SAME_DEG || apart_deg >= 360 - SAME_DEG;
}

static bool is_echo(int mm) {
    return mm > 0 && mm <= NEAR_MM;
}

static bool is_close(int one_mm, int other_mm) {
    return abs(one_mm - other_mm) <= CLOSE_MM + one_mm * CLOSE_PERCENT / 100;
}

// Whose bearing the others are turned onto, and who they are.
typedef struct {
    int sonar;
    int world_deg;
    argus_mask_t trusted;
} question_t;

// What a sonar gave on a heading, where it looked along the bearing in question; 0: nothing that counts.
static int testimony(const survey_views_t *self, const argus_status_t *status, const question_t *question,
                     int heading, int sonar) {
    const bool counts =
        sonar != question->sonar && (question->trusted >> sonar & 1u) != 0 &&
        looks_alike(self->heading_deg[heading] + status->bearing_deg[sonar], question->world_deg);
    return counts ? self->mm[heading][sonar] : 0;
}

// The testimonies: how many are close to `mm`; all of them for mm = 0.
static int count_near(const survey_views_t *self, const argus_status_t *status, const question_t *question,
                      int mm) {
    int count = 0;
    for (int h = 0; h < self->headings; h++) {
        for (int i = 0; i < status->sonars; i++) {
            const int other_mm = testimony(self, status, question, h, i);
            count += other_mm > 0 && (mm == 0 || (is_echo(other_mm) && is_close(other_mm, mm)));
        }
    }
    return count;
}

// The echo on which most of the others agree; 0: they do not agree, or heard none.
static int heard_by_others(const survey_views_t *self, const argus_status_t *status,
                           const question_t *question) {
    int best = 0;
    int best_mm = 0;
    for (int h = 0; h < self->headings; h++) {
        for (int i = 0; i < status->sonars; i++) {
            const int mm = testimony(self, status, question, h, i);
            const int near = is_echo(mm) ? count_near(self, status, question, mm) : 0;
            best_mm = near > best ? mm : best_mm;
            best = near > best ? near : best;
        }
    }
    return best >= WITNESSES && 2 * best > count_near(self, status, question, 0) ? best_mm : 0;
}

survey_match_t survey_views_match(const survey_views_t *self, const argus_status_t *status, int sonar,
                                  argus_mask_t trusted) {
    survey_match_t match = {0, 0, 0};
    for (int h = 0; h < self->headings; h++) {
        const int mm = self->mm[h][sonar];
        const question_t question = {sonar, self->heading_deg[h] + status->bearing_deg[sonar], trusted};
        const int theirs_mm = mm == 0 ? 0 : heard_by_others(self, status, &question);
        if (theirs_mm == 0) {
            continue;
        }
        match.compared++;
        match.unheard += mm >= ARGUS_NO_ECHO_MM;
        match.agreed += mm < ARGUS_NO_ECHO_MM && is_close(theirs_mm, mm);
    }
    return match;
}

argus_fault_kind_t survey_proves(const survey_match_t *match) {
    const int against = match->compared - match->agreed;
    if (match->compared < COMPARED || against * 100 < match->compared * PROOF_PERCENT) {
        return ARGUS_KIND_NONE;
    }
    return match->unheard * 100 >= match->compared * PROOF_PERCENT ? ARGUS_KIND_OFF : ARGUS_KIND_WRONG;
}
