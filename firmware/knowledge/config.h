// SPDX-License-Identifier: MIT
// The arithmetic of S5 that others than argus_config_check() need.
#ifndef ARGUS_CONFIG_H
#define ARGUS_CONFIG_H

#include "argus/argus.h"
#include "robot/robot.h"

// Which settings follow the robot.
typedef struct {
    bool sonar_cycle;
    bool speed;
    bool object_range;
    bool check_range;
} argus_follows_t;

// Those that are ARGUS_AUTO.
argus_follows_t argus_config_follows(const argus_config_t *config);

// The one place where they become numbers: as they hold for a robot and for its other end. The ranges follow
// its body alone, the speed what S5 leaves of them.
void argus_config_follow(argus_config_t *config, argus_follows_t follows, const argus_robot_t *robot);

// As argus_config_check(), for a robot.
argus_config_report_t argus_config_check_for(const argus_config_t *asked, const argus_robot_t *robot);

// Each setting that is out of its range becomes its default: what is refused is not run with, either.
void argus_config_mend(argus_config_t *config);

// S5: the way, in mm, from a reading that asks for a stop to standstill at the driving speed: v t + v^2 / (2
// decel). `late_ms`: by how much the link is late beyond what t counts on.
int32_t argus_config_stop_mm(const argus_config_t *config, const argus_robot_t *robot, int32_t late_ms);

// Largest reading, in mm, that a forward-facing sonar gives of a point which the body sweeps when it moves
// `step_mm` ahead.
int32_t argus_config_reach_mm(const argus_robot_t *robot, int32_t step_mm);

// S5 solved for the speed: the highest, mm/s, from which the robot stands before an object at a reading of
// `range_mm`, 0..INT16_MAX. It is never more, and at most 6 mm/s less. The settings must have passed
// argus_config_check().
int32_t argus_config_speed_mm_s(const argus_config_t *config, const argus_robot_t *robot, int32_t range_mm,
                                int32_t late_ms);

#endif
