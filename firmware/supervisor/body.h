// SPDX-License-Identifier: MIT
// Which robot has answered, and whether it may be driven.
#ifndef ARGUS_SUPERVISOR_BODY_H
#define ARGUS_SUPERVISOR_BODY_H

#include "behaviour/core.h"

// A session is open, and the geometry of its robot holds from now on. A robot that is unknown, or for which
// the settings are unsafe, is passive.
void argus_meet_body(argus_t *self);

// Tells, once, of a robot that lists sonars which its subclass has not got. Where those are of the sixteen
// it has another body, and is passive until an operator says otherwise. True: it may not be driven.
bool argus_sees_through_body(const argus_t *self, argus_orders_t *orders, argus_events_t *events);

// Says why the robot at hand may not be driven; false: it may.
bool argus_find_bar(const argus_t *self, argus_orders_t *orders, argus_events_t *events);

// At rest: the other end leads from now on; nothing translates before a full check. The way to its heading is
// an ordinary turn, under S7.
void argus_turn_about(argus_t *self);

#endif
