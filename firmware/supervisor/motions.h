// SPDX-License-Identifier: MIT
// Commands to the robot's wheels, as far as argus_permit() lets the manager.
#ifndef ARGUS_MOTIONS_H
#define ARGUS_MOTIONS_H

#include "behaviour/core.h"

// The robot moves, or a motion may be on its way though the SIPs do not show it yet.
bool argus_is_to_halt(const argus_t *self);

// Motions and motors; false: it may not, and nothing was sent.
bool argus_turn_to(const argus_t *self, argus_motion_t *motion, argus_bend_t *bend, argus_outbox_t *out,
                   int32_t heading_cdeg);
bool argus_move(const argus_t *self, argus_motion_t *motion, argus_outbox_t *out, int32_t distance_mm,
                int32_t speed_mm_s);
void argus_steer(const argus_t *self, argus_bend_t *bend, argus_outbox_t *out, int32_t heading_cdeg);
void argus_enable_motors(const argus_t *self, argus_outbox_t *out);

// The robot rests off the target of its turn: commanded again, or failed after some tries.
void argus_turn_again(const argus_t *self, argus_motion_t *motion, argus_outbox_t *out);

#endif
