// SPDX-License-Identifier: MIT
// The course: waypoints in order, and how far the goal is.
#include <string.h>

#include "knowledge/angle.h"
#include "task/task.h"

// A waypoint is a place to pass: where something stopped the robot before it, so near is near enough.
#define PASSED_MM 200

static bool within(const int32_t mm) {
    return mm >= -ARGUS_COURSE_LIMIT_MM && mm <= ARGUS_COURSE_LIMIT_MM;
}

static bool fits(const argus_point_t *const point) {
    return within(point->x_mm) && within(point->y_mm);
}

bool argus_task_set(argus_task_t *const self, const argus_point_t *const points, const uint16_t count) {
    if (count == 0 || count > ARGUS_WAYPOINTS_MAX) {
        return false;
    }
    for (uint16_t i = 0; i < count; i++) {
        if (!fits(&points[i])) {
            return false;
        }
    }
    memcpy(self->waypoint, points, count * sizeof *points);
    self->count = count;
    self->next = 0;
    argus_task_restart(self);
    return true;
}

void argus_task_restart(argus_task_t *const self) {
    self->has_leg = false;
    self->avoiding = false;
    self->refused = false;
    memset(&self->progress, 0, sizeof self->progress);
}

static int32_t distance_mm(const argus_knowledge_t *const knowledge, const argus_point_t *const to) {
    return argus_hypot(to->x_mm - knowledge->pose.x_mm, to->y_mm - knowledge->pose.y_mm);
}

int32_t argus_task_goal_mm(const argus_task_t *const self, const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(self->count <= ARGUS_WAYPOINTS_MAX);
    return self->count == 0 ? 0 : distance_mm(knowledge, &self->waypoint[self->count - 1]);
}

bool argus_task_progress(argus_task_t *const self, const argus_knowledge_t *const knowledge,
                         const argus_config_t *const config, int *const passed) {
    ARGUS_ASSERT(self->next <= self->count && self->count <= ARGUS_WAYPOINTS_MAX);
    *passed = 0;
    while (self->next < self->count) {
        const bool last = self->next + 1 == self->count;
        const int32_t passing_mm =
            self->refused ? argus_max(PASSED_MM, config->waypoint_radius_mm) : config->waypoint_radius_mm;
        const int32_t radius_mm = last ? config->goal_radius_mm : passing_mm;
        if (distance_mm(knowledge, &self->waypoint[self->next]) > radius_mm) {
            break;
        }
        self->next++;
        (*passed)++;
        argus_task_restart(self);
    }
    return self->count > 0 && self->next == self->count;
}

void argus_task_return(argus_task_t *const self) {
    ARGUS_ASSERT(self->count > 0 && self->next == self->count);
    self->next--;
    argus_task_restart(self);
}

int32_t argus_task_bearing_cdeg(const argus_task_t *const self, const argus_knowledge_t *const knowledge) {
    return argus_atan2(self->leg.to.y_mm - knowledge->pose.y_mm, self->leg.to.x_mm - knowledge->pose.x_mm);
}

int32_t argus_task_leg_mm(const argus_task_t *const self, const argus_knowledge_t *const knowledge) {
    return distance_mm(knowledge, &self->leg.to);
}
