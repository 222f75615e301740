// SPDX-License-Identifier: MIT
// The sweep through the plan's rotations (paper: Fig. 10).
#ifndef ARGUS_DRIVE_H
#define ARGUS_DRIVE_H

#include "adjustment/plan.h"
#include "knowledge/knowledge.h"

// Walks the rotations of a plan. Like the verification it only says which heading it wants.
typedef struct {
    uint8_t index;       // rotation at work
    argus_mask_t covers; // the disabled sonars that its plan is for
    argus_mask_t looks;  // ... and those that may look along their bearings
    bool home;           // on the way back to the base heading
    bool done;           // back on it, all rotations read
    int32_t base_cdeg;
    uint16_t smallest_mm; // smallest compensating reading so far
    int8_t smallest_of;   // the disabled sonar that it was seen for
    uint8_t smallest_at;  // rotation index
} argus_drive_t;

void argus_sweep_begin(argus_drive_t *self, const argus_plan_t *plan, int32_t base_cdeg);

// S1: the plan is no longer the one that the sweep began with, nor are the bearings to see or those that
// look.
bool argus_sweep_is_outdated(const argus_drive_t *self, const argus_plan_t *plan);

// The sonars that count where the sweep is: those of the rotation at work, none on the way home.
argus_mask_t argus_sweep_wants(const argus_drive_t *self, const argus_plan_t *plan,
                               const argus_robot_t *robot);

int32_t argus_sweep_heading_cdeg(const argus_drive_t *self, const argus_plan_t *plan);

// Call on each SIP while settled on that heading since `mark`. True when the wanted heading changed or it is
// done.
bool argus_sweep_step(argus_drive_t *self, const argus_plan_t *plan, const argus_knowledge_t *knowledge,
                      const argus_mark_t *mark);

#endif
