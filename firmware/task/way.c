// SPDX-License-Identifier: MIT
// Lets the wave come to the robot and follows it back, as far as one SIP allows.
#include "task/way.h"

#include <string.h>

#include "knowledge/angle.h"

#define CELLS ARGUS_GRID_CELLS
#define CELL_MM ARGUS_GRID_CELL_MM
#define SAMPLE_MM 50
#define LEG_LEAST_MM 100 // a leg is done at 60
#define CUT_SAMPLES 4    // a straight leg may have so many more narrow samples than the way itself
#define AHEAD_MM 1000
#define FAR_MM 40000
#define WORK_MOST 2600  // in one SIP, in units of some 100 instructions of a Cortex-M4
#define BEGIN_WORK 1000 // a survey of what is passable,
#define DESCENT_WORK 8  // ... a cell on the way back,
#define SAMPLE_WORK 1   // ... and a place of a straight line

static argus_point_t robot_at(const argus_ground_t *const ground) {
    return (argus_point_t){ground->knowledge->pose.x_mm, ground->knowledge->pose.y_mm};
}

// What argus_hypot() takes of the way from one to the other.
static argus_point_t from_to(const argus_point_t from, const argus_point_t to) {
    return (argus_point_t){argus_within(FAR_MM, to.x_mm - from.x_mm),
                           argus_within(FAR_MM, to.y_mm - from.y_mm)};
}

static int32_t between_mm(const argus_point_t a, const argus_point_t b) {
    const argus_point_t by = from_to(a, b);
    return argus_hypot(by.x_mm, by.y_mm);
}

// Back to the robot's first leg
// ---------------------------------------------------------------------------------

// The neighbour that the wave reached soonest; false at its source.
static bool descend(const argus_wave_t *const wave, argus_pull_t *const pull) {
    static const int8_t around[8][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    const unsigned here = argus_wave_label(wave, pull->at);
    unsigned most = 0;
    argus_cell_t next = pull->at;
    for (int i = 0; i < 8; i++) {
        const argus_cell_t cell = {pull->at.x + around[i][0], pull->at.y + around[i][1]};
        const unsigned label = argus_wave_label(wave, cell);
        const unsigned sooner = (here + ARGUS_WAVE_LABELS - label) % ARGUS_WAVE_LABELS;
        if (label != 0 && sooner <= ARGUS_WAVE_LABELS / 2 && sooner > most) {
            most = sooner;
            next = cell;
        }
    }
    pull->at = next;
    pull->steps -= (int32_t)most;
    return most > 0;
}

// Samples of the straight line that are not wide; INT32_MAX: it is not free.
static int32_t narrow_samples(argus_search_t *const self, const argus_point_t to) {
    const argus_wave_t *const wave = &self->wave;
    const argus_point_t from = {self->robot.x_mm - wave->low.x * CELL_MM,
                                self->robot.y_mm - wave->low.y * CELL_MM}; // in the window
    const argus_point_t by = from_to(self->robot, to);
    const int32_t length_mm = argus_max(1, argus_hypot(by.x_mm, by.y_mm));
    const int32_t way_mm = argus_min(length_mm, CELLS * CELL_MM);
    int32_t narrow = 0;
    for (int32_t mm = 0; mm <= way_mm; mm += SAMPLE_MM) {
        const uint32_t x = (uint32_t)(from.x_mm + by.x_mm * mm / length_mm) / CELL_MM;
        const uint32_t y = (uint32_t)(from.y_mm + by.y_mm * mm / length_mm) / CELL_MM;
        self->work += SAMPLE_WORK;
        if (x >= CELLS || y >= CELLS) { // beyond the window all is free
            continue;
        }
        if ((wave->narrow[y] >> x & 1u) == 0) {
            return INT32_MAX;
        }
        narrow += (wave->wide[y] >> x & 1u) == 0 ? 1 : 0;
    }
    return narrow;
}

static argus_point_t centre_of(const argus_wave_t *const wave, const argus_cell_t in) {
    const argus_cell_t cell = {in.x + wave->low.x, in.y + wave->low.y};
    return argus_grid_centre(cell);
}

static bool is_better(const bool straight, const bool wide, const bool wide_end) {
    return straight && (wide || !wide_end);
}

static void begin_pull(argus_search_t *const self) {
    self->pull = (argus_pull_t){
        .at = self->wave.to,
        .steps = self->wave.step - 1,
        .narrow = CUT_SAMPLES,
        .straight = true,
        .first = true,
    };
    self->leg.to = self->robot;
    self->is_there = true;
}

// One cell more towards the waypoint. A leg ends at the farthest cell of the way that can be driven straight
// to, best one on which the robot can turn. False: it is pulled.
static bool pull_on(argus_search_t *const self) {
    argus_pull_t *const pull = &self->pull;
    ARGUS_ASSERT(pull->straight || !pull->first); // what is done at once ends in a cell beside the robot's
    if (!pull->straight || !descend(&self->wave, pull)) {
        return false;
    }
    const argus_point_t centre = centre_of(&self->wave, pull->at);
    const bool wide = (self->wave.wide[pull->at.y] >> pull->at.x & 1u) != 0;
    pull->narrow += wide ? 0 : CELL_MM / SAMPLE_MM;
    pull->straight = narrow_samples(self, centre) <= pull->narrow;
    if (pull->first || is_better(pull->straight, wide, pull->wide_end)) {
        self->leg.to = centre;
        self->leg.to_go_mm = pull->steps * CELL_MM;
        pull->wide_end = wide;
    }
    pull->first = between_mm(self->robot, self->leg.to) < LEG_LEAST_MM; // it would be done at once
    self->work += DESCENT_WORK;
    return true;
}

static void end_pull(argus_search_t *const self, const argus_point_t waypoint) {
    argus_leg_t *const leg = &self->leg;
    leg->direct = self->pull.straight && narrow_samples(self, waypoint) <= self->pull.narrow;
    leg->to = leg->direct ? waypoint : leg->to;
    leg->to_go_mm = leg->direct ? 0 : leg->to_go_mm + self->wave.beyond * CELL_MM;
    leg->narrow = narrow_samples(self, leg->to) > 0;
}

// SIP by SIP
// ---------------------------------------------------------------------------------------------------

// Something that stops it begins a search anew; that it has gone again does not, or a search might never end.
static bool goes_on(const argus_search_t *const self, const argus_ground_t *const ground,
                    const argus_point_t waypoint) {
    return self->is_on && ground->knowledge->sips - self->sip == 1 && (self->stopped || !ground->stopped) &&
           self->waypoint.x_mm == waypoint.x_mm && self->waypoint.y_mm == waypoint.y_mm;
}

static void begin(argus_search_t *const self, const argus_ground_t *const ground,
                  const argus_point_t waypoint) {
    argus_wave_begin(&self->wave, ground, waypoint);
    self->robot = robot_at(ground);
    self->waypoint = waypoint;
    self->stopped = ground->stopped;
    self->is_there = false;
    self->work += BEGIN_WORK;
}

static argus_search_news_t search_on(argus_search_t *const self) {
    while (self->work < WORK_MOST) {
        if (self->is_there && !pull_on(self)) {
            end_pull(self, self->waypoint);
            return ARGUS_SEARCH_FOUND;
        }
        if (self->is_there) {
            continue;
        }
        const argus_wave_news_t news = argus_wave_spread(&self->wave, &self->work);
        if (news == ARGUS_WAVE_DEAD) {
            return ARGUS_SEARCH_NO_WAY;
        }
        if (news == ARGUS_WAVE_THERE) {
            begin_pull(self);
        }
    }
    return ARGUS_SEARCH_GOES_ON;
}

// Where there is room to turn all along the straight line, that is the way, and no wave is needed.
static bool is_in_sight(argus_search_t *const self) {
    self->leg = (argus_leg_t){.to = self->waypoint, .direct = true};
    return narrow_samples(self, self->waypoint) == 0;
}

argus_search_news_t argus_way_find(argus_search_t *const self, const argus_ground_t *const ground,
                                   const argus_point_t waypoint) {
    if (!argus_grid_is_inside(ground->grid, argus_grid_cell(robot_at(ground)))) {
        return ARGUS_SEARCH_NO_WAY; // no SIP has come yet
    }
    self->work = 0;
    if (!goes_on(self, ground, waypoint)) {
        begin(self, ground, waypoint);
        if (is_in_sight(self)) {
            self->is_on = false;
            return ARGUS_SEARCH_FOUND;
        }
    }
    self->sip = ground->knowledge->sips;
    const argus_search_news_t news = search_on(self);
    self->is_on = news == ARGUS_SEARCH_GOES_ON;
    return news;
}

static bool is_clear(const argus_ground_t *const ground, const argus_cell_t about, const int32_t radius_mm) {
    ARGUS_ASSERT(radius_mm > 0);
    const int most = (int)(radius_mm / CELL_MM);
    for (int dy = -most; dy <= most; dy++) {
        const int by = argus_wave_reach(radius_mm, dy);
        for (int dx = -by; dx <= by; dx++) {
            const argus_cell_t cell = {about.x + dx, about.y + dy};
            if (argus_grid_is_occupied(ground->grid, cell)) {
                return false;
            }
        }
    }
    return true;
}

bool argus_way_is_free(const argus_ground_t *const ground, const argus_leg_t *const leg) {
    const argus_point_t to = leg->to;
    const int32_t radius_mm =
        leg->narrow ? argus_wave_narrow_mm(ground->knowledge) : argus_wave_wide_mm(ground->knowledge);
    const argus_point_t from = robot_at(ground);
    const argus_point_t by = from_to(from, to);
    const int32_t length_mm = argus_max(1, argus_hypot(by.x_mm, by.y_mm));
    const int32_t end_mm = argus_min(AHEAD_MM, length_mm - ARGUS_WAVE_OUT_MM);
    for (int32_t mm = ARGUS_WAVE_OUT_MM + SAMPLE_MM; mm <= end_mm; mm += SAMPLE_MM) {
        const argus_point_t on = {from.x_mm + by.x_mm * mm / length_mm, from.y_mm + by.y_mm * mm / length_mm};
        if (!is_clear(ground, argus_grid_cell(on), radius_mm)) {
            return false;
        }
    }
    return true;
}
