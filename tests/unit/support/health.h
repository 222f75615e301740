// SPDX-License-Identifier: MIT
// Puts a sonar into any state of health without asking whether that may follow the one before.
#ifndef TEST_HEALTH_H
#define TEST_HEALTH_H

#include "knowledge/knowledge.h"

// Entered at `now_ms`. A failure counts as in the fault manager: once for each entry into DISABLED.
void put_health(argus_sonar_t *sonar, argus_health_t health, argus_fault_kind_t kind, uint32_t now_ms);

#endif
