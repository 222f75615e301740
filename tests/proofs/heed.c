// SPDX-License-Identifier: MIT
// A robot that is faster than it was ordered and does not slow down is found after 3 SIPs and the delay.
// Bounds: begun anew, speeds of 0 to 4,000, a link that is up to 400 ms late: 8 SIPs
// Sources: firmware/guardian/heed.c
// Unwind: 10
// Ci: yes
// Mutant: firmware/guardian/heed.c | self->sips <= waits && | self->sips != waits &&
#include "proof.h"

#include "guardian/heed.h"

void proof(void) {
    argus_heed_t heed = {0};
    const int32_t given = any_between(0, 4000);
    const int32_t seen = any_between(0, 4000);
    const int32_t late_ms = any_between(0, 400);
    ASSUME(seen > given + given / 8 + 40);
    bool again = false;
    int32_t sips = 0;
    for (; sips < 8 && !again; sips++) {
        again = argus_heed_sip(&heed, given, seen, 40, 10, late_ms);
    }
    PROVE(again && sips == 4 + late_ms / 100, "after so many");
    PROVE(!argus_heed_sip(&heed, given, given, 40, 10, late_ms), "and no longer once it obeys");
}
