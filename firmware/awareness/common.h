// SPDX-License-Identifier: MIT
// Common cause: all sonars of an array, or most, stop hearing anything at once; whether that is a failure.
#ifndef ARGUS_COMMON_H
#define ARGUS_COMMON_H

#include "knowledge/knowledge.h"

#define ARGUS_ARRAYS_MAX 4

// An array is dark while none of its sonars that are in use hears anything, or while five or more do not that
// stopped at once. Its peers are no proof then: they are suspects as well. Two things prove that it has
// failed. Its own sonars heard something in the round before; or, of a whole array, it passes walls on either
// side that those abeam of another array go on hearing.
typedef struct {
    uint32_t odometer_mm; // way driven when one abeam of another array was heard last
    int32_t mm;           // driven beside something near that it hears
    bool near;            // it heard such
} argus_passed_t;

typedef struct {
    argus_passed_t passed[2]; // right, left
    argus_mask_t sonars;      // that are dark, 0: it is not
    bool at_once;             // what it heard ended at one time, and the robot did not turn
    bool news;                // ... in this SIP
    bool proven;
} argus_dark_t;

typedef struct {
    bool has_turned;
    uint32_t turned_ms; // the robot rotated last, if it has
    argus_dark_t of[ARGUS_ARRAYS_MAX];
    bool heard[ARGUS_SONARS];       // its last echo was near enough to last
    bool echoed[ARGUS_SONARS];      // it has heard one
    uint8_t none_run[ARGUS_SONARS]; // readings in a row without an echo, up to 255
    uint32_t echo_ms[ARGUS_SONARS]; // of its last echo
} argus_common_t;

void argus_common_init(argus_common_t *self);

// After each SIP. Cost: one pass over the sonars for each array.
void argus_common_sip(argus_common_t *self, const argus_knowledge_t *knowledge);

// What an array heard has just ended at once; one of `sonars` is of it.
bool argus_common_strikes(const argus_common_t *self, argus_mask_t sonars);

// This sonar is of those of an array that are dark, and proved to have failed.
bool argus_common_convicts(const argus_common_t *self, int sonar);

// Others are dark, and it is not known whether they have failed: disagreeing with them is no fault.
bool argus_common_excuses(const argus_common_t *self, int sonar);

#endif
