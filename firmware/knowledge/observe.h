// SPDX-License-Identifier: MIT
// What a robot without ARCOS says of itself, as a SIP.
#ifndef ARGUS_OBSERVE_H
#define ARGUS_OBSERVE_H

#include "arcos/sip.h"
#include "robot/robot.h"

// `robot`: as it is built.
void argus_sip_of(argus_sip_t *sip, const argus_observation_t *observation, const argus_robot_t *robot);

#endif
