// SPDX-License-Identifier: MIT
// The sonar ring (ring.py) in C, for tick.c.
#ifndef ARGUS_SIM_RING_H
#define ARGUS_SIM_RING_H

#include "tick.h"

// Whether what fires up to then is plain; the rest is left to Python.
bool argus_sim_can_fire(const parts_t *parts, double now_ms);
void argus_sim_ring_advance(const parts_t *parts, double now_ms);

// The same angle in (-180, 180] degrees.
double argus_sim_wrapped(double degrees);

#endif
