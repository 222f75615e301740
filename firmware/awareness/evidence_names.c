// SPDX-License-Identifier: MIT
// What the tests of a sonar amount to: a suspicion, a name, a conviction (profile argus).
#include "awareness/evidence_internal.h"
#include "knowledge/angle.h"

#define NAME_CONFLICTS 3 // a view is one of a pair: who is wrong takes a third
#define NAME_PARTNERS 2
#define OFF_RUN 5
#define LOST_FOR 4
#define LOST_CONTRADICTED 200
#define BACK_CONTRADICTED 200
#define HEARD_TRACK 3      // crosstalk makes no three echoes of one thing
#define OFF_RUN_LONG 12    // what echoed before is named off after so many readings without an echo
#define OFF_RUN_LONGEST 20 // ... and what was called intermittent
#define OFF_HOLLOW 3
#define MUTE_CONTRADICTED 380 // of one that hears nothing, where nothing else is contradicted
#define DEAF_RUN 8 // who hears nothing for so long, and is contradicted for it, is neither late nor wrong
#define DEAF_HOLLOW 2
#define VIEW_OFF_RUN 3
#define VIEW_ECHOES 6
#define HOLLOW_OF 4
#define CONVICT_CONFLICTS 4
#define CONVICT_BESIDE 3
#define VIEW_OUTWEIGHS 3      // so many times more views of it are contradicted than borne out,
#define OFF_OUTWEIGHS 2       // ... of one that is silent, since any echo clears it
#define CONVICT_EPISODES 3    // what moves about the robot does not contradict the same sonar again later
#define HELD 150              // hundredths of a nat that the peers must come down to before one is cleared
#define LATE_NAMING 800       // late and not well, of one without a name,
#define LATE_NAMING_BUSY 1400 // ... while something moves about the robot,
#define LATE_CONTRADICTED 300 // ... that the others contradict,
#define LATE_BEYOND 400       // ... or, so far beyond the level,
#define LATE_CONTRADICTED_BEYOND 100
#define LATE_SURE 1000 // ... or of one that is intermittent or garbage so far
#define LATE_FIRST 430 // hundredths of a nat, all that speaks for late and against wrong together: at first
#define LATE_AFTER 880 // ... and once it is called wrong, and for a conviction
#define LATE_NO_MORE 420
#define LATE_NO_MORE_OF_SILENT 150 // less than any name of slow takes
#define LATE_BOTH 1000             // by the peers and by its own readings, those LATE_OWN at least
#define LATE_BOTH_BUSY 1300
#define LATE_BOTH_CONTRADICTED 850 // ... of one that the others contradict by BACK_CONTRADICTED
#define LATE_BOTH_INSTEAD 1200     // ... in the place of gaps or wild readings
#define LATE_BOTH_SURE 1450        // ... of a bent axis; or with LATE_OWN_LITTLE at least
#define LATE_OWN 300
#define LATE_OWN_LITTLE 150
#define LEAPS_CONTRADICTED 360 // two of them
#define LATE_OF_WILD 300       // less is no lag, of one whose readings are wild
#define BENT_NAMING 1100
#define BENT_NAMING_BUSY 1500
#define BENT_CONTRADICTED 300
#define BENT_TOLD_NAMING 600 // ... while nothing does, of one that the bend tells so much of
#define BENT_TOLD 500
#define BENT_SURE 1000 // in the place of another name
#define BENT_SURE_TOLD 300
#define BENT_NO_LESS 500
#define BENT_KEEPS 4  // times what tells of the bend is more than the lateness
#define BENT_HOLLOW 5 // more silences than this, of the last eight contradicted readings, are no bent axis
#define HOLLOW_MOST 8

// How many others contradict it, of the last conflicts counted.
static int partners(const argus_case_t *const c) {
    uint32_t mask = 0;
    const int count = argus_min(c->conflicts, ARGUS_REFUTED);
    for (int i = 1; i <= count; i++) {
        const int partner = c->refuted[(c->refuted_next + ARGUS_REFUTED - i) % ARGUS_REFUTED].partner;
        mask |= partner == ARGUS_SCAN_PARTNER ? 0x30000u : (partner >= 0 ? 1u << partner : 0u);
    }
    return argus_count_bits(mask);
}

static int partner_at(const argus_case_t *const c, const int back) {
    return c->refuted[(c->refuted_next + ARGUS_REFUTED - back) % ARGUS_REFUTED].partner;
}

static int conflicts_with(const argus_case_t *const c, const int partner, const int count) {
    int same = 0;
    for (int i = 1; i <= count; i++) {
        same += partner_at(c, i) == partner ? 1 : 0;
    }
    return same;
}

// Conflicts, of the last ones counted, with others than the partner of most of them: a liar beside it is one
// voice.
static int beside_the_main(const argus_case_t *const c) {
    const int count = argus_min(c->conflicts, ARGUS_REFUTED);
    int most = 0;
    for (int i = 1; i <= count; i++) {
        const int partner = partner_at(c, i);
        most = partner != ARGUS_SCAN_PARTNER ? argus_max(most, conflicts_with(c, partner, count)) : most;
    }
    return count - most;
}

static const uint8_t kind_of_test[ARGUS_TESTS] = {
    [ARGUS_TEST_OFF] = ARGUS_KIND_OFF,         [ARGUS_TEST_STUCK] = ARGUS_KIND_STUCK,
    [ARGUS_TEST_GARBAGE] = ARGUS_KIND_GARBAGE, [ARGUS_TEST_DROPOUT] = ARGUS_KIND_INTERMITTENT,
    [ARGUS_TEST_LAG] = ARGUS_KIND_SLOW,
};

static bool rests_on_views(const argus_test_t test) {
    return test == ARGUS_TEST_VIEW || test == ARGUS_TEST_OFF;
}

static bool is_named_by(const argus_case_t *const c, const argus_test_t test, const int32_t level) {
    const bool enough = test == ARGUS_TEST_OFF ? c->none_run >= OFF_RUN && c->misses > 0
                                               : test != ARGUS_TEST_VIEW || (c->conflicts >= NAME_CONFLICTS &&
                                                                             partners(c) >= NAME_PARTNERS);
    return c->score[test] >= level && enough;
}

// A faulty sonar's own echoes come and go after the robot has come to rest; those of others are of people.
static bool is_busy_beside(const argus_evidence_t *const self, const int sonar) {
    return (self->stirred & ~(1u << sonar)) != 0;
}

static bool is_busy_for(const argus_evidence_t *const self, const int sonar, const argus_test_t test) {
    return test == ARGUS_TEST_LAG ? is_busy_beside(self, sonar) : self->busy;
}

static int32_t naming_level(const argus_evidence_t *const self, const int sonar, const argus_test_t test) {
    return is_busy_for(self, sonar, test) ? argus_bounds[test].naming_busy : argus_bounds[test].naming;
}

static bool outweighs(const argus_case_t *const c, const argus_test_t test) {
    return (test == ARGUS_TEST_OFF ? OFF_OUTWEIGHS : VIEW_OUTWEIGHS) * c->borne_out <= c->conflicts;
}

// Who walks about contradicts, and does, while the robot turns and stops, what it did a moment ago.
static bool is_disturbed(const argus_evidence_t *const self, const int sonar, const argus_test_t test) {
    const bool wants_calm = rests_on_views(test) || test == ARGUS_TEST_LAG;
    return wants_calm && (self->crowded || is_busy_for(self, sonar, test));
}

// By its own readings alone, however late they look, nobody is given up.
static bool is_told_of(const argus_evidence_t *const self, const int sonar, const argus_test_t test) {
    return test != ARGUS_TEST_LAG || argus_peers_told(&self->peers, sonar) > 0;
}

static bool is_convicted_by(const argus_evidence_t *const self, const int sonar, const argus_test_t test) {
    const argus_case_t *const c = &self->of[sonar];
    const bool enough =
        !rests_on_views(test) || (outweighs(c, test) && c->conflicts >= CONVICT_CONFLICTS &&
                                  c->episodes >= CONVICT_EPISODES && beside_the_main(c) >= CONVICT_BESIDE);
    return c->score[test] >= argus_bounds[test].convincing && enough && !is_disturbed(self, sonar, test) &&
           is_told_of(self, sonar, test) && is_named_by(c, test, argus_bounds[test].naming);
}

// Late against wrong, in hundredths of a nat: what the changes of its own readings say, and what the others
// saw where it was some firings ago.
static int32_t lateness(const argus_evidence_t *const self, const int sonar) {
    return argus_peers_told(&self->peers, sonar) + self->of[sonar].score[ARGUS_TEST_LAG];
}

// Late, neither well nor wrong, and contradicted: a late sonar is borne out again whenever the robot rests.
static bool is_late_from(const argus_evidence_t *const self, const int sonar, const int32_t level) {
    const int32_t beyond = argus_peers_late(&self->peers, sonar) - level;
    const int32_t wanted = beyond >= LATE_BEYOND ? LATE_CONTRADICTED_BEYOND : LATE_CONTRADICTED;
    return beyond >= 0 && lateness(self, sonar) >= LATE_FIRST &&
           self->of[sonar].score[ARGUS_TEST_PEERS] >= wanted;
}

static bool looks_late(const argus_evidence_t *const self, const int sonar) {
    return is_late_from(self, sonar, is_busy_beside(self, sonar) ? LATE_NAMING_BUSY : LATE_NAMING);
}

// Of one lag: what its own readings and the peers say together, where both do; 0: not enough of its own.
static int32_t late_of_both(const int32_t own, const int32_t theirs) {
    const int32_t sum = own + theirs;
    const bool counts = own >= LATE_OWN || (own >= LATE_OWN_LITTLE && sum >= LATE_BOTH_SURE);
    return counts && theirs > 0 ? sum : 0;
}

static int32_t most_late_of_both(const argus_evidence_t *const self, const int sonar) {
    int32_t most = 0;
    for (int n = ARGUS_LEAST_LAG; n < ARGUS_TRAIL; n++) {
        most = argus_max(most, late_of_both(self->of[sonar].lag[n], self->peers.of[sonar].late[n]));
    }
    return most;
}

// Its own readings are the third who says who is wrong, where the others rather contradict it.
static bool is_late_by_both_from(const argus_evidence_t *const self, const int sonar, const int32_t level) {
    return self->of[sonar].score[ARGUS_TEST_PEERS] >= 0 && most_late_of_both(self, sonar) >= level;
}

static bool is_late_by_both(const argus_evidence_t *const self, const int sonar) {
    if (is_busy_beside(self, sonar)) {
        return is_late_by_both_from(self, sonar, LATE_BOTH_BUSY);
    }
    const bool contradicted = self->of[sonar].score[ARGUS_TEST_PEERS] >= BACK_CONTRADICTED;
    return is_late_by_both_from(self, sonar, contradicted ? LATE_BOTH_CONTRADICTED : LATE_BOTH);
}

// Neither gaps nor wild readings come to this; the echoes of a late sonar may look like either.
static bool is_surely_late(const argus_evidence_t *const self, const int sonar) {
    return is_late_from(self, sonar, LATE_SURE);
}

// Among wild readings some lag always explains a few: the others must know of one.
static bool is_late_by_both_instead(const argus_evidence_t *const self, const int sonar) {
    return argus_peers_late(&self->peers, sonar) >= LATE_OF_WILD &&
           is_late_by_both_from(self, sonar, LATE_BOTH_INSTEAD);
}

static argus_fault_kind_t late_or_wrong(const argus_evidence_t *const self, const int sonar,
                                        const int32_t late_from) {
    return lateness(self, sonar) >= late_from ? ARGUS_KIND_SLOW : ARGUS_KIND_WRONG;
}

// Off and wrong share a test; what the readings look like tells them apart, and a late sonar from both.
static argus_fault_kind_t kind_of_view(const argus_evidence_t *const self, const int sonar,
                                       const int32_t late_from) {
    const argus_case_t *const c = &self->of[sonar];
    if (c->none_run < VIEW_OFF_RUN && self->peers.of[sonar].borne_out &&
        argus_peers_hollow(&self->peers, sonar, HOLLOW_OF) == HOLLOW_OF) {
        return ARGUS_KIND_INTERMITTENT;
    }
    if (c->none_run == 0 && c->echoes >= VIEW_ECHOES) {
        return late_or_wrong(self, sonar, late_from);
    }
    if (c->score[ARGUS_TEST_DROPOUT] > 0) {
        return ARGUS_KIND_INTERMITTENT;
    }
    return c->none_run >= VIEW_OFF_RUN ? ARGUS_KIND_OFF : ARGUS_KIND_WRONG;
}

// All that contradicted it of late was silence; nearly all.
static bool is_hollow(const argus_evidence_t *const self, const int sonar) {
    return argus_peers_hollow(&self->peers, sonar, OFF_HOLLOW) == OFF_HOLLOW;
}

static bool is_mostly_hollow(const argus_evidence_t *const self, const int sonar) {
    return argus_peers_hollow(&self->peers, sonar, HOLLOW_OF) >= HOLLOW_OF - 1;
}

// Contradicted for silence only: off, unless they bore out an echo of it since they doubt it.
static argus_fault_kind_t kind_of_peers(const argus_evidence_t *const self, const int sonar,
                                        const int32_t late_from) {
    const argus_case_t *const c = &self->of[sonar];
    const int hollow = argus_peers_hollow(&self->peers, sonar, OFF_HOLLOW);
    if (hollow == OFF_HOLLOW) {
        const int run = self->peers.of[sonar].borne_out ? OFF_RUN_LONG : OFF_RUN;
        return c->none_run >= run ? ARGUS_KIND_OFF : ARGUS_KIND_INTERMITTENT;
    }
    return hollow > 0 && c->score[ARGUS_TEST_DROPOUT] > 0 ? ARGUS_KIND_INTERMITTENT
                                                          : late_or_wrong(self, sonar, late_from);
}

// Among wild readings some lag always explains a few: the others, where they contradict it, know of a true
// one.
static bool is_wild(const argus_evidence_t *const self, const int sonar) {
    return self->of[sonar].score[ARGUS_TEST_GARBAGE] >= naming_level(self, sonar, ARGUS_TEST_GARBAGE) &&
           self->of[sonar].score[ARGUS_TEST_PEERS] >= LATE_CONTRADICTED &&
           argus_peers_late(&self->peers, sonar) < LATE_OF_WILD;
}

static argus_fault_kind_t kind_by(const argus_evidence_t *const self, const int sonar,
                                  const argus_test_t test, const int32_t late_from) {
    if (test == ARGUS_TEST_PEERS) {
        return kind_of_peers(self, sonar, late_from);
    }
    if (test == ARGUS_TEST_LAG && is_wild(self, sonar)) {
        return ARGUS_KIND_GARBAGE;
    }
    return test == ARGUS_TEST_VIEW ? kind_of_view(self, sonar, late_from)
                                   : (argus_fault_kind_t)kind_of_test[test];
}

// Who is wrong takes a third, among peers too.
static bool has_partners(const argus_evidence_t *const self, const int sonar) {
    return argus_peers_against(&self->peers, sonar) >= NAME_PARTNERS;
}

// The more definite tests come first.
static const uint8_t precedence[ARGUS_TESTS] = {ARGUS_TEST_OFF,     ARGUS_TEST_STUCK,   ARGUS_TEST_LAG,
                                                ARGUS_TEST_GARBAGE, ARGUS_TEST_DROPOUT, ARGUS_TEST_VIEW,
                                                ARGUS_TEST_PEERS};

static argus_fault_kind_t first_name(const argus_evidence_t *const self, const int sonar, const int tests) {
    for (int i = 0; i < tests; i++) {
        const argus_test_t test = (argus_test_t)precedence[i];
        const bool enough = test != ARGUS_TEST_PEERS || has_partners(self, sonar);
        if (is_named_by(&self->of[sonar], test, naming_level(self, sonar, test)) && enough) {
            return kind_by(self, sonar, test, LATE_FIRST);
        }
    }
    return ARGUS_KIND_NONE;
}

// The others heard something wherever it lately did not, and it has heard nothing for a while: less is wanted
// than of one whose echoes might be of another thing.
static bool is_mute(const argus_evidence_t *const self, const int sonar) {
    const argus_case_t *const c = &self->of[sonar];
    return c->none_run >= OFF_RUN && !self->peers.of[sonar].borne_out &&
           c->score[ARGUS_TEST_PEERS] >= MUTE_CONTRADICTED && is_hollow(self, sonar) &&
           has_partners(self, sonar);
}

// One of its readings that counted is a silence since it last proved alive: contradicted, or it had not
// counted.
static bool is_missed(const argus_evidence_t *const self, const int sonar) {
    for (int i = 0; i < ARGUS_COUNTED; i++) {
        const argus_glimpse_t *const at = &self->peers.of[sonar].counted[i];
        const uint32_t since_ms = at->t_ms - self->of[sonar].alive_ms;
        if (at->reading_mm >= ARGUS_NO_ECHO_MM && since_ms > 0 && since_ms <= INT32_MAX) {
            return true;
        }
    }
    return false;
}

// It followed an echo, lost it, and somebody else hears one there: what it did itself is the second voice.
static bool has_lost(const argus_evidence_t *const self, const int sonar) {
    const argus_case_t *const c = &self->of[sonar];
    return c->followed && c->none_run >= LOST_FOR && !self->peers.of[sonar].borne_out &&
           c->score[ARGUS_TEST_PEERS] >= LOST_CONTRADICTED && is_missed(self, sonar) &&
           !is_busy_beside(self, sonar);
}

// What leaps, contradicted by the others, is garbage a leap before it is so by itself.
static argus_fault_kind_t garbage_or(const argus_evidence_t *const self, const int sonar,
                                     const argus_fault_kind_t other) {
    const argus_case_t *const c = &self->of[sonar];
    const bool open = other == ARGUS_KIND_NONE || other == ARGUS_KIND_WRONG;
    const bool leaps = c->score[ARGUS_TEST_GARBAGE] >= LEAPS_CONTRADICTED &&
                       c->score[ARGUS_TEST_PEERS] >= argus_bounds[ARGUS_TEST_PEERS].suspicious &&
                       argus_peers_late(&self->peers, sonar) < LATE_OF_WILD;
    return open && leaps && !is_busy_beside(self, sonar) && has_partners(self, sonar) ? ARGUS_KIND_GARBAGE
                                                                                      : other;
}

static argus_fault_kind_t off_or(const argus_evidence_t *const self, const int sonar,
                                 const argus_fault_kind_t other) {
    return other == ARGUS_KIND_NONE && (is_mute(self, sonar) || has_lost(self, sonar)) ? ARGUS_KIND_OFF
                                                                                       : other;
}

// In a turn a late sonar looks bent, and a bent one late: half as much that tells of a bend decides, since a
// bend is told of once in a place, a lag by every reading. One that mostly hears nothing is not bent.
static bool is_bent(const argus_evidence_t *const self, const int sonar, const int32_t level,
                    const int32_t told) {
    const argus_bend_t bend = argus_bend(&self->peers, sonar);
    return bend.well >= level && bend.told >= told && 2 * bend.told > lateness(self, sonar) &&
           has_partners(self, sonar) && argus_peers_hollow(&self->peers, sonar, HOLLOW_MOST) <= BENT_HOLLOW;
}

// Before a broad wall it is borne out again and again: where it mostly sees what others see aside, that it
// is contradicted on the whole is enough.
static bool looks_bent(const argus_evidence_t *const self, const int sonar) {
    const int32_t contradicted = self->of[sonar].score[ARGUS_TEST_PEERS];
    if (is_busy_beside(self, sonar)) {
        return contradicted >= BENT_CONTRADICTED && is_bent(self, sonar, BENT_NAMING_BUSY, 0);
    }
    return (contradicted >= BENT_CONTRADICTED && is_bent(self, sonar, BENT_NAMING, 0)) ||
           (contradicted >= 0 && is_bent(self, sonar, BENT_TOLD_NAMING, BENT_TOLD));
}

static bool is_surely_bent(const argus_evidence_t *const self, const int sonar) {
    return is_bent(self, sonar, BENT_SURE, BENT_SURE_TOLD);
}

// A bent axis without another name, or under one that it may get as well.
static argus_fault_kind_t bent_or(const argus_evidence_t *const self, const int sonar,
                                  const argus_fault_kind_t other) {
    const bool unlike =
        other == ARGUS_KIND_INTERMITTENT || other == ARGUS_KIND_GARBAGE || other == ARGUS_KIND_SLOW;
    const bool bent =
        other == ARGUS_KIND_NONE ? looks_bent(self, sonar) : unlike && is_surely_bent(self, sonar);
    return bent ? ARGUS_KIND_WRONG : other;
}

// Late without another name, or under one that a late sonar may get as well.
static argus_fault_kind_t slow_or(const argus_evidence_t *const self, const int sonar,
                                  const argus_fault_kind_t other) {
    const bool unsteady = other == ARGUS_KIND_INTERMITTENT || other == ARGUS_KIND_GARBAGE;
    const bool late =
        other == ARGUS_KIND_NONE ? looks_late(self, sonar) : unsteady && is_surely_late(self, sonar);
    const bool both = other == ARGUS_KIND_NONE ? is_late_by_both(self, sonar)
                                               : unsteady && is_late_by_both_instead(self, sonar);
    return both || (late && has_partners(self, sonar)) ? ARGUS_KIND_SLOW : other;
}

// What contradicted it before it fell silent, by an echo, was of another time.
static argus_fault_kind_t deaf_or(const argus_evidence_t *const self, const int sonar,
                                  const argus_fault_kind_t other) {
    const bool unlike = other == ARGUS_KIND_SLOW || other == ARGUS_KIND_WRONG;
    const bool deaf = self->of[sonar].none_run >= DEAF_RUN &&
                      argus_peers_hollow(&self->peers, sonar, DEAF_HOLLOW) == DEAF_HOLLOW;
    return unlike && deaf ? ARGUS_KIND_OFF : other;
}

argus_fault_kind_t argus_evidence_names(const argus_evidence_t *const self, const int sonar) {
    const argus_fault_kind_t first = off_or(self, sonar, first_name(self, sonar, ARGUS_TESTS));
    const argus_fault_kind_t found =
        bent_or(self, sonar, slow_or(self, sonar, garbage_or(self, sonar, first)));
    return deaf_or(self, sonar, found);
}

// It hears again what the others hear, and silence was nearly all that contradicted it; a late one would tell
// by itself.
static bool has_come_back(const argus_evidence_t *const self, const int sonar) {
    const argus_case_t *const c = &self->of[sonar];
    return c->none_run < VIEW_OFF_RUN && self->peers.of[sonar].borne_out &&
           c->score[ARGUS_TEST_PEERS] >= BACK_CONTRADICTED && is_mostly_hollow(self, sonar) &&
           c->score[ARGUS_TEST_LAG] < LATE_FIRST;
}

argus_fault_kind_t argus_evidence_renames(const argus_evidence_t *const self, const int sonar,
                                          const argus_fault_kind_t present) {
    const argus_fault_kind_t found = argus_evidence_names(self, sonar);
    const bool gaps = found == ARGUS_KIND_NONE && present == ARGUS_KIND_OFF && has_come_back(self, sonar);
    return gaps ? ARGUS_KIND_INTERMITTENT : found;
}

void argus_evidence_note_name(argus_evidence_t *const self, const int sonar, const argus_fault_kind_t kind) {
    argus_peer_t *const peer = &self->peers.of[sonar];
    peer->borne_out = peer->borne_out && kind != ARGUS_KIND_OFF; // what it heard before tells nothing of now
}

argus_fault_kind_t argus_evidence_relapses(const argus_evidence_t *const self, const int sonar) {
    return first_name(self, sonar, ARGUS_TESTS - 1);
}

argus_fault_kind_t argus_evidence_convicts(const argus_evidence_t *const self, const int sonar) {
    for (int i = 0; i < ARGUS_TESTS; i++) {
        const argus_test_t test = (argus_test_t)precedence[i];
        if (is_convicted_by(self, sonar, test)) {
            return bent_or(self, sonar, slow_or(self, sonar, kind_by(self, sonar, test, LATE_AFTER)));
        }
    }
    return ARGUS_KIND_NONE;
}

// What took the name of another fault for that of a bent axis keeps it while it looks like one at all.
static bool is_still_bent(const argus_evidence_t *const self, const int sonar) {
    const argus_bend_t bend = argus_bend(&self->peers, sonar);
    return bend.well >= BENT_NO_LESS && BENT_KEEPS * bend.told > lateness(self, sonar);
}

// Wrong is what is left when nothing more definite shows.
static bool is_more_than_wrong(const argus_evidence_t *const self, const int sonar,
                               const argus_fault_kind_t found) {
    switch (found) {
    case ARGUS_KIND_OFF:
        return self->of[sonar].none_run >= OFF_RUN_LONG && is_hollow(self, sonar) &&
               !is_still_bent(self, sonar);
    case ARGUS_KIND_INTERMITTENT:
        return is_mostly_hollow(self, sonar) && !is_still_bent(self, sonar);
    case ARGUS_KIND_SLOW:
        return lateness(self, sonar) >= LATE_AFTER &&
               (!is_still_bent(self, sonar) || is_late_by_both_from(self, sonar, LATE_BOTH_SURE));
    case ARGUS_KIND_GARBAGE:
        return !is_still_bent(self, sonar);
    default:
        return true;
    }
}

static bool is_heard(const argus_case_t *const self) {
    return self->none_run == 0 && self->track >= HEARD_TRACK;
}

// A stray echo among silences that are contradicted may be crosstalk: it makes nobody late or wrong.
static bool is_more_than_off(const argus_evidence_t *const self, const int sonar,
                             const argus_fault_kind_t found) {
    const bool late = found == ARGUS_KIND_SLOW && !is_surely_late(self, sonar) &&
                      self->of[sonar].score[ARGUS_TEST_LAG] < argus_bounds[ARGUS_TEST_LAG].naming;
    const bool stray = is_mostly_hollow(self, sonar) && !is_heard(&self->of[sonar]);
    return !(found == ARGUS_KIND_WRONG || late) || !stray;
}

// What tells of no lag gives the name up, for gaps or silence too where those are contradicted. A name that
// was taken from a bent axis for sure goes back for less than it took.
static bool is_more_than_slow(const argus_evidence_t *const self, const int sonar,
                              const argus_fault_kind_t found) {
    const int32_t late = lateness(self, sonar);
    const bool bent = is_surely_bent(self, sonar) && !is_late_by_both_from(self, sonar, LATE_BOTH);
    const bool hollow = found == ARGUS_KIND_INTERMITTENT || found == ARGUS_KIND_OFF;
    return (found == ARGUS_KIND_WRONG && (late < LATE_NO_MORE || bent)) ||
           (found == ARGUS_KIND_GARBAGE && is_wild(self, sonar)) ||
           (hollow && late < LATE_NO_MORE_OF_SILENT && is_mostly_hollow(self, sonar));
}

// Gaps give way to a silence that lasts; gaps and wild readings to what is late or bent for sure.
static bool is_more_than_unsteady(const argus_evidence_t *const self, const int sonar,
                                  const argus_fault_kind_t present, const argus_fault_kind_t found) {
    const bool deaf = present == ARGUS_KIND_INTERMITTENT && self->of[sonar].none_run >= OFF_RUN_LONGEST;
    const bool late = is_surely_late(self, sonar) || is_late_by_both_instead(self, sonar);
    return (found == ARGUS_KIND_OFF && deaf) || (found == ARGUS_KIND_SLOW && late) ||
           (found == ARGUS_KIND_WRONG && is_surely_bent(self, sonar));
}

static bool gives_way(const argus_evidence_t *const self, const int sonar, const argus_fault_kind_t present,
                      const argus_fault_kind_t found) {
    switch (present) {
    case ARGUS_KIND_NONE:
        return true;
    case ARGUS_KIND_OFF:
        return is_more_than_off(self, sonar, found);
    case ARGUS_KIND_INTERMITTENT:
        return is_more_than_unsteady(self, sonar, present, found);
    case ARGUS_KIND_GARBAGE:
        return is_more_than_unsteady(self, sonar, present, found) ||
               (found == ARGUS_KIND_WRONG && self->of[sonar].score[ARGUS_TEST_GARBAGE] <= 0);
    case ARGUS_KIND_STUCK:
        return self->of[sonar].score[ARGUS_TEST_STUCK] == 0; // one other value refutes it
    case ARGUS_KIND_SLOW:
        return is_more_than_slow(self, sonar, found);
    case ARGUS_KIND_WRONG:
        return is_more_than_wrong(self, sonar, found);
    default:
        return false;
    }
}

bool argus_evidence_replaces(const argus_evidence_t *const self, const int sonar,
                             const argus_fault_kind_t present, const argus_fault_kind_t found) {
    return found != ARGUS_KIND_NONE && found != present && gives_way(self, sonar, present, found);
}

bool argus_evidence_is_unsteady(const argus_evidence_t *const self, const int sonar) {
    static const uint8_t tests[] = {ARGUS_TEST_GARBAGE, ARGUS_TEST_DROPOUT, ARGUS_TEST_LAG};
    for (int i = 0; i < (int)sizeof tests; i++) {
        const argus_test_t test = (argus_test_t)tests[i];
        if (self->of[sonar].score[test] >= argus_bounds[test].suspicious &&
            !is_convicted_by(self, sonar, test)) {
            return true;
        }
    }
    return false;
}

static bool is_suspected_by(const argus_evidence_t *const self, const int sonar, const int tests) {
    for (int i = 0; i < tests; i++) {
        if (self->of[sonar].score[i] >= argus_bounds[i].suspicious) {
            return true;
        }
    }
    return false;
}

bool argus_evidence_suspects(const argus_evidence_t *const self, const int sonar) {
    return is_suspected_by(self, sonar, ARGUS_TESTS) || looks_late(self, sonar) ||
           is_late_by_both(self, sonar) || looks_bent(self, sonar);
}

bool argus_evidence_keeps_out(const argus_evidence_t *const self, const int sonar) {
    return is_suspected_by(self, sonar, ARGUS_TEST_PEERS);
}

bool argus_evidence_holds(const argus_evidence_t *const self, const int sonar) {
    return argus_evidence_suspects(self, sonar) || self->of[sonar].score[ARGUS_TEST_PEERS] > HELD ||
           argus_peers_late(&self->peers, sonar) > HELD;
}
