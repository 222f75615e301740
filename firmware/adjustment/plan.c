// SPDX-License-Identifier: MIT
// The table of policies, and who looks where after a rotation.
#include "adjustment/plan.h"

#include <string.h>

#include "adjustment/policy_cover.h"
#include "adjustment/policy_walk.h"
#include "knowledge/angle.h"

typedef struct {
    bool walks;
    bool ring;
    int16_t stop_cost;
    int16_t degree_cost;
} policy_t;

int argus_plan_cover(const argus_robot_t *const robot, const argus_plan_t *const plan,
                     const int16_t rotation_deg, const int disabled) {
    const int bearing_deg = argus_robot_pose(robot, disabled)->heading_deg - rotation_deg;
    for (int by = 0; by < argus_robot_sonars(robot); by++) {
        const int off_deg = argus_robot_pose(robot, by)->heading_deg - bearing_deg;
        if ((plan->looks >> by & 1u) != 0 && argus_angle_wrap(off_deg * 100) == 0) {
            return by;
        }
    }
    return -1;
}

argus_mask_t argus_plan_covering(const argus_robot_t *const robot, const argus_plan_t *const plan,
                                 const int16_t rotation_deg) {
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
    unsigned mask = 0;
    for (int i = 0; i < plan->count; i++) {
        mask |= argus_plan_covering(robot, plan, plan->rotation_deg[i]);
    }
    return (argus_mask_t)mask;
}

static const policy_t *policy_of(const argus_policy_t policy) {
#define ROW(name, setting, walks, ring, stop, degree, meaning) \
    [ARGUS_POLICY_##name] = {(walks) != 0, (ring) != 0, (stop), (degree)},
    static const policy_t policies[] = {ARGUS_POLICY_TABLE(ROW)};
#undef ROW
    ARGUS_ASSERT((unsigned)policy < sizeof policies / sizeof policies[0]);
    return &policies[policy];
}

bool argus_plan_asks_ring(const argus_policy_t policy) {
    return policy_of(policy)->ring;
}

argus_plan_t argus_plan(const argus_robot_t *const robot, const argus_policy_t policy,
                        const argus_mask_t disabled, const argus_mask_t living) {
    const policy_t *const row = policy_of(policy);
    argus_plan_t plan;
    memset(&plan, 0, sizeof plan);
    plan.disabled = disabled & argus_robot_forward(robot);
    plan.looks = (argus_mask_t)((row->ring ? living & argus_robot_all(robot) : argus_robot_forward(robot)) &
                                ~(unsigned)plan.disabled);
    plan.return_each = row->walks;
    plan.complete = plan.disabled == 0;
    if (plan.complete) {
        return plan;
    }
    argus_turns_t turns;
    argus_turns_of(&turns, robot, &plan);
    if (row->walks) {
        argus_policy_walk(&plan, &turns);
    } else {
        (void)argus_policy_cover(&plan, &turns, row->stop_cost, row->degree_cost);
    }
    return plan;
}
