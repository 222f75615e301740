// SPDX-License-Identifier: MIT
// Commands to the robot's wheels.
#ifndef ARGUS_MOTIONS_H
#define ARGUS_MOTIONS_H

#include "supervisor/core.h"

// STOP or E_STOP; under `passive` nothing is sent, and rest waited for.
void argus_stop(argus_t *self, uint8_t command);

// STOP, unless the robot stands and no motion is on its way.
void argus_halt(argus_t *self);

// A STOP that belongs to the way, and waiting for rest on whatever heading.
void argus_brake(argus_t *self);
void argus_hold(argus_t *self);

// Whatever is under way must not go on beside a check.
void argus_come_to_rest(argus_t *self);

// Motions and motors, as far as argus_permit() lets the manager; false: it does not, and nothing was sent.
bool argus_turn_to(argus_t *self, int32_t heading_cdeg);
bool argus_move(argus_t *self, int32_t distance_mm, int32_t speed_mm_s);
void argus_steer(argus_t *self, int32_t heading_cdeg);
void argus_enable_motors(argus_t *self);

// The robot rests off the target of its turn: commanded again, or failed after some tries.
void argus_turn_again(argus_t *self);

#endif
