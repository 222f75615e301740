// SPDX-License-Identifier: MIT
// The SIP of a robot (report.py) in C.
#ifndef ARGUS_SIM_REPORT_H
#define ARGUS_SIM_REPORT_H

#include "tick.h"

enum { FRAME_MAX = 260 };

// What of tables and session a SIP asks for; flags: without those of the motors.
typedef struct {
    double unit_mm, idle_w, sonar_w, wheel_j_m, full_v, empty_v, capacity_j, internal_ohm;
    int32_t turn, flags, motors, still, moving, digout;
} report_t;

// Writes the packet and takes readings and stalls; returns its length.
int32_t argus_sim_sip(const parts_t *parts, const report_t *report, uint8_t *packet);
uint32_t argus_sim_checksum(const uint8_t *data, int32_t length);

#endif
