// SPDX-License-Identifier: MIT
// The tolerance range and Algorithm 1 (paper: Fig. 7, eq. 1 and 2, Table II).
#include "awareness/awareness.h"
#include "knowledge/angle.h"

// tr = (a1 + a2) (1 / cos 20 - 1). With fewer digits some readings round to the wrong side.
#define FACE_MM 167
#define EXCESS INT64_C(641777725) // of EXCESS_ONE
#define EXCESS_ONE INT64_C(10000000000)

int32_t argus_tolerance_mm(const int32_t reading_mm) {
    const int64_t scaled = (int64_t)(reading_mm + FACE_MM) * EXCESS;
    return (int32_t)((scaled + EXCESS_ONE / 2) / EXCESS_ONE);
}

// A neighbour that may be compared with: one of 1..6 that is usable; else -1.
static int neighbour(const argus_knowledge_t *const knowledge, const int sonar) {
    const bool forward = sonar >= ARGUS_FORWARD_FIRST && sonar <= ARGUS_FORWARD_LAST;
    return forward && argus_usable(knowledge, sonar) ? sonar : -1;
}

static int32_t reading(const argus_knowledge_t *const knowledge, const int sonar) {
    return knowledge->sonar[sonar].reading_mm;
}

argus_verdict_t argus_disparity(const argus_knowledge_t *const knowledge, const int sonar,
                                int32_t *const difference_mm) {
    const int left = neighbour(knowledge, sonar - 1);
    const int right = neighbour(knowledge, sonar + 1);
    *difference_mm = 0;
    if (neighbour(knowledge, sonar) < 0 || (left < 0 && right < 0)) {
        return ARGUS_NO_VERDICT;
    }
    const int32_t tr = argus_tolerance_mm(reading(knowledge, sonar));
    if (left >= 0 && right >= 0 && argus_abs(reading(knowledge, left) - reading(knowledge, right)) > tr) {
        return ARGUS_NO_VERDICT;
    }
    *difference_mm = reading(knowledge, right >= 0 ? right : left) - reading(knowledge, sonar);
    return *difference_mm > tr ? ARGUS_DISPARATE : ARGUS_AGREES;
}
