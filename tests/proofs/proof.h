// SPDX-License-Identifier: MIT
// What all proofs share: values that may be anything, assumptions, and claims. For CBMC alone.
#ifndef ARGUS_PROOF_H
#define ARGUS_PROOF_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Any value at all: CBMC knows these names by their form, and no program defines them.
bool nondet_bool(void);
uint8_t nondet_u8(void);
uint16_t nondet_u16(void);
uint32_t nondet_u32(void);
int32_t nondet_i32(void);
size_t nondet_size(void);

void __CPROVER_assume(_Bool condition);
void __CPROVER_assert(_Bool condition, const char *text);

#define ASSUME(condition) __CPROVER_assume(condition)
#define PROVE(condition, text) __CPROVER_assert((condition), (text))

// From `least` to `most`.
static inline int32_t any_between(const int32_t least, const int32_t most) {
    const int32_t value = nondet_i32();
    ASSUME(value >= least && value <= most);
    return value;
}

#endif
