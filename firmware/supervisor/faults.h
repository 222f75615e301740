// SPDX-License-Identifier: MIT
// What follows when the health of a sonar changes: failure state, plan, firing order, what it has said
// before.
#ifndef ARGUS_FAULTS_H
#define ARGUS_FAULTS_H

#include "behaviour/core.h"

void argus_disable(argus_t *self, int sonar, argus_fault_kind_t kind);

// Of these, that do not face forward, those that are STALE report again; the others yield nothing any more.
void argus_watch(argus_knowledge_t *knowledge, argus_events_t *events, argus_mask_t sonars);

void argus_flag_suspects(const argus_t *self, argus_knowledge_t *knowledge, argus_events_t *events,
                         argus_mask_t suspects);

// Failure state and plan for the present fault map.
void argus_replan(argus_t *self);

// After each SIP. A plan is made anew when one of its sonars may be relied on no more. So is one that leaves
// a bearing open which others may look along now. False: no sonar is left to look along a blind bearing.
bool argus_keep_plan(const argus_t *self, argus_plan_t *plan, argus_events_t *events);

// POLLING for the present plan; again in each new session.
void argus_share_slots(const argus_t *self, argus_outbox_t *out, argus_firing_t *firing);

#endif
