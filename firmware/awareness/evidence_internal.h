// SPDX-License-Identifier: MIT
// What the parts of the evidence share: trails, the rule table, counting.
#ifndef ARGUS_EVIDENCE_INTERNAL_H
#define ARGUS_EVIDENCE_INTERNAL_H

#include "awareness/evidence.h"
#include "awareness/robot_compat.h"

// The increments of a test, in hundredths of a nat (DESIGN.md derives them), and its bounds.
typedef struct {
    int16_t suspicious;  // a look is called for
    int16_t naming;      // a suspect with the name of its fault, not relied on
    int16_t naming_busy; // ... while something moves about the robot (LAG: before others); at least `naming`
    int16_t convincing;  // DISABLED
    int16_t floor;
    int16_t ceiling;
} argus_bounds_t;

extern const argus_bounds_t argus_bounds[ARGUS_TESTS];

#define ARGUS_FULL_PERCENT 100 // the caution of the tables
#define ARGUS_OUT_TIMES 4      // what speaks for a sonar that is out counts so often, but in LAG

// Adds to a test's score, by caution and within its bounds; four times what speaks for a sonar that is out.
void argus_score(argus_case_t *self, argus_test_t test, int32_t increment);

// The reading `back` before the newest that was taken in (1: that one); NULL: not so many.
const argus_trail_t *argus_trail_at(const argus_case_t *self, int back);

// What `before` would read from the place and heading of `now` if it saw a standing thing: less the way that
// the transducer went along its axis.
int32_t argus_trail_predict_mm(const argus_trail_t *now, const argus_trail_t *before, int sonar);

// Difference of two coordinates modulo 65,536 mm.
int32_t argus_trail_offset_mm(uint16_t now_mm, uint16_t before_mm);

bool argus_trail_goes_on(const argus_trail_t *now, const argus_trail_t *before, int sonar);
int32_t argus_trail_moved_mm(const argus_trail_t *now, const argus_trail_t *before);
int32_t argus_trail_turned_cdeg(const argus_trail_t *now, const argus_trail_t *before);

bool argus_trail_is_echo(const argus_trail_t *at);

#define ARGUS_STILL_MM 12 // less way and turn than this may leave a reading as it is
#define ARGUS_STILL_CDEG 150
#define ARGUS_CLIPPED_MM 105 // the shortest readings are all alike

// One more reading through the tests of each lag, LEAST_LAG to ARGUS_TRAIL - 1 firings, which make its LAG
// score; in unrest no step speaks for one. `caution` below 100 counts as 100. Cost: nine readings predicted.
#define ARGUS_LEAST_LAG 2
void argus_lag_test(argus_case_t *self, const argus_trail_t *now, bool unrest, int sonar);

// What was known of its lateness (its LAG score, 0 to 3000) may be of any lag.
void argus_lag_restore(argus_case_t *self);

// One reading through the tests of the sonar's own trail. True: it confirms the one before, a view.
bool argus_trail_test(argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar,
                      const argus_trail_t *now);

// Where one of two readings was made, seen from where the other was, which is at most some metres away: how
// far ahead on the bearing, how far beside it.
typedef struct {
    int32_t along_mm;
    int32_t lateral_mm; // no sign
} argus_shift_t;
argus_shift_t argus_pair_shift(int32_t dx_mm, int32_t dy_mm, int32_t bearing_cdeg);

// Beyond, the air decides whether an echo is heard; from the first on it begins to.
#define ARGUS_PAIR_SURE_MM 4000
#define ARGUS_PAIR_FARTHEST_MM 4600

// By how much two echoes of one thing may differ at a range.
int32_t argus_pair_limit_mm(int32_t range_mm);

// What two readings on one bearing say of each other, `now` made `along_mm` ahead of `then`. NOTHING: too
// near, or an echo from so far that the air decides whether it is heard.
typedef enum {
    ARGUS_PAIR_QUIET, // both without an echo
    ARGUS_PAIR_AGREE,
    ARGUS_PAIR_DIFFER,
    ARGUS_PAIR_NOW_MISSES, // no echo where the other heard one
    ARGUS_PAIR_THEN_MISSES,
    ARGUS_PAIR_NOTHING
} argus_outcome_t;
argus_outcome_t argus_pair_compare(int32_t now_mm, int32_t then_mm, int32_t along_mm);

// Whether one of the two misses what the other heard so far off that the air may have decided.
bool argus_pair_is_faint(int32_t now_mm, int32_t then_mm, int32_t along_mm);

// What QUIET is worth, in hundredths of a nat.
#define ARGUS_BOTH_QUIET (-20)

// One reading against what the others saw on about its bearing from this place, then remembered.
typedef enum {
    ARGUS_SCAN_NOTHING,
    ARGUS_SCAN_AGREES,
    ARGUS_SCAN_DIFFERS,
    ARGUS_SCAN_MISSES
} argus_scan_verdict_t;
#define ARGUS_SCAN_PARTNER 16 // stands for two others or more
void argus_scan_restart(argus_scan_t *self);
argus_scan_verdict_t argus_scan_take(argus_scan_t *self, const argus_knowledge_t *knowledge, int sonar);
int32_t argus_scan_weight(argus_scan_verdict_t verdict); // hundredths of a nat

// What a scan says of a sonar goes into its score.
void argus_views_scan(argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar,
                      argus_scan_verdict_t verdict);

// Something moves before this sonar; and whether it does before any other that is not out: then evidence
// against one counts little.
void argus_note_unrest(argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar);
bool argus_is_unrest_before(const argus_case_t *self, const argus_knowledge_t *knowledge);
bool argus_is_unrest_beside(const argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar);
bool argus_is_unrest(const argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar); // either
int32_t argus_unrest_percent(const argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar);

// A confirmed view: remembered, and compared with what the other sonars saw on its bearing.
void argus_views_take(argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar);

// Whether another sonar has lately seen something where this one now says that its echo comes from.
bool argus_views_support(const argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar);

// One reading against the glimpses of the other sonars on its bearing, as of now and as of earlier poses of
// its own; then it is one itself, and answers for those of the others that nobody has judged. Cost: up to
// 30 * 15 * 64 glimpses looked through, and as many again for each of up to 15 that it answers.
void argus_peers_take(argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar);
void argus_peers_sip(argus_evidence_t *self, const argus_knowledge_t *knowledge); // after all of a SIP
void argus_peers_restart(argus_peers_t *self);
// More of what the sonars in use read is contradicted than faults make so: people are about.
bool argus_peers_crowded(const argus_peers_t *self, const argus_knowledge_t *knowledge);
void argus_peers_forget(argus_peers_t *self, int sonar);
// For some lag, in hundredths of a nat: late against well, 0 to 2000, and late against wrong, 0 to 900.
int32_t argus_peers_late(const argus_peers_t *self, int sonar);
int32_t argus_peers_told(const argus_peers_t *self, int sonar);
// Of the bend of its axis that most speaks for, in hundredths of a nat: bent against well (0 to 3000), and
// bent against faulty in another way (200 to 900); both 0: what the others see aside speaks of none.
typedef struct {
    int32_t well;
    int32_t told;
} argus_bend_t;
argus_bend_t argus_bend(const argus_peers_t *self, int sonar);
void argus_bend_forget(argus_peer_t *self);

int argus_peers_against(const argus_peers_t *self, int sonar); // others that contradict it, 0 to 15
// Of its last contradicted readings, up to 8: how many were without an echo.
int argus_peers_hollow(const argus_peers_t *self, int sonar, int of_last);

// The present run without an echo is one that a sonar may have here: this one has proved alive.
void argus_trail_learn_run(argus_evidence_t *self, int sonar);

#endif
