// SPDX-License-Identifier: MIT
// Algorithm 2: neighbours turn onto a suspect's bearing and testify (paper: Table III).
#ifndef ARGUS_VERIFY_H
#define ARGUS_VERIFY_H

#include "knowledge/knowledge.h"

typedef enum {
    ARGUS_VERIFY_IDLE,
    ARGUS_VERIFY_RECHECK, // at the base heading: the suspect and its neighbours are read again
    ARGUS_VERIFY_LEFT,    // turned to the right: the left neighbour looks where s looked
    ARGUS_VERIFY_RIGHT,   // turned to the left: the right neighbour does
    ARGUS_VERIFY_RETURN,  // back on the base heading
    ARGUS_VERIFY_DONE
} argus_verify_phase_t;

typedef enum {
    ARGUS_RESULT_NONE,
    ARGUS_RESULT_DROPPED, // no longer disparate at rest
    ARGUS_RESULT_CLEARED, // |mean of the witnesses - v| <= tr
    ARGUS_RESULT_CONVICTED,
    ARGUS_RESULT_UNPROVEN // no usable witness
} argus_result_t;

// A state machine that never blocks. It says which heading it wants, learns when the robot has settled there,
// and waits for a reading fired after that.
typedef struct {
    argus_verify_phase_t phase;
    int8_t sonar;
    int8_t by[2];        // its neighbours, left and right; -1: none
    int16_t turn_deg[2]; // that put each of them on its bearing
    uint8_t witnesses;   // usable neighbours: bit 0 left, bit 1 right
    uint8_t heard;       // witnesses that gave a usable reading
    int32_t base_cdeg;
    uint16_t reading_mm;    // v
    uint16_t witness_mm[2]; // A, B
    int32_t difference_mm;
    int32_t mean_mm;
    argus_result_t result;
} argus_verify_t;

void argus_verify_init(argus_verify_t *self);
// `sonar`: a forward-facing one.
void argus_verify_begin(argus_verify_t *self, const argus_robot_t *robot, int sonar, int32_t base_cdeg);

// The heading that the present phase needs.
int32_t argus_verify_heading_cdeg(const argus_verify_t *self);

// Call on each SIP while settled on that heading since `mark`. True when the phase changed (look at `phase`).
bool argus_verify_step(argus_verify_t *self, const argus_knowledge_t *knowledge, const argus_mark_t *mark);

#endif
