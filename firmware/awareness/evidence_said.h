// SPDX-License-Identifier: MIT
// What the peers say of one reading, and who asks them.
#ifndef ARGUS_EVIDENCE_SAID_H
#define ARGUS_EVIDENCE_SAID_H

#include "evidence_internal.h"

// FAINT: it misses an echo that the air may have swallowed, or the other way round; SAME: the pose of then
// would have it look where it looks now.
typedef enum { UNSEEN, QUIET, AGREED, CONTRADICTED, FAINT, DIVIDED, SAME, VERDICTS } argus_said_t;

// Of a reading of this sonar, had it been made there. Cost: up to 2 * 15 * 32 glimpses looked through.
argus_said_t argus_peers_say(const argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar,
                             const argus_glimpse_t *at);

#define ARGUS_TOLD_CEILING 900                       // of sums against another fault
int16_t argus_limited(int32_t sum, int32_t ceiling); // from 0 to the ceiling
int16_t argus_faded(int16_t score);                  // what is left of a sum of the peers after a second

// One counted reading of this sonar (`verdict`: AGREED or CONTRADICTED; `increment`, hundredths of a nat:
// what it adds to PEERS) as if its axis were bent. Cost: up to 6 times argus_peers_say.
void argus_bend_weigh(argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar,
                      const argus_glimpse_t *at, argus_said_t verdict, int32_t increment);
void argus_bend_fade(argus_peer_t *self); // once a second

#endif
