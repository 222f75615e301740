// SPDX-License-Identifier: MIT
// The paper's planner: Algorithm 3's walk.
#ifndef ARGUS_POLICY_WALK_H
#define ARGUS_POLICY_WALK_H

#include "adjustment/turns.h"

// Keeps a turn, nearest to 0 first and of two the negative one, when it shows a bearing not seen yet. paper:
// Algorithm 3's lines 27 to 34 stop at 50 degrees and add a rotation twice that covers two bearings; not so
// here.
void argus_policy_walk(argus_plan_t *plan, const argus_turns_t *turns);

#endif
