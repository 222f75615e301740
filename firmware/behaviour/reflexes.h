// SPDX-License-Identifier: MIT
// What must happen in the SIP that shows it (S2): detectors, in the order in which they are asked.
#ifndef ARGUS_REFLEXES_H
#define ARGUS_REFLEXES_H

#include "behaviour/core.h"
#include "behaviour/intent.h"

// X(NAME, last, meaning): `last` 1: once it acts, those behind it are not asked in this SIP.
#define ARGUS_REFLEX_TABLE(X)                                                                         \
    X(bumper, 1, "a new contact: E_STOP, then away from it")                                          \
    X(leap, 0, "the odometry steps as no robot moves: STOP, a full check; again and again: given up") \
    X(slip, 0, "the ranges stay while the wheels turn: likewise")                                     \
    X(stall, 1, "a wheel stalls that stood or went free of a pressed bumper: STOP")                   \
    X(others, 0, "a sonar that does not face forward yields nothing any more, or does again (paper)") \
    X(battery, 0, "the battery is low: said once")                                                    \
    X(motors, 0, "the motors were cut, or are on again: STOP, then a full check")                     \
    X(dead, 1, "a dead or silent sonar ahead: STOP, DISABLED")                                        \
    X(object, 1, "an object in range along the motion: STOP, then looked at again at rest")           \
    X(swing, 1, "something within the swing circle in a turn: STOP (argus)")                          \
    X(flank, 1, "a wall that its way slants into, or that is not heard any more: STOP (argus)")

typedef enum {
#define ARGUS_REFLEX_ENUM(name, last, meaning) ARGUS_REFLEX_##name,
    ARGUS_REFLEX_TABLE(ARGUS_REFLEX_ENUM)
#undef ARGUS_REFLEX_ENUM
        ARGUS_REFLEXES
} argus_reflex_t;

// What the reflex wants done; it writes what the reflexes remember, and nothing else.
void argus_reflex(argus_reflex_t reflex, const argus_t *self, const argus_alarm_t *alarm,
                  argus_reflexes_t *mine, argus_intent_t *intent);
bool argus_reflex_is_last(argus_reflex_t reflex);

#endif
