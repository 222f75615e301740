// SPDX-License-Identifier: MIT
// Extremes of a reading: the shortest that a robot gives, and what it never gives, judged by what no standing
// thing can do (profile argus).
#ifndef ARGUS_EXTREMES_H
#define ARGUS_EXTREMES_H

#include "knowledge/knowledge.h"

// Of one sonar. The shortest readings are all alike, so the tests of its trail leave them aside. A run is of
// readings so near that they forbid to turn, each like the first.
typedef struct {
    argus_point_t at;   // where the run is looked at from, course frame
    argus_point_t from; // where it began, or where its mate heard the same last
    int32_t from_cdeg;  // heading when it began
    int32_t away_mm;    // way that the transducer has gone from what it reads, since
    uint16_t before_mm;
    uint16_t run_mm; // the reading that began the run
    uint8_t row;     // shortest readings, one after the other
    uint8_t level;   // impossible readings of late, weighed
    uint8_t waits;   // weight of the reading before, until those beside it have fired
    bool visited;    // the reading before leapt near
    bool running;    // the reading before was a shortest one
    bool proved;     // it stayed though the robot went away from it
} argus_extreme_t;

typedef struct {
    argus_extreme_t of[ARGUS_SONARS];
} argus_extremes_t;

void argus_extremes_init(argus_extremes_t *self);

// A session opened, or SIPs come again: what was read before says nothing of the place where the robot is
// now.
void argus_extremes_restart(argus_extremes_t *self);

void argus_extremes_forget(argus_extremes_t *self, int sonar);

// The fresh readings of one SIP. Cost: some ten multiplications for each shortest reading.
void argus_extremes_sip(argus_extremes_t *self, const argus_knowledge_t *knowledge);

// STUCK: a reading that forbids to turn stays while the robot goes away from it, or one below the shortest
// does not change. INTERMITTENT: such come and go faster than anything moves. Else NONE.
argus_fault_kind_t argus_extremes_convicts(const argus_extremes_t *self, int sonar);

// It is too early to try it again.
bool argus_extremes_keeps_out(const argus_extremes_t *self, int sonar);

#endif
