// SPDX-License-Identifier: MIT
// Finds which sonar looks where after a rotation.
#include "adjustment/cover.h"

#include "knowledge/angle.h"

int argus_plan_cover(const argus_robot_t *const robot, const argus_plan_t *const plan,
                     const int16_t rotation_deg, const int disabled) {
    ARGUS_ASSERT(plan->count <= ARGUS_ROTATIONS_MAX);
    const int bearing_deg = argus_robot_pose(robot, disabled).heading_deg - rotation_deg;
    for (int by = 0; by < argus_robot_sonars(robot); by++) {
        const int off_deg = argus_robot_pose(robot, by).heading_deg - bearing_deg;
        if ((plan->looks >> by & 1u) != 0 && argus_angle_wrap(off_deg * 100) == 0) {
            return by;
        }
    }
    return -1;
}

argus_mask_t argus_plan_covering(const argus_robot_t *const robot, const argus_plan_t *const plan,
                                 const int16_t rotation_deg) {
    ARGUS_ASSERT(plan->count <= ARGUS_ROTATIONS_MAX);
    unsigned mask = 0;
    for (int i = 0; i < robot->forward_count; i++) {
        const int d = robot->forward[i];
        const bool open = (plan->disabled >> d & 1u) != 0;
        const int by = open ? argus_plan_cover(robot, plan, rotation_deg, d) : -1;
        mask |= by >= 0 ? 1u << by : 0u;
    }
    return (argus_mask_t)mask;
}

argus_mask_t argus_plan_needs(const argus_robot_t *const robot, const argus_plan_t *const plan) {
    ARGUS_ASSERT(plan->count <= ARGUS_ROTATIONS_MAX);
    unsigned mask = 0;
    for (int i = 0; i < plan->count; i++) {
        mask |= argus_plan_covering(robot, plan, plan->rotation_deg[i]);
    }
    return (argus_mask_t)mask;
}
