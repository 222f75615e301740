// SPDX-License-Identifier: MIT
// Which end of the robot leads: the rear while the front has failed (profile argus).
#ifndef ARGUS_REVERSE_H
#define ARGUS_REVERSE_H

#include "behaviour/core.h"

// The other end would do better. The one that leads cannot go on, has led for long without an echo, has lost
// most of its sonars, or is the rear though the front is whole. Because of what is lost not twice within 2 m
// of driving; never for an operator's step. Cost: one plan.
bool argus_should_turn_about(const argus_t *self);

// The rear has been turned ahead, and looks there. It hears nothing, so the front drives on as far as the
// rear has seen; or the front has heard something in the turn, and lives. If only the rear hears, it leads.
bool argus_should_hand_back(const argus_t *self);

#endif
