// SPDX-License-Identifier: MIT
// The tests of a sonar's own trail: stuck, garbage, intermittent, and the loss of an echo.
#include <stddef.h>

#include "awareness/evidence_internal.h"
#include "knowledge/angle.h"

#define GO_ON_MM 60     // a reading goes on with the one before within this,
#define GO_ON_PERCENT 3 // ... this part of it,
#define GO_ON_QUARTER 4 // ... and one fourth of the way driven
#define SAME_CDEG 300   // readings on headings farther apart are not of one bearing
#define FAMILIAR_MM 100
#define NOVEL_MM 450 // nobody walks so far between two firings
#define NOVEL_BACK 2
#define WALK_MIN_MM 70
#define FAR_MM 4200 // echoes from beyond come and go
#define JUMP_MM 80
#define TRACKED 3
#define LOST_RUN_OTHERS 4
#define USUAL_MAX 10
#define LOST_RUN 2 // readings without an echo after which one that was followed is lost
#define HEARD_BACK 5
#define HEARD_CDEG 1000
#define DEAF_CDEG 6000 // no echo through such a turn
#define DEAF_RUN 5     // ... through so many readings: one more is a view, two would not say more

// Hundredths of a nat; see DESIGN.md, Evidence.
#define STUCK_MOVED 210
#define STUCK_ABEAM 90
#define NOVEL 180
#define SILENT_RUN 4 // and one more: what reads at random is not without an echo so often in a row
#define FAMILIAR (-300)
#define BETWEEN 50
#define BETWEEN_MAX 600
#define DROPOUT_REST 400
#define REST_PLACE_MM 200u
#define DROPOUT_REST_MOST 3 // of one place: at the edge of what is heard echoes come and go
#define DROPOUT_MOVING 320
#define DROPOUT_MOVING_MAX 1100
#define STEADY_ECHO (-12)

const argus_trail_t *argus_trail_at(const argus_case_t *const self, const int back) {
    if (back < 1 || back > self->trail_count) {
        return NULL;
    }
    return &self->trail[(self->trail_next + ARGUS_TRAIL - back) % ARGUS_TRAIL];
}

int32_t argus_trail_offset_mm(const uint16_t now_mm, const uint16_t before_mm) {
    const int32_t delta = (int32_t)((uint32_t)(now_mm - before_mm) & 0xFFFFu);
    return delta > INT16_MAX ? delta - 0x10000 : delta;
}

int32_t argus_trail_moved_mm(const argus_trail_t *const now, const argus_trail_t *const before) {
    return argus_hypot(argus_trail_offset_mm(now->x_mm, before->x_mm),
                       argus_trail_offset_mm(now->y_mm, before->y_mm));
}

int32_t argus_trail_turned_cdeg(const argus_trail_t *const now, const argus_trail_t *const before) {
    return argus_angle_abs_diff(now->heading_cdeg, before->heading_cdeg);
}

int32_t argus_trail_predict_mm(const argus_trail_t *const now, const argus_trail_t *const before,
                               const int sonar) {
    const int32_t axis = now->heading_cdeg + argus_sonar_pose[sonar].heading_deg * 100;
    const int32_t dx = argus_trail_offset_mm(now->x_mm, before->x_mm);
    const int32_t dy = argus_trail_offset_mm(now->y_mm, before->y_mm);
    return before->reading_mm - (dx * argus_cos(axis) + dy * argus_sin(axis)) / ARGUS_TRIG_ONE;
}

bool argus_trail_goes_on(const argus_trail_t *const now, const argus_trail_t *const before, const int sonar) {
    if (!before->steady || argus_trail_turned_cdeg(now, before) > SAME_CDEG) {
        return false;
    }
    const bool none = now->reading_mm >= ARGUS_NO_ECHO_MM;
    if (none || before->reading_mm >= ARGUS_NO_ECHO_MM) {
        return none && before->reading_mm >= ARGUS_NO_ECHO_MM;
    }
    const int32_t limit =
        GO_ON_MM + now->reading_mm * GO_ON_PERCENT / 100 + argus_trail_moved_mm(now, before) / GO_ON_QUARTER;
    return argus_abs(now->reading_mm - argus_trail_predict_mm(now, before, sonar)) <= limit;
}

bool argus_trail_is_echo(const argus_trail_t *const at) {
    return at->reading_mm < ARGUS_NO_ECHO_MM;
}

// A sonar that looks across the way sees the same distance along a wall.
static bool looks_abeam(const int sonar) {
    return argus_abs(argus_cos(argus_sonar_pose[sonar].heading_deg * 100)) < ARGUS_TRIG_ONE * 4 / 10;
}

static void test_stuck(argus_case_t *const self, const argus_trail_t *const now,
                       const argus_trail_t *const before, const int sonar) {
    if (now->reading_mm != before->reading_mm || !argus_trail_is_echo(now) ||
        now->reading_mm <= ARGUS_CLIPPED_MM) {
        self->score[ARGUS_TEST_STUCK] = 0;
        return;
    }
    const bool turned = argus_trail_turned_cdeg(now, before) >= ARGUS_STILL_CDEG;
    if (turned || argus_trail_moved_mm(now, before) >= ARGUS_STILL_MM) {
        argus_score(self, ARGUS_TEST_STUCK, looks_abeam(sonar) && !turned ? STUCK_ABEAM : STUCK_MOVED);
    }
}

static bool is_near(const argus_trail_t *const now, const argus_trail_t *const then, const int sonar) {
    const int32_t limit = FAMILIAR_MM + argus_trail_moved_mm(now, then);
    return argus_trail_is_echo(then) &&
           argus_abs(now->reading_mm - argus_trail_predict_mm(now, then, sonar)) <= limit;
}

static bool is_far_from(const argus_trail_t *const now, const argus_trail_t *const then, const int sonar) {
    return argus_abs(now->reading_mm - argus_trail_predict_mm(now, then, sonar)) > NOVEL_MM;
}

// What the last echoes on this heading say to one more.
typedef struct {
    int comparable;
    bool familiar;
    bool novel;
} likeness_t;

static likeness_t liken(const argus_case_t *const self, const argus_trail_t *const now, const int sonar) {
    likeness_t like = {0, false, true};
    for (int i = 1; i <= self->trail_count && like.comparable < NOVEL_BACK; i++) {
        const argus_trail_t *const then = argus_trail_at(self, i);
        if (argus_trail_is_echo(then) && then->steady && argus_trail_turned_cdeg(now, then) <= SAME_CDEG) {
            like.comparable++;
            like.familiar = like.familiar || is_near(now, then, sonar);
            like.novel = like.novel && is_far_from(now, then, sonar);
        }
    }
    return like;
}

// Readings between familiar and novel name nobody: so looks somebody who walks, too.
static void test_garbage(argus_case_t *const self, const argus_trail_t *const now, const int sonar,
                         const bool unrest) {
    if (!argus_trail_is_echo(now)) {
        if (self->out && self->none_run >= SILENT_RUN) {
            argus_score(self, ARGUS_TEST_GARBAGE, FAMILIAR);
        }
        return;
    }
    const likeness_t like = liken(self, now, sonar);
    if (like.familiar) {
        argus_score(self, ARGUS_TEST_GARBAGE, FAMILIAR);
    } else if (like.comparable > 0 && !unrest &&
               (like.novel || self->score[ARGUS_TEST_GARBAGE] < BETWEEN_MAX)) {
        argus_score(self, ARGUS_TEST_GARBAGE, like.novel ? NOVEL : BETWEEN);
    }
}

// How far a reading at rest is from the one before; 0 when they cannot be compared.
static int32_t drift_at_rest(const argus_trail_t *const now, const argus_trail_t *const before,
                             const int sonar) {
    const bool comparable = now->rest && before->rest && argus_trail_is_echo(now) &&
                            argus_trail_is_echo(before) && argus_trail_turned_cdeg(now, before) <= SAME_CDEG;
    return comparable ? now->reading_mm - argus_trail_predict_mm(now, before, sonar) : 0;
}

// What walks goes on the same way from one reading to the next, whatever the robot does.
static void test_walker(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                        const argus_trail_t *const now, const argus_trail_t *const before, const int sonar) {
    argus_case_t *const c = &self->of[sonar];
    const int32_t drift = drift_at_rest(now, before, sonar);
    const bool walks = argus_abs(drift) >= WALK_MIN_MM + now->reading_mm / 50 && argus_abs(drift) <= NOVEL_MM;
    if (walks && (drift > 0) == (c->drift_mm > 0) && c->drift_mm != 0) {
        argus_note_unrest(self, knowledge, sonar);
    }
    c->drift_mm = (int16_t)(walks ? drift : 0);
}

// The last echo before a run of none, or NULL.
static const argus_trail_t *echo_before_gap(const argus_case_t *const self) {
    return self->none_run > 0 && self->none_run < ARGUS_TRAIL ? argus_trail_at(self, self->none_run + 1)
                                                              : NULL;
}

// A look aside that heard nothing is no gap in what the sonar hears ahead.
static bool is_all_on_heading(const argus_case_t *const self, const argus_trail_t *const now,
                              const int count) {
    for (int i = 1; i <= count; i++) {
        if (argus_trail_turned_cdeg(now, argus_trail_at(self, i)) > SAME_CDEG) {
            return false;
        }
    }
    return true;
}

// In motion an echo at the edge of what is heard comes and goes by itself: that alone convicts no one, nor
// does one place.
static void score_dropout(argus_case_t *const self, const argus_trail_t *const now,
                          const argus_trail_t *const then, const bool unrest) {
    if (unrest) {
        return; // somebody may have stood in between
    }
    if (now->rest && then->rest) {
        if (self->rest_gaps < DROPOUT_REST_MOST) {
            self->rest_gaps++;
            argus_score(self, ARGUS_TEST_DROPOUT, DROPOUT_REST);
        }
    } else if (self->score[ARGUS_TEST_DROPOUT] < DROPOUT_MOVING_MAX) {
        const int32_t left = DROPOUT_MOVING_MAX - self->score[ARGUS_TEST_DROPOUT];
        argus_score(self, ARGUS_TEST_DROPOUT, argus_min(left, DROPOUT_MOVING));
    }
}

static void test_dropout(argus_case_t *const self, const argus_trail_t *const now, const int sonar,
                         const bool unrest) {
    if (!argus_trail_is_echo(now)) {
        return;
    }
    const argus_trail_t *const then = self->none_run > 0 ? echo_before_gap(self) : NULL;
    if (then != NULL && now->reading_mm < FAR_MM && is_all_on_heading(self, now, self->none_run + 1) &&
        is_near(now, then, sonar)) {
        score_dropout(self, now, then, unrest);
    } else {
        argus_score(self, ARGUS_TEST_DROPOUT, STEADY_ECHO);
    }
}

// Echoes that it heard on about this heading just before it heard none any more.
static int heard_before(const argus_case_t *const c, const argus_trail_t *const now) {
    int heard = 0;
    for (int i = c->none_run; i < c->none_run + HEARD_BACK; i++) {
        const argus_trail_t *const then = argus_trail_at(c, i);
        heard += then != NULL && argus_trail_is_echo(then) && then->reading_mm < FAR_MM &&
                 argus_trail_turned_cdeg(now, then) <= HEARD_CDEG;
    }
    return heard;
}

// An echo that it followed is gone for longer than sonars have lost theirs of late: smooth walls make them
// lose echoes again and again.
static bool is_unusual(const argus_case_t *const c, const int usual_run, const int sonar) {
    const bool ahead = (ARGUS_FORWARD_MASK >> sonar & 1u) != 0;
    return c->followed && c->none_run == (ahead ? LOST_RUN : LOST_RUN_OTHERS) + usual_run;
}

static void follow_lost(argus_evidence_t *const self, argus_case_t *const c, const argus_trail_t *const now,
                        const argus_trail_t *const before, const int sonar) {
    const int32_t turned = c->deaf_cdeg + argus_trail_turned_cdeg(now, before);
    const bool deaf = c->deaf_cdeg < DEAF_CDEG && turned >= DEAF_CDEG;
    c->deaf_cdeg = (uint16_t)argus_min(turned, UINT16_MAX);
    c->track = 0;
    if (c->none_run == 1) {
        c->followed = heard_before(c, now) >= TRACKED;
    }
    if (deaf || is_unusual(c, self->usual_run, sonar)) {
        self->lost |= (uint16_t)(1u << sonar);
    }
}

static void follow_jump(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                        const argus_trail_t *const now, const argus_trail_t *const before, const bool goes_on,
                        const int sonar) {
    argus_case_t *const c = &self->of[sonar];
    const int32_t step = argus_abs(now->reading_mm - before->reading_mm);
    if (goes_on) {
        c->track = (uint8_t)argus_min(c->track + 1, UINT8_MAX - 1);
        if (c->jump_track == 1 && c->track >= TRACKED) {
            c->jump_track = 0;
            self->jumped |= argus_views_support(self, knowledge, sonar) ? 0 : (uint16_t)(1u << sonar);
        }
        return;
    }
    c->jump_track = c->track >= TRACKED && step > JUMP_MM + now->reading_mm / 12 ? 1 : 0;
    c->track = 1;
}

// Follows one echo: its loss and a jump to another one are what an active look may settle.
static void follow(argus_evidence_t *const self, const argus_knowledge_t *const knowledge,
                   const argus_trail_t *const now, const argus_trail_t *const before, const bool goes_on,
                   const int sonar) {
    argus_case_t *const c = &self->of[sonar];
    if (!argus_trail_is_echo(now)) {
        follow_lost(self, c, now, before, sonar);
        return;
    }
    c->deaf_cdeg = 0;
    if (!now->steady) {
        c->track = 0;
        c->jump_track = 0;
    } else {
        follow_jump(self, knowledge, now, before, goes_on, sonar);
    }
}

void argus_trail_learn_run(argus_evidence_t *const self, const int sonar) {
    self->usual_run = (uint8_t)argus_max(self->usual_run, argus_min(self->of[sonar].none_run, USUAL_MAX));
}

static void count_echo(argus_case_t *const self, const argus_knowledge_t *const knowledge,
                       const argus_trail_t *const now, const bool goes_on) {
    const bool echo = argus_trail_is_echo(now);
    if (echo) {
        self->score[ARGUS_TEST_OFF] = 0;
    }
    self->none_run = echo ? 0 : (uint8_t)argus_min(self->none_run + 1, UINT8_MAX);
    self->echo_bits = (uint8_t)((unsigned)self->echo_bits << 1 | (echo ? 1u : 0u));
    self->echoes = (uint8_t)argus_count_bits(self->echo_bits);
    if (echo && goes_on) {
        self->alive_odometer_mm = knowledge->odometer_mm;
        self->alive_ms = knowledge->sip_ms;
    }
}

bool argus_trail_test(argus_evidence_t *const self, const argus_knowledge_t *const knowledge, const int sonar,
                      const argus_trail_t *const now) {
    argus_case_t *const c = &self->of[sonar];
    const argus_trail_t *const before = argus_trail_at(c, 1);
    if (before == NULL) {
        return false;
    }
    const bool goes_on = now->steady && argus_trail_goes_on(now, before, sonar);
    if (argus_trail_is_echo(now) && (ARGUS_FORWARD_MASK >> sonar & 1u) != 0) {
        argus_trail_learn_run(self, sonar);
    }
    test_stuck(c, now, before, sonar);
    const bool unrest = argus_is_unrest_beside(self, knowledge, sonar);
    argus_lag_test(c, now, unrest, sonar);
    test_walker(self, knowledge, now, before, sonar);
    if (knowledge->odometer_mm - c->rest_odometer_mm >= REST_PLACE_MM) {
        c->rest_odometer_mm = knowledge->odometer_mm;
        c->rest_gaps = 0;
    }
    if (now->steady) {
        test_garbage(c, now, sonar, unrest);
        test_dropout(c, now, sonar, unrest);
    }
    count_echo(c, knowledge, now, goes_on);
    follow(self, knowledge, now, before, goes_on, sonar);
    return goes_on || (now->steady && c->none_run >= DEAF_RUN);
}
