// SPDX-License-Identifier: MIT
// What the evidence of one SIP makes of every sonar (profile argus): names, convictions, the way back.
#ifndef ARGUS_JUDGE_H
#define ARGUS_JUDGE_H

#include "behaviour/core.h"
#include "behaviour/intent.h"

// One sonar. A conviction ahead of the robot calls for a check at rest.
void argus_judge(argus_t *self, int sonar, argus_intent_t *intent);

#endif
