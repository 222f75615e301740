// SPDX-License-Identifier: MIT
// The exact planner: the rotations that cost least, in one pass and one return.
#ifndef ARGUS_POLICY_COVER_H
#define ARGUS_POLICY_COVER_H

#include "adjustment/turns.h"

#define ARGUS_COVER_STEPS_MAX 20000u // for any robot known; 7,533 for a P3-DX

// The least stop_cost x stops + degree_cost x degrees turned in all. Among equals it has the least stops,
// then the least sum of the rotations, then the list that comes first when sorted ascending. Visited negative
// side outward, then positive side outward; once around where that is less. No set of rotations costs less.
// Returns the steps taken (a sum and a comparison each), at most ARGUS_COVER_STEPS_MAX.
uint32_t argus_policy_cover(argus_plan_t *plan, const argus_turns_t *turns, int32_t stop_cost,
                            int32_t degree_cost);

#endif
