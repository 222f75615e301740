// SPDX-License-Identifier: MIT
// The table of policies.
#include "adjustment/plan.h"

#include <string.h>

#include "adjustment/policy_cover.h"
#include "adjustment/policy_walk.h"

typedef struct {
    bool walks;
    bool ring;
    int16_t stop_cost;
    int16_t degree_cost;
} policy_t;

static const policy_t *policy_of(const argus_policy_t policy) {
#define ROW(name, word, walks, ring, stop, degree, meaning) \
    [ARGUS_POLICY_##name] = {(walks) != 0, (ring) != 0, (stop), (degree)},
    static const policy_t policies[] = {ARGUS_POLICY_TABLE(ROW, )};
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
    plan.looks =
        (argus_mask_t)((row->ring ? living & argus_robot_looking(robot) : argus_robot_forward(robot)) &
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
