// SPDX-License-Identifier: MIT
// What all parts of argusd share: exit codes and the size of a message.
#ifndef ARGUSD_H
#define ARGUSD_H

#include "argus/argus.h" // has the version

// X(NAME, code, meaning).
#define ARGUSD_EXIT_TABLE(X)                                                               \
    X(OK, 0, "goal reached, check passed, or closed by the operator (q, SIGINT, SIGTERM)") \
    X(MISSION, 1, "the mission ended without reaching the goal, or --survey may not turn") \
    X(USAGE, 2, "bad arguments, config, course or state file")                             \
    X(LINK, 3, "the link could not be opened, or was gone before a robot answered")        \
    X(NO_ROBOT, 4, "no robot answered")                                                    \
    X(INTERNAL, 5, "internal error")                                                       \
    X(UNCLEAN, 6, "ended without closing the robot's session; its watchdog stops it")      \
    X(FAULTS, 7, "--survey found a sonar broken or a suspect")

typedef enum {
#define ARGUSD_EXIT_ENUM(name, code, meaning) ARGUSD_EXIT_##name = (code),
    ARGUSD_EXIT_TABLE(ARGUSD_EXIT_ENUM)
#undef ARGUSD_EXIT_ENUM
} argusd_exit_t;

// Room for every one-line message.
#define ARGUSD_MESSAGE_MAX 1024

#endif
