// SPDX-License-Identifier: MIT
// What a laser's scan shows in each sector, and what of it a sonar must hear.
#ifndef ARGUS_SCAN_H
#define ARGUS_SCAN_H

#include <stdbool.h>

#include "knowledge/knowledge.h"

// EDGE: what stands out, or ends, somewhere in the sector.
typedef enum { ARGUS_SHAPE_NONE, ARGUS_SHAPE_EDGE, ARGUS_SHAPE_WALL } argus_shape_t;

// What the last scan shows in a sector of a laser. Of a wall: how far its foot, its nearest point, lies to
// the left of the sector's axis, hundredths of a degree; 0 of all else.
argus_shape_t argus_scan_shape(const argus_knowledge_t *knowledge, int sector, int32_t *aside_cdeg);

// The nearest of what the last scan returns that a sonar must hear: well within its cone, and seen for what
// it is. How far from the transducer, mm, and its sector; -1: none. What is nearer may lie below the scan.
// Cost: a pass over the sectors.
int argus_scan_heard(const argus_knowledge_t *knowledge, int sonar, int32_t *mm);

#endif
