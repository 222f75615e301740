// SPDX-License-Identifier: MIT
// The persistent record of Knowledge: history of every sonar, also of earlier missions (SPEC.md, Record).
#ifndef ARGUS_RECORD_H
#define ARGUS_RECORD_H

#include "argus/knowledge.h"

typedef enum { ARGUS_RECORD_OK, ARGUS_RECORD_DAMAGED, ARGUS_RECORD_FOREIGN } argus_record_fault_t;

// Length of the record, 0 when it does not fit `capacity`. Its own CRC is inside.
size_t argus_record_encode(const argus_knowledge_t *knowledge, uint8_t *out, size_t capacity);

// Takes the record as history (kind_before, disabled_before); the present health of every sonar stays as it
// is. Nothing is taken unless ARGUS_RECORD_OK is returned. `record` may be any bytes.
argus_record_fault_t argus_record_decode(argus_knowledge_t *knowledge, const uint8_t *record, size_t length);

#endif
