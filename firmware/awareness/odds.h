// SPDX-License-Identifier: MIT
// What a reading tells of its sonar, by how odd the readings of all the others are of late.
#ifndef ARGUS_ODDS_H
#define ARGUS_ODDS_H

#include "awareness/facts.h"

// ln of a number from 1 on, in hundredths: between powers of two a straight line, at most 7 off.
int32_t argus_ln(int32_t number);

// What a reading of a sonar that is odd for a test, or not, adds to its score, hundredths of a nat. Cost: one
// pass over the sonars.
int32_t argus_odds_of(const argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar,
                      argus_test_t test, bool odd);

// Likewise where a healthy one is known to be odd as often as this at the least, permille.
int32_t argus_odds_where(const argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar,
                         argus_test_t test, bool odd, int32_t least_permille);

// Sonars differ in what they hear: how often one was silent where another heard something, permille, over
// minutes. Its silences count once an echo of it is borne out: it is not dead, then. One of which little is
// known is taken for one as all are.
void argus_odds_note_deaf(argus_evidence_t *self, int sonar, bool silent);
int32_t argus_odds_deaf_permille(const argus_evidence_t *self, int sonar);

// Takes it into the rates.
void argus_odds_note(argus_evidence_t *self, int sonar, argus_test_t test, bool odd);

// Which part of the readings of those in use, but this one (-1: of all), is odd of late, permille.
int32_t argus_odds_permille(const argus_evidence_t *self, const argus_knowledge_t *knowledge, int but,
                            argus_test_t test);

// Likewise of all but the two oddest: what more than two of them have in common.
int32_t argus_odds_common_permille(const argus_evidence_t *self, const argus_knowledge_t *knowledge,
                                   argus_test_t test);

// Once a second the rates fade.
void argus_odds_fade(argus_evidence_t *self);

#endif
