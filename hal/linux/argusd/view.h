// SPDX-License-Identifier: MIT
// One picture of robot, manager and link: what status lines and the screen show.
#ifndef ARGUSD_VIEW_H
#define ARGUSD_VIEW_H

#include "argus/argus.h"
#include "hal/isotp.h"
#include "hal/link.h"

#define VIEW_LINK_MAX 96

// Holds no pointer of its own that outlives a process: the screen is another process.
typedef struct {
    uint64_t t_ms; // since argusd began
    argus_status_t status;
    char name[ARGUS_NAME_MAX];
    char robot_class[ARGUS_NAME_MAX];
    char subclass[ARGUS_NAME_MAX];
    char link[VIEW_LINK_MAX];
    bool link_up;
    hal_link_counters_t counters;
    uint32_t reopened;
    bool has_can; // the link or the telemetry is on a CAN bus
    uint32_t can_errors[HAL_ISOTP_ERRORS];
    uint32_t can_sent;              // telemetry frames
    uint32_t can_taken;             // orders
    uint32_t can_refused;           // ...
    uint8_t sonar;                  // the one that the operator has chosen
    uint32_t course_mm;             // straight line from the start to the goal, 0 without a course
    bool controlled;                // a client at the control socket has control
    uint8_t injected[ARGUS_SONARS]; // argus_fault_kind_t that argusd itself makes, 0: none
    bool inject;                    // it may
    bool silent;                    // nothing new has come for so long that all of this is of earlier
} view_t;

#endif
