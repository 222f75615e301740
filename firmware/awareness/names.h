// SPDX-License-Identifier: MIT
// What the tests and hypotheses of a sonar amount to: a suspicion, a name, a conviction.
#ifndef ARGUS_NAMES_H
#define ARGUS_NAMES_H

#include "awareness/facts.h"

bool argus_names_suspects(const argus_evidence_t *self, int sonar);

// The kind that its evidence names, or convicts of; NONE: not so far. A name takes disagreements with two
// others, or what its own readings tell; a conviction takes them again at other times.
argus_fault_kind_t argus_names_found(const argus_evidence_t *self, int sonar);
argus_fault_kind_t argus_names_convicts(const argus_evidence_t *self, int sonar);

// The fault that explains it best so far, and how far its evidence is to a conviction: 0 to 100 percent.
argus_fault_kind_t argus_names_best(const argus_evidence_t *self, int sonar, uint8_t *percent);

#endif
