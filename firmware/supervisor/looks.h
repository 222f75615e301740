// SPDX-License-Identifier: MIT
// Which sonars are worth a look, and what the looks have shown (profile argus).
#ifndef ARGUS_LOOKS_H
#define ARGUS_LOOKS_H

#include "awareness/finding.h"
#include "supervisor/core.h"

// Sonars in use that the evidence suspects.
argus_mask_t argus_doubted(const argus_t *self);

// Once a SIP while it drives: what doubt costs.
void argus_count_loss(const argus_t *self, argus_looks_t *mine);

// A look costs less than to go on without, or an operator has asked for it; and there is room to turn.
bool argus_look_pays(const argus_t *self);

// Where no sonar ahead has heard an echo and others have: those that a look is to try, once in a session; 0:
// no look.
argus_mask_t argus_to_try(const argus_t *self);

// At the goal: what is named and open is settled there, where a look costs no way. 0: nothing, or no room to
// turn.
argus_mask_t argus_to_settle(const argus_t *self);

// The kind that the evidence gives it (NONE: none): `wrong` where a law of its readings was named and given
// up.
argus_fault_kind_t argus_named_kind(const argus_t *self, int sonar, const argus_finding_t *finding);

// The looks are over: each sonar that was asked is cleared, given up or left open.
void argus_conclude_looks(argus_t *self);

// They are not to be looked at in this place, and covered for like those that are out.
void argus_leave_open(const argus_knowledge_t *knowledge, argus_algorithm1_t *algorithm1,
                      argus_events_t *events, argus_mask_t sonars);

// What is remembered of looks; looks.c is its only writer ---------------------------------------------------

#endif
