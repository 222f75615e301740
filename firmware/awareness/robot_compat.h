// SPDX-License-Identifier: MIT
// What the evidence takes for granted of the P3-DX, until it asks argus_knowledge_t.robot.
#ifndef ARGUS_ROBOT_COMPAT_H
#define ARGUS_ROBOT_COMPAT_H

#include "knowledge/knowledge.h"
#include "robot/gen_p3dx.h"

#define argus_sonar_pose argus_sonar_poses // the default robot's rows come first
#define ARGUS_FORWARD_MASK 0x7Eu
#define ARGUS_FORWARD_FIRST 1
#define ARGUS_FORWARD_LAST 6

// Those rows are of the robot as it is built, whichever end leads.
static inline argus_pose_t argus_built_pose(const argus_knowledge_t *const knowledge) {
    argus_pose_t pose = knowledge->pose;
    pose.heading_cdeg = argus_built_heading_cdeg(knowledge);
    return pose;
}

#endif
