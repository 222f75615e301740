// SPDX-License-Identifier: MIT
// The echo model (kernel.c), as tick.c uses it.
#ifndef ARGUS_SIM_ECHO_H
#define ARGUS_SIM_ECHO_H

#include <stdint.h>

typedef struct echo echo_t;
typedef struct patch patch_t;

enum { UNKNOWN_CELL = -1, NO_MEMORY = -2 };

// Range of one of the robot's sonars, mm, or one of the above; `others` NULL: nothing moves.
int32_t argus_sim_echo_ping(echo_t *self, int32_t sonar, double x, double y, double heading_deg,
                            double angle_deg, double gain_db, const patch_t *others);

// Each segment and corner in the axes of its owner becomes one of the world; `places`: x, y, cosine, sine.
void argus_sim_place(patch_t *here, const patch_t *shape, const int32_t *owner, const int32_t *corner_owner,
                     const double *places);

#endif
