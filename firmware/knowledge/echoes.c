// SPDX-License-Identifier: MIT
// Remembers the echoes of the last minute as points, and says how much room they leave.
#include "knowledge/echoes.h"

#include <string.h>

#include "knowledge/angle.h"

#define REMEMBER_BELOW_MM 2000 // beyond it a beam is too wide to say where the echo lies
#define SAME_PLACE_MM 80
#define SAME_THING_MM 150
#define ABOUT_MM 1000      // a turn is asked for no farther
#define LATELY_MS 5000u    // what was seen so near does not go away while a look is prepared
#define NEARER_MM 10       // of two echoes of one place
#define PAST_MM 40         // a sonar hears so far past a place: nothing stands there
#define CONE_SLOPE 27      // tan 12 degrees, / 128: within 15 where the beam still tells
#define BEHIND_MM 100      // an echo this far ahead of the centre is beside the robot already
#define BY_TOUCH UINT8_MAX // no sonar: it is there for sure

void argus_echoes_init(argus_echoes_t *const self) {
    memset(self, 0, sizeof *self);
}

static bool same_place(const argus_echo_t *const seen, const argus_point_t *const at) {
    return argus_abs(seen->x_mm - at->x_mm) < SAME_PLACE_MM &&
           argus_abs(seen->y_mm - at->y_mm) < SAME_PLACE_MM;
}

// It still stands, nearer to the robot than the new echo: a corner that the robot has passed, whose face is
// heard behind it.
static bool stays(const argus_echo_t *const seen, const argus_point_t *const at, const argus_point_t centre) {
    const int32_t old_mm = argus_hypot(seen->x_mm - centre.x_mm, seen->y_mm - centre.y_mm);
    const int32_t new_mm = argus_hypot(at->x_mm - centre.x_mm, at->y_mm - centre.y_mm);
    return seen->stands && old_mm + NEARER_MM < new_mm;
}

// The slot that holds this place already, else a free one, else the oldest.
static argus_echo_t *slot_for(argus_echoes_t *const self, const argus_point_t *const at,
                              const argus_point_t centre) {
    ARGUS_ASSERT(self->count <= ARGUS_POINTS_MAX && self->next < ARGUS_POINTS_MAX);
    for (uint16_t i = 0; i < self->count; i++) {
        if (same_place(&self->at[i], at) && !stays(&self->at[i], at, centre)) {
            return &self->at[i];
        }
    }
    if (self->count < ARGUS_POINTS_MAX) {
        return &self->at[self->count++];
    }
    self->next = (uint16_t)((self->next + 1) % ARGUS_POINTS_MAX);
    return &self->at[self->next];
}

bool argus_are_one_thing(const argus_point_t a, const argus_point_t b) {
    return argus_abs(a.x_mm - b.x_mm) <= SAME_THING_MM && argus_abs(a.y_mm - b.y_mm) <= SAME_THING_MM;
}

// A second echo of one thing, lately; a wall gives one a little farther on, as far as the robot drove
// meanwhile. An echo from far off is put on the axis, but comes from anywhere across a wide cone: it does not
// tell where a thing is. What was seen twice before stays so for as long as it is remembered.
static bool is_seen_again(const argus_echo_t *const seen, const argus_point_t *const at, const bool near,
                          const uint32_t now_ms) {
    const uint32_t age_ms = now_ms - seen->seen_ms;
    const argus_point_t there = {seen->x_mm, seen->y_mm};
    return (near && argus_are_one_thing(there, *at) && age_ms <= LATELY_MS) ||
           (seen->again && age_ms <= ARGUS_FORGET_MS && same_place(seen, at));
}

// ... of something at most so far from there.
static bool has_seen(const argus_echoes_t *const self, const argus_point_t *const at, const bool near,
                     const uint32_t now_ms, const argus_point_t *const from, const int32_t within_mm) {
    ARGUS_ASSERT(within_mm > 0);
    for (uint16_t i = 0; i < self->count; i++) {
        const argus_echo_t *const seen = &self->at[i];
        if (is_seen_again(seen, at, near, now_ms) &&
            argus_hypot(seen->x_mm - from->x_mm, seen->y_mm - from->y_mm) <= within_mm) {
            return true;
        }
    }
    return false;
}

bool argus_echoes_have_seen(const argus_echoes_t *const self, const argus_knowledge_t *const knowledge,
                            const argus_point_t at, const int32_t within_mm) {
    ARGUS_ASSERT(within_mm > 0);
    const argus_point_t centre = {knowledge->pose.x_mm, knowledge->pose.y_mm};
    return has_seen(self, &at, true, knowledge->sip_ms, &centre, within_mm);
}

static void remember(argus_echoes_t *const self, const argus_point_t centre, const argus_point_t at,
                     const uint8_t sonar, const bool near, const uint32_t now_ms) {
    ARGUS_ASSERT(sonar < ARGUS_SONARS || sonar == BY_TOUCH);
    if (argus_abs(at.x_mm) > INT16_MAX || argus_abs(at.y_mm) > INT16_MAX) {
        return;
    }
    const bool again = sonar == BY_TOUCH || has_seen(self, &at, near, now_ms, &at, INT32_MAX);
    argus_echo_t *const slot = slot_for(self, &at, centre);
    slot->again = again;
    slot->stands = again;
    slot->x_mm = (int16_t)at.x_mm;
    slot->y_mm = (int16_t)at.y_mm;
    slot->sonar = sonar;
    slot->seen_ms = now_ms;
}

// No beam and no fading of the map takes that back.
static void mark_touches(argus_echoes_t *const self) {
    for (int i = 0; i < self->touches.count; i++) {
        argus_grid_mark(&self->grid, self->touches.at[i], true);
    }
}

argus_view_t argus_view(const argus_knowledge_t *const knowledge) {
    return (argus_view_t){argus_frame_at(&knowledge->pose), knowledge};
}

static bool is_about(const argus_echo_t *const seen, const argus_view_t *const from) {
    return argus_abs(seen->x_mm - from->robot.at.x_mm) < ABOUT_MM &&
           argus_abs(seen->y_mm - from->robot.at.y_mm) < ABOUT_MM;
}

static argus_point_t place_of(const argus_echo_t *const seen, const argus_view_t *const from) {
    return argus_into_frame(&from->robot, (argus_point_t){seen->x_mm, seen->y_mm});
}

// The place, robot frame, is in the cone of this sonar, and it hears something farther off. Silence is no
// proof: a smooth wall sends no echo back.
static bool hears_past(const argus_knowledge_t *const knowledge, const int sonar, const argus_point_t at) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    const argus_point_t seen = argus_from_sonar(knowledge, sonar, at);
    return seen.x_mm > 0 && argus_abs(seen.y_mm) <= seen.x_mm * CONE_SLOPE / 128 &&
           knowledge->sonar[sonar].reading_mm > seen.x_mm + PAST_MM;
}

static bool is_heard_past(const argus_knowledge_t *const knowledge, const argus_mask_t sonars,
                          const argus_point_t at) {
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((sonars >> i & 1u) != 0 && hears_past(knowledge, i, at)) {
            return true;
        }
    }
    return false;
}

// Readings that tell where something is.
static argus_mask_t telling(const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    unsigned mask = 0;
    for (int i = 0; i < knowledge->sonars && !knowledge->rotating; i++) {
        const bool tells = argus_usable(knowledge, i) && knowledge->sonar[i].health != ARGUS_SUSPECT;
        mask |= tells ? 1u << i : 0u;
    }
    return (argus_mask_t)(mask & knowledge->fresh);
}

// What was heard past has gone, or was put on the axis of a cone and stands elsewhere in it.
static void hear_past(argus_echoes_t *const self, const argus_knowledge_t *const knowledge,
                      const argus_mask_t sonars) {
    ARGUS_ASSERT(self->count <= ARGUS_POINTS_MAX);
    const argus_view_t from = argus_view(knowledge);
    for (uint16_t i = 0; i < self->count && sonars != 0; i++) {
        argus_echo_t *const seen = &self->at[i];
        if (seen->stands && is_about(seen, &from)) {
            seen->stands = !is_heard_past(knowledge, sonars, place_of(seen, &from));
        }
    }
}

void argus_echoes_see(argus_echoes_t *const self, const argus_knowledge_t *const knowledge,
                      const uint32_t now_ms) {
    ARGUS_ASSERT(knowledge->sonars <= ARGUS_SONARS);
    const argus_mask_t sonars = telling(knowledge);
    argus_grid_see(&self->grid, knowledge);
    mark_touches(self);
    hear_past(self, knowledge, sonars);
    const argus_point_t centre = {knowledge->pose.x_mm, knowledge->pose.y_mm};
    for (int i = 0; i < knowledge->sonars; i++) {
        if ((sonars >> i & 1u) != 0 && knowledge->sonar[i].reading_mm < REMEMBER_BELOW_MM) {
            remember(self, centre, argus_to_course(&knowledge->pose, argus_echo_robot(knowledge, i)),
                     (uint8_t)i, knowledge->sonar[i].reading_mm <= ARGUS_PLACED_MM, now_ms);
        }
    }
}

void argus_echoes_forget(argus_echoes_t *const self, const int sonar, const bool lied) {
    ARGUS_ASSERT(sonar >= 0 && sonar < ARGUS_SONARS);
    uint16_t kept = 0;
    argus_grid_clear(&self->grid); // it cannot be separated from what the others put there
    mark_touches(self);
    for (uint16_t i = 0; i < self->count; i++) {
        if (!lied || self->at[i].sonar != sonar) {
            self->at[kept++] = self->at[i];
        }
    }
    self->count = kept;
    ARGUS_ASSERT(kept <= ARGUS_POINTS_MAX);
    self->next = 0;
}

void argus_echoes_touched(argus_echoes_t *const self, const argus_point_t at, const uint32_t now_ms) {
    remember(self, at, at, BY_TOUCH, true, now_ms);
    argus_grid_mark(&self->grid, at, true);
}

void argus_echoes_met(argus_echoes_t *const self, const argus_knowledge_t *const knowledge,
                      const argus_contact_t how) {
    ARGUS_ASSERT(how <= ARGUS_CONTACT_GONE);
    switch (how) {
    case ARGUS_CONTACT_BUMPER:
        argus_touches_bumped(&self->touches, knowledge);
        break;
    case ARGUS_CONTACT_AHEAD:
    case ARGUS_CONTACT_BACK:
        argus_touches_end(&self->touches, knowledge, how == ARGUS_CONTACT_AHEAD ? 1 : -1);
        break;
    case ARGUS_CONTACT_TURN:
        argus_touches_sides(&self->touches, knowledge);
        break;
    case ARGUS_CONTACT_GONE:
        argus_touches_leave(&self->touches, knowledge);
        break;
    case ARGUS_CONTACT_NONE:
    default:
        return;
    }
    mark_touches(self);
}

int32_t argus_echoes_clear_mm(const argus_echoes_t *const self, const argus_knowledge_t *const knowledge,
                              const int32_t heading_cdeg, const int32_t half_mm) {
    ARGUS_ASSERT(half_mm > 0 && self->count <= ARGUS_POINTS_MAX);
    const int32_t c = argus_cos(heading_cdeg);
    const int32_t s = argus_sin(heading_cdeg);
    int32_t clear = argus_touches_clear_mm(&self->touches, knowledge, heading_cdeg, half_mm);
    for (uint16_t i = 0; i < self->count; i++) {
        const int32_t dx = argus_within(32000, self->at[i].x_mm - knowledge->pose.x_mm);
        const int32_t dy = argus_within(32000, self->at[i].y_mm - knowledge->pose.y_mm);
        const int32_t ahead = (dx * c + dy * s) / ARGUS_TRIG_ONE;
        const int32_t beside = (dy * c - dx * s) / ARGUS_TRIG_ONE;
        // One echo alone may have been crosstalk.
        const uint32_t counts_ms = self->at[i].again ? ARGUS_FORGET_MS : LATELY_MS;
        const bool recent = knowledge->sip_ms - self->at[i].seen_ms <= counts_ms;
        if (recent && ahead > BEHIND_MM && argus_abs(beside) < half_mm) {
            clear = argus_min(clear, ahead);
        }
    }
    return clear;
}

static inline bool place_since(const argus_echo_t *const seen, const argus_view_t *const from,
                               const uint32_t counts_ms, argus_point_t *const at) {
    ARGUS_ASSERT(counts_ms <= ARGUS_FORGET_MS);
    if (from->knowledge->sip_ms - seen->seen_ms > counts_ms || !is_about(seen, from)) {
        return false;
    }
    *at = place_of(seen, from);
    return true;
}

static bool has_stood(const argus_echoes_t *const self, const argus_view_t *const from, const int index,
                      argus_point_t *const at) {
    ARGUS_ASSERT(index >= 0 && index < self->count);
    return self->at[index].stands && place_since(&self->at[index], from, ARGUS_FORGET_MS, at);
}

bool argus_echoes_near(const argus_echoes_t *const self, const argus_view_t *const from, const int index,
                       argus_point_t *const at) {
    ARGUS_ASSERT(index >= 0 && index < self->count);
    return self->at[index].again && place_since(&self->at[index], from, LATELY_MS, at);
}

bool argus_echoes_stands(const argus_echoes_t *const self, const argus_view_t *const from, const int index,
                         argus_point_t *const at) {
    return argus_echoes_near(self, from, index, at) || has_stood(self, from, index, at);
}

bool argus_echoes_beside(const argus_echoes_t *const self, const argus_view_t *const from, const int index,
                         argus_point_t *const at) {
    const argus_robot_t *const robot = from->knowledge->robot;
    return argus_echoes_near(self, from, index, at) ||
           (has_stood(self, from, index, at) && at->x_mm > -robot->rear_mm && at->x_mm < robot->front_mm);
}

int32_t argus_echoes_nearest_mm(const argus_echoes_t *const self, const argus_knowledge_t *const knowledge,
                                const int32_t back_mm) {
    ARGUS_ASSERT(back_mm >= 0 && self->count <= ARGUS_POINTS_MAX);
    const argus_view_t from = argus_view(knowledge);
    const int32_t touched_mm = argus_touches_nearest_mm(&self->touches, knowledge, back_mm);
    uint32_t least = UINT32_MAX;
    for (int i = 0; i < self->count; i++) {
        argus_point_t at;
        if (argus_echoes_beside(self, &from, i, &at)) {
            const uint32_t square = argus_square_of(at.x_mm + back_mm, at.y_mm);
            least = square < least ? square : least;
        }
    }
    return least == UINT32_MAX ? touched_mm : argus_min(touched_mm, (int32_t)argus_sqrt(least));
}

int32_t argus_echoes_ahead_mm(const argus_echoes_t *const self, const argus_knowledge_t *const knowledge,
                              const int32_t half_mm) {
    ARGUS_ASSERT(half_mm > 0 && self->count <= ARGUS_POINTS_MAX);
    const argus_view_t from = argus_view(knowledge);
    int32_t nearest = INT32_MAX;
    for (int i = 0; i < self->count; i++) {
        argus_point_t at;
        if (argus_echoes_near(self, &from, i, &at) && at.x_mm > BEHIND_MM && argus_abs(at.y_mm) < half_mm) {
            nearest = argus_min(nearest, at.x_mm);
        }
    }
    return nearest;
}
