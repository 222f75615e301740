// SPDX-License-Identifier: MIT
// The tests of a sonar's own readings: stuck, garbage, intermittent; the loss of an echo.
#include "awareness/own.h"

#include <stddef.h>

#include "awareness/clutter.h"
#include "awareness/lag.h"
#include "awareness/numbers.h"
#include "awareness/odds.h"
#include "knowledge/angle.h"

static void score(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                  const argus_test_t test, const bool odd) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_score(self, sonar, test, argus_odds_of(self, knowledge, sonar, test, odd));
    argus_odds_note(self, sonar, test, odd);
}

// What one abeam shows of a reading on its side. 1: it is of no wall along the way: one so near this one
// would hear, too, and the range of another would stay; -1: it may be; 0: this one hears none.
static int wall_of(const argus_pings_t *const pings, const int32_t reading_mm) {
    const argus_ping_t *const last = argus_pings_at(pings, 1);
    const argus_ping_t *const then = argus_pings_at(pings, 2);
    if (then == NULL) {
        return 0;
    }
    if (reading_mm <= ARGUS_PARALLEL_HEARD_MM && last->reading_mm > reading_mm + ARGUS_FAMILIAR_MM) {
        return 1;
    }
    if (!argus_ping_is_echo(last) || !argus_ping_is_echo(then)) {
        return 0;
    }
    return argus_abs(last->reading_mm - then->reading_mm) > ARGUS_PARALLEL_MM ? 1 : -1;
}

// What the sonars abeam on its side show of the wall there; of two that differ, that it stays.
static int wall_beside(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                       const int sonar, const int32_t reading_mm) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const argus_robot_t *const robot = knowledge->robot;
    const unsigned abeam =
        (argus_robot_flank(robot) | argus_robot_rear_flank(robot)) & ~(unsigned)argus_out(knowledge);
    const bool left = argus_robot_pose(robot, sonar).y_mm > 0;
    int shows = 0;
    for (int i = 0; i < knowledge->sonars && shows >= 0; i++) {
        if ((abeam >> i & 1u) != 0 && i != sonar && (argus_robot_pose(robot, i).y_mm > 0) == left) {
            const int wall = wall_of(&self->pings[i], reading_mm);
            shows = wall != 0 ? wall : shows;
        }
    }
    return shows;
}

// The same reading has come since the robot looked elsewhere: while it turns past square-on to a wall, its
// range stays.
static bool stays_in_turn(const argus_pings_t *const pings, const argus_ping_t *const now) {
    for (int i = 1; i <= ARGUS_LOOKED_BACK; i++) {
        const argus_ping_t *const then = argus_pings_at(pings, i);
        if (then == NULL || then->reading_mm != now->reading_mm) {
            return false;
        }
        if (argus_ping_turned_cdeg(now, then) >= ARGUS_STUCK_TURNED_CDEG) {
            return true;
        }
    }
    return false;
}

// A healthy sonar's range would have changed since `before`. Not that of a wall along the way, which a sonar
// aslant hears at the rim of its cone, nor that of one it turns past.
static bool must_change(const argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                        const int sonar, const argus_ping_t *const now, const argus_ping_t *const before) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    if (argus_ping_turned_cdeg(now, before) >= ARGUS_STILL_CDEG) {
        return now->reading_mm != before->reading_mm || stays_in_turn(&self->pings[sonar], now);
    }
    if (argus_abs(argus_ping_shift(now, before).along_mm) < ARGUS_STILL_MM) {
        return false;
    }
    const int32_t bearing = argus_robot_pose(knowledge->robot, sonar).heading_deg * 100;
    const bool ahead = argus_abs(argus_cos(bearing)) > ARGUS_TRIG_ONE * ARGUS_SHORTEST_ALONG_PERCENT / 100;
    return wall_beside(self, knowledge, sonar, now->reading_mm) >= (ahead ? 0 : 1);
}

// Of what goes on alike: how often the very same value comes again depends on noise and on the steps of
// range.
static void test_stuck(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                       const int sonar, const argus_ping_t *const now, const argus_ping_t *const before) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_case_t *const c = &self->of[sonar];
    const bool tells = argus_ping_is_echo(now) && now->reading_mm > ARGUS_CLIPPED_MM;
    const int32_t changed_mm = argus_abs(now->reading_mm - c->last_mm);
    if (!tells || changed_mm > 0) {
        c->score[ARGUS_TEST_STUCK] = 0;
    }
    if (!tells || changed_mm > ARGUS_ALIKE_MM) {
        return;
    }
    // Where a healthy one repeats itself, too, that tells how often, and nothing of it.
    if (must_change(self, knowledge, sonar, now, before)) {
        score(self, knowledge, sonar, ARGUS_TEST_STUCK, changed_mm == 0);
    } else if (argus_ping_moved_mm(now, before) >= ARGUS_STILL_MM) {
        argus_odds_note(self, sonar, ARGUS_TEST_STUCK, changed_mm == 0);
    }
}

static int32_t off_mm(const argus_ping_t *const now, const argus_ping_t *const then) {
    return argus_abs(now->reading_mm - argus_ping_predict_mm(now, then));
}

static bool is_familiar(const argus_ping_t *const now, const argus_ping_t *const then) {
    ARGUS_ASSERT(argus_ping_is_echo(then));
    return off_mm(now, then) <= ARGUS_FAMILIAR_MM + argus_ping_moved_mm(now, then);
}

// What the last echoes on this bearing say to one more.
typedef struct {
    int comparable;
    bool familiar;
    bool novel;
} likeness_t;

static likeness_t liken(const argus_pings_t *const pings, const argus_ping_t *const now) {
    likeness_t like = {0, false, true};
    for (int i = 1; i <= ARGUS_LOOKED_BACK && like.comparable < ARGUS_COMPARED; i++) {
        const argus_ping_t *const then = argus_pings_at(pings, i);
        if (then == NULL) {
            break;
        }
        if (argus_ping_is_echo(then) && then->steady &&
            argus_ping_turned_cdeg(now, then) <= ARGUS_SAME_CDEG) {
            like.comparable++;
            like.familiar = like.familiar || is_familiar(now, then);
            like.novel = like.novel && off_mm(now, then) > ARGUS_LEAP_MM;
        }
    }
    return like;
}

// Readings between familiar and novel name nothing: a person who walks looks the same.
static void test_garbage(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                         const int sonar, const argus_ping_t *const now, const bool unrest) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_case_t *const c = &self->of[sonar];
    if (!argus_ping_is_echo(now)) {
        if (c->out &&
            c->none_run >= ARGUS_SILENT_RUN) { // one that reads at random is not so often silent in a row
            score(self, knowledge, sonar, ARGUS_TEST_GARBAGE, false);
        }
        return;
    }
    const likeness_t like = liken(&self->pings[sonar], now);
    if (like.familiar) {
        score(self, knowledge, sonar, ARGUS_TEST_GARBAGE, false);
    } else if (like.comparable > 0 && like.novel && !unrest) {
        score(self, knowledge, sonar, ARGUS_TEST_GARBAGE, true);
    }
}

// What walks goes on the same way from one reading to the next, whatever the robot does.
static void test_walker(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                        const int sonar, const argus_ping_t *const now, const argus_ping_t *const before) {
    ARGUS_ASSERT((unsigned)sonar < ARGUS_SONARS);
    argus_case_t *const c = &self->of[sonar];
    const bool comparable =
        now->rest && before->rest && argus_ping_is_echo(now) && argus_ping_is_echo(before);
    const int32_t drift = comparable ? now->reading_mm - before->reading_mm : 0;
    const bool walks =
        argus_abs(drift) >= ARGUS_WALK_MM + now->reading_mm / 50 && argus_abs(drift) <= ARGUS_LEAP_MM;
    if (walks && c->drift_mm != 0 && (drift > 0) == (c->drift_mm > 0)) {
        argus_clutter_note(self, knowledge, sonar);
    }
    c->drift_mm = (int16_t)(walks ? drift : 0);
}

// The echo before the run of none that ends now, all of it on this bearing; NULL: none.
static const argus_ping_t *echo_before_gap(const argus_pings_t *const pings, const argus_ping_t *const now) {
    for (int i = 1; i <= ARGUS_LOOKED_BACK; i++) {
        const argus_ping_t *const then = argus_pings_at(pings, i);
        if (then == NULL || argus_ping_turned_cdeg(now, then) > ARGUS_SAME_CDEG) {
            return NULL;
        }
        if (argus_ping_is_echo(then)) {
            return i > 1 ? then : NULL;
        }
    }
    return NULL;
}

// At the edge of what is heard an echo comes and goes by itself: after a few gaps a place tells no more.
static void test_dropout(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                         const int sonar, const argus_ping_t *const now, const bool unrest) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_case_t *const c = &self->of[sonar];
    if (!argus_ping_is_echo(now) || c->gaps >= ARGUS_GAPS_MOST) {
        return;
    }
    const argus_ping_t *const then = echo_before_gap(&self->pings[sonar], now);
    if (then == NULL || now->reading_mm >= ARGUS_SURE_MM || !is_familiar(now, then)) {
        score(self, knowledge, sonar, ARGUS_TEST_DROPOUT, false);
        return;
    }
    if (unrest) {
        return; // a person may have stood in between
    }
    c->gaps++;
    const int32_t adds = argus_odds_of(self, knowledge, sonar, ARGUS_TEST_DROPOUT, true);
    argus_odds_note(self, sonar, ARGUS_TEST_DROPOUT, true);
    const int32_t left =
        now->rest && then->rest ? ARGUS_CEILING : ARGUS_DROPOUT_MOVING_MAX - c->score[ARGUS_TEST_DROPOUT];
    argus_score(self, sonar, ARGUS_TEST_DROPOUT, argus_between(0, left, adds));
}

static void run_tests(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                      const argus_ping_t *const now, const argus_ping_t *const before) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_case_t *const c = &self->of[sonar];
    const bool unrest = argus_clutter_beside(self, knowledge, sonar, ARGUS_UNREST_MS);
    test_stuck(self, knowledge, sonar, now, before);
    if (argus_robot_is_sector(knowledge->robot, sonar)) {
        return; // the nearest in a sector leaps where things enter it
    }
    argus_lag_take(self, knowledge, sonar, now);
    test_walker(self, knowledge, sonar, now, before);
    if (knowledge->odometer_mm - c->place_odometer_mm >= ARGUS_SAME_ALONG_MM) {
        c->place_odometer_mm = knowledge->odometer_mm;
        c->gaps = 0;
    }
    if (now->steady) {
        test_garbage(self, knowledge, sonar, now, unrest);
        test_dropout(self, knowledge, sonar, now, unrest);
    }
}

void argus_own_take(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                    const argus_ping_t *const now) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    argus_case_t *const c = &self->of[sonar];
    const argus_ping_t *const before = argus_pings_at(&self->pings[sonar], 1);
    if (before == NULL) {
        return;
    }
    run_tests(self, knowledge, sonar, now, before);
    c->none_run = argus_ping_is_echo(now) ? 0 : argus_one_more(c->none_run);
}
