// SPDX-License-Identifier: MIT
// Evidence (profile argus): sequential tests of every sonar, fed by its own trail of readings and by pairs of
// views of one bearing.
#ifndef ARGUS_EVIDENCE_H
#define ARGUS_EVIDENCE_H

#include "argus/argus.h"
#include "awareness/trend.h"
#include "knowledge/knowledge.h"

#define ARGUS_TRAIL 10 // readings of its own that a sonar's tests look back on
#define ARGUS_VIEWS 8  // confirmed views that are remembered of each sonar
#define ARGUS_REFUTED 6

// One cumulative-sum test (Page 1954; its increments are log-likelihood ratios as in Wald's SPRT) for each
// way a sonar can be seen to fail. Scores are hundredths of a nat and never fall below the floor of the test.
typedef enum {
    ARGUS_TEST_VIEW,    // other sonars saw something else on this bearing (wrong)
    ARGUS_TEST_OFF,     // no echo where others hear one, and none anywhere (off)
    ARGUS_TEST_STUCK,   // the same value again though the robot moved
    ARGUS_TEST_GARBAGE, // readings that match none before them
    ARGUS_TEST_DROPOUT, // no echo between two echoes of one thing (intermittent)
    ARGUS_TEST_LAG,     // its readings do what the robot did some firings ago (slow)
    ARGUS_TEST_PEERS,   // other sonars saw something else, each reading counted (names only)
    ARGUS_TESTS
} argus_test_t;

// A reading as it came, with the pose of the SIP that listed it; x and y modulo 65,536 mm.
typedef struct {
    uint16_t reading_mm;
    uint16_t x_mm;
    uint16_t y_mm;
    int16_t heading_cdeg;
    bool steady; // neither this SIP nor the one before showed a rotation
    bool rest;
} argus_trail_t;

// What a sonar saw, twice in agreement: from where, on which bearing (course frame), how far.
typedef struct {
    int32_t x_mm; // of the transducer
    int32_t y_mm;
    int32_t bearing_cdeg;
    uint32_t t_ms;
    uint16_t reading_mm;
    bool rest; // the robot stood
    bool valid;
} argus_view_t;

// The picture of what lies all round, about the robot's centre.
#define ARGUS_SCAN_BINS 36
#define ARGUS_SCAN_DEPTH 4
typedef struct {
    uint32_t t_ms;
    uint16_t range_mm;
    uint8_t sonar;
    bool used;
} argus_scan_entry_t;

typedef struct {
    argus_scan_entry_t entry[ARGUS_SCAN_DEPTH];
    uint8_t next;
} argus_scan_bin_t;

typedef struct {
    argus_scan_bin_t bin[ARGUS_SCAN_BINS];
    int32_t x_mm; // where it was begun
    int32_t y_mm;
} argus_scan_t;

// Where a conflict was counted, so that one place and pair does not count twice.
typedef struct {
    int32_t x_mm;
    int32_t y_mm;
    int32_t bearing_cdeg;
    int8_t partner; // -1: none
} argus_refuted_t;

typedef struct {
    argus_trail_t trail[ARGUS_TRAIL];
    argus_view_t view[ARGUS_VIEWS];
    argus_refuted_t refuted[ARGUS_REFUTED];
    int16_t score[ARGUS_TESTS];
    uint8_t trail_count;
    uint8_t trail_next;
    uint8_t view_next;
    uint8_t refuted_next;
    uint8_t lag_run[ARGUS_TRAIL]; // [n]: readings in a row that vary and equal the one n before, up to 4
    uint8_t track;                // echoes in a row that go on as the motion predicts
    uint8_t none_run;             // readings in a row without an echo
    uint8_t rest_gaps;            // in its trail at rest in this place, up to those that count
    uint32_t rest_odometer_mm;    // where that place began
    uint8_t jump_track;           // 1: went over to another echo; its track decides
    bool followed;                // the run without an echo began on an echo that it had followed
    uint16_t deaf_cdeg;           // turned since it heard an echo last
    uint8_t taken;                // counts its readings, low bits
    int16_t lag[ARGUS_TRAIL]; // [n], n >= 2: that it is n firings late, by its own readings, hundredths of a
                              // nat, 0 to 3000
    uint8_t conflicts;        // counted since the VIEW score left its floor
    uint8_t borne_out;        // agreements since then
    uint8_t episodes;         // ... at so many times, some seconds apart
    uint32_t conflict_ms;
    uint8_t misses; // of those: no echo where another hears one
    uint8_t agreed; // comparisons in a row that agreed, for rehabilitation
    uint8_t echoes; // echoes in the last 8 readings
    uint8_t echo_bits;
    int32_t agreed_x_mm; // where and on which bearing a scan agreed with it last
    int32_t agreed_y_mm;
    int32_t agreed_cdeg;
    uint16_t caution; // percent: so much of the tabled evidence a level takes
    bool out;    // its evidence is of whether it may come back: what speaks for it counts more, but in LAG
    bool unrest; // something moved before it, at unrest_ms
    uint32_t unrest_ms;
    int16_t drift_mm; // what the last reading differed from the prediction, when it was an echo after an echo
    uint32_t counted_ms;
    uint32_t alive_odometer_mm; // way driven when it last proved alive, or was acquitted
    uint32_t alive_ms;
    uint32_t agreed_ms; // when others bore it out last
} argus_case_t;

// A reading with the place of its transducer and its bearing when the ping was sent, about; x and y modulo
// 65,536 mm, course frame.
#define ARGUS_GLIMPSES 64 // that are remembered of each sonar: some 20 s in motion, longer at rest
#define ARGUS_COUNTED 6
#define ARGUS_BENDS 6 // of an axis: -24, -18, -12, 12, 18, 24 degrees
typedef struct {
    uint32_t t_ms;
    uint16_t x_mm;
    uint16_t y_mm;
    int16_t bearing_cdeg;
    uint16_t reading_mm;
    uint16_t repeats; // further ones that were alike, from the same place, the last at t_ms
} argus_glimpse_t;

typedef struct {
    argus_glimpse_t seen[ARGUS_GLIMPSES];
    argus_glimpse_t counted[ARGUS_COUNTED];
    int16_t late[ARGUS_TRAIL];      // [n]: that it is n firings late and not well, hundredths of a nat
    int16_t told[ARGUS_TRAIL];      // [n]: ... and not wrong
    int16_t bend[ARGUS_BENDS];      // [i]: bent so far and not well, hundredths of a nat, 0 to 3000
    int16_t bend_told[ARGUS_BENDS]; // [i]: ... and not faulty in another way, 0 to 900
    uint16_t verdicts;              // that the others gave on it, sixteenths, fading
    uint16_t contradicted;          // ... and of those, against it
    uint16_t against;               // bit i: sonar i, since its score left 0
    bool borne_out;                 // an echo of it was, since then
    uint8_t hollow; // bit i: of the contradicted readings, in the order they were judged, the one i before
                    // had no echo
    uint8_t next;
    uint8_t count;
    uint8_t counted_next;
    uint64_t weighed; // bit i: seen[i] was, against what the others saw
} argus_peer_t;

typedef struct {
    argus_peer_t of[ARGUS_SONARS];
    argus_pose_t before; // of the SIP before, at before_ms
    uint32_t before_ms;
    uint32_t faded_ms;
} argus_peers_t;

typedef struct {
    argus_case_t of[ARGUS_SONARS];
    argus_peers_t peers;
    argus_scan_t scan;
    argus_trend_t trend;
    argus_mask_t lost;     // lost the echo that they followed
    argus_mask_t jumped;   // went over to another echo
    uint8_t straight_sips; // SIPs in a row without a rotation
    uint8_t usual_run;     // readings without an echo that sonars which proved alive have had lately
    uint32_t usual_ms;     // when that was lowered last
    bool busy;             // something moved about the robot, last at busy_ms
    argus_mask_t stirred;  // ... before these sonars, those that are out left aside
    uint32_t busy_ms;
    bool crowded; // the sonars contradicted each other as they do among people, last at crowded_ms
    uint32_t crowded_ms;
    uint32_t agreements; // monotonic counters of compared views
    uint32_t disagreements;
} argus_evidence_t;

void argus_evidence_init(argus_evidence_t *self);

// `percent` of the tabled evidence, 25 to 400 (LAG: 100 at least), is what each level takes from now on; 100
// after init.
void argus_evidence_set_caution(argus_evidence_t *self, int32_t percent);

// The readings begin anew (session, gap of the link): trails and views are forgotten, and with them what the
// peers say; the other scores stay.
void argus_evidence_restart(argus_evidence_t *self);

// After each SIP. Cost: for each fresh sonar one pass over the views of the other 15 (120); over their
// glimpses (960) one, two where they contradict it, up to sixteen more where its lags are doubted and
// twelve where its axis is, and the same again for each of the others that it answers.
void argus_evidence_sip(argus_evidence_t *self, const argus_knowledge_t *knowledge);

// Whether a look is called for; the kind that the evidence names, or convicts of (NONE: not so far). A name
// takes disagreements with two others, or with one and what its own readings tell; a conviction takes them
// again at another time.
bool argus_evidence_suspects(const argus_evidence_t *self, int sonar);

// Whether what made a suspect is not gone yet: the levels that clear are below those that accuse.
bool argus_evidence_holds(const argus_evidence_t *self, int sonar);

// It does not agree with itself: more of its readings at rest would tell.
bool argus_evidence_is_unsteady(const argus_evidence_t *self, int sonar);
argus_fault_kind_t argus_evidence_names(const argus_evidence_t *self, int sonar);
argus_fault_kind_t argus_evidence_convicts(const argus_evidence_t *self, int sonar);

// What a suspect that carries `present` (NONE: no name) is named now: as above, and INTERMITTENT who was
// taken for OFF and hears again, since then, what another hears. That it was given a name.
argus_fault_kind_t argus_evidence_renames(const argus_evidence_t *self, int sonar,
                                          argus_fault_kind_t present);
void argus_evidence_note_name(argus_evidence_t *self, int sonar, argus_fault_kind_t kind);

// What keeps a sonar out, and the kind that ends its probation: as suspects and names, without what the peers
// alone say.
bool argus_evidence_keeps_out(const argus_evidence_t *self, int sonar);
argus_fault_kind_t argus_evidence_relapses(const argus_evidence_t *self, int sonar);

// Whether the kind `found` is to replace the kind that a sonar carries: a name that says more, or one whose
// ground is gone.
bool argus_evidence_replaces(const argus_evidence_t *self, int sonar, argus_fault_kind_t present,
                             argus_fault_kind_t found);

// Sonars of 1..6 that hear nothing and have proved alive last long ago.
argus_mask_t argus_evidence_unseen(const argus_evidence_t *self, const argus_knowledge_t *knowledge,
                                   const argus_config_t *config);

// The heading on which a sonar that hears nothing would look along a bearing where another one lately heard
// something near, from the same place: whether it is deaf is told there. False: there is none that would be
// news. Cost: one pass over 120 views.
bool argus_evidence_aim(const argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar,
                        int32_t *heading_cdeg);

// Whether the last readings of a sonar that looks abeam (0, 7) show a wall that the robot slants into, so
// near that the body would touch it within `stop_mm` of way. False also when they were not made on a way
// straight ahead of 80 mm or more.
bool argus_evidence_slants_in(const argus_evidence_t *self, int sonar, int32_t stop_mm);

// A sonar was looked at and not convicted: its suspicions are spent.
void argus_evidence_acquit(argus_evidence_t *self, const argus_knowledge_t *knowledge, int sonar);

// A sonar was given up: what it alone has said against others is taken back.
void argus_evidence_retract(argus_evidence_t *self, int sonar);

// Forgets what is known of one sonar (an operator's re-test).
void argus_evidence_forget(argus_evidence_t *self, int sonar);

// What others ask of it ------------------------------------------------------------------------------------

// Sonars that lost the echo that they followed; that went over to another one. Both call for a look, and
// others may say so as well.
argus_mask_t argus_evidence_lost(const argus_evidence_t *self);
argus_mask_t argus_evidence_jumped(const argus_evidence_t *self);
void argus_evidence_note_loss(argus_evidence_t *self, argus_mask_t sonars);
void argus_evidence_note_jump(argus_evidence_t *self, argus_mask_t sonars);

// Comparisons in a row that agreed with it, since it was put out or on probation.
uint8_t argus_evidence_agreed(const argus_evidence_t *self, int sonar);
void argus_evidence_agree_anew(argus_evidence_t *self, int sonar);

// Any two have ever borne each other out.
bool argus_evidence_has_pairs(const argus_evidence_t *self);

// It loses echoes between echoes of one thing.
bool argus_evidence_shows_gaps(const argus_evidence_t *self, int sonar);

// Readings in a row without an echo; that others contradict it, hundredths of a nat.
uint8_t argus_evidence_silent_run(const argus_evidence_t *self, int sonar);
int32_t argus_evidence_accused(const argus_evidence_t *self, int sonar);

// Since it proved alive by an echo that went on; since another bore it out.
uint32_t argus_evidence_alive_age_ms(const argus_evidence_t *self, const argus_knowledge_t *knowledge,
                                     int sonar);
uint32_t argus_evidence_agreed_age_ms(const argus_evidence_t *self, const argus_knowledge_t *knowledge,
                                      int sonar);

// Its readings are counted, low bits; bit i: of the last 8, the one i before was an echo.
uint8_t argus_evidence_taken(const argus_evidence_t *self, int sonar);
uint8_t argus_evidence_echo_bits(const argus_evidence_t *self, int sonar);

// The sonar whose growing weakness is new and worth saying now, -1: none. `metres`: of driving until it will
// have failed. And all of it forgotten.
int argus_evidence_news(argus_evidence_t *self, const argus_knowledge_t *knowledge, int32_t *metres);
void argus_evidence_forget_trend(argus_evidence_t *self, int sonar);

#endif
