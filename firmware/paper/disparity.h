// SPDX-License-Identifier: MIT
// The tolerance range and Algorithm 1 for one sonar (paper: Fig. 7, Table II).
#ifndef ARGUS_DISPARITY_H
#define ARGUS_DISPARITY_H

#include "knowledge/knowledge.h"

// Tolerance range, mm, rounded to nearest, of a reading a1 in 0..65535 (paper: eq. 1 and 2; for the P3-DX a2
// = 167 mm and 20 degrees).
int32_t argus_tolerance_mm(const argus_robot_t *robot, int32_t reading_mm);

typedef enum {
    ARGUS_NO_VERDICT, // no usable neighbour, or the neighbours disagree
    ARGUS_AGREES,
    ARGUS_DISPARATE
} argus_verdict_t;

// Algorithm 1 for one forward-facing sonar on the present readings; `difference_mm` is r(neighbour) -
// r(sonar). paper: the listing lacks the absolute value on the neighbours' difference and reuses the previous
// difference where they disagree; here that sonar yields no verdict.
argus_verdict_t argus_disparity(const argus_knowledge_t *knowledge, int sonar, int32_t *difference_mm);

#endif
