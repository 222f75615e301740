// SPDX-License-Identifier: MIT
// Walks through the turns from 0 outward.
#include "adjustment/policy_walk.h"

#include "knowledge/angle.h"

// The next one outward from `last_deg`, or -1.
static int next_outward(const argus_turns_t *const turns, const int last_deg) {
    ARGUS_ASSERT(turns->count <= ARGUS_TURNS_MAX);
    int next = -1;
    for (int k = 0; k < turns->count; k++) {
        const int deg = turns->deg[k];
        const bool beyond = argus_abs(deg) > argus_abs(last_deg) || (deg > 0 && deg == -last_deg);
        if (beyond && (next < 0 || argus_abs(deg) < argus_abs(turns->deg[next]))) {
            next = k; // of two the negative one, which is listed first
        }
    }
    return next;
}

void argus_policy_walk(argus_plan_t *const plan, const argus_turns_t *const turns) {
    ARGUS_ASSERT(plan->count <= ARGUS_ROTATIONS_MAX);
    ARGUS_ASSERT(turns->count <= ARGUS_TURNS_MAX);
    unsigned open = argus_turns_open(turns);
    int next = next_outward(turns, 0);
    for (int tries = 0; tries < turns->count && open != 0; tries++) {
        ARGUS_ASSERT(next >= 0); // each turn comes once: as many are left as tries
        const unsigned seen = turns->sees[next] & open;
        if (seen != 0) {
            ARGUS_ASSERT(plan->count < ARGUS_ROTATIONS_MAX); // each rotation sees another blind bearing
            plan->rotation_deg[plan->count++] = turns->deg[next];
            open &= ~seen;
        }
        next = next_outward(turns, turns->deg[next]);
    }
    plan->complete = open == 0;
}
