// SPDX-License-Identifier: MIT
// A wall beside the way: whether the robot slants into one that the sonars ahead do not hear.
#include <stddef.h>

#include "awareness/evidence_internal.h"
#include "knowledge/angle.h"

#define WAY_MM 80 // two readings show a slant when they were made so far apart
#define STRAIGHT_CDEG 300
#define FALL_MM 12   // ... and differ by more than noise
#define UNEVEN_MM 18 // from the line of the two another one differs so much by noise
#define APART_MM 20
#define REFRESH_MM 64 // of the stopping way: from one reading to the next, where all sonars take turns

// At the reading at which its corner would touch, the body goes beyond the sonar's face by these.
static int32_t beyond_mm(const int sonar) {
    return ARGUS_P3DX_BODY_WIDTH_MM / 2 - argus_abs(argus_sonar_pose[sonar].y_mm);
}

// Those mounted in the rear are asked while the rear leads.
static bool is_rear(const int sonar) {
    return argus_sonar_pose[sonar].x_mm < 0;
}

static int32_t ahead_mm(const int sonar) {
    return is_rear(sonar) ? ARGUS_P3DX_BODY_REAR_MM + argus_sonar_pose[sonar].x_mm
                          : ARGUS_P3DX_BODY_FRONT_MM - argus_sonar_pose[sonar].x_mm;
}

// The way ahead, on its own heading, from one reading to a later one.
static int32_t ahead_of_mm(const argus_trail_t *const now, const argus_trail_t *const then, const int sonar) {
    const int32_t dx = argus_trail_offset_mm(now->x_mm, then->x_mm);
    const int32_t dy = argus_trail_offset_mm(now->y_mm, then->y_mm);
    const int32_t along_mm = argus_pair_shift(dx, dy, now->heading_cdeg).along_mm;
    return is_rear(sonar) ? -along_mm : along_mm;
}

// The latest reading on this heading from far enough back that shows a fall; NULL: none.
static const argus_trail_t *slant_since(const argus_case_t *const self, const argus_trail_t *const now,
                                        const int sonar) {
    for (int i = 2; i <= self->trail_count; i++) {
        const argus_trail_t *const then = argus_trail_at(self, i);
        if (argus_trail_turned_cdeg(now, then) > STRAIGHT_CDEG) {
            return NULL;
        }
        if (then->reading_mm <= ARGUS_FLANK_NEAR_MM && then->reading_mm - now->reading_mm >= FALL_MM &&
            ahead_of_mm(now, then, sonar) >= WAY_MM) {
            return then;
        }
    }
    return NULL;
}

static const argus_trail_t *echo_before(const argus_case_t *const self) {
    const argus_trail_t *const before = argus_trail_at(self, 2);
    return before->reading_mm < ARGUS_NO_ECHO_MM ? before : argus_trail_at(self, 3);
}

bool argus_evidence_slants_in(const argus_evidence_t *const self, const int sonar, const int32_t stop_mm) {
    const argus_case_t *const c = &self->of[sonar];
    const argus_trail_t *const now = argus_trail_at(c, 1);
    const argus_trail_t *const then = now != NULL ? slant_since(c, now, sonar) : NULL;
    const argus_trail_t *const before = then != NULL ? echo_before(c) : NULL;
    if (before == NULL) {
        return false;
    }
    const int32_t fall = then->reading_mm - now->reading_mm;
    const int32_t way = ahead_of_mm(now, then, sonar);
    const int32_t step = ahead_of_mm(now, before, sonar);
    const bool in_line = argus_abs(before->reading_mm - now->reading_mm - fall * step / way) <= UNEVEN_MM;
    const int32_t left_mm = ahead_mm(sonar) + stop_mm + argus_max(0, step - REFRESH_MM);
    return in_line && now->reading_mm <= beyond_mm(sonar) + left_mm * fall / way + APART_MM;
}
