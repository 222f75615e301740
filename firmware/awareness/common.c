// SPDX-License-Identifier: MIT
// Common cause: an array of which all sonars, or most, stop hearing anything at once: whether that is a
// failure.
#include "awareness/common.h"

#include <string.h>

#include "awareness/numbers.h"
#include "awareness/odds.h"
#include "knowledge/angle.h"

void argus_common_init(argus_common_t *const self) {
    memset(self, 0, sizeof *self);
}

// What an echo of something straight ahead would read now.
static int32_t expected_mm(const argus_heard_t *const echo, const argus_knowledge_t *const knowledge) {
    return echo->reading_mm - (int32_t)(knowledge->odometer_mm - echo->odometer_mm);
}

static bool goes_on(const argus_heard_t *const echo, const argus_knowledge_t *const knowledge,
                    const uint16_t reading_mm) {
    return echo->reading_mm != 0 &&
           argus_abs(expected_mm(echo, knowledge) - reading_mm) <= ARGUS_DARK_GOES_ON_MM;
}

// One that goes on from none before may be crosstalk.
static void note_echo(argus_common_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                      const uint16_t reading_mm) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_heard_t echo = {reading_mm, knowledge->odometer_mm, knowledge->sip_ms};
    if (goes_on(&self->last[sonar], knowledge, reading_mm) ||
        goes_on(&self->sure[sonar], knowledge, reading_mm)) {
        self->sure[sonar] = echo;
    }
    self->last[sonar] = echo;
}

static void take(argus_common_t *const self, const argus_knowledge_t *const knowledge, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const uint16_t reading_mm = knowledge->sonar[sonar].reading_mm;
    if (reading_mm < knowledge->robot->no_echo_mm) {
        note_echo(self, knowledge, sonar, reading_mm);
        self->none_run[sonar] = 0;
        self->heard[sonar] =
            reading_mm <= ARGUS_LASTING_MM || argus_robot_faces_forward(knowledge->robot, sonar);
        self->echoed[sonar] = true;
        self->echo_ms[sonar] = knowledge->sip_ms;
    } else {
        self->none_run[sonar] = argus_one_more(self->none_run[sonar]);
    }
}

static int least_run(const argus_common_t *const self, const argus_mask_t sonars) {
    int least = UINT8_MAX;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        least = (sonars >> i & 1u) != 0 ? argus_min(least, self->none_run[i]) : least;
    }
    return least;
}

// Since the last echo of all of them, of one that may go out of range, too.
static uint32_t since_last_ms(const argus_common_t *const self, const argus_knowledge_t *const knowledge,
                              const argus_mask_t sonars) {
    uint32_t least_ms = UINT32_MAX;
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((sonars >> i & 1u) != 0 && self->echoed[i] && knowledge->sip_ms - self->echo_ms[i] < least_ms) {
            least_ms = knowledge->sip_ms - self->echo_ms[i];
        }
    }
    return least_ms;
}

// Those that heard something until the one moment, at which the robot did not turn. One that drives out of a
// door loses one after the other.
static argus_mask_t lost_at_once(const argus_common_t *const self, const argus_knowledge_t *const knowledge,
                                 const argus_mask_t sonars) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const uint32_t last_ms = since_last_ms(self, knowledge, sonars);
    if (self->has_turned && knowledge->sip_ms - self->turned_ms <= last_ms + ARGUS_DARK_AT_ONCE_MS) {
        return 0;
    }
    unsigned lost = 0;
    for (int i = 0; i < knowledge->sonars; i++) {
        const bool counts = (sonars >> i & 1u) != 0 && self->heard[i];
        const bool lately = knowledge->sip_ms - self->echo_ms[i] - last_ms <= ARGUS_DARK_AT_ONCE_MS;
        lost |= counts && lately ? 1u << i : 0u;
    }
    return (argus_mask_t)lost;
}

// What it tells against an array that one of its sonars is silent where something stands: as much less as
// that one is silent there more often than is taken for granted of each.
static int32_t piece_of(const argus_evidence_t *const evidence, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int32_t often = argus_ln(argus_max(1, argus_odds_deaf_permille(evidence, sonar)));
    return argus_between(0, ARGUS_DARK_PIECE_CNAT,
                         ARGUS_DARK_PIECE_CNAT + argus_ln(1000 / ARGUS_DEAF_EARLIER) - often);
}

// What speaks against the array as a whole, and whose echoes.
static void add(argus_dark_t *const dark, const int32_t nats, const argus_mask_t by) {
    dark->nats = (int16_t)argus_min(dark->nats + nats, ARGUS_CEILING);
    dark->by |= by;
}

static bool hears_within(const argus_knowledge_t *const knowledge, const int sonar, const int32_t mm) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return argus_trusted(knowledge, sonar) && knowledge->sonar[sonar].reading_mm <= mm;
}

static bool is_left(const argus_knowledge_t *const knowledge, const int sonar) {
    return argus_robot_pose(knowledge->robot, sonar).y_mm > 0;
}

static unsigned abeam_of(const argus_knowledge_t *const knowledge) {
    return argus_robot_flank(knowledge->robot) | (unsigned)argus_robot_rear_flank(knowledge->robot);
}

// What a wall on this side tells against it: as the one of its own that hears best there would miss it.
static int32_t piece_beside(const argus_evidence_t *const evidence, const argus_knowledge_t *const knowledge,
                            const argus_dark_t *const dark, const bool left) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const unsigned own = dark->sonars & abeam_of(knowledge);
    int32_t most = -1;
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((own >> i & 1u) != 0 && is_left(knowledge, i) == left) {
            most = argus_max(most, piece_of(evidence, i));
        }
    }
    return most < 0 ? ARGUS_DARK_PIECE_CNAT : most;
}

// One abeam, of another array, that is relied on: the way since it was heard last counts while it hears
// something near.
static void pass(argus_dark_t *const dark, const argus_evidence_t *const evidence,
                 const argus_knowledge_t *const knowledge, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const bool left = is_left(knowledge, sonar);
    const int32_t piece = piece_beside(evidence, knowledge, dark, left);
    argus_passed_t *const passed = &dark->passed[left];
    const int32_t way_mm = (int32_t)(knowledge->odometer_mm - passed->odometer_mm);
    const bool apart = way_mm > ARGUS_DARK_APART_MM;
    const bool near = hears_within(knowledge, sonar, ARGUS_NEAR_MM);
    const bool lasting = hears_within(knowledge, sonar, ARGUS_LASTING_MM);
    passed->mm += passed->near && near && !apart ? way_mm * piece / ARGUS_DARK_PIECE_CNAT : 0;
    passed->stretch_mm += passed->lasting && lasting && !apart ? way_mm : 0;
    passed->near = near;
    passed->lasting = lasting;
    passed->odometer_mm = knowledge->odometer_mm;
    if (passed->stretch_mm >= ARGUS_STRETCH_MM) {
        passed->stretch_mm = 0;
        add(dark, piece, (argus_mask_t)(1u << sonar));
    }
}

static void pass_all(argus_dark_t *const dark, const argus_evidence_t *const evidence,
                     const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const unsigned others = abeam_of(knowledge) & ~(unsigned)dark->sonars & knowledge->fresh;
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((others >> i & 1u) != 0) {
            pass(dark, evidence, knowledge, i);
        }
    }
}

// On either side: what goes along on one may be a person.
static bool has_passed(const argus_dark_t *const dark) {
    const int32_t right_mm = dark->passed[0].mm;
    const int32_t left_mm = dark->passed[1].mm;
    return argus_min(right_mm, left_mm) >= ARGUS_STRETCH_MM && right_mm + left_mm >= ARGUS_DARK_PASSED_MM;
}

static argus_mask_t silent_of(const argus_common_t *const self, const argus_mask_t sonars) {
    unsigned silent = 0;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        silent |= (sonars >> i & 1u) != 0 && self->none_run[i] > 0 ? 1u << i : 0u;
    }
    return (argus_mask_t)silent;
}

static argus_mask_t leading_of(const argus_knowledge_t *const knowledge, const argus_mask_t in_use) {
    return (argus_mask_t)(in_use & (unsigned)argus_robot_leading(knowledge->robot));
}

// One of these has heard something while the others were dark.
static bool lives(const argus_common_t *const self, const argus_dark_t *const dark, const unsigned sonars) {
    bool heard = false;
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const uint32_t since_ms = self->echo_ms[i] - dark->since_ms;
        heard = heard || ((sonars >> i & 1u) != 0 && self->echoed[i] && since_ms <= INT32_MAX &&
                          since_ms > ARGUS_DARK_AT_ONCE_MS);
    }
    return dark->sonars != 0 && heard;
}

// What fails as a whole: an array in use. Of one that looks to both ends it is what does not look astern
// where the rest of it hears: an echo behind shows no living end ahead.
static argus_mask_t whole_of(const argus_common_t *const self, const argus_knowledge_t *const knowledge,
                             const argus_dark_t *const dark, const argus_mask_t in_use) {
    const unsigned leading = leading_of(knowledge, in_use);
    const bool parts = argus_count_bits((argus_mask_t)leading) >= ARGUS_DARK_LEAST;
    const bool apart = silent_of(self, in_use) != in_use || lives(self, dark, in_use & ~leading);
    return parts && apart ? (argus_mask_t)leading : in_use;
}

// The whole where it is silent; else those that lost their echoes at once. Those of one that has failed are
// out by now.
static argus_mask_t members(const argus_common_t *const self, const argus_knowledge_t *const knowledge,
                            const argus_dark_t *const dark, const argus_mask_t in_use,
                            const argus_mask_t whole) {
    const argus_mask_t silent = silent_of(self, in_use);
    if (dark->proven) {
        return dark->sonars;
    }
    return (whole & ~(unsigned)silent) == 0 ? whole : lost_at_once(self, knowledge, silent);
}

// It heard something ahead, twice, and the robot has gone on towards it since.
static bool has_lost(const argus_common_t *const self, const argus_knowledge_t *const knowledge,
                     const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_heard_t *const echo = &self->sure[sonar];
    const bool straight = !self->has_turned || (int32_t)(echo->t_ms - self->turned_ms) > 0;
    const int32_t left_mm = expected_mm(echo, knowledge);
    return argus_abs(argus_robot_pose(knowledge->robot, sonar).heading_deg) <= ARGUS_DARK_AHEAD_DEG &&
           echo->reading_mm != 0 && straight && self->none_run[sonar] >= ARGUS_DARK_RUN &&
           left_mm <= ARGUS_LASTING_MM && left_mm >= ARGUS_DARK_AHEAD_LEAST_MM;
}

static void count_lost(argus_common_t *const self, const argus_evidence_t *const evidence,
                       const argus_knowledge_t *const knowledge, argus_dark_t *const dark) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const unsigned open = dark->sonars & ~(unsigned)dark->lost;
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((open >> i & 1u) != 0 && has_lost(self, knowledge, i)) {
            dark->lost |= (argus_mask_t)(1u << i);
            add(dark, piece_of(evidence, i), 0);
        }
    }
}

// What those that stopped hearing at once tell together is as much as so many that hear as is taken for
// granted.
static bool tells_at_once(const argus_common_t *const self, const argus_evidence_t *const evidence,
                          const argus_knowledge_t *const knowledge, const argus_mask_t sonars) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const unsigned lost = lost_at_once(self, knowledge, sonars);
    int32_t nats = 0;
    for (int i = 0; i < knowledge->sonars; i++) {
        nats += (lost >> i & 1u) != 0 ? piece_of(evidence, i) : 0;
    }
    return nats >= ARGUS_DARK_AT_ONCE_CNAT;
}

// True: since now. What ended at once, and tells too little for a proof, is reason for doubt.
static bool comes_to_doubt(argus_dark_t *const dark, const int run) {
    const bool before = dark->doubted;
    const bool ended = dark->at_once && !dark->tells && run >= ARGUS_DARK_RUN;
    dark->doubted = before || ended || dark->nats >= ARGUS_DARK_DOUBT_CNAT;
    return dark->doubted && !before && !dark->at_once && !dark->proven;
}

// What those who hear badly miss ends with the surface: for them the robot must have gone on as well.
static bool has_lasted(const argus_dark_t *const dark, const argus_knowledge_t *const knowledge,
                       const int run, const int hear) {
    const uint32_t way_mm = knowledge->odometer_mm - dark->odometer_mm;
    if (!dark->tells) {
        return run >= ARGUS_DARK_RUN_OF_SOME && way_mm >= ARGUS_STRETCH_MM;
    }
    return run >= (hear <= 1 ? ARGUS_DARK_RUN : ARGUS_DARK_RUN_OF_SOME);
}

// `hear`: so many of the array go on hearing.
static bool is_proven(const argus_dark_t *const dark, const argus_knowledge_t *const knowledge, const int run,
                      const int hear) {
    const bool disputed = dark->nats >= ARGUS_DARK_PROOF_CNAT && argus_count_bits(dark->by) >= ARGUS_PARTNERS;
    return (dark->at_once && has_lasted(dark, knowledge, run, hear)) || (hear == 0 && has_passed(dark)) ||
           disputed;
}

static void begin(const argus_common_t *const self, const argus_evidence_t *const evidence,
                  const argus_knowledge_t *const knowledge, argus_dark_t *const dark,
                  const argus_mask_t sonars) {
    dark->since_ms = knowledge->sip_ms - since_last_ms(self, knowledge, sonars);
    dark->odometer_mm = knowledge->odometer_mm;
    dark->tells = tells_at_once(self, evidence, knowledge, sonars);
}

// It was dark before, and not the end ahead alone where what looks astern now is as well: from there on the
// whole counts.
static bool was_dark(const argus_knowledge_t *const knowledge, const argus_dark_t *const dark,
                     const argus_mask_t in_use, const argus_mask_t sonars) {
    const bool widens =
        dark->sonars == leading_of(knowledge, in_use) && sonars == in_use && dark->sonars != in_use;
    return dark->sonars != 0 && !widens;
}

static void look_at(argus_common_t *const self, const argus_evidence_t *const evidence,
                    const argus_knowledge_t *const knowledge, const int array) {
    argus_dark_t *const dark = &self->of[array];
    const argus_mask_t all = argus_robot_array(knowledge->robot, array);
    const argus_mask_t its = (argus_mask_t)(all & ~(unsigned)argus_robot_sectors(knowledge->robot));
    const argus_mask_t in_use = (argus_mask_t)(its & ~(unsigned)argus_out(knowledge));
    const argus_mask_t parts = whole_of(self, knowledge, dark, in_use);
    const argus_mask_t sonars = members(self, knowledge, dark, in_use, parts);
    const bool whole = sonars == parts;
    const int least = whole ? ARGUS_DARK_LEAST : ARGUS_DARK_LEAST_OF_SOME;
    const int run = argus_count_bits(sonars) >= least ? least_run(self, sonars) : 0;
    const bool before = was_dark(knowledge, dark, in_use, sonars);
    const bool at_once =
        before ? dark->at_once : argus_count_bits(lost_at_once(self, knowledge, sonars)) >= least;
    if (run == 0 || (!whole && !at_once)) {
        *dark = (argus_dark_t){.sonars = 0};
        return;
    }
    if (!before) {
        begin(self, evidence, knowledge, dark, sonars);
    }
    dark->sonars = sonars;
    dark->at_once = at_once;
    count_lost(self, evidence, knowledge, dark);
    dark->news = (!before && at_once) || comes_to_doubt(dark, run);
    pass_all(dark, evidence, knowledge);
    const int hear = argus_count_bits(parts) - argus_count_bits(sonars);
    dark->proven |= is_proven(dark, knowledge, run, hear);
}

void argus_common_sip(argus_common_t *const self, const argus_evidence_t *const evidence,
                      const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const int32_t differ_mm_s = argus_abs(knowledge->vel_right_mm_s - knowledge->vel_left_mm_s);
    if (differ_mm_s * ARGUS_DARK_TURNING_PER_MM > knowledge->robot->track_mm) {
        self->has_turned = true;
        self->turned_ms = knowledge->sip_ms;
    }
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((knowledge->fresh >> i & 1u) != 0) {
            take(self, knowledge, i);
        }
    }
    for (int array = 0; array < argus_min(knowledge->robot->arrays, ARGUS_ARRAYS_MAX); array++) {
        look_at(self, evidence, knowledge, array);
    }
}

void argus_common_weigh(argus_common_t *const self, argus_evidence_t *const evidence,
                        const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->robot != NULL);
    evidence->dark = 0;
    evidence->mute = 0;
    for (int array = 0; array < ARGUS_ARRAYS_MAX; array++) {
        argus_dark_t *const dark = &self->of[array];
        argus_dispute_t *const dispute = &evidence->dispute[array];
        if (dark->sonars != 0) {
            add(dark, dispute->nats, dispute->by);
            evidence->dark |= dark->sonars;
            evidence->mute |= dark->nats > 0 ? dark->sonars : 0;
        }
        *dispute = (argus_dispute_t){.since_ms = dark->since_ms};
    }
}

void argus_common_touched(argus_common_t *const self, const argus_mask_t sonars) {
    for (int array = 0; array < ARGUS_ARRAYS_MAX; array++) {
        argus_dark_t *const dark = &self->of[array];
        if ((dark->sonars & sonars) != 0) {
            add(dark, ARGUS_DARK_DOUBT_CNAT, 0);
        }
    }
}

void argus_common_turned_about(argus_common_t *const self, const uint32_t now_ms) {
    self->has_turned = true;
    self->turned_ms = now_ms;
}

bool argus_common_doubts(const argus_common_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int array = argus_robot_array_of(sonar);
    return self->of[array].doubted && (self->of[array].sonars >> sonar & 1u) != 0;
}

bool argus_common_strikes(const argus_common_t *const self, const argus_mask_t sonars) {
    for (int array = 0; array < ARGUS_ARRAYS_MAX; array++) {
        if (self->of[array].news && (self->of[array].sonars & sonars) != 0) {
            return true;
        }
    }
    return false;
}

bool argus_common_convicts(const argus_common_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int array = argus_robot_array_of(sonar);
    return self->of[array].proven && (self->of[array].sonars >> sonar & 1u) != 0;
}

bool argus_common_excuses(const argus_common_t *const self, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    for (int array = 0; array < ARGUS_ARRAYS_MAX; array++) {
        const argus_dark_t *const dark = &self->of[array];
        if (dark->sonars != 0 && !dark->proven && (dark->sonars >> sonar & 1u) == 0) {
            return true;
        }
    }
    return false;
}
