// SPDX-License-Identifier: MIT
// Names of the forward-facing sonars for the parts of the manager that have `self`; they go when these ask
// the robot.
#ifndef ARGUS_SUPERVISOR_ROBOT_COMPAT_H
#define ARGUS_SUPERVISOR_ROBOT_COMPAT_H

#undef ARGUS_FORWARD_MASK // robot/compat.h has those of the P3-DX
#undef ARGUS_FORWARD_FIRST
#undef ARGUS_FORWARD_LAST

// The forward-facing sonars of every robot are numbered in a row.
#define ARGUS_FORWARD_MASK argus_robot_forward(self->knowledge.robot)
#define ARGUS_FORWARD_FIRST (self->knowledge.robot->forward[0])
#define ARGUS_FORWARD_LAST (self->knowledge.robot->forward[0] + self->knowledge.robot->forward_count - 1)

#endif
