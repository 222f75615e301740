// SPDX-License-Identifier: MIT
// Algorithm 1: disparate readings in a row make a suspect (paper: Table II).
#ifndef ARGUS_ALGORITHM1_H
#define ARGUS_ALGORITHM1_H

#include "argus/argus.h"
#include "knowledge/knowledge.h"
#include "paper/disparity.h"

// Per forward-facing sonar: how often in a row it was disparate, and the hold-off after it was cleared.
typedef struct {
    uint8_t in_a_row;
    uint32_t counted_ms; // when a reading was counted last
    int32_t difference_mm;
    bool held;
    uint32_t held_odometer_mm;
    int32_t held_heading_cdeg;
    int32_t held_difference_mm;
} argus_disparate_t;

typedef struct {
    argus_mask_t verified; // sonars verified since the robot last drove: not again in this place
    argus_disparate_t of[ARGUS_SONARS];
} argus_algorithm1_t;

void argus_algorithm1_init(argus_algorithm1_t *self);

// After each SIP: counts the disparities of those that face forward. `away`: turned away to look, what is
// read there is no verdict on the sonars' own bearings.
void argus_algorithm1_sip(argus_algorithm1_t *self, const argus_knowledge_t *knowledge, bool away);

// Sonars that Algorithm 1 now calls suspects: suspect_readings in a row, not held off, not verified in this
// place.
argus_mask_t argus_algorithm1_suspects(argus_algorithm1_t *self, const argus_knowledge_t *knowledge,
                                       const argus_config_t *config);

// Algorithm 2 cleared the sonar; its disparity at rest was `difference_mm`: hold off.
void argus_algorithm1_cleared(argus_algorithm1_t *self, const argus_knowledge_t *knowledge, int sonar,
                              int32_t difference_mm);

// It is no longer disparate at rest. / It is verified in this place, whatever came of it. / Those of a mask
// are to be verified again.
void argus_algorithm1_dropped(argus_algorithm1_t *self, int sonar);
void argus_algorithm1_settle(argus_algorithm1_t *self, int sonar);
void argus_algorithm1_reopen(argus_algorithm1_t *self, argus_mask_t sonars);

// The robot stands somewhere new: of those verified only `kept` still are. / The readings begin anew.
void argus_algorithm1_moved(argus_algorithm1_t *self, argus_mask_t kept);
void argus_algorithm1_restart(argus_algorithm1_t *self);

#endif
