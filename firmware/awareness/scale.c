// SPDX-License-Identifier: MIT
// Holds the ranges along the way against the odometry, and finds an array that is off as a whole.
#include "awareness/scale.h"

#include "awareness/crosscheck.h"
#include "awareness/numbers.h"
#include "knowledge/angle.h"

static bool is_sure(const argus_ping_t *const ping) {
    return ping->reading_mm > ARGUS_NEAREST_MM && ping->reading_mm < ARGUS_SURE_MM;
}

// Else it is of another thing, or no measure: in a turn, or aside.
static bool goes_on(const argus_ping_t *const now, const argus_ping_t *const before,
                    argus_shift_t *const shift) {
    if (!is_sure(now) || !is_sure(before) || argus_ping_turned_cdeg(now, before) > ARGUS_STILL_CDEG) {
        return false;
    }
    *shift = argus_ping_shift(now, before);
    const int32_t way_mm = argus_abs(shift->along_mm);
    const int32_t off_mm = argus_abs(now->reading_mm - (before->reading_mm - shift->along_mm));
    return shift->lateral_mm * ARGUS_SCALE_ASIDE <= way_mm + ARGUS_STILL_MM &&
           off_mm <= ARGUS_AGREE_MM + way_mm * 2 / 5;
}

static void begin_stretch(argus_scale_t *const self) {
    self->way_mm = 0;
    self->nearer_mm = 0;
}

static void measure(argus_scale_t *const self) {
    const int32_t fits_mm = argus_abs(self->way_mm) * ARGUS_SCALE_FITS_PERCENT / 100;
    const int32_t more_mm = argus_abs(self->nearer_mm) - argus_abs(self->way_mm);
    const bool fits = argus_abs(more_mm) <= fits_mm;
    self->off = !fits && self->more == (more_mm > 0) ? argus_one_more(self->off) : (uint8_t)!fits;
    self->more = more_mm > 0;
    self->keeps = fits;
}

// Two that are off beside others of their array that contradict them are two; where none of it does, it is
// the array.
static argus_mask_t off_of(const argus_evidence_t *const self, const argus_mask_t array) {
    unsigned off = 0;
    unsigned against = 0;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        if ((array >> i & 1u) != 0 && self->of[i].scale.off >= ARGUS_SCALE_OFF_RUN) {
            off |= 1u << i;
            against |= self->of[i].against;
        }
    }
    const bool whole = argus_count_bits(off) >= ARGUS_SCALE_LEAST_OFF && (against & array) == 0;
    return (argus_mask_t)(whole ? array : off);
}

// Where no other array keeps to the way, the odometry may be what is off.
static bool another_keeps(const argus_evidence_t *const self, const argus_mask_t array) {
    bool keeps = false;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        keeps = keeps || ((array >> i & 1u) == 0 && self->of[i].scale.keeps);
    }
    return keeps;
}

static void doubt(argus_evidence_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    unsigned off = 0;
    for (int array = 0; array < knowledge->robot->arrays; array++) {
        const argus_mask_t its = argus_robot_array(knowledge->robot, array);
        off |= another_keeps(self, its) ? off_of(self, its) : 0u;
    }
    const unsigned news = off & ~(unsigned)self->off_scale;
    self->off_scale = (argus_mask_t)off;
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((news >> i & 1u) != 0) {
            argus_crosscheck_retract(self, i);
        }
    }
}

void argus_scale_take(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                      const argus_ping_t *const now) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_scale_t *const scale = &self->of[sonar].scale;
    const argus_ping_t *const before = argus_pings_at(&self->pings[sonar], 1);
    argus_shift_t shift;
    if (before == NULL) {
        return;
    }
    if (!goes_on(now, before, &shift)) {
        begin_stretch(scale);
        return;
    }
    scale->way_mm = (int16_t)(scale->way_mm + shift.along_mm);
    scale->nearer_mm = (int16_t)(scale->nearer_mm + before->reading_mm - now->reading_mm);
    if (argus_abs(scale->way_mm) >= ARGUS_STRETCH_MM) {
        measure(scale);
        doubt(self, knowledge);
        begin_stretch(scale);
    }
}
