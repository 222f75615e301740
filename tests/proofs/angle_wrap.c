// SPDX-License-Identifier: MIT
// An angle of up to five turns is reduced to -18000 < a <= 18000, and stays the same direction.
// Bounds: each angle up to 180,000 hundredths to either side; all 2^32 are tested one by one, in test_angle.c
// Unwind: 1
// Ci: yes
// Mutant: firmware/knowledge/angle.h | rest <= -ARGUS_HALF_TURN_CDEG ? | rest < -ARGUS_HALF_TURN_CDEG ?
#include "proof.h"

#include "knowledge/angle.h"

#define TURNS 5

void proof(void) {
    const int32_t direction = any_between(1 - ARGUS_HALF_TURN_CDEG, ARGUS_HALF_TURN_CDEG);
    const int32_t turns = any_between(-TURNS, TURNS);
    const int32_t wrapped = argus_angle_wrap(direction + turns * ARGUS_TURN_CDEG);
    PROVE(wrapped == direction, "the same direction");
}
