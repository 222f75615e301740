// SPDX-License-Identifier: MIT
// The tolerance range and Algorithm 1 (paper: Fig. 7, eq. 1 and 2, Table II).
#include "paper/disparity.h"

#include "knowledge/angle.h"

// tr = (a1 + a2) (1 / cos 20 - 1). With fewer digits some readings round to the wrong side.
int32_t argus_tolerance_mm(const argus_robot_t *const robot, const int32_t reading_mm) {
    ARGUS_ASSERT(reading_mm >= 0);
    const uint64_t half = UINT64_C(1) << 31;
    const uint64_t scaled =
        (uint64_t)(uint32_t)(reading_mm + robot->tolerance_centre_mm) * robot->tolerance_excess;
    return (int32_t)((scaled + half) >> 32);
}

// A sonar that may be compared with, or -1.
static int usable(const argus_knowledge_t *const knowledge, const int sonar) {
    return sonar >= 0 && argus_usable(knowledge, sonar) ? sonar : -1;
}

static int32_t reading(const argus_knowledge_t *const knowledge, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return knowledge->sonar[sonar].reading_mm;
}

argus_verdict_t argus_disparity(const argus_knowledge_t *const knowledge, const int sonar,
                                int32_t *const difference_mm) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int left = usable(knowledge, argus_robot_beside(knowledge->robot, sonar, true));
    const int right = usable(knowledge, argus_robot_beside(knowledge->robot, sonar, false));
    *difference_mm = 0;
    if (!argus_usable(knowledge, sonar) || (left < 0 && right < 0)) {
        return ARGUS_NO_VERDICT;
    }
    const int32_t tr = argus_tolerance_mm(knowledge->robot, reading(knowledge, sonar));
    if (left >= 0 && right >= 0 && argus_abs(reading(knowledge, left) - reading(knowledge, right)) > tr) {
        return ARGUS_NO_VERDICT;
    }
    *difference_mm = reading(knowledge, right >= 0 ? right : left) - reading(knowledge, sonar);
    return *difference_mm > tr ? ARGUS_DISPARATE : ARGUS_AGREES;
}
