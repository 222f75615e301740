// SPDX-License-Identifier: MIT
// The policies: Algorithm 3's walk, and the fewest stops by trying every set of rotations.
#include "adjustment/plan.h"

#include <string.h>

#include "knowledge/angle.h"

#define PITCH_DEG 20
#define FIRST 1
#define LAST 6
#define FORWARD_MASK 0x7Eu
#define SHIFTS 10 // rotations of +-20 .. +-100: index 0 is -20, 1 is +20, 2 is -40, ...

// Nearest to 0 first; a tie goes to the negative rotation.
static int16_t shift_deg(const unsigned index) {
    const int size = ((int)index / 2 + 1) * PITCH_DEG;
    return (int16_t)((index & 1u) == 0 ? -size : size);
}

// Which disabled sonars' bearings the healthy ones see after a rotation: sonar e looks where e - r / 20 is
// mounted.
static unsigned sees(const unsigned disabled, const int16_t rotation_deg) {
    const unsigned healthy = ~disabled & FORWARD_MASK;
    const int shift = rotation_deg / PITCH_DEG;
    const unsigned moved = shift > 0 ? healthy >> shift : healthy << -shift;
    return moved & disabled & FORWARD_MASK;
}

int argus_plan_cover(const argus_plan_t *const plan, const int16_t rotation_deg, const int disabled) {
    const int by = disabled + rotation_deg / PITCH_DEG;
    const bool forward = by >= FIRST && by <= LAST;
    return forward && (plan->disabled >> by & 1u) == 0 ? by : -1;
}

uint16_t argus_plan_covering(const argus_plan_t *const plan, const int16_t rotation_deg) {
    unsigned mask = 0;
    for (int d = FIRST; d <= LAST; d++) {
        const int by = argus_plan_cover(plan, rotation_deg, d);
        if ((plan->disabled >> d & 1u) != 0 && by >= 0) {
            mask |= 1u << by;
        }
    }
    return (uint16_t)mask;
}

static void walk(argus_plan_t *const plan) {
    unsigned open = plan->disabled;
    for (unsigned i = 0; i < SHIFTS && open != 0; i++) {
        const unsigned seen = sees(plan->disabled, shift_deg(i)) & open;
        if (seen != 0 && plan->count < ARGUS_ROTATIONS_MAX) {
            plan->rotation_deg[plan->count++] = shift_deg(i);
            open &= ~seen;
        }
    }
    plan->complete = open == 0;
}

typedef struct {
    unsigned set; // bit i: rotation shift_deg(i)
    int count;
    int sweep;
    int sum;
} choice_t;

static bool covers_all(const unsigned disabled, const unsigned set) {
    unsigned seen = 0;
    for (unsigned i = 0; i < SHIFTS; i++) {
        seen |= (set >> i & 1u) != 0 ? sees(disabled, shift_deg(i)) : 0u;
    }
    return seen == disabled;
}

static choice_t measure(const unsigned set) {
    choice_t choice = {.set = set};
    int low = 0;
    int high = 0;
    for (unsigned i = 0; i < SHIFTS; i++) {
        if ((set >> i & 1u) != 0) {
            const int r = shift_deg(i);
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
    for (int i = SHIFTS - 2; i >= 0; i -= 2) { // negative rotations, lowest first
        if ((differ >> i & 1u) != 0) {
            return (a >> i & 1u) != 0;
        }
    }
    for (int i = 1; i < SHIFTS; i += 2) {
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
static void list(argus_plan_t *const plan, const unsigned set) {
    for (unsigned side = 0; side < 2; side++) {
        for (unsigned i = side; i < SHIFTS; i += 2) {
            if ((set >> i & 1u) != 0 && plan->count < ARGUS_ROTATIONS_MAX) {
                plan->rotation_deg[plan->count++] = shift_deg(i);
            }
        }
    }
}

static void fewest(argus_plan_t *const plan) {
    choice_t best = {.count = SHIFTS + 1};
    for (unsigned set = 1; set < 1u << SHIFTS; set++) {
        const choice_t choice = measure(set);
        if (better(&choice, &best) && covers_all(plan->disabled, set)) {
            best = choice;
        }
    }
    plan->complete = best.count <= SHIFTS;
    if (plan->complete) {
        list(plan, best.set);
    }
}

argus_plan_t argus_plan(const argus_policy_t policy, const uint16_t disabled) {
    argus_plan_t plan;
    memset(&plan, 0, sizeof plan);
    plan.disabled = (uint16_t)(disabled & FORWARD_MASK);
    plan.return_each = policy == ARGUS_POLICY_PAPER;
    plan.complete = plan.disabled == 0;
    if (plan.disabled != 0 && policy == ARGUS_POLICY_PAPER) {
        walk(&plan);
    } else if (plan.disabled != 0) {
        fewest(&plan);
    }
    return plan;
}
