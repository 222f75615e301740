// SPDX-License-Identifier: MIT
// What a guard port gives of a wanted speed is never more than its bound, nor than was wanted, nor the other
// way.
// Bounds: each bound of 0 to 32,767 mm/s, each speed wanted and each given before, 15 bits and a sign
// Unwind: 3
// Ci: yes
// Mutant: firmware/guardian/hold.c | given <= most_mm_s && given > speed ? given : speed | given > speed ? given : speed
// Mutant: firmware/guardian/hold.c | return wanted_mm_s < 0 ? -speed : speed; | return given_mm_s < 0 ? -speed : speed;
#include "proof.h"

#include "guardian/hold.c"

void proof(void) {
    const argus_bound_t bound = {.speed_mm_s = any_between(0, 32767)};
    const int32_t wanted = any_between(-32767, 32767);
    const int32_t given = any_between(-32767, 32767);
    const int32_t mm_s = bounded(&bound, wanted, given);
    PROVE(argus_abs(mm_s) <= bound.speed_mm_s, "no more than the bound");
    PROVE(argus_abs(mm_s) <= argus_abs(wanted), "no more than wanted");
    PROVE(wanted < 0 ? mm_s <= 0 : mm_s >= 0, "the way that is wanted");
    PROVE(bound.speed_mm_s < argus_abs(wanted) || mm_s == wanted, "all of it where the bound lets");
}
