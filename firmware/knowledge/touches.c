// SPDX-License-Identifier: MIT
// Remembers where the body met something, and how far it is from there.
#include "knowledge/touches.h"

#include <string.h>

#include "knowledge/angle.h"

#define AT_END_MM 60     // what touches an end now is no farther from it
#define SAME_PLACE_MM 50 // two that are nearer are one
#define ASIDE_MM 47      // beside the body a way keeps so much off one
#define FAR_MM 32000     // what argus_in_frame() and argus_hypot() take

void argus_touches_init(argus_touches_t *const self) {
    memset(self, 0, sizeof *self);
}

static argus_point_t away_from(const argus_point_t from, const argus_point_t to) {
    return (argus_point_t){argus_within(FAR_MM, to.x_mm - from.x_mm),
                           argus_within(FAR_MM, to.y_mm - from.y_mm)};
}

static int32_t between_mm(const argus_point_t a, const argus_point_t b) {
    const argus_point_t by = away_from(a, b);
    return argus_hypot(by.x_mm, by.y_mm);
}

argus_point_t argus_touches_seen(const argus_touches_t *const self, const argus_knowledge_t *const knowledge,
                                 const int index) {
    ARGUS_ASSERT(index >= 0 && index < self->count);
    const argus_point_t centre = {knowledge->pose.x_mm, knowledge->pose.y_mm};
    return argus_in_frame(away_from(centre, self->at[index]), knowledge->pose.heading_cdeg);
}

static argus_point_t *slot_for(argus_touches_t *const self, const argus_point_t at) {
    ARGUS_ASSERT(self->count <= ARGUS_TOUCHES_MAX);
    if (self->count < ARGUS_TOUCHES_MAX) {
        return &self->at[self->count++];
    }
    int farthest = 0;
    for (int i = 1; i < self->count; i++) {
        farthest = between_mm(self->at[i], at) > between_mm(self->at[farthest], at) ? i : farthest;
    }
    return &self->at[farthest];
}

void argus_touches_add(argus_touches_t *const self, const argus_point_t at) {
    for (int i = 0; i < self->count; i++) {
        if (between_mm(self->at[i], at) < SAME_PLACE_MM) {
            return;
        }
    }
    *slot_for(self, at) = at;
}

static void add_at(argus_touches_t *const self, const argus_knowledge_t *const knowledge, const int32_t x_mm,
                   const int32_t y_mm) {
    argus_touches_add(self, argus_to_course(&knowledge->pose, (argus_point_t){x_mm, y_mm}));
}

// The front segments lie across the bow, bit 1 leftmost.
void argus_touches_bumped(argus_touches_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->robot->front_bumpers <= 7);
    const argus_robot_t *const robot = knowledge->robot;
    const int segments = robot->front_bumpers;
    for (int segment = 1; segment <= segments; segment++) {
        if ((knowledge->bumpers_front >> segment & 1u) != 0) {
            const int32_t beside_mm = (segments + 1 - 2 * segment) * (robot->width_mm / segments) / 2;
            add_at(self, knowledge, robot->front_mm, beside_mm);
        }
    }
    if (knowledge->bumpers_rear != 0) {
        argus_touches_end(self, knowledge, -1);
    }
}

void argus_touches_end(argus_touches_t *const self, const argus_knowledge_t *const knowledge,
                       const int sign) {
    ARGUS_ASSERT(sign == 1 || sign == -1);
    const argus_robot_t *const robot = knowledge->robot;
    const int32_t x_mm = sign > 0 ? robot->front_mm : -robot->rear_mm;
    for (int side = -1; side <= 1; side++) {
        add_at(self, knowledge, x_mm, side * argus_robot_half_width_mm(robot));
    }
}

void argus_touches_sides(argus_touches_t *const self, const argus_knowledge_t *const knowledge) {
    const argus_robot_t *const robot = knowledge->robot;
    const int32_t y_mm = argus_robot_half_width_mm(robot) + ASIDE_MM;
    for (int side = -1; side <= 1; side += 2) {
        add_at(self, knowledge, robot->front_mm, side * y_mm);
        add_at(self, knowledge, -robot->rear_mm, side * y_mm);
    }
}

static bool is_at_end(const argus_touches_t *const self, const argus_knowledge_t *const knowledge,
                      const int index) {
    const argus_robot_t *const robot = knowledge->robot;
    const argus_point_t at = argus_touches_seen(self, knowledge, index);
    const bool beside = argus_abs(at.y_mm) > argus_robot_half_width_mm(robot) + AT_END_MM;
    return !beside && at.x_mm < robot->front_mm + AT_END_MM && at.x_mm > -robot->rear_mm - AT_END_MM;
}

void argus_touches_leave(argus_touches_t *const self, const argus_knowledge_t *const knowledge) {
    uint8_t kept = 0;
    for (int i = 0; i < self->count; i++) {
        if (!is_at_end(self, knowledge, i)) {
            self->at[kept++] = self->at[i];
        }
    }
    self->count = kept;
}

int32_t argus_touches_clear_mm(const argus_touches_t *const self, const argus_knowledge_t *const knowledge,
                               const int32_t heading_cdeg, const int32_t half_mm) {
    ARGUS_ASSERT(half_mm > 0);
    const argus_point_t centre = {knowledge->pose.x_mm, knowledge->pose.y_mm};
    int32_t clear_mm = INT32_MAX;
    for (int i = 0; i < self->count; i++) {
        const argus_point_t at = argus_in_frame(away_from(centre, self->at[i]), heading_cdeg);
        if (at.x_mm > 0 && argus_abs(at.y_mm) < half_mm) {
            clear_mm = argus_min(clear_mm, at.x_mm);
        }
    }
    return clear_mm;
}

int32_t argus_touches_before_mm(const argus_touches_t *const self, const argus_knowledge_t *const knowledge,
                                const int sign) {
    ARGUS_ASSERT(sign == 1 || sign == -1);
    const argus_robot_t *const robot = knowledge->robot;
    const int32_t half_mm = argus_robot_half_width_mm(robot) + ASIDE_MM;
    const int32_t way_cdeg = argus_angle_wrap(knowledge->pose.heading_cdeg + (sign > 0 ? 0 : 18000));
    const int32_t clear_mm = argus_touches_clear_mm(self, knowledge, way_cdeg, half_mm);
    const int32_t end_mm = sign > 0 ? robot->front_mm : robot->rear_mm;
    return clear_mm == INT32_MAX ? INT32_MAX : argus_max(0, clear_mm - end_mm);
}

int32_t argus_touches_nearest_mm(const argus_touches_t *const self, const argus_knowledge_t *const knowledge,
                                 const int32_t back_mm) {
    ARGUS_ASSERT(back_mm >= 0);
    int32_t nearest_mm = INT32_MAX;
    for (int i = 0; i < self->count; i++) {
        const argus_point_t at = argus_touches_seen(self, knowledge, i);
        nearest_mm = argus_min(nearest_mm, argus_hypot(at.x_mm + back_mm, at.y_mm));
    }
    return nearest_mm;
}
