// SPDX-License-Identifier: MIT
// Remembers looks: what they cleared, what they left, and what doubt has cost since.
#include "analysis/looked.h"

#include <string.h>

#include "arcos/gen_arcos.h"
#include "knowledge/angle.h"

#define HOLD_MM 400u         // a cleared sonar is not looked at again before this distance,
#define HOLD_DOUBLINGS 2     // ... doubled each time it is cleared, so often
#define HOLD_FORGET_MM 4000u // ... and forgotten after this one
#define LOOK_COST_MS 9000u   // what a look takes: two turns aside, the way back, two rounds of readings each
#define PROOFS 3             // looks in a row that leave a sonar its name
#define NAME_STANDS_MS 1000u // three rounds, before a name is said: many for a healthy sonar pass sooner

void argus_looks_init(argus_looks_t *const self) {
    memset(self, 0, sizeof *self);
}

void argus_looks_open(argus_looks_t *const self) {
    self->tried = false;
    self->unheard_said = false;
}

void argus_looks_checked(argus_looks_t *const self, const uint32_t now_ms) {
    self->check_ms = now_ms;
}

void argus_looks_leave(argus_looks_t *const self) {
    self->settling = 0;
}

void argus_looks_begin(argus_looks_t *const self, const bool arriving) {
    self->settling = (uint8_t)(arriving ? self->settling + 1 : 0);
}

void argus_looks_tried(argus_looks_t *const self) {
    self->tried = true;
}

bool argus_looks_unheard(argus_looks_t *const self) {
    const bool is_new = !self->unheard_said;
    self->unheard_said = true;
    return is_new;
}

void argus_looks_ask(argus_looks_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    self->hold[sonar].cleared = 0;
    self->asked = true;
}

bool argus_looks_stands(argus_looks_t *const self, const int sonar, const argus_fault_kind_t kind,
                        const uint32_t now_ms) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT((unsigned)kind < ARGUS_KINDS);
    argus_naming_t *const naming = &self->naming[sonar];
    if (naming->named != kind) {
        naming->named = (uint8_t)kind;
        naming->since_ms = now_ms;
    }
    return kind != ARGUS_KIND_NONE && now_ms - naming->since_ms >= NAME_STANDS_MS;
}

void argus_looks_rename(argus_looks_t *const self, const int sonar, const argus_fault_kind_t from,
                        const argus_fault_kind_t to) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    self->hold[sonar].slow_withdrawn |= from == ARGUS_KIND_SLOW && to == ARGUS_KIND_WRONG;
}

void argus_looks_forget(argus_looks_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    self->hold[sonar].confirmed = 0;
    self->hold[sonar].slow_withdrawn = false;
}

void argus_looks_free(argus_looks_t *const self) {
    self->lost_ms = 0;
}

void argus_looks_lose(argus_looks_t *const self, const int32_t lost_mm_s, const int32_t free_mm_s) {
    ARGUS_ASSERT(free_mm_s > 0 && lost_mm_s >= 0);
    self->lost_ms += ARCOS_TIMING_SIP_CYCLE_MS * (uint32_t)lost_mm_s / (uint32_t)free_mm_s;
}

bool argus_looks_cost(const argus_looks_t *const self) {
    return self->lost_ms >= LOOK_COST_MS;
}

void argus_looks_clear(argus_looks_t *const self, const argus_knowledge_t *const knowledge, const int sonar) {
    ARGUS_ASSERT(!argus_is_out(knowledge, sonar));
    argus_hold_t *const hold = &self->hold[sonar];
    if (knowledge->odometer_mm - hold->odometer_mm > HOLD_FORGET_MM) {
        hold->cleared = 0;
    }
    argus_looks_forget(self, sonar);
    hold->cleared = argus_one_more(hold->cleared);
    hold->odometer_mm = knowledge->odometer_mm;
}

bool argus_looks_hold(const argus_looks_t *const self, const int sonar, const uint32_t odometer_mm) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_hold_t *const hold = &self->hold[sonar];
    const int32_t doublings = argus_min(hold->cleared - 1, HOLD_DOUBLINGS);
    return hold->cleared > 0 && odometer_mm - hold->odometer_mm < HOLD_MM
                                                                      << (unsigned)argus_max(0, doublings);
}

bool argus_looks_prove(argus_looks_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_hold_t *const hold = &self->hold[sonar];
    hold->confirmed = (uint8_t)argus_min(hold->confirmed + 1, PROOFS);
    return hold->confirmed >= (self->settling > 0 ? ARGUS_LOOKS_PROOFS_AT_GOAL : PROOFS);
}

void argus_looks_over(argus_looks_t *const self) {
    self->asked = false;
    self->lost_ms = 0;
}
