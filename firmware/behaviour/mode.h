// SPDX-License-Identifier: MIT
// The modes and the ways between them, as tables. DESIGN.md's diagram is made of them.
#ifndef ARGUS_MODE_H
#define ARGUS_MODE_H

#include "argus/argus.h"

// What a mode may do, and what may happen to it.
#define ARGUS_MAY_TURN 1u       // turns are commanded
#define ARGUS_MAY_TRANSLATE 2u  // MOVEs are
#define ARGUS_MAY_REACT 4u      // reflexes are asked
#define ARGUS_MAY_JUDGE 8u      // the evidence judges (profile argus)
#define ARGUS_MAY_BREAK_OFF 16u // a loss or a conviction ahead leads to a check
#define ARGUS_IN_SESSION (ARGUS_MAY_REACT | ARGUS_MAY_JUDGE)

// X(NAME, may, limit_ms, then, meaning): `limit_ms`: after it the mode ends by itself, in the mode `then`. 0:
// no limit but that of its motions (adjustment/motion.h).
#define ARGUS_MODE_TABLE(X)                                                                                  \
    X(OFFLINE, 0, 0, OFFLINE, "no session with a robot")                                                     \
    X(CHECKING, ARGUS_IN_SESSION | ARGUS_MAY_TURN | ARGUS_MAY_BREAK_OFF, 0, CHECKING,                        \
      "at rest: every forward-facing sonar reports before anything moves")                                   \
    X(VERIFYING, ARGUS_IN_SESSION | ARGUS_MAY_TURN, 0, VERIFYING,                                            \
      "neighbours turn onto a suspect's bearing, or the robot looks round")                                  \
    X(IDLE, ARGUS_IN_SESSION | ARGUS_MAY_BREAK_OFF, 0, IDLE, "nothing to do")                                \
    X(DRIVING, ARGUS_IN_SESSION | ARGUS_MAY_TURN | ARGUS_MAY_TRANSLATE | ARGUS_MAY_BREAK_OFF, 0, DRIVING,    \
      "drives, every bearing ahead in use")                                                                  \
    X(SWEEPING, ARGUS_IN_SESSION | ARGUS_MAY_TURN | ARGUS_MAY_BREAK_OFF, 0, SWEEPING,                        \
      "failure mode, at rest: turns through the plan's rotations")                                           \
    X(STEPPING, ARGUS_IN_SESSION | ARGUS_MAY_TRANSLATE | ARGUS_MAY_BREAK_OFF, 0, STEPPING, "one step ahead") \
    X(BACKING, ARGUS_IN_SESSION | ARGUS_MAY_TRANSLATE, 0, BACKING,                                           \
      "away from a pressed bumper or a blocked swing circle")                                                \
    X(WAITING, ARGUS_IN_SESSION, 0, WAITING, "cannot go on by itself")                                       \
    X(CLOSING, 0, 1500, CLOSED, "comes to rest, then the session is closed")                                 \
    X(CLOSED, 0, 0, CLOSED, "over")                                                                          \
    X(CREEPING, ARGUS_IN_SESSION | ARGUS_MAY_TURN | ARGUS_MAY_TRANSLATE | ARGUS_MAY_BREAK_OFF, 0, CREEPING,  \
      "no sonar sees the way: slowly, on the bumpers alone")

// X(FROM, TO, when): every way from one mode to another. ANY: every mode in a session.
#define ARGUS_WAY_TABLE(X)                                                         \
    X(OFFLINE, CHECKING, "a session opens")                                        \
    X(ANY, CHECKING, "reflex, conviction, order, end of a motion")                 \
    X(CHECKING, VERIFYING, "suspects, or a look is due")                           \
    X(CHECKING, IDLE, "no course, or paused")                                      \
    X(CHECKING, DRIVING, "every bearing ahead in use")                             \
    X(CHECKING, SWEEPING, "a bearing is blind")                                    \
    X(CHECKING, CREEPING, "no sonar sees the way, and the operator lets it creep") \
    X(IDLE, VERIFYING, "suspects")                                                 \
    X(IDLE, DRIVING, "an operator's step")                                         \
    X(IDLE, SWEEPING, "an operator's step, a bearing is blind")                    \
    X(IDLE, CREEPING, "an operator's step, likewise")                              \
    X(DRIVING, VERIFYING, "suspects, or a look is due")                            \
    X(DRIVING, STEPPING, "an operator's step")                                     \
    X(DRIVING, SWEEPING, "a bearing is blind, and the way is not seen far enough") \
    X(DRIVING, IDLE, "at the goal")                                                \
    X(SWEEPING, VERIFYING, "suspects")                                             \
    X(SWEEPING, STEPPING, "the sweep found nothing near")                          \
    X(SWEEPING, DRIVING, "the sweep has seen the way")                             \
    X(SWEEPING, IDLE, "at the goal")                                               \
    X(STEPPING, SWEEPING, "the step is done")                                      \
    X(STEPPING, DRIVING, "... and every bearing is in use again")                  \
    X(STEPPING, IDLE, "an operator's step is done")                                \
    X(CREEPING, VERIFYING, "suspects")                                             \
    X(CREEPING, IDLE, "at the goal, or an operator's step is done")                \
    X(ANY, BACKING, "no room to turn, a bumper, or an operator's order")           \
    X(ANY, WAITING, "bumper, motors off, no room to turn, no way, all ahead out")  \
    X(ANY, OFFLINE, "the link is lost")                                            \
    X(ANY, CLOSING, "shutdown")                                                    \
    X(OFFLINE, CLOSING, "shutdown while a session is being opened")                \
    X(OFFLINE, CLOSED, "shutdown")                                                 \
    X(CLOSING, CLOSED, "the session is closed, or the link is lost")

// Whether there is a way between the two, or they are one.
bool argus_mode_may_follow(argus_mode_t from, argus_mode_t to);
bool argus_mode_may(argus_mode_t mode, unsigned what);
uint32_t argus_mode_limit_ms(argus_mode_t mode);

#endif
