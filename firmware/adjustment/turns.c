// SPDX-License-Identifier: MIT
// Lists the turns that put a sonar which may look on the bearing of a blind one.
#include "adjustment/turns.h"

#include <string.h>

#include "knowledge/angle.h"

static void insert(argus_turns_t *const self, const int16_t deg) {
    int at = 0;
    while (at < self->count && self->deg[at] < deg) {
        at++;
    }
    if (deg == 0 || (at < self->count && self->deg[at] == deg)) {
        return;
    }
    ARGUS_ASSERT(self->count < ARGUS_TURNS_MAX);
    for (int k = self->count; k > at; k--) {
        self->deg[k] = self->deg[k - 1];
    }
    self->deg[at] = deg;
    self->count++;
}

static void insert_turns_onto(argus_turns_t *const self, const argus_plan_t *const plan, const int blind) {
    ARGUS_ASSERT(plan->count <= ARGUS_ROTATIONS_MAX);
    ARGUS_ASSERT(self->count <= ARGUS_TURNS_MAX);
    const int bearing_deg = argus_robot_pose(self->robot, blind).heading_deg;
    for (int by = 0; by < argus_robot_sonars(self->robot); by++) {
        if ((plan->looks >> by & 1u) != 0 && self->count < ARGUS_TURNS_MAX) {
            const int turn_deg = bearing_deg - argus_robot_pose(self->robot, by).heading_deg;
            insert(self, (int16_t)(argus_angle_wrap(turn_deg * 100) / 100));
        }
    }
}

void argus_turns_of(argus_turns_t *const self, const argus_robot_t *const robot,
                    const argus_plan_t *const plan) {
    ARGUS_ASSERT(robot->forward_count <= ARGUS_FORWARD_MAX);
    memset(self, 0, sizeof *self);
    self->robot = robot;
    for (int i = 0; i < robot->forward_count; i++) {
        if ((plan->disabled >> robot->forward[i] & 1u) != 0) {
            self->blind[self->blinds++] = robot->forward[i];
            insert_turns_onto(self, plan, robot->forward[i]);
        }
    }
    for (int k = 0; k < self->count; k++) {
        for (int i = 0; i < self->blinds; i++) {
            const bool seen = argus_plan_cover(robot, plan, self->deg[k], self->blind[i]) >= 0;
            self->sees[k] = (uint8_t)(self->sees[k] | (seen ? 1u << i : 0u));
        }
    }
}

unsigned argus_turns_open(const argus_turns_t *const self) {
    ARGUS_ASSERT(self->count <= ARGUS_TURNS_MAX);
    ARGUS_ASSERT(self->blinds <= ARGUS_FORWARD_MAX);
    return (1u << self->blinds) - 1u;
}
