// SPDX-License-Identifier: MIT
// What is known of one sonar: its last reading, its health, its history.
#ifndef ARGUS_SONAR_H
#define ARGUS_SONAR_H

#include "argus/argus.h"

typedef struct {
    uint16_t reading_mm;
    bool reported;
    bool steady;          // taken while the robot did not rotate
    uint32_t sip;         // index of the SIP that listed it last
    uint32_t heard_ms;    // time of that SIP
    uint32_t odometer_mm; // way driven by then
    uint32_t readings;    // monotonic
    argus_health_t health;
    argus_fault_kind_t kind;
    uint32_t since_ms;        // entry into `health`
    uint16_t disabled_times;  // this mission
    uint16_t disabled_before; // earlier missions, from the record
    argus_fault_kind_t kind_before;
    uint8_t relapses; // disabled again, less missions without a fault
} argus_sonar_t;

#endif
