// SPDX-License-Identifier: MIT
// The root of any number is the greatest whole one whose square is no more.
// Bounds: each number up to 65,535; larger ones are tested at both edges of all 65,536 roots, in test_angle.c
// Sources: firmware/knowledge/angle.c
// Unwind: 18
// Ci: yes
// Mutant: firmware/knowledge/angle.c | if (rest >= root + bit) { | if (rest > root + bit) {
#include "proof.h"

#include "knowledge/angle.h"

void proof(void) {
    const uint32_t value = nondet_u16();
    const uint32_t root = argus_sqrt(value);
    PROVE(root <= 255 && root * root <= value && (root + 1) * (root + 1) > value, "the floor of its root");
}
