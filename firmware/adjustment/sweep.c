// SPDX-License-Identifier: MIT
// The sweep: turn to each rotation of the plan, read what covers the disabled bearings, end on the base
// heading.
#include <string.h>

#include "adjustment/drive.h"
#include "knowledge/angle.h"

void argus_sweep_begin(argus_drive_t *const self, const argus_plan_t *const plan, const int32_t base_cdeg) {
    ARGUS_ASSERT(plan->count <= ARGUS_ROTATIONS_MAX);
    memset(self, 0, sizeof *self);
    self->base_cdeg = base_cdeg;
    self->covers = plan->disabled;
    self->looks = plan->looks;
    self->smallest_mm = UINT16_MAX;
    self->smallest_of = -1;
    self->home = plan->count == 0;
}

bool argus_sweep_is_outdated(const argus_drive_t *const self, const argus_plan_t *const plan) {
    ARGUS_ASSERT(plan->count <= ARGUS_ROTATIONS_MAX);
    return self->covers != plan->disabled || self->looks != plan->looks;
}

argus_mask_t argus_sweep_wants(const argus_drive_t *const self, const argus_plan_t *const plan,
                               const argus_robot_t *const robot) {
    ARGUS_ASSERT(plan->count <= ARGUS_ROTATIONS_MAX);
    const bool looks = !self->done && !self->home && self->index < plan->count;
    return looks ? argus_plan_covering(robot, plan, plan->rotation_deg[self->index]) : 0;
}

int32_t argus_sweep_heading_cdeg(const argus_drive_t *const self, const argus_plan_t *const plan) {
    ARGUS_ASSERT(plan->count <= ARGUS_ROTATIONS_MAX);
    const int32_t rotation = self->home || self->index >= plan->count ? 0 : plan->rotation_deg[self->index];
    return argus_angle_wrap(self->base_cdeg + rotation * 100);
}

static void note_smallest(argus_drive_t *const self, const argus_plan_t *const plan,
                          const argus_knowledge_t *const knowledge) {
    ARGUS_ASSERT(knowledge->robot->forward_count <= ARGUS_FORWARD_MAX);
    ARGUS_ASSERT(self->index < plan->count);
    const int16_t rotation = plan->rotation_deg[self->index];
    const argus_robot_t *const robot = knowledge->robot;
    for (int i = 0; i < robot->forward_count; i++) {
        const int d = robot->forward[i];
        const int by = (plan->disabled >> d & 1u) != 0 ? argus_plan_cover(robot, plan, rotation, d) : -1;
        if (by >= 0 && knowledge->sonar[by].reading_mm < self->smallest_mm) {
            self->smallest_mm = knowledge->sonar[by].reading_mm;
            self->smallest_of = (int8_t)d;
            self->smallest_at = self->index;
        }
    }
}

static void next_rotation(argus_drive_t *const self, const argus_plan_t *const plan) {
    ARGUS_ASSERT(self->index < plan->count);
    self->index++;
    self->home = plan->return_each || self->index >= plan->count;
}

bool argus_sweep_step(argus_drive_t *const self, const argus_plan_t *const plan,
                      const argus_knowledge_t *const knowledge, const argus_mark_t *const mark) {
    ARGUS_ASSERT(plan->count <= ARGUS_ROTATIONS_MAX);
    ARGUS_ASSERT(self->index <= ARGUS_ROTATIONS_MAX);
    if (self->done) {
        return false;
    }
    if (self->home) {
        self->home = false;
        self->done = self->index >= plan->count;
        return true;
    }
    if (!argus_all_fresh_since(knowledge, argus_sweep_wants(self, plan, knowledge->robot), mark)) {
        return false;
    }
    note_smallest(self, plan, knowledge);
    next_rotation(self, plan);
    return true;
}
