// SPDX-License-Identifier: MIT
// Any angle is reduced to -18000 < a <= 18000 without overflow, and one that lies there stays as it is.
// Bounds: each of the 2^32 angles; that it stays the same direction is angle_wrap's, and of all in test_angle.c
// Unwind: 1
// Ci: yes
// Mutant: firmware/knowledge/angle.h | if (rest > ARGUS_HALF_TURN_CDEG) { | if (rest > ARGUS_HALF_TURN_CDEG + 1) {
// Mutant: firmware/knowledge/angle.h | rest <= -ARGUS_HALF_TURN_CDEG ? | rest <= ARGUS_HALF_TURN_CDEG ?
#include "proof.h"

#include "knowledge/angle.h"

void proof(void) {
    const int32_t angle = nondet_i32();
    const int32_t wrapped = argus_angle_wrap(angle);
    const bool within = angle > -ARGUS_HALF_TURN_CDEG && angle <= ARGUS_HALF_TURN_CDEG;
    PROVE(wrapped > -ARGUS_HALF_TURN_CDEG && wrapped <= ARGUS_HALF_TURN_CDEG, "half a turn to either side");
    PROVE(!within || wrapped == angle, "what lies there stays");
}
