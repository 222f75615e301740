// SPDX-License-Identifier: MIT
// Whatever a client says, and whenever the clock wraps, no more passes than the rate lets, and 10 orders at
// once go out.
// Bounds: any state that its invariant allows, any time, up to 1,000 bytes: an inductive step
// Sources: firmware/guardian/limit.c
// Unwind: 3
// Ci: yes
// Mutant: firmware/guardian/limit.c | passed_ms < LONG_MS ? | passed_ms < LONG_MS * 10000u ?
// Mutant: firmware/guardian/limit.c | self->used + bytes * PARTS > BYTES_MOST * PARTS | self->used > BYTES_MOST * PARTS
#include "proof.h"

#include "guardian/limit.h"

void proof(void) {
    argus_limit_t limit;
    ASSUME(limit.used <= 400000 && limit.orders <= 10 && limit.words <= 5);
    const argus_limit_t before = limit;
    const uint32_t now_ms = nondet_u32();
    const uint16_t bytes = nondet_u16();
    ASSUME(bytes <= 1000);
    const uint32_t passed_ms = now_ms - before.filled_ms;
    const bool passed = argus_limit_pass(&limit, now_ms, bytes);
    PROVE(limit.used <= 400000, "no more than a third of a slow line, and a start");
    PROVE(!passed || limit.used >= bytes * 1000u, "what passes is counted");
    PROVE(passed_ms < 10000 || bytes > 400 || passed, "after 10 s all may pass");
    PROVE(!argus_limit_order(&limit) || limit.orders <= 10, "10 orders");
    PROVE(!argus_limit_word(&limit) || limit.words <= 5, "5 words");
}
