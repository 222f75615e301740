// SPDX-License-Identifier: MIT
// The step rule implies S5: each place that the front of the body sweeps in one step is within what the rule
// counts on of a sonar that faces forward, so a check that reads farther leaves none
// of them unseen for being too far.
// Bounds: a P3-DX and its sonars, the longest step; places to the millimetre
// Sources: firmware/knowledge/angle.c firmware/robot/gen_robots.c firmware/robot/robot.c
// Unwind: 856
// Ci: no
// Mutant: firmware/knowledge/config.c | const int32_t front2 = 2 * (robot->front_mm + step_mm); | const int32_t front2 = 2 * robot->front_mm;
// Mutant: firmware/knowledge/config.c | for (int32_t y2 = -side2; y2 <= side2; y2++) { | for (int32_t y2 = -side2 / 2; y2 <= side2 / 2; y2++) {
#include "proof.h"

#include "knowledge/config.c"

#define STEP_MM 200

void proof(void) {
    const argus_robot_t *const robot = argus_robot_default();
    const int32_t reach_mm = argus_config_reach_mm(robot, STEP_MM);
    const int32_t x_mm = any_between(robot->front_mm, robot->front_mm + STEP_MM);
    const int32_t y_mm = any_between(-robot->width_mm / 2, robot->width_mm / 2);
    bool within = false;
    for (int i = 0; i < robot->forward_count; i++) {
        const argus_sonar_pose_t pose = argus_robot_pose(robot, robot->forward[i]);
        const int32_t dx = x_mm - pose.x_mm;
        const int32_t dy = y_mm - pose.y_mm;
        within = within || dx * dx + dy * dy <= reach_mm * reach_mm;
    }
    PROVE(within, "a sonar is near enough");
}
