// SPDX-License-Identifier: MIT
// The finding on one sonar: what its evidence, its range limits and the outage of its array amount to.
#ifndef ARGUS_FINDING_H
#define ARGUS_FINDING_H

#include "awareness/common.h"
#include "awareness/evidence.h"
#include "awareness/extremes.h"

// Each level holds what those before it do.
typedef enum {
    ARGUS_FOUND_NONE,
    ARGUS_FOUND_HELD,    // what made it a suspect is not gone yet
    ARGUS_FOUND_SUSPECT, // a look is called for
    ARGUS_FOUND_NAMED,
    ARGUS_FOUND_CONVICTED,
    ARGUS_FOUND_CERTAIN // by way and time alone, or with the whole of its array
} argus_found_t;

typedef struct {
    argus_found_t level;
    argus_fault_kind_t kind;  // that it is convicted of; NONE: not so far
    argus_fault_kind_t named; // ... that its evidence names
    bool doubted;             // with its array: not relied on, whatever its own evidence
    bool excused;             // another array is dark, and may have failed: disagreeing with it is no fault
    bool keeps_out;           // it is too early to try it again
} argus_finding_t;

// Cost: some hundred comparisons.
argus_finding_t argus_finding(const argus_evidence_t *evidence, const argus_extremes_t *extremes,
                              const argus_common_t *common, int sonar);

#endif
