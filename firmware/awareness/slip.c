// SPDX-License-Identifier: MIT
// Compares ranges along the way with the way that the odometry says.
#include "awareness/slip.h"

#include <stddef.h>
#include <string.h>

#include "knowledge/angle.h"

#define STRETCH_MM 500
#define BEGIN_MM 150    // a reading of the beginning is made within this
#define END_MM 250      // ... and one of the end: what fell silent on the way tells nothing of it
#define TURNED_CDEG 500 // a straight way turns less
#define ALONG_CDEG 3100 // so far off the way a range still changes with it
#define STEEP_CDEG 3000 // an edge of the cone that looks farther aside takes a wall there for given
#define STEEP_MANY 3    // so many are wanted where one of them looks so: a slant wall may keep two ranges
#define NEAR_MM 2500    // echoes from farther off come and go
#define STAYS_MM 100    // less than a change: of 500
#define FITS_MM 200     // off what the odometry says
#define FITS_WANTED 2   // ranges that change as they should end a doubt: one may be chance
#define PROOF 6         // of stretches one after the other:
#define BOTH_WAYS 3     // ... on which one ahead and one that looks back stay, so two of these,
#define ONE_WAY 2       // ... or two that look one way: a person may walk there

void argus_slip_restart(argus_slip_t *const self) {
    self->begun = false;
    self->doubted = 0;
}

static void begin(argus_slip_t *const self, const argus_knowledge_t *const knowledge) {
    memset(self->reading_mm, 0, sizeof self->reading_mm);
    self->from = knowledge->pose;
    self->read = 0;
    self->begun = true;
    self->ahead = knowledge->vel_left_mm_s + knowledge->vel_right_mm_s > 0;
}

static int32_t bearing_cdeg(const argus_knowledge_t *const knowledge, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    return argus_robot_pose(knowledge->robot, sonar).heading_deg * 100;
}

// Whether it looks where the robot goes to (true) or comes from.
static bool looks(const argus_slip_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                  const bool to) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int32_t way_cdeg = self->ahead == to ? 0 : 18000;
    return argus_angle_abs_diff(bearing_cdeg(knowledge, sonar), way_cdeg) <= ALONG_CDEG;
}

// The nearest that a sonar hears on the side to which this one looks.
static int32_t beside_mm(const argus_knowledge_t *const knowledge, const int sonar) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const bool left = argus_sin(bearing_cdeg(knowledge, sonar)) > 0;
    int32_t nearest = INT32_MAX;
    for (int i = 0; i < knowledge->sonars; i++) {
        const int32_t bearing = bearing_cdeg(knowledge, i);
        const bool abeam = argus_abs(argus_cos(bearing)) < ARGUS_TRIG_ONE / 2;
        if (abeam && (argus_sin(bearing) > 0) == left && argus_usable(knowledge, i)) {
            nearest = argus_min(nearest, knowledge->sonar[i].reading_mm);
        }
    }
    return nearest;
}

// How far off the way the edge of its cone looks that is farther aside.
static int32_t edge_cdeg(const argus_knowledge_t *const knowledge, const int sonar) {
    const int32_t off_way_cdeg = argus_abs(bearing_cdeg(knowledge, sonar));
    return argus_min(off_way_cdeg, 18000 - off_way_cdeg) + knowledge->robot->cone_deg * 50;
}

// Along a wall the edge of the cone hears the wall, always as far off.
static bool may_be_wall_beside(const argus_knowledge_t *const knowledge, const int sonar,
                               const int32_t edge) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const int32_t aside = knowledge->sonar[sonar].reading_mm * argus_sin(edge) / ARGUS_TRIG_ONE;
    const int32_t beside = beside_mm(knowledge, sonar);
    const bool unheard = beside >= ARGUS_NO_ECHO_MM && edge > STEEP_CDEG; // a wall may turn the echo away
    return unheard || aside + STAYS_MM >= beside;
}

static void note_beginnings(argus_slip_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const unsigned news = knowledge->fresh & ~(unsigned)self->read;
    for (int i = 0; i < knowledge->sonars; i++) {
        const bool counts = (news >> i & 1u) != 0 && argus_usable(knowledge, i) &&
                            knowledge->sonar[i].reading_mm <= NEAR_MM &&
                            knowledge->sonar[i].reading_mm > knowledge->robot->min_mm + STRETCH_MM;
        if (counts) {
            self->reading_mm[i] = knowledge->sonar[i].reading_mm;
        }
    }
    self->read |= knowledge->fresh;
}

typedef struct {
    int to;    // those that look along the way and stayed,
    int back;  // ... and back
    int steep; // of them those that look far aside of it
    int fits;  // those that changed as the odometry says
} witnesses_t;

// It reads, and has read here.
static bool can_tell(const argus_slip_t *const self, const argus_knowledge_t *const knowledge,
                     const int sonar) {
    const uint32_t since_mm = knowledge->odometer_mm - knowledge->sonar[sonar].odometer_mm;
    return since_mm <= END_MM && self->reading_mm[sonar] != 0 && argus_usable(knowledge, sonar);
}

static void ask(const argus_slip_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                const int32_t way_mm, witnesses_t *const of) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const bool to = looks(self, knowledge, sonar, true);
    if ((!to && !looks(self, knowledge, sonar, false)) || !can_tell(self, knowledge, sonar)) {
        return;
    }
    const int32_t change = knowledge->sonar[sonar].reading_mm - self->reading_mm[sonar];
    const int32_t edge = edge_cdeg(knowledge, sonar);
    if (argus_abs(change - (to ? -way_mm : way_mm)) <= FITS_MM) {
        of->fits++;
    } else if (argus_abs(change) <= STAYS_MM && !may_be_wall_beside(knowledge, sonar, edge)) {
        of->to += to;
        of->back += !to;
        of->steep += edge > STEEP_CDEG;
    }
}

static bool looks_both_ways(const witnesses_t *const of) {
    return of->to > 0 && of->back > 0;
}

static bool is_held(const witnesses_t *const of) {
    const bool enough = looks_both_ways(of) || of->to >= 2 || of->back >= 2;
    return of->fits == 0 && (of->steep > 0 ? of->to + of->back >= STEEP_MANY : enough);
}

static bool slip(argus_slip_t *const self) {
    self->proof = 0;
    self->doubted = FITS_WANTED;
    self->slips++;
    return true;
}

static bool judge(argus_slip_t *const self, const argus_knowledge_t *const knowledge, const int32_t way_mm) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    witnesses_t of = {0, 0, 0, 0};
    for (int i = 0; i < knowledge->sonars; i++) {
        ask(self, knowledge, i, way_mm, &of);
    }
    const bool stays = is_held(&of);
    self->doubted = (uint8_t)argus_max(0, self->doubted - of.fits);
    if (!stays || self->proof == 0) {
        self->first = self->doubted > 0 ? self->first : self->from;
        self->slipped_mm = 0;
    }
    self->proof =
        (uint8_t)(stays ? self->proof + (looks_both_ways(&of) && of.steep == 0 ? BOTH_WAYS : ONE_WAY) : 0);
    self->slipped_mm += way_mm;
    return self->proof >= PROOF && slip(self);
}

static bool is_straight(const argus_slip_t *const self, const argus_knowledge_t *const knowledge) {
    const int32_t speed = knowledge->vel_left_mm_s + knowledge->vel_right_mm_s;
    const int32_t turned = argus_angle_abs_diff(knowledge->pose.heading_cdeg, self->from.heading_cdeg);
    return turned <= TURNED_CDEG && !knowledge->leapt && (speed == 0 || (speed > 0) == self->ahead);
}

bool argus_slip_sip(argus_slip_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->robot != NULL);
    if (!self->begun || !is_straight(self, knowledge)) {
        self->proof = 0;
        begin(self, knowledge);
        return false;
    }
    const argus_point_t from = {self->from.x_mm, self->from.y_mm};
    const int32_t way_mm = argus_hypot(knowledge->pose.x_mm - from.x_mm, knowledge->pose.y_mm - from.y_mm);
    if (way_mm <= BEGIN_MM) {
        note_beginnings(self, knowledge);
    }
    if (way_mm < STRETCH_MM) {
        return false;
    }
    const bool slipped = judge(self, knowledge, way_mm);
    begin(self, knowledge);
    if (slipped) {
        self->from.x_mm = self->first.x_mm;
        self->from.y_mm = self->first.y_mm;
    }
    return slipped;
}

bool argus_slip_denies(argus_slip_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(self->proof < PROOF);
    if (self->doubted == 0 && self->proof < PROOF / 2) {
        return false;
    }
    self->slipped_mm =
        argus_hypot(knowledge->pose.x_mm - self->first.x_mm, knowledge->pose.y_mm - self->first.y_mm);
    self->begun = false;
    return slip(self);
}
