// SPDX-License-Identifier: MIT
// The persistent record of Knowledge: what is remembered of every sonar between missions (SPEC.md, Record).
#ifndef ARGUS_RECORD_H
#define ARGUS_RECORD_H

#include "awareness/evidence.h"
#include "knowledge/knowledge.h"

#define ARGUS_RECORD_BYTES (14 + 43 * ARGUS_SONARS) // of version 2, the one that is written

typedef enum {
    ARGUS_RECORD_OK,
    ARGUS_RECORD_DAMAGED,
    ARGUS_RECORD_FOREIGN,    // another version, ring or set of tests
    ARGUS_RECORD_OTHER_ROBOT // said by the manager once it knows its robot
} argus_record_fault_t;

typedef struct {
    uint32_t robot;   // that it was recorded of, 0: unknown
    argus_mask_t out; // sonars that were DISABLED or on PROBATION; their kind is in kind_before
} argus_record_note_t;

// Identity of a robot, never 0; name, class and subclass as it states them.
uint32_t argus_record_robot(const char *name, const char *robot_class, const char *subclass);

// Length of the record, 0 when it does not fit `capacity`. Its own CRC is inside.
size_t argus_record_encode(const argus_knowledge_t *knowledge, const argus_evidence_t *evidence,
                           uint32_t robot, uint8_t *out, size_t capacity);

// Takes the history (kind_before, disabled_before, relapses, missions_named) and half of the evidence. What
// it takes never names or convicts by itself. The present health of every sonar stays as it is. Version 1 has
// history only. Nothing is taken unless ARGUS_RECORD_OK is returned. `record` may be any bytes.
argus_record_fault_t argus_record_decode(argus_knowledge_t *knowledge, argus_evidence_t *evidence,
                                         argus_record_note_t *note, const uint8_t *record, size_t length);

// Takes back all that argus_record_decode() took but the health that followed from it.
void argus_record_forget(argus_knowledge_t *knowledge, argus_evidence_t *evidence);

#endif
