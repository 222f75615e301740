// SPDX-License-Identifier: MIT
// The sine of any direction is at most 1, and has the sign of its side.
// Bounds: each angle of one turn; against the exact values all are tested one by one, in test_angle.c
// Sources: firmware/knowledge/angle.c
// Unwind: 2
// Ci: yes
// Mutant: firmware/knowledge/angle.c | size > QUARTER ? ARGUS_HALF_TURN_CDEG - size : size | size
// Mutant: firmware/knowledge/angle.c | a < 0 ? -value : value | value
#include "proof.h"

#include "knowledge/angle.h"

void proof(void) {
    const int32_t a = any_between(1 - ARGUS_HALF_TURN_CDEG, ARGUS_HALF_TURN_CDEG);
    const int32_t s = argus_sin(a);
    PROVE(s >= -ARGUS_TRIG_ONE && s <= ARGUS_TRIG_ONE, "at most 1");
    PROVE(a < 0 || s >= 0, "positive to the left");
    PROVE(a > 0 || s <= 0, "negative to the right");
}
