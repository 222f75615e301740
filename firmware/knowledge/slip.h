// SPDX-License-Identifier: MIT
// Wheels that turn while the robot does not move: ranges along the way that stay though the odometry goes on.
#ifndef ARGUS_SLIP_H
#define ARGUS_SLIP_H

#include "knowledge/knowledge.h"

// One stretch of straight way or one turn, and what each sonar read where it began; 0: nothing that counts.
typedef struct {
    bool begun;
    uint8_t doubted;   // slipped: so many ranges have still to change as the odometry says
    uint8_t proof;     // what the stretches that began at `first` are worth
    argus_mask_t read; // sonars that have been listed since, or since the turn ended
    argus_pose_t from;
    argus_pose_t first; // where the stretches began of which each says so, or the doubt
    uint32_t slips;     // monotonic
    int32_t slipped_mm; // the last one
    uint16_t reading_mm[ARGUS_SONARS];
} argus_slip_t;

// A session opened, or SIPs come again: the robot may have moved since.
void argus_slip_restart(argus_slip_t *self);

// One SIP. True: the wheels made `slipped_mm` of way and the robot did not; it is at `first`. False: no sonar
// can tell. Proof takes one sonar ahead and one back that stay through two stretches of half a metre. Two
// that look one way must stay through three, as a person may walk there. So do two turns in which three stay
// of those that should hear what others have heard. No range may change as the odometry says.
bool argus_slip_sip(argus_slip_t *self, const argus_knowledge_t *knowledge);

// At a goal by the odometry. True: that is no goal, the robot is still at `first`. It has slipped on the way,
// or half of the proof says so, and no range tells of motion since.
bool argus_slip_denies(argus_slip_t *self, const argus_knowledge_t *knowledge);

#endif
