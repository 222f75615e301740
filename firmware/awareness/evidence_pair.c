// SPDX-License-Identifier: MIT
// Two readings on one bearing, from one place or nearly: how far apart they were made, and what they say of
// each other.
#include "awareness/evidence_internal.h"
#include "knowledge/angle.h"

#define NEAREST_MM 150
#define AGREE_MM 80
#define AGREE_PERCENT 5

argus_shift_t argus_pair_shift(const int32_t dx_mm, const int32_t dy_mm, const int32_t bearing_cdeg) {
    const int32_t c = argus_cos(bearing_cdeg);
    const int32_t s = argus_sin(bearing_cdeg);
    const argus_shift_t shift = {.along_mm = (dx_mm * c + dy_mm * s) / ARGUS_TRIG_ONE,
                                 .lateral_mm = argus_abs(dy_mm * c - dx_mm * s) / ARGUS_TRIG_ONE};
    return shift;
}

int32_t argus_pair_limit_mm(const int32_t range_mm) {
    return AGREE_MM + range_mm * AGREE_PERCENT / 100;
}

// Where the echo that one of the two heard would be for the other.
static int32_t heard_at_mm(const int32_t now_mm, const int32_t then_mm, const int32_t along_mm) {
    return then_mm >= ARGUS_NO_ECHO_MM ? now_mm + along_mm : then_mm - along_mm;
}

static argus_outcome_t compare_silence(const int32_t now_mm, const int32_t then_mm, const int32_t along_mm) {
    const bool none = now_mm >= ARGUS_NO_ECHO_MM;
    if (none && then_mm >= ARGUS_NO_ECHO_MM) {
        return ARGUS_PAIR_QUIET;
    }
    const int32_t expected = heard_at_mm(now_mm, then_mm, along_mm);
    if (expected < NEAREST_MM || expected > ARGUS_PAIR_FARTHEST_MM) {
        return ARGUS_PAIR_NOTHING;
    }
    return none ? ARGUS_PAIR_NOW_MISSES : ARGUS_PAIR_THEN_MISSES;
}

argus_outcome_t argus_pair_compare(const int32_t now_mm, const int32_t then_mm, const int32_t along_mm) {
    if (now_mm >= ARGUS_NO_ECHO_MM || then_mm >= ARGUS_NO_ECHO_MM) {
        return compare_silence(now_mm, then_mm, along_mm);
    }
    const int32_t expected = then_mm - along_mm;
    if (expected < NEAREST_MM) {
        return ARGUS_PAIR_NOTHING;
    }
    const int32_t limit = argus_pair_limit_mm(argus_min(expected, now_mm));
    return argus_abs(expected - now_mm) <= limit ? ARGUS_PAIR_AGREE : ARGUS_PAIR_DIFFER;
}

bool argus_pair_is_faint(const int32_t now_mm, const int32_t then_mm, const int32_t along_mm) {
    const bool one_misses = (now_mm >= ARGUS_NO_ECHO_MM) != (then_mm >= ARGUS_NO_ECHO_MM);
    return one_misses && heard_at_mm(now_mm, then_mm, along_mm) > ARGUS_PAIR_SURE_MM;
}
