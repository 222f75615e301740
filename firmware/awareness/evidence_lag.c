// SPDX-License-Identifier: MIT
// Whether a sonar hands out its echoes some firings late: its readings do what the robot did then.
#include <stddef.h>

#include "awareness/evidence_said.h"
#include "knowledge/angle.h"

#define SPIN_CDEG 1000
#define SPREAD_MM 60 // a stretch that varies less is not known again

// Hundredths of a nat; see DESIGN.md, Evidence.
#define STEP_MOST 300
#define FORGOTTEN 4 // with each reading
#define REPEATS 5
static const int16_t repeated[REPEATS] = {0, 0, 580, 870, 0}; // [i]: the i-th reading in a row given before

// What the robot did between two firings of a sonar.
typedef enum { STILL, STRAIGHT, TURN, SPIN, MOTIONS } motion_t;

// How much better a motion explains that a reading is so far from what it predicts, one row each, than
// nothing does: a reading at random, counted as exp(-9.5) for a millimetre.
#define CHANGES 13
static const int16_t change_from_mm[CHANGES] = {0, 8, 16, 25, 40, 60, 90, 140, 220, 350, 600, 1000, 2000};
static const int16_t explains_change[MOTIONS][CHANGES] = {
    [STILL] = {660, 620, 540, 400, 200, 50, -10, -60, -90, -140, -160, -250, -450},
    [STRAIGHT] = {630, 610, 560, 470, 340, 190, 50, -30, -60, -110, -120, -220, -420},
    [TURN] = {610, 590, 530, 440, 340, 270, 210, 160, 110, 40, 10, -120, -330},
    [SPIN] = {510, 500, 470, 430, 370, 300, 260, 230, 190, 130, 90, -30, -240},
};
// ... that it loses its echo, or hears one again: one gap in twenty readings needs no reason.
static const int16_t explains_loss[MOTIONS] = {-200, -170, 0, 110};
static const int16_t explains_find[MOTIONS] = {-100, -80, 90, 160};

static motion_t motion_of(const argus_trail_t *const here, const argus_trail_t *const there) {
    const int32_t turned_cdeg = argus_trail_turned_cdeg(here, there);
    if (turned_cdeg >= ARGUS_STILL_CDEG) {
        return turned_cdeg >= SPIN_CDEG ? SPIN : TURN;
    }
    return argus_trail_moved_mm(here, there) >= ARGUS_STILL_MM ? STRAIGHT : STILL;
}

static int32_t worth_of_change(const motion_t motion, const int32_t change_mm) {
    int i = CHANGES - 1;
    while (i > 0 && argus_abs(change_mm) < change_from_mm[i]) {
        i--;
    }
    return explains_change[motion][i];
}

// How well it explains `now` after `before` that the robot went from `there` to `here`.
static int32_t worth_of(const argus_trail_t *const now, const argus_trail_t *const before,
                        const argus_trail_t *const here, const argus_trail_t *const there, const int sonar) {
    const motion_t motion = motion_of(here, there);
    if (!argus_trail_is_echo(now)) {
        return explains_loss[motion];
    }
    if (!argus_trail_is_echo(before)) {
        return explains_find[motion];
    }
    const int32_t predicted_mm = argus_trail_predict_mm(here, there, sonar) - there->reading_mm;
    return worth_of_change(motion, now->reading_mm - before->reading_mm - predicted_mm);
}

// ... without a lag: the motion now, or nothing at all; and a wall that is seen aslant, whose range may
// change by all that the robot drives, or not at all. That speaks against no lag: a late sonar sees walls,
// too.
typedef struct {
    int32_t motion;
    int32_t wall;
} without_lag_t;

static int32_t worth_of_wall(const argus_trail_t *const now, const argus_trail_t *const before) {
    const int32_t change_mm = argus_abs(now->reading_mm - before->reading_mm);
    return worth_of_change(STILL, argus_max(0, change_mm - argus_trail_moved_mm(now, before)));
}

static without_lag_t without_lag(const argus_trail_t *const now, const argus_trail_t *const before,
                                 const int sonar) {
    const bool wall =
        argus_trail_is_echo(now) && argus_trail_is_echo(before) && motion_of(now, before) == STRAIGHT;
    const without_lag_t worth = {.motion = argus_max(0, worth_of(now, before, now, before, sonar)),
                                 .wall = wall ? worth_of_wall(now, before) : 0};
    return worth;
}

// The readings change with what the robot does: a healthy sonar's at once, a late one's some firings after.
static int32_t step_of(const argus_case_t *const self, const argus_trail_t *const now, const int lag,
                       const without_lag_t *const without, const int sonar) {
    const argus_trail_t *const before = argus_trail_at(self, 1);
    const argus_trail_t *const here = argus_trail_at(self, lag);
    const argus_trail_t *const there = argus_trail_at(self, lag + 1);
    if (there == NULL || (!argus_trail_is_echo(now) && !argus_trail_is_echo(before))) {
        return 0;
    }
    const int32_t worth = worth_of(now, before, here, there, sonar);
    if (worth <= without->motion) {
        return argus_max(-STEP_MOST, worth - without->motion);
    }
    return argus_max(0, argus_min(STEP_MOST, worth - argus_max(without->motion, without->wall)));
}

// Spread of the last `count` readings before `now`, and of it.
static int32_t spread_mm(const argus_case_t *const self, const argus_trail_t *const now, const int count) {
    int32_t least = now->reading_mm;
    int32_t most = now->reading_mm;
    for (int i = 1; i <= count; i++) {
        const argus_trail_t *const at = argus_trail_at(self, i);
        least = argus_min(least, at->reading_mm);
        most = argus_max(most, at->reading_mm);
    }
    return most - least;
}

// A stretch of the past comes again once: what has been read since as well goes to and fro.
static bool is_known_again(const argus_case_t *const self, const argus_trail_t *const now, const int lag) {
    for (int i = 1; i < lag; i++) {
        if (argus_trail_at(self, i)->reading_mm == now->reading_mm) {
            return false;
        }
    }
    return now->reading_mm > ARGUS_CLIPPED_MM && spread_mm(self, now, lag) >= SPREAD_MM;
}

// A sonar that hands out its echoes late repeats what it has read already when the lag begins, as many
// readings as it is late.
static int32_t replay_of(argus_case_t *const self, const argus_trail_t *const now, const int lag) {
    const argus_trail_t *const then = argus_trail_at(self, lag);
    if (then == NULL || !argus_trail_is_echo(now) || then->reading_mm != now->reading_mm) {
        self->lag_run[lag] = 0;
        return 0;
    }
    if (self->lag_run[lag] >= lag || !is_known_again(self, now, lag)) {
        return 0;
    }
    self->lag_run[lag] = (uint8_t)argus_min(self->lag_run[lag] + 1, REPEATS - 1);
    return repeated[self->lag_run[lag]];
}

// Less caution than 100 % would make a lag of what is chance: the levels of this test are as low as they may
// be.
void argus_lag_test(argus_case_t *const self, const argus_trail_t *const now, const bool unrest,
                    const int sonar) {
    const without_lag_t without = without_lag(now, argus_trail_at(self, 1), sonar);
    int32_t most = 0;
    for (int n = ARGUS_LEAST_LAG; n < ARGUS_TRAIL; n++) {
        const int32_t step = step_of(self, now, n, &without, sonar);
        const int32_t gain = (unrest ? argus_min(0, step) : step) + replay_of(self, now, n) - FORGOTTEN;
        const int32_t sum =
            self->lag[n] + gain * ARGUS_FULL_PERCENT / argus_max(ARGUS_FULL_PERCENT, self->caution);
        self->lag[n] = argus_limited(sum, argus_bounds[ARGUS_TEST_LAG].ceiling);
        most = argus_max(most, self->lag[n]);
    }
    self->score[ARGUS_TEST_LAG] = (int16_t)most;
}

void argus_lag_restore(argus_case_t *const self) {
    for (int n = ARGUS_LEAST_LAG; n < ARGUS_TRAIL; n++) {
        self->lag[n] = self->score[ARGUS_TEST_LAG];
    }
}
