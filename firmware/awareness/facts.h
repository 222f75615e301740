// SPDX-License-Identifier: MIT
// What the evidence knows of every sonar: its pings, the scores of its tests, what hypotheses explain it.
#ifndef ARGUS_FACTS_H
#define ARGUS_FACTS_H

#include "awareness/laser.h"
#include "awareness/numbers.h"
#include "awareness/pings.h"

// For each way in which a sonar can be seen to fail there is one cumulative-sum test (Page 1954). Its
// increments are log-likelihood ratios as in Wald's SPRT. Scores are hundredths of a nat, never below the
// floor of the test.
typedef enum {
    ARGUS_TEST_STUCK,   // the same value again though the robot moved
    ARGUS_TEST_GARBAGE, // readings that match none before them
    ARGUS_TEST_DROPOUT, // no echo between two echoes of one thing (intermittent)
    ARGUS_TEST_PEERS,   // other sonars saw something else
    ARGUS_TESTS
} argus_test_t;

// Hypotheses map a reading to the ping that a healthy sonar would have had. It is late by so many firings, or
// its axis is offset by so much.
#define ARGUS_HYPOTHESES (ARGUS_LAGS + ARGUS_OFFSETS)
typedef struct {
    int16_t over_healthy; // so explained, against healthy, hundredths of a nat
    int16_t over_other;   // ... against faulty in another way
} argus_hypothesis_t;

// Readings of late that a test took, and the odd ones of them, sixteenths, fading.
typedef struct {
    uint16_t all;
    uint16_t odd;
} argus_rate_t;

// A stretch of way along its bearing, and by how much its range came nearer on it; measures of that.
typedef struct {
    int16_t way_mm;
    int16_t nearer_mm;
    uint8_t off; // in a row that the odometry contradicts to one side
    bool more;   // that side: more than the way
    bool keeps;  // the last one fits
} argus_scale_t;

typedef struct {
    int16_t score[ARGUS_TESTS];
    uint8_t lag_run[ARGUS_LAGS]; // readings in a row that vary and equal the one so many before, up to 4
    uint16_t last_mm;            // its last reading
    int16_t drift_mm;            // at rest, what it differed from the one before
    uint8_t none_run;            // readings in a row without an echo
    uint8_t gaps;                // at rest in this place, up to those that count
    bool out;                   // its evidence is of whether it may come back: what speaks for it counts more
    bool moved;                 // something moved before it, at moved_ms
    uint32_t place_odometer_mm; // where that place began
    uint8_t agreed;             // counted readings in a row that others bore out
    uint8_t silent_bits;        // bit i: of the contradicted readings, the one i before had no echo
    uint8_t episodes;     // times at which it was contradicted, some seconds apart, since its score left 0
    bool borne_out;       // an echo of it was, since then
    argus_mask_t against; // sonars that contradicted it, since then
    uint32_t episode_ms;
    uint32_t moved_ms;
    uint32_t counted_ms;
    argus_rate_t rate[ARGUS_TESTS];
    argus_hypothesis_t hypothesis[ARGUS_HYPOTHESES];
    argus_scale_t scale;
} argus_case_t;
_Static_assert(ARGUS_SONARS <= ARGUS_ARRAYS_MAX * ARCOS_TIMING_TRANSDUCERS_PER_ARRAY, "each is of an array");
_Static_assert(sizeof(argus_case_t) == 128, "one shift leads to a case");

// What sonars outside an array that is dark have heard where it was silent, in this SIP.
typedef struct {
    int16_t nats;      // hundredths
    argus_mask_t by;   // whose echoes
    uint32_t since_ms; // it has been dark since, if it is
} argus_dispute_t;

// The cases come first: dozens ask for one, which then takes one instruction.
typedef struct {
    argus_case_t of[ARGUS_SONARS];
    argus_pose_t before; // of the SIP before, at before_ms
    uint32_t before_ms;
    uint32_t faded_ms;
    uint32_t crowded_ms; // the sonars contradicted each other as they do among people, last
    bool crowded;
    bool busy;             // ... or something moved before one, lately
    uint8_t straight_sips; // SIPs in a row without a rotation
    uint8_t asked;         // hypotheses that this SIP has weighed
    uint16_t caution;      // percent: so much of the tabled evidence a level takes
    argus_mask_t dark;     // of arrays that hear nothing at all,
    argus_mask_t mute;     // ... which is in dispute: their silence speaks neither for nor against anyone
    argus_dispute_t dispute[ARGUS_ARRAYS_MAX];
    argus_rate_t deaf[ARGUS_SONARS];  // where another heard something: all, and those at which it was silent
    argus_rate_t deaf_ring;           // ... of all sonars together
    uint8_t deaf_waits[ARGUS_SONARS]; // its silences since an echo of it was borne out last: it may be dead
    argus_mask_t told[ARGUS_SONARS]; // those whose echoes its silence has contradicted, as long as it goes on
    argus_mask_t off_scale;          // ranges do not change as the way does: no witnesses
    argus_pings_t pings[ARGUS_SONARS];
#if ARGUS_LASER
    argus_laser_t laser;
#endif
} argus_evidence_t;

// Adds to a test's score, by caution and within its bounds; more of what speaks for a sonar that is out.
void argus_score(argus_evidence_t *self, int sonar, argus_test_t test, int32_t increment);
void argus_hypothesis_add(argus_evidence_t *self, int sonar, int hypothesis, int32_t over_healthy,
                          int32_t over_other);

typedef struct {
    int16_t naming;     // a suspect with the name of its fault, not relied on
    int16_t convincing; // DISABLED
    int16_t floor;
} argus_bounds_t;
extern const argus_bounds_t argus_bounds[ARGUS_TESTS];

#endif
