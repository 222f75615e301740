// SPDX-License-Identifier: MIT
// Two directions are at most half a turn apart, either way round as far, and 0 only where they are one.
// Bounds: each pair of directions, -18000 < a <= 18000
// Unwind: 1
// Ci: yes
// Mutant: firmware/knowledge/angle.h | argus_abs(argus_angle_wrap(argus_angle_wrap(a_cdeg) - argus_angle_wrap(b_cdeg))) | argus_abs(argus_angle_wrap(a_cdeg) - argus_angle_wrap(b_cdeg))
#include "proof.h"

#include "knowledge/angle.h"

void proof(void) {
    const int32_t a = any_between(1 - ARGUS_HALF_TURN_CDEG, ARGUS_HALF_TURN_CDEG);
    const int32_t b = any_between(1 - ARGUS_HALF_TURN_CDEG, ARGUS_HALF_TURN_CDEG);
    const int32_t apart = argus_angle_abs_diff(a, b);
    const int32_t plain = a < b ? b - a : a - b;
    PROVE(apart >= 0 && apart <= ARGUS_HALF_TURN_CDEG, "at most half a turn apart");
    PROVE(apart == plain || apart == ARGUS_TURN_CDEG - plain, "one way round or the other");
    PROVE((apart == 0) == (a == b), "0 where they are one");
}
