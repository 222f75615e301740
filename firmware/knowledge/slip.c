// SPDX-License-Identifier: MIT
// Compares ranges with the way and the turns that the odometry says.
#include "knowledge/slip.h"

#include <stddef.h>
#include <string.h>

#include "knowledge/angle.h"

#define STRETCH_MM 500
#define BEGIN_MM 150    // a reading of the beginning is made within this
#define END_MM 250      // ... and one of the end: what fell silent on the way tells nothing of it
#define TURNED_CDEG 500 // a straight way turns less
#define ALONG_CDEG 1500 // a range so far off the way changes with it; farther off a wall beside keeps it
#define BESIDE_SINE (ARGUS_TRIG_ONE * 98 / 100) // within 10 degrees of abeam
#define BESIDE 2                                // ... as far off as this many times what is heard abeam of it
#define NEAR_MM 2500                            // echoes from farther off come and go
#define STAYS_MM 100                            // less than a change: of 500
#define FITS_MM 200                             // off what the odometry says
#define FITS_WANTED 2  // ranges that change as they should end a doubt: one may be chance
#define TURN_CDEG 3500 // so far turned a sonar looks where another one has looked
#define BESIDE_CDEG 1000
#define DIFFERS_MM 300 // what it hears there is another thing
#define TURN_MANY 3
#define PROOF 6     // of stretches, with none between that tells of motion:
#define BOTH_WAYS 3 // ... on which one ahead and one that looks back stay, so two of these, or of turns,
#define ONE_WAY 2   // ... or two that look one way: a person may walk there

void argus_slip_restart(argus_slip_t *const self) {
    self->begun = false;
    self->proof = 0;
    self->doubted = 0;
}

static void begin(argus_slip_t *const self, const argus_knowledge_t *const knowledge) {
    memset(self->reading_mm, 0, sizeof self->reading_mm);
    self->from = knowledge->pose;
    self->read = 0;
    self->begun = true;
}

static int32_t bearing_cdeg(const argus_knowledge_t *const knowledge, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return argus_robot_pose(knowledge->robot, sonar).heading_deg * 100;
}

static bool looks(const argus_knowledge_t *const knowledge, const int sonar, const bool ahead) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return argus_angle_abs_diff(bearing_cdeg(knowledge, sonar), ahead ? 0 : 18000) <= ALONG_CDEG;
}

static void note_beginnings(argus_slip_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const unsigned news = knowledge->fresh & ~(unsigned)self->read;
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((news >> i & 1u) != 0 && argus_usable(knowledge, i)) {
            self->reading_mm[i] = knowledge->sonar[i].reading_mm;
        }
    }
    self->read |= knowledge->fresh;
}

typedef struct {
    int ahead; // those that look ahead and stayed,
    int back;  // ... and back,
    int plain; // ... and heard no wall beside the way
    int fits;  // those that changed as the odometry says
} witnesses_t;

// It reads, and has read here.
static bool can_tell(const argus_slip_t *const self, const argus_knowledge_t *const knowledge,
                     const int sonar) {
    const uint32_t since_mm = knowledge->odometer_mm - knowledge->sonar[sonar].odometer_mm;
    return since_mm <= END_MM && self->reading_mm[sonar] != 0 && argus_usable(knowledge, sonar);
}

// What was heard in the beginning on a bearing of the robot; 0: nothing.
static int32_t heard_there_mm(const argus_slip_t *const self, const argus_knowledge_t *const knowledge,
                              const int32_t bearing) {
    for (int i = 0; i < knowledge->sonars; i++) {
        if (self->reading_mm[i] != 0 &&
            argus_angle_abs_diff(bearing_cdeg(knowledge, i), bearing) <= BESIDE_CDEG) {
            return self->reading_mm[i];
        }
    }
    return 0;
}

// How far beside the way the nearest thing is on a side, in the beginning or now: a door in a wall beside the
// one end is no door all along. INT32_MAX: nothing was heard.
static int32_t beside_mm(const argus_slip_t *const self, const argus_knowledge_t *const knowledge,
                         const bool left) {
    int32_t nearest_mm = INT32_MAX;
    for (int i = 0; i < knowledge->sonars; i++) {
        const int32_t bearing = bearing_cdeg(knowledge, i);
        const int32_t sine = argus_sin(left ? bearing : -bearing);
        if (sine < BESIDE_SINE) {
            continue;
        }
        const int32_t now_mm = argus_usable(knowledge, i) ? knowledge->sonar[i].reading_mm : INT16_MAX;
        const int32_t then_mm = self->reading_mm[i] != 0 ? self->reading_mm[i] : INT16_MAX;
        const int32_t reading_mm = argus_min(now_mm, then_mm);
        nearest_mm =
            reading_mm < INT16_MAX ? argus_min(nearest_mm, reading_mm * sine / ARGUS_TRIG_ONE) : nearest_mm;
    }
    return nearest_mm;
}

// At both ends of the way it may hear a wall that runs along it, out at the edge of its cone.
static bool hears_beside(const argus_slip_t *const self, const argus_knowledge_t *const knowledge,
                         const int sonar) {
    return self->reading_mm[sonar] / BESIDE >= beside_mm(self, knowledge, bearing_cdeg(knowledge, sonar) > 0);
}

static void ask(const argus_slip_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                const int32_t way_mm, witnesses_t *const of) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const bool ahead = looks(knowledge, sonar, true);
    if ((!ahead && !looks(knowledge, sonar, false)) || !can_tell(self, knowledge, sonar)) {
        return;
    }
    const int32_t change = knowledge->sonar[sonar].reading_mm - self->reading_mm[sonar];
    if (argus_abs(change + (ahead ? way_mm : -way_mm)) <= FITS_MM) {
        of->fits++;
    } else if (argus_abs(change) <= STAYS_MM && self->reading_mm[sonar] <= NEAR_MM) {
        of->ahead += ahead;
        of->back += !ahead;
        of->plain += !hears_beside(self, knowledge, sonar);
    }
}

static bool looks_both_ways(const witnesses_t *const of) {
    return of->ahead > 0 && of->back > 0;
}

static bool is_held(const witnesses_t *const of) {
    return of->fits == 0 && of->plain > 0 && (looks_both_ways(of) || of->ahead >= 2 || of->back >= 2);
}

static void slip(argus_slip_t *const self, const argus_pose_t *const to) {
    self->slipped_mm = argus_hypot(to->x_mm - self->first.x_mm, to->y_mm - self->first.y_mm);
    self->begun = false;
    self->proof = 0;
    self->doubted = FITS_WANTED;
    self->slips++;
}

static bool prove(argus_slip_t *const self, const argus_pose_t *const to, const int worth) {
    self->proof = (uint8_t)(self->proof + worth);
    const bool proven = self->proof >= PROOF;
    if (proven) {
        slip(self, to);
    }
    return proven;
}

// Where nothing tells, what was proved before stands.
static bool judge_way(argus_slip_t *const self, const argus_knowledge_t *const knowledge,
                      const int32_t way_mm) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    witnesses_t of = {0, 0, 0, 0};
    for (int i = 0; i < knowledge->sonars; i++) {
        ask(self, knowledge, i, way_mm, &of);
    }
    self->doubted = (uint8_t)argus_max(0, self->doubted - of.fits);
    if (is_held(&of)) {
        return prove(self, &knowledge->pose, looks_both_ways(&of) ? BOTH_WAYS : ONE_WAY);
    }
    self->proof = of.fits > 0 ? 0 : self->proof;
    return false;
}

// After a turn a sonar hears what another one has heard there. Where the body stays it hears what it heard.
static bool judge_turn(argus_slip_t *const self, const argus_knowledge_t *const knowledge,
                       const int32_t turn_cdeg) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    int stay = 0;
    int fits = 0;
    for (int i = 0; i < knowledge->sonars; i++) {
        const int32_t here = self->reading_mm[i];
        const int32_t there = heard_there_mm(self, knowledge, bearing_cdeg(knowledge, i) + turn_cdeg);
        if ((self->read >> i & 1u) != 0 && can_tell(self, knowledge, i) && there != 0 &&
            argus_abs(here - there) > DIFFERS_MM) {
            stay += argus_abs(knowledge->sonar[i].reading_mm - here) <= STAYS_MM;
            fits += argus_abs(knowledge->sonar[i].reading_mm - there) <= FITS_MM;
        }
    }
    self->proof = fits > stay ? 0 : self->proof;
    return stay >= TURN_MANY && fits == 0 && prove(self, &knowledge->pose, BOTH_WAYS);
}

// The turn goes on, or not all have been heard since.
static bool is_in_turn(argus_slip_t *const self, const argus_knowledge_t *const knowledge) {
    self->read = (argus_mask_t)(knowledge->rotating ? 0 : self->read | knowledge->fresh);
    return argus_count_bits(self->read) < knowledge->sonars;
}

static void go_on(argus_slip_t *const self, const argus_knowledge_t *const knowledge) {
    begin(self, knowledge);
    if (self->proof == 0 && self->doubted == 0) {
        self->first = self->from;
    }
}

// How far ahead of a pose another one is.
static int32_t ahead_mm(const argus_pose_t *const from, const argus_pose_t *const to) {
    const argus_point_t way = {to->x_mm - from->x_mm, to->y_mm - from->y_mm};
    return argus_in_frame(way, from->heading_cdeg).x_mm;
}

static bool judge(argus_slip_t *const self, const argus_knowledge_t *const knowledge, const int32_t way_mm,
                  const int32_t turn_cdeg) {
    if (argus_abs(turn_cdeg) <= TURNED_CDEG) {
        return judge_way(self, knowledge, way_mm);
    }
    return argus_abs(turn_cdeg) >= TURN_CDEG && judge_turn(self, knowledge, turn_cdeg);
}

static bool is_done(argus_slip_t *const self, const argus_knowledge_t *const knowledge, const int32_t way_mm,
                    const int32_t turn_cdeg) {
    if (argus_abs(turn_cdeg) > TURNED_CDEG) {
        return way_mm > BEGIN_MM || !is_in_turn(self, knowledge);
    }
    if (way_mm <= BEGIN_MM) {
        note_beginnings(self, knowledge);
    }
    return way_mm >= STRETCH_MM;
}

bool argus_slip_sip(argus_slip_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->robot != NULL);
    if (!self->begun || knowledge->leapt) {
        go_on(self, knowledge);
        return false;
    }
    const int32_t way_mm = ahead_mm(&self->from, &knowledge->pose);
    const int32_t turn_cdeg = argus_angle_wrap(knowledge->pose.heading_cdeg - self->from.heading_cdeg);
    if (!is_done(self, knowledge, argus_abs(way_mm), turn_cdeg)) {
        return false;
    }
    if (judge(self, knowledge, way_mm, turn_cdeg)) {
        return true;
    }
    go_on(self, knowledge);
    return false;
}

bool argus_slip_denies(argus_slip_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(self->proof < PROOF);
    if (self->doubted == 0 && self->proof < PROOF / 2) {
        return false;
    }
    slip(self, &knowledge->pose);
    return true;
}
