// SPDX-License-Identifier: MIT
// What is remembered of looks and of the names that the evidence gives; no other file writes it.
#ifndef ARGUS_LOOKED_H
#define ARGUS_LOOKED_H

#include "knowledge/knowledge.h"

#define ARGUS_LOOKS_PROOFS_AT_GOAL 2 // looks in a row that leave a sonar its name, one at once upon the other
#define ARGUS_LOOKS_SETTLE_MOST 8    // looks at the goal: a verdict takes disagreements at more than one time

// Looks (profile argus) and checks. A sonar that was cleared is not looked at again for a while.
typedef struct {
    uint32_t odometer_mm;
    uint8_t cleared;
    uint8_t confirmed;   // looks in a row that left it its name
    bool slow_withdrawn; // it was named slow, and then wrong after all
} argus_hold_t;

// The kind that the evidence gives it, and since when.
typedef struct {
    uint32_t since_ms;
    uint8_t named;
} argus_naming_t;

typedef struct {
    uint32_t check_ms; // a health check
    uint32_t lost_ms;  // what doubt has cost since the last look: time, against the speed without
    uint8_t settling;  // looks at the goal
    bool asked;        // an operator wants a look
    bool tried;        // in this session, since those ahead had heard nothing and others had
    bool unheard_said; // likewise
    argus_hold_t hold[ARGUS_SONARS];
    argus_naming_t naming[ARGUS_SONARS];
} argus_looks_t;

void argus_looks_init(argus_looks_t *self);

// A session opened; a health check was made; the robot is to drive on.
void argus_looks_open(argus_looks_t *self);
void argus_looks_checked(argus_looks_t *self, uint32_t now_ms);
void argus_looks_leave(argus_looks_t *self);

// Looks begin; `arriving`: at a goal. They are those of argus_to_try().
void argus_looks_begin(argus_looks_t *self, bool arriving);
void argus_looks_tried(argus_looks_t *self);

// No sonar ahead has heard an echo: whether that is new in this session.
bool argus_looks_unheard(argus_looks_t *self);

// An operator wants a look, which comes with the next check: that the sonar was cleared is forgotten.
void argus_looks_ask(argus_looks_t *self, int sonar);

// Whether the evidence has named this kind for a while.
bool argus_looks_stands(argus_looks_t *self, int sonar, argus_fault_kind_t kind, uint32_t now_ms);

// It is no suspect any more: what names and looks have shown of it is forgotten.
void argus_looks_forget(argus_looks_t *self, int sonar);

// A suspect gets another name.
void argus_looks_rename(argus_looks_t *self, int sonar, argus_fault_kind_t from, argus_fault_kind_t to);

// In a SIP doubt costs nothing; it costs time, at so much less speed than without. It has cost as much as a
// look.
void argus_looks_free(argus_looks_t *self);
void argus_looks_lose(argus_looks_t *self, int32_t lost_mm_s, int32_t free_mm_s);
bool argus_looks_cost(const argus_looks_t *self);

// A look has cleared this one. It is not looked at again before some way, longer each time.
void argus_looks_clear(argus_looks_t *self, const argus_knowledge_t *knowledge, int sonar);
bool argus_looks_hold(const argus_looks_t *self, int sonar, uint32_t odometer_mm);

// A look has left it its name; true: often enough.
bool argus_looks_prove(argus_looks_t *self, int sonar);

// All have been concluded.
void argus_looks_over(argus_looks_t *self);

#endif
