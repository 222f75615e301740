// SPDX-License-Identifier: MIT
// What orders, faults and the end of a way change of the travel. Else travel.c alone writes it.
#ifndef ARGUS_JOURNEY_H
#define ARGUS_JOURNEY_H

#include "behaviour/core.h"

// A course is set; false: it is none, and nothing changes. It is followed from the start again.
bool argus_journey_set(argus_travel_t *mine, const argus_point_t *points, uint16_t count);
void argus_journey_restart(argus_travel_t *mine);

// An operator's step ahead, 0: none.
void argus_journey_jog(argus_travel_t *mine, int32_t distance_mm);

// It does not stop at the goal any more.
void argus_journey_leave_goal(argus_travel_t *mine);

// The present heading is refused to the course. The course has got nowhere for too long; `drives`: it is
// tried at present.
void argus_journey_refuse(argus_travel_t *mine, const argus_knowledge_t *knowledge, argus_echoes_t *echoes);
bool argus_journey_is_hopeless(argus_travel_t *mine, const argus_knowledge_t *knowledge, bool drives);

#endif
