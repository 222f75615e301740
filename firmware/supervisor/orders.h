// SPDX-License-Identifier: MIT
// What an operator orders: the course, a step or a turn, passive or active, one sonar.
#ifndef ARGUS_ORDERS_H
#define ARGUS_ORDERS_H

#include "behaviour/core.h"

// False: it cannot be done, and nothing has changed.
bool argus_obey(argus_t *self, argus_op_t op, int32_t argument);

// A client of a guard port takes the robot, or stops it while the manager has it. Neither undoes an
// operator's stop.
void argus_yield_to_client(argus_t *self);
void argus_stop_for_client(argus_t *self);

#endif
