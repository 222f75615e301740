// SPDX-License-Identifier: MIT
// Holds the speed of the wheels against the last SETV.
#include "adjustment/pace.h"

#include <string.h>

#include "arcos/gen_arcos.h"
#include "knowledge/angle.h"

#define SIPS 3  // in a row: one may say anything
#define SHARE 8 // an eighth more is how a robot keeps a speed
#define SPARE_MM_S 40

void argus_pace_init(argus_pace_t *const self) {
    memset(self, 0, sizeof *self);
}

bool argus_pace_sip(argus_pace_t *const self, const argus_knowledge_t *const knowledge,
                    const int32_t set_mm_s) {
    ARGUS_ASSERT(set_mm_s >= 0);
    const int32_t speed_mm_s = argus_abs(knowledge->vel_left_mm_s + knowledge->vel_right_mm_s) / 2;
    if (set_mm_s == 0) {
        self->may_mm_s = speed_mm_s;
        self->sips = 0;
        return false;
    }
    const int32_t brakes_mm_s = knowledge->robot->decel_mm_s2 * ARCOS_TIMING_SIP_CYCLE_MS / 1000;
    self->may_mm_s = argus_max(set_mm_s, self->may_mm_s - brakes_mm_s);
    const bool beyond = speed_mm_s > self->may_mm_s + self->may_mm_s / SHARE + SPARE_MM_S;
    self->sips = (uint8_t)(beyond ? argus_min(self->sips + 1, SIPS + 1) : 0);
    if (self->sips >= SIPS) {
        self->seen_mm_s = argus_max(self->seen_mm_s, speed_mm_s);
    }
    return self->sips == SIPS;
}
