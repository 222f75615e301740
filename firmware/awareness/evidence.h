// SPDX-License-Identifier: MIT
// Evidence (profile argus): sequential tests of every sonar, fed by its own pings and by those of the others
// on its bearing.
#ifndef ARGUS_EVIDENCE_H
#define ARGUS_EVIDENCE_H

#include "argus/argus.h"
#include "awareness/facts.h"

void argus_evidence_init(argus_evidence_t *self);

// `percent` of the tabled evidence, 25 to 400, is what each level takes from now on; 100 after init.
void argus_evidence_set_caution(argus_evidence_t *self, int32_t percent);

// The readings begin anew (session, gap of the link): pings are forgotten, as the robot may have been moved.
// What they told of the sonars stays.
void argus_evidence_restart(argus_evidence_t *self);

// After each SIP. Cost, for each fresh sonar: one pass over the pings of the others (480) and fourteen more
// where they contradict it. Each ping that it answers costs the same.
void argus_evidence_sip(argus_evidence_t *self, const argus_knowledge_t *knowledge);

// Whether a look is called for; the kind that the evidence names, or convicts of (NONE: not so far). A name
// takes disagreements with two others, or with one and what its own readings tell; a conviction takes them
// again at another time.
bool argus_evidence_suspects(const argus_evidence_t *self, int sonar);

// Whether what made a suspect is not gone yet: the levels that clear are below those that make one.
bool argus_evidence_holds(const argus_evidence_t *self, int sonar);

argus_fault_kind_t argus_evidence_names(const argus_evidence_t *self, int sonar);
argus_fault_kind_t argus_evidence_convicts(const argus_evidence_t *self, int sonar);

// A sonar was given up: what it alone has said against others is taken back.
void argus_evidence_retract(argus_evidence_t *self, int sonar);

// What is remembered between missions, hundredths of a nat, by its place in the record (OFF: no longer used).
typedef enum {
    ARGUS_KEPT_WRONG,
    ARGUS_KEPT_OFF,
    ARGUS_KEPT_STUCK,
    ARGUS_KEPT_GARBAGE,
    ARGUS_KEPT_DROPOUT,
    ARGUS_KEPT_LATE,
    ARGUS_KEPT
} argus_kept_t;

// 0: not enough for a suspicion. Half of what was kept counts: at most a suspicion of one that was out, and
// less of any other. The rest must come from what is seen in this mission.
int16_t argus_evidence_kept(const argus_evidence_t *self, int sonar, argus_kept_t kept);
void argus_evidence_restore(argus_evidence_t *self, int sonar, argus_kept_t kept, int16_t score, bool out);

// Forgets what is known of one sonar (an operator's re-test).
void argus_evidence_forget(argus_evidence_t *self, int sonar);

// What others ask of it ------------------------------------------------------------------------------------

// Comparisons in a row that agreed with it, since it was put out or on probation.
uint8_t argus_evidence_agreed(const argus_evidence_t *self, int sonar);
void argus_evidence_agree_anew(argus_evidence_t *self, int sonar);

// It reads one value again and again though the robot moves; it loses echoes between echoes of one thing.
bool argus_evidence_repeats(const argus_evidence_t *self, int sonar);
bool argus_evidence_shows_gaps(const argus_evidence_t *self, int sonar);

// What a laser's scan is off for as a whole, where this is a sector of it; NONE: it is sound, or a sonar.
argus_fault_kind_t argus_evidence_laser(const argus_evidence_t *self, int sonar);

// Found in this SIP of a laser's scan as a whole: an argus_scan_fault_t, 0: nothing.
int32_t argus_evidence_laser_news(const argus_evidence_t *self);

// Readings in a row without an echo; how much the others contradict it, hundredths of a nat.
uint8_t argus_evidence_silent_run(const argus_evidence_t *self, int sonar);
int32_t argus_evidence_contradicted(const argus_evidence_t *self, int sonar);

#endif
