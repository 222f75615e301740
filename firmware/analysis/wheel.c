// SPDX-License-Identifier: MIT
// Sizes what a wheel falls short by: a way with a bend of k radians a mm has wheels apart by k times the
// track.
#include "analysis/wheel.h"

#include "knowledge/angle.h"

#define CDEG_PER_RADIAN 5730
#define LEAST_PM 5
#define ALIKE_PM 10 // two sizes differ by this, or a third, at most
#define TURN_MOST_CDEG 9000
#define NEW_PARTS 4 // of the size each piece after the first two makes one

// The faster wheel makes the way and half of the difference.
static int32_t size_pm(const argus_knowledge_t *const knowledge, const argus_way_turn_t *const piece) {
    ARGUS_ASSERT(piece->way_mm > 0);
    const int32_t turn_cdeg = argus_within(TURN_MOST_CDEG, piece->turn_cdeg);
    const int32_t apart_um = turn_cdeg * knowledge->robot->track_mm * 100 / (CDEG_PER_RADIAN / 10);
    const int32_t pm = apart_um / (piece->way_mm + argus_abs(apart_um) / 2000);
    return knowledge->robot->reversed ? -pm : pm;
}

// Of a size `a` that counts.
static bool are_alike(const int32_t a, const int32_t b) {
    ARGUS_ASSERT(argus_abs(a) >= LEAST_PM);
    const int32_t room = argus_max(ALIKE_PM, argus_max(argus_abs(a), argus_abs(b)) / 3);
    return argus_abs(b) >= LEAST_PM && argus_abs(a - b) <= room && (a > 0) == (b > 0);
}

// The first two pieces count as one: what is read at the seam of two cancels.
static argus_wheel_news_t name(argus_wheel_t *const self, const argus_knowledge_t *const knowledge,
                               const argus_way_turn_t *const piece) {
    const bool named = self->kind == ARGUS_KIND_WRONG;
    const argus_way_turn_t both = {self->last.way_mm + piece->way_mm,
                                   self->last.turn_cdeg + piece->turn_cdeg};
    const int32_t pm = size_pm(knowledge, named ? piece : &both);
    self->short_pm = (int16_t)(named ? self->short_pm + (pm - self->short_pm) / NEW_PARTS : pm);
    self->health = ARGUS_SUSPECT;
    self->kind = ARGUS_KIND_WRONG;
    return named ? ARGUS_WHEEL_SAME : ARGUS_WHEEL_NAMED;
}

static argus_wheel_news_t clear(argus_wheel_t *const self) {
    const bool named = self->kind == ARGUS_KIND_WRONG;
    self->health = ARGUS_HEALTHY;
    self->kind = ARGUS_KIND_NONE;
    self->short_pm = 0;
    return named ? ARGUS_WHEEL_CLEARED : ARGUS_WHEEL_SAME;
}

static argus_wheel_news_t take(argus_wheel_t *const self, const argus_knowledge_t *const knowledge,
                               const argus_way_turn_t *const piece) {
    const int32_t pm = size_pm(knowledge, piece);
    const int32_t before = self->last.way_mm > 0 ? size_pm(knowledge, &self->last) : 0;
    if (argus_abs(pm) > ARGUS_WHEEL_MOST_PM) {
        return ARGUS_WHEEL_SAME;
    }
    if (argus_abs(pm) < LEAST_PM) {
        const bool even = argus_abs(before) < LEAST_PM || self->kind == ARGUS_KIND_NONE;
        return even ? clear(self) : ARGUS_WHEEL_SAME;
    }
    if (self->kind == ARGUS_KIND_NONE) {
        self->health = ARGUS_SUSPECT;
    }
    return are_alike(pm, before) ? name(self, knowledge, piece) : ARGUS_WHEEL_SAME;
}

argus_wheel_news_t argus_wheel_judge(argus_wheel_t *const self, const argus_knowledge_t *const knowledge,
                                     const argus_way_turn_t *const piece) {
    const argus_way_turn_t now = {piece->way_mm, argus_within(TURN_MOST_CDEG, piece->turn_cdeg)};
    const argus_wheel_news_t news = take(self, knowledge, &now);
    self->odometer_mm = knowledge->odometer_mm;
    self->last = now;
    return news;
}
