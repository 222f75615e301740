// SPDX-License-Identifier: MIT
// Common cause: all sonars of an array, or most, stop hearing anything at once; whether that is a failure.
#ifndef ARGUS_COMMON_H
#define ARGUS_COMMON_H

#include "awareness/facts.h"
#include "knowledge/knowledge.h"

// An array is dark while none of its sonars that are in use hears anything, or while five or more do not that
// stopped at once. Its peers are no proof then: they are suspects as well. Two things prove that it has
// failed. Its own sonars heard something in the round before; or, of a whole array, it passes walls on either
// side that those abeam of another array go on hearing. Less than that is added up for the array as a whole,
// since a board that fails is likelier than many coincidences: what others have heard where it was silent or
// abeam, what those ahead had heard and should hear still, what the body has touched. A silence tells as much
// less as that sonar has been silent more often where others heard something. First it is doubted: none of it
// is relied on. By more, of two others at least, it is proved.
typedef struct {
    uint32_t odometer_mm; // way driven when one abeam of another array was heard last
    int32_t mm;           // driven beside something near that it hears
    int32_t stretch_mm;   // ... or something farther, since that counted last
    bool near;            // it heard such
    bool lasting;         // ... or such
} argus_passed_t;

typedef struct {
    argus_passed_t passed[2]; // right, left
    argus_mask_t sonars;      // that are dark, 0: it is not
    argus_mask_t lost;        // of these, that had something ahead which they should hear still
    argus_mask_t by;          // others that have heard what they have not
    int16_t nats;             // against it, hundredths
    uint32_t since_ms;        // the last echo of one of them
    uint32_t odometer_mm;     // way driven when it went dark
    bool at_once;             // what it heard ended at one time, and the robot did not turn
    bool tells;               // ... and those that lost it hear well enough for that to be a proof
    bool news;                // ... in this SIP, or there is reason to doubt it
    bool doubted;             // until one of them hears something
    bool proven;
} argus_dark_t;

// One echo; reading_mm 0: none.
typedef struct {
    uint16_t reading_mm;
    uint32_t odometer_mm;
    uint32_t t_ms;
} argus_heard_t;

typedef struct {
    bool has_turned;
    uint32_t turned_ms; // the robot rotated last, if it has
    argus_dark_t of[ARGUS_ARRAYS_MAX];
    bool heard[ARGUS_SONARS];         // its last echo was near enough to last
    bool echoed[ARGUS_SONARS];        // it has heard one
    uint8_t none_run[ARGUS_SONARS];   // readings in a row without an echo, up to 255
    uint32_t echo_ms[ARGUS_SONARS];   // of its last echo
    argus_heard_t last[ARGUS_SONARS]; // that,
    argus_heard_t sure[ARGUS_SONARS]; // ... and the last one that went on from one before
} argus_common_t;

void argus_common_init(argus_common_t *self);

// After each SIP. Cost: one pass over the sonars for each array.
void argus_common_sip(argus_common_t *self, const argus_evidence_t *evidence,
                      const argus_knowledge_t *knowledge);

// After that: takes what the evidence has found against those that are dark, and tells it which these are.
void argus_common_weigh(argus_common_t *self, argus_evidence_t *evidence, const argus_knowledge_t *knowledge);

// The body has met something on its way ahead: those of `sonars`, which look there, have not heard it.
void argus_common_touched(argus_common_t *self, argus_mask_t sonars);

// The other end leads: what was heard is not ahead any more, nor was it driven towards.
void argus_common_turned_about(argus_common_t *self, uint32_t now_ms);

// What an array heard has just ended at once, or it is doubted since now; one of `sonars` is of it.
bool argus_common_strikes(const argus_common_t *self, argus_mask_t sonars);

// This sonar is of those of an array that are dark, and proved to have failed.
bool argus_common_convicts(const argus_common_t *self, int sonar);

// This sonar is of those of an array that are dark, and doubted.
bool argus_common_doubts(const argus_common_t *self, int sonar);

// Others are dark, and it is not known whether they have failed: disagreeing with them is no fault.
bool argus_common_excuses(const argus_common_t *self, int sonar);

#endif
