// SPDX-License-Identifier: MIT
// A wall beside the way: whether the robot slants into one that the sonars ahead do not hear.
#include <stddef.h>

#include "argus/angle.h"
#include "evidence_internal.h"

#define NEAR_MM 350
#define WAY_MM 80 // two readings show a slant when they were made so far apart
#define STRAIGHT_CDEG 300
#define FALL_MM 12   // ... and differ by more than noise
#define UNEVEN_MM 10 // from the line of the two the one before may differ so much
#define APART_MM 20

// At the reading at which its corner would touch, the body goes beyond the sonar's face by these.
static int32_t beyond_mm(const int sonar) {
    return ARGUS_P3DX_BODY_WIDTH_MM / 2 - argus_abs(argus_sonar_pose[sonar].y_mm);
}

static int32_t ahead_mm(const int sonar) {
    return ARGUS_P3DX_BODY_FRONT_MM - argus_sonar_pose[sonar].x_mm;
}

// The latest reading on this heading that was made far enough back; NULL: none.
static const argus_trail_t *far_enough_back(const argus_case_t *const self, const argus_trail_t *const now) {
    for (int i = 2; i <= self->trail_count; i++) {
        const argus_trail_t *const then = argus_trail_at(self, i);
        if (argus_trail_turned_cdeg(now, then) > STRAIGHT_CDEG) {
            return NULL;
        }
        if (argus_trail_moved_mm(now, then) >= WAY_MM) {
            return then;
        }
    }
    return NULL;
}

bool argus_evidence_slants_in(const argus_evidence_t *const self, const int sonar, const int32_t stop_mm) {
    const argus_case_t *const c = &self->of[sonar];
    const argus_trail_t *const now = argus_trail_at(c, 1);
    const argus_trail_t *const before = argus_trail_at(c, 2);
    const argus_trail_t *const then = now != NULL ? far_enough_back(c, now) : NULL;
    if (then == NULL || then->reading_mm > NEAR_MM || then->reading_mm - now->reading_mm < FALL_MM) {
        return false;
    }
    const int32_t fall = then->reading_mm - now->reading_mm;
    const int32_t way = argus_trail_moved_mm(now, then);
    const int32_t expected = now->reading_mm + fall * argus_trail_moved_mm(now, before) / way;
    const bool in_line = before == then || argus_abs(before->reading_mm - expected) <= UNEVEN_MM;
    return in_line &&
           now->reading_mm <= beyond_mm(sonar) + (ahead_mm(sonar) + stop_mm) * fall / way + APART_MM;
}
