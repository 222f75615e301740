// SPDX-License-Identifier: MIT
// What the other sonars say of each ping, as it stands and as each hypothesis maps it.
#ifndef ARGUS_CROSSCHECK_H
#define ARGUS_CROSSCHECK_H

#include "awareness/facts.h"

// Compares the newest ping of this sonar, as it stands and as its hypotheses map it, with those of the others
// from that place on that bearing. Then that ping answers for those of the others that are not judged yet.
// Cost: one pass over the pings of the others (480), fourteen more where it is contradicted, and the same for
// each that it answers.
void argus_crosscheck_take(argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar);

// Once a second what was said fades.
void argus_crosscheck_fade(argus_evidence_t *self, const argus_knowledge_t *knowledge);

// A sonar was given up: what it alone has said against others is taken back. Or it is forgotten.
void argus_crosscheck_retract(argus_evidence_t *self, int sonar);

// Of its last contradicted readings, up to 8: how many were without an echo.
int argus_crosscheck_silences(const argus_case_t *self, int of_last);

// Whether what this one says of another counts.
bool argus_crosscheck_is_witness(const argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar,
                                 int of);

#endif
