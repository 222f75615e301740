// SPDX-License-Identifier: MIT
// The policies: Algorithm 3's walk, and the fewest stops by trying every set of rotations.
#include "adjustment/plan.h"

#include <string.h>

#include "knowledge/angle.h"

// What the turns of a robot show. Its table lists them nearest to 0 first, in pairs of which the negative one
// comes first: even rows are negative, odd ones positive.
typedef struct {
    const argus_robot_t *robot;
    unsigned disabled;
    unsigned sees[ARGUS_TURNS_MAX]; // which disabled sonars' bearings the healthy ones see after that turn
} turns_t;

int argus_plan_cover(const argus_robot_t *const robot, const argus_plan_t *const plan,
                     const int16_t rotation_deg, const int disabled) {
    const int bearing_deg = argus_robot_pose(robot, disabled)->heading_deg - rotation_deg;
    for (int i = 0; i < robot->forward_count; i++) {
        const int by = robot->forward[i];
        if ((plan->disabled >> by & 1u) == 0 && argus_robot_pose(robot, by)->heading_deg == bearing_deg) {
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
        const int by = argus_plan_cover(robot, plan, rotation_deg, d);
        if ((plan->disabled >> d & 1u) != 0 && by >= 0) {
            mask |= 1u << by;
        }
    }
    return (argus_mask_t)mask;
}

static unsigned seen_after(const argus_robot_t *const robot, const argus_plan_t *const plan,
                           const int16_t rotation_deg) {
    unsigned seen = 0;
    for (int i = 0; i < robot->forward_count; i++) {
        const int d = robot->forward[i];
        const bool open = (plan->disabled >> d & 1u) != 0;
        seen |= open && argus_plan_cover(robot, plan, rotation_deg, d) >= 0 ? 1u << d : 0u;
    }
    return seen;
}

static void walk(argus_plan_t *const plan, const turns_t *const turns) {
    unsigned open = plan->disabled;
    for (unsigned i = 0; i < turns->robot->turns && open != 0; i++) {
        const unsigned seen = turns->sees[i] & open;
        if (seen != 0 && plan->count < ARGUS_ROTATIONS_MAX) {
            plan->rotation_deg[plan->count++] = turns->robot->turn_deg[i];
            open &= ~seen;
        }
    }
    plan->complete = open == 0;
}

typedef struct {
    unsigned set; // bit i: the robot's turn i
    int count;
    int sweep;
    int sum;
} choice_t;

static bool covers_all(const turns_t *const turns, const unsigned set) {
    unsigned seen = 0;
    for (unsigned i = 0; i < turns->robot->turns; i++) {
        seen |= (set >> i & 1u) != 0 ? turns->sees[i] : 0u;
    }
    return seen == turns->disabled;
}

static choice_t measure(const argus_robot_t *const robot, const unsigned set) {
    choice_t choice = {.set = set};
    int low = 0;
    int high = 0;
    for (unsigned i = 0; i < robot->turns; i++) {
        if ((set >> i & 1u) != 0) {
            const int r = robot->turn_deg[i];
            choice.count++;
            choice.sum += r < 0 ? -r : r;
            low = argus_min(low, r);
            high = argus_max(high, r);
        }
    }
    choice.sweep = 2 * (high - low);
    return choice;
}

// Of two sets of equal size, the list that sorted ascending comes first is the one that holds the lowest
// rotation in which they differ.
static bool sorts_before(const unsigned a, const unsigned b) {
    const unsigned differ = a ^ b;
    for (int i = ARGUS_TURNS_MAX - 2; i >= 0; i -= 2) { // negative rotations, lowest first
        if ((differ >> i & 1u) != 0) {
            return (a >> i & 1u) != 0;
        }
    }
    for (int i = 1; i < ARGUS_TURNS_MAX; i += 2) {
        if ((differ >> i & 1u) != 0) {
            return (a >> i & 1u) != 0;
        }
    }
    return false;
}

static bool better(const choice_t *const a, const choice_t *const b) {
    if (a->count != b->count) {
        return a->count < b->count;
    }
    if (a->sweep != b->sweep) {
        return a->sweep < b->sweep;
    }
    if (a->sum != b->sum) {
        return a->sum < b->sum;
    }
    return sorts_before(a->set, b->set);
}

// The negative side outward, cross, the positive side outward.
static void list(argus_plan_t *const plan, const argus_robot_t *const robot, const unsigned set) {
    for (unsigned side = 0; side < 2; side++) {
        for (unsigned i = side; i < robot->turns; i += 2) {
            if ((set >> i & 1u) != 0 && plan->count < ARGUS_ROTATIONS_MAX) {
                plan->rotation_deg[plan->count++] = robot->turn_deg[i];
            }
        }
    }
}

static void fewest(argus_plan_t *const plan, const turns_t *const turns) {
    choice_t best = {.count = ARGUS_TURNS_MAX + 1};
    for (unsigned set = 1; set < 1u << turns->robot->turns; set++) {
        const choice_t choice = measure(turns->robot, set);
        if (better(&choice, &best) && covers_all(turns, set)) {
            best = choice;
        }
    }
    plan->complete = best.count <= ARGUS_TURNS_MAX;
    if (plan->complete) {
        list(plan, turns->robot, best.set);
    }
}

argus_plan_t argus_plan(const argus_robot_t *const robot, const argus_policy_t policy,
                        const argus_mask_t disabled) {
    argus_plan_t plan;
    memset(&plan, 0, sizeof plan);
    plan.disabled = disabled & argus_robot_forward(robot);
    plan.return_each = policy == ARGUS_POLICY_PAPER;
    plan.complete = plan.disabled == 0;
    turns_t turns = {.robot = robot, .disabled = plan.disabled};
    ARGUS_ASSERT(robot->turns <= ARGUS_TURNS_MAX && robot->forward_count <= ARGUS_FORWARD_MAX);
    for (unsigned i = 0; i < robot->turns; i++) {
        turns.sees[i] = seen_after(robot, &plan, robot->turn_deg[i]);
    }
    if (plan.disabled != 0 && policy == ARGUS_POLICY_PAPER) {
        walk(&plan, &turns);
    } else if (plan.disabled != 0) {
        fewest(&plan, &turns);
    }
    return plan;
}
