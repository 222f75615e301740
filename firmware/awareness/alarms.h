// SPDX-License-Identifier: MIT
// What one SIP shows that calls for a STOP: dead and silent sonars, bumpers, stalls, objects.
#ifndef ARGUS_ALARMS_H
#define ARGUS_ALARMS_H

#include "argus/argus.h"
#include "knowledge/knowledge.h"

typedef struct {
    argus_mask_t dead;   // no echo on a forward-facing sonar not DISABLED
    argus_mask_t silent; // no reading for stale_ms on a forward-facing sonar not DISABLED
    argus_mask_t object; // at or below the object range, looking along the motion, not DISABLED
    int8_t object_sonar; // nearest of them
    uint16_t object_mm;
    bool bumper;
    bool stall;
} argus_alarm_t;

// After each SIP, before the clock goes on. Cost: one pass over the sonars.
argus_alarm_t argus_alarms(const argus_knowledge_t *knowledge, const argus_config_t *config);

#endif
