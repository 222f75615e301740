// SPDX-License-Identifier: MIT
// Which sonars are worth a look (profile argus).
#ifndef ARGUS_LOOKS_H
#define ARGUS_LOOKS_H

#include "awareness/finding.h"
#include "behaviour/core.h"

// Sonars in use that the evidence suspects.
argus_mask_t argus_doubted(const argus_t *self);

// Once a SIP while it drives: what doubt costs.
void argus_count_loss(const argus_t *self, argus_looks_t *mine);

// A look costs less than to go on without, or an operator has asked for it; and there is room to turn.
bool argus_look_pays(const argus_t *self);

// Where no sonar ahead has heard an echo and others have: those that a look is to try, once in a session; 0:
// no look.
argus_mask_t argus_to_try(const argus_t *self);

// At the goal: what is named and open is settled there, where a look costs no way. 0: nothing.
argus_mask_t argus_to_settle(const argus_t *self);

// The kind that the evidence gives it (NONE: none): `wrong` where a `slow` diagnosis was withdrawn.
argus_fault_kind_t argus_named_kind(const argus_t *self, int sonar, const argus_finding_t *finding);

#endif
