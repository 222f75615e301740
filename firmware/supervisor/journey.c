// SPDX-License-Identifier: MIT
// Sets the course and the operator's step, begins them anew, and closes ways to them.
#include "supervisor/journey.h"

bool argus_journey_set(argus_travel_t *const mine, const argus_point_t *const points, const uint16_t count) {
    if (!argus_task_set(&mine->task, points, count)) {
        return false;
    }
    mine->arriving = false;
    return true;
}

void argus_journey_restart(argus_travel_t *const mine) {
    argus_task_restart(&mine->task);
}

void argus_journey_jog(argus_travel_t *const mine, const int32_t distance_mm) {
    ARGUS_ASSERT(distance_mm >= 0);
    mine->jog_mm = distance_mm;
}

void argus_journey_leave_goal(argus_travel_t *const mine) {
    mine->arriving = false;
}

void argus_journey_refuse(argus_travel_t *const mine, const argus_knowledge_t *const knowledge,
                          argus_echoes_t *const echoes) {
    argus_task_refuse(&mine->task, knowledge, echoes);
}

bool argus_journey_is_hopeless(argus_travel_t *const mine, const argus_knowledge_t *const knowledge,
                               const bool drives) {
    return argus_task_is_hopeless(&mine->task, knowledge, drives);
}
