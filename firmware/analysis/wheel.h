// SPDX-License-Identifier: MIT
// Which wheel turns less than it should, and by how much, from pieces of way that bend.
#ifndef ARGUS_WHEEL_H
#define ARGUS_WHEEL_H

#include "knowledge/knowledge.h"

#define ARGUS_WHEEL_MOST_PM 150 // a wheel that is shorter is no matter of alignment

// The health record of the drive. short_pm: permille by which a wheel, of the robot as it is built, falls
// short. It is positive for the left one, negative for the right one, and 0 where neither does or it is not
// known.
typedef struct {
    argus_health_t health; // UNKNOWN, HEALTHY, SUSPECT: a piece bends; kind WRONG: named
    argus_fault_kind_t kind;
    int16_t short_pm;
    argus_way_turn_t last; // piece
    uint32_t odometer_mm;  // when it was measured last
} argus_wheel_t;

typedef enum { ARGUS_WHEEL_SAME, ARGUS_WHEEL_NAMED, ARGUS_WHEEL_CLEARED } argus_wheel_news_t;

// Takes a piece of straight way. Two pieces in a row that bend alike name a wheel, two straight ones clear
// it.
argus_wheel_news_t argus_wheel_judge(argus_wheel_t *self, const argus_knowledge_t *knowledge,
                                     const argus_way_turn_t *piece);

#endif
