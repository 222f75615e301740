// SPDX-License-Identifier: MIT
// The health of every sonar: what may happen to it, where that leads, and which event says so. No other file
// writes it.
#ifndef ARGUS_HEALTH_H
#define ARGUS_HEALTH_H

#include "argus/argus.h"
#include "knowledge/knowledge.h"

// X(NAME, from, to, event, meaning): what may happen to a sonar. `from`: the states in which it may, U
// UNKNOWN, H HEALTHY, S SUSPECT, D DISABLED, P PROBATION, T STALE, A ABSENT. `event`: what says so; NONE:
// nothing is said.
#define ARGUS_CHANGE_TABLE(X)                                                                               \
    X(JUDGED, "UT", HEALTHY, SONAR_HEALTHY, "a full check at rest found no complaint")                      \
    X(RESTORED, "P", HEALTHY, SONAR_HEALTHY, "its probation is over")                                       \
    X(CLEARED, "S", HEALTHY, SONAR_CLEARED, "others bear it out")                                           \
    X(DROPPED, "S", HEALTHY, SUSPICION_DROPPED, "what made it a suspect is gone")                           \
    X(HEARD, "T", HEALTHY, NONE, "it reports again")                                                        \
    X(SUSPECTED, "UHT", SUSPECT, SONAR_SUSPECT, "it is to be looked at")                                    \
    X(NAMED, "S", SUSPECT, SONAR_NAMED, "the evidence so far names a fault")                                \
    X(DISABLED, "UHSPT", DISABLED, SONAR_DISABLED, "it is not used any more")                               \
    X(RENAMED, "D", DISABLED, SONAR_KIND, "its fault is known better")                                      \
    X(TRIED, "DA", PROBATION, SONAR_PROBATION, "it does well again")                                        \
    X(RETESTED, "DP", PROBATION, SONAR_PROBATION, "an operator wants it tried anew: relapses are forgiven") \
    X(RECORDED, "UHST", PROBATION, SONAR_PROBATION, "it was out in the last mission")                       \
    X(STALLED, "H", STALE, SONAR_STALE, "it yields no reading")                                             \
    X(FORGOTTEN, "UHSDPT", UNKNOWN, NONE, "the record, or what was found out, was of another robot")        \
    X(MISSING, "UHSDPT", ABSENT, NONE, "the robot that answers has not got it, or never says so")           \
    X(FITTED, "A", UNKNOWN, NONE, "the robot that answers has it")

typedef enum {
#define ARGUS_CHANGE_ENUM(name, from, to, event, meaning) ARGUS_CHANGE_##name,
    ARGUS_CHANGE_TABLE(ARGUS_CHANGE_ENUM)
#undef ARGUS_CHANGE_ENUM
        ARGUS_CHANGES
} argus_change_t;

// Makes the change and returns the event to say, its id 0 when there is none. The caller fills in time and
// failure state. `kind`: of the fault, ARGUS_KIND_NONE where the new state has none. `value`: of the event.
argus_event_t argus_health_set(argus_knowledge_t *self, int sonar, argus_change_t change,
                               argus_fault_kind_t kind, int32_t value, uint32_t now_ms);

// An operator has seen to it: in which missions it was named counts no more.
void argus_health_forgive(argus_knowledge_t *self, int sonar);

// Whether the change may happen to the sonar now.
bool argus_health_may(const argus_knowledge_t *self, int sonar, argus_change_t change);

#endif
