// SPDX-License-Identifier: MIT
// Which robot's body and sonars hold.
#ifndef ARGUS_BODY_H
#define ARGUS_BODY_H

#include "knowledge/knowledge.h"

// This robot's geometry holds from now on. Sonars that it has not got are absent; one that was absent is
// UNKNOWN.
void argus_body_is(argus_knowledge_t *self, const argus_robot_t *robot, uint32_t now_ms);

#endif
