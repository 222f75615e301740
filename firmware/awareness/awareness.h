// SPDX-License-Identifier: MIT
// Awareness: dead and silent sonars, bumpers, objects, and Algorithm 1's disparate readings (paper: Table
// II).
#ifndef ARGUS_AWARENESS_H
#define ARGUS_AWARENESS_H

#include "argus/argus.h"
#include "awareness/disparity.h"
#include "knowledge/knowledge.h"

// What one SIP (or the clock) shows.
typedef struct {
    argus_mask_t dead;   // no echo on a forward-facing sonar not DISABLED
    argus_mask_t silent; // no reading for stale_ms on a forward-facing sonar not DISABLED
    argus_mask_t object; // at or below the object range, looking along the motion, not DISABLED
    int8_t object_sonar; // nearest of them
    uint16_t object_mm;
    bool bumper;
    bool stall;
} argus_alarm_t;

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
    bool away; // turned away to look: what is read there is no verdict on the sonars' own bearings
    argus_mask_t verified; // sonars verified since the robot last drove: not again in this place
    argus_disparate_t of[ARGUS_SONARS];
} argus_awareness_t;

void argus_awareness_init(argus_awareness_t *self);

// After each SIP: counts disparities and returns the alarms.
argus_alarm_t argus_awareness_sip(argus_awareness_t *self, const argus_knowledge_t *knowledge,
                                  const argus_config_t *config);

// Sonars that Algorithm 1 now calls suspects: suspect_readings in a row, not held off, not verified in this
// place.
argus_mask_t argus_suspects(argus_awareness_t *self, const argus_knowledge_t *knowledge,
                            const argus_config_t *config);

// Algorithm 2 cleared the sonar; its disparity at rest was `difference_mm`: hold off. / The robot stands
// somewhere new. / The readings begin anew.
void argus_awareness_cleared(argus_awareness_t *self, const argus_knowledge_t *knowledge, int sonar,
                             int32_t difference_mm);
void argus_awareness_moved(argus_awareness_t *self);
void argus_awareness_restart(argus_awareness_t *self);

#endif
