// SPDX-License-Identifier: MIT
// How far a robot turns until it stands is worked out without overflow for any turn a client may ask for, and
// is bounded.
// Bounds: each speed that RVEL can name, 15 bits and a sign, and more: 31 bits
// Unwind: 3
// Ci: yes
// Mutant: firmware/guardian/hold.c | argus_within(ARGUS_CLIENT_TURN_DEG_S, deg_s); | deg_s;
#include "proof.h"

#include "guardian/hold.c"

void proof(void) {
    const int32_t deg_s = any_between(-INT32_MAX, INT32_MAX);
    const int32_t ahead_cdeg = until_rest_cdeg(deg_s);
    PROVE(ahead_cdeg >= -10000 && ahead_cdeg <= 10000, "no more than 100 degrees");
    PROVE(deg_s < 0 ? ahead_cdeg <= 0 : ahead_cdeg >= 0, "the way that it turns");
    const int32_t looked = widened(ahead_cdeg, LEAST_CDEG);
    PROVE(looked >= LEAST_CDEG || looked <= -LEAST_CDEG, "at least so far");
}
