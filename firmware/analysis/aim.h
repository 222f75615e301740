// SPDX-License-Identifier: MIT
// Where a silent sonar would look along what another one lately heard.
#ifndef ARGUS_AIM_H
#define ARGUS_AIM_H

#include "awareness/facts.h"

// The heading on which a sonar that hears nothing looks where another one lately heard something near, from
// the same place. There its readings show whether it is deaf. False: there is none where it has not looked.
// Cost: one pass over the pings of the others.
bool argus_aim(const argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar,
               int32_t *heading_cdeg);

#endif
