// SPDX-License-Identifier: MIT
// Takes another robot's geometry, and tells the sonars that it has from those that it has not.
#include "knowledge/body.h"

#include "knowledge/health.h"

void argus_body_is(argus_knowledge_t *const self, const argus_robot_t *const robot, const uint32_t now_ms) {
    ARGUS_ASSERT(robot != NULL);
    self->robot = robot;
    self->sonars = (uint8_t)argus_robot_sonars(robot);
    for (int i = 0; i < ARGUS_SONARS; i++) {
        const argus_change_t change = i < self->sonars ? ARGUS_CHANGE_FITTED : ARGUS_CHANGE_MISSING;
        if (argus_health_may(self, i, change)) {
            self->sonar[i].reported = false;
            argus_health_set(self, i, change, ARGUS_KIND_NONE, 0, now_ms);
        }
    }
    ARGUS_ASSERT(self->sonars <= ARGUS_SONARS);
}
