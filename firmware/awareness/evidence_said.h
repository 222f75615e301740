// SPDX-License-Identifier: MIT
// What the peers say of one reading, and who asks them.
#ifndef ARGUS_EVIDENCE_SAID_H
#define ARGUS_EVIDENCE_SAID_H

#include "awareness/evidence_internal.h"

// FAINT: it misses an echo that the air may have swallowed, or the other way round; SAME: the pose of then
// would have it look where it looks now.
typedef enum { UNSEEN, QUIET, AGREED, CONTRADICTED, FAINT, DIVIDED, SAME, VERDICTS } argus_said_t;

// What to look for among the glimpses of a sonar: on the bearing of `at` (not NULL), or at most span_cdeg
// aside, from its place (60 mm across, 200 mm along), at most age_ms before now_ms.
typedef struct {
    const argus_glimpse_t *at;
    uint32_t now_ms;
    uint32_t age_ms;
    int32_t span_cdeg;
} argus_gaze_t;

// How far back, beyond `after` (0: from the last on), a sonar saw so, and how far behind `at`; 0: it did not.
// Cost: up to 64 glimpses.
int argus_seen_find(const argus_peer_t *self, const argus_gaze_t *gaze, int after, int32_t *along_mm);

// The glimpse so far back (1: the last), and the one that a sonar had so many firings before that; NULL: not
// so many.
const argus_glimpse_t *argus_seen_at(const argus_peer_t *self, int back);
const argus_glimpse_t *argus_seen_before(const argus_peer_t *self, int back, int firings);

// What stands still stays where it was seen.
#define ARGUS_REMEMBERED_MS 40000u

// One more, `repeats` 0; what a robot at rest sees again and again is one glimpse, the first, of the last
// time. What is too old for any gaze goes.
void argus_seen_note(argus_peer_t *self, argus_glimpse_t now);
void argus_seen_forget(argus_peer_t *self);

// Whether what was seen so far back was judged by the others; that it was.
bool argus_seen_is_weighed(const argus_peer_t *self, int back);
void argus_seen_weigh(argus_peer_t *self, int back);

int32_t argus_seen_bearing_cdeg(const argus_glimpse_t *a, const argus_glimpse_t *b); // between, 0 to 18000

// Whether two were made from one place, and how far `now` was ahead on its bearing.
bool argus_seen_from(const argus_glimpse_t *now, const argus_glimpse_t *then, int32_t *along_mm);

// Of a reading of this sonar, had it been made there. Cost: up to 2 * 15 * 64 glimpses looked through.
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
