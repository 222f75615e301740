// SPDX-License-Identifier: MIT
// A span of less than 24.8 days is measured exactly, whenever the clock wraps, and a clock that steps back is
// no silence.
// Bounds: none, each pair of the 2^32 values
// Unwind: 1
// Ci: yes
// Mutant: firmware/arcos/arithmetic.h | elapsed < UINT32_C(0x80000000) ? elapsed : 0 | now_ms > then_ms ? elapsed : 0
#include "proof.h"

#include "arcos/arithmetic.h"

void proof(void) {
    const uint32_t then_ms = nondet_u32();
    const uint32_t span_ms = nondet_u32();
    ASSUME(span_ms < 0x80000000u);
    PROVE(argus_elapsed_ms(then_ms + span_ms, then_ms) == span_ms, "as long as it was");
    PROVE(span_ms == 0 || argus_elapsed_ms(then_ms - span_ms, then_ms) == 0, "a step back is none");
    const int32_t most = any_between(0, INT32_MAX);
    const int32_t kept = argus_within(most, nondet_i32());
    PROVE(kept >= -most && kept <= most, "within");
}
