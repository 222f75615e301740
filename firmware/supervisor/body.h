// SPDX-License-Identifier: MIT
// Which robot it is, and whether it may be driven.
#ifndef ARGUS_BODY_H
#define ARGUS_BODY_H

#include "supervisor/core.h"

// A session is open: the geometry of its robot holds, and it may be driven or not.
void argus_meet_body(argus_t *self);

// Says why the robot may not be driven; false: it may.
bool argus_say_barred(argus_t *self);

#endif
