// SPDX-License-Identifier: MIT
// What a client may say: the list of commands, and what of an argument is in range. A command that is not on
// the list ends here.
#ifndef ARGUS_ADMIT_H
#define ARGUS_ADMIT_H

#include "arcos/frame.h"

// What a command is about.
typedef enum {
    ARGUS_TOPIC_REFUSED,
    ARGUS_TOPIC_PASSED, // as it is, at the rate of limit.h
    ARGUS_TOPIC_SESSION,
    ARGUS_TOPIC_WAY,
    ARGUS_TOPIC_TURN,
    ARGUS_TOPIC_BOTH, // the way and the turn
    ARGUS_TOPIC_STOP,
    ARGUS_TOPIC_ENABLE,
    ARGUS_TOPIC_SETTING,
    ARGUS_TOPIC_ORIGIN,
    ARGUS_TOPIC_SONAR,
    ARGUS_TOPIC_ANALOG, // kept here: the robot's own port is the manager's
    ARGUS_TOPIC_STREAM  // passed, and ended with the client's session
} argus_topic_t;

// What may follow the command number.
typedef enum {
    ARGUS_FORM_ANY,
    ARGUS_FORM_INT,   // a type of sign and at most 32,767; missing bytes are 0
    ARGUS_FORM_WORD,  // likewise, 16 bits: two bytes in one
    ARGUS_FORM_STRING // a length and as many characters
} argus_form_t;

// X(first, last, topic, form, answer, meaning); answer: bytes that the robot says for it, about.
// What would undo that on which the bounds count is not here: calibration (TICKSMM, REVCOUNT, DRIFTFACTOR,
// GYROCALCW), gains of the wheels (ROTKP, TRANSKP, ...), motion by other hands (JOYDRIVE, LATVEL,
// RECENTERWHEELS), what a contact does (BUMPSTALL, E_STALL), the sonars (POLLING, SONAR_CYCLE), the line
// (HOSTBAUD, MAINTENANCE), power and false batteries (POWER, BATTEST).
#define ARGUS_CLIENT_TABLE(X)                                                                                \
    X(PULSE, PULSE, SESSION, ANY, 0, "kept here: a sign of life")                                            \
    X(OPEN, OPEN, SESSION, ANY, 0, "opens the client's session")                                             \
    X(CLOSE, CLOSE, SESSION, ANY, 0, "ends it; the robot's own goes on")                                     \
    X(RESET, RESET, SESSION, ANY, 0, "as CLOSE")                                                             \
    X(VEL, VEL, WAY, INT, 0, "within the bounds")                                                            \
    X(MOVE, MOVE, WAY, INT, 0, "within the bounds")                                                          \
    X(RVEL, RVEL, TURN, INT, 0, "within the bounds")                                                         \
    X(ROTATE, ROTATE, TURN, INT, 0, "as RVEL")                                                               \
    X(HEAD, HEAD, TURN, INT, 0, "within the bounds")                                                         \
    X(DHEAD, DHEAD, TURN, INT, 0, "as HEAD")                                                                 \
    X(DCHEAD, DCHEAD, TURN, INT, 0, "as HEAD")                                                               \
    X(VEL2, VEL2, BOTH, WORD, 0, "within the bounds")                                                        \
    X(STOP, STOP, STOP, ANY, 0, "at once")                                                                   \
    X(E_STOP, E_STOP, STOP, ANY, 0, "at once")                                                               \
    X(QSTOP, QSTOP, STOP, ANY, 0, "as E_STOP")                                                               \
    X(ENABLE, ENABLE, ENABLE, INT, 0, "1: where the client may move at all, later where it may not yet")     \
    X(SETV, SETV, SETTING, INT, 0, "passed")                                                                 \
    X(SETA, SETA, SETTING, INT, 0, "no weaker brake than the robot's own; no more than the settings' start") \
    X(SETRV, SETRV, SETTING, INT, 0, "at most 100 deg/s")                                                    \
    X(SETRA, SETRA, SETTING, INT, 0, "likewise; a brake of 100 deg/s2 or more")                              \
    X(SETO, SETO, ORIGIN, ANY, 0, "while argusd is passive")                                                 \
    X(SONAR, SONAR, SONAR, INT, 0, "for this client alone: what its SIPs list")                              \
    X(CONFIG, CONFIG, PASSED, INT, 150, "passed")                                                            \
    X(ENCODER, ENCODER, STREAM, INT, 14, "passed")                                                           \
    X(IOREQUEST, IOREQUEST, STREAM, INT, 40, "passed")                                                       \
    X(JOYREQUEST, JOYREQUEST, STREAM, INT, 16, "passed")                                                     \
    X(GYRO, GYRO, STREAM, INT, 30, "passed")                                                                 \
    X(IMUREQUEST, IMUREQUEST, STREAM, INT, 40, "passed")                                                     \
    X(GRIPREQUEST, GRIPREQUEST, STREAM, INT, 16, "passed")                                                   \
    X(BATTERYINFO, BATTERYINFO, PASSED, INT, 20, "passed")                                                   \
    X(SAY, SAY, PASSED, STRING, 0, "passed")                                                                 \
    X(SOUND, SOUND, PASSED, INT, 0, "passed")                                                                \
    X(PLAYLIST, PLAYLIST, PASSED, INT, 40, "passed")                                                         \
    X(SOUNDTOG, SOUNDTOG, PASSED, INT, 0, "passed")                                                          \
    X(LCDWRITE, LCDWRITE, PASSED, STRING, 0, "passed")                                                       \
    X(TTY2, TTY2, PASSED, STRING, 0, "passed")                                                               \
    X(TTY3, TTY3, PASSED, STRING, 0, "passed")                                                               \
    X(TTY4, TTY4, PASSED, STRING, 0, "passed")                                                               \
    X(GETAUX, GETAUX, PASSED, INT, 30, "passed")                                                             \
    X(GETAUX2, GETAUX2, PASSED, INT, 30, "passed")                                                           \
    X(GETAUX3, GETAUX3, PASSED, INT, 30, "passed")                                                           \
    X(AUX1BAUD, AUX3BAUD, PASSED, INT, 0, "passed")                                                          \
    X(TCM2, TCM2, PASSED, INT, 20, "passed")                                                                 \
    X(TIMER, TIMER, PASSED, INT, 0, "passed")                                                                \
    X(ADSEL, ADSEL, ANALOG, INT, 0, "for this client alone: the analog port that its SIPs show")             \
    X(DIGOUT, DIGOUT, PASSED, WORD, 0, "passed")                                                             \
    X(MOVINGBLINK, MOVINGBLINK, PASSED, INT, 0, "passed")                                                    \
    X(PTUPOS, PTUPOS, PASSED, WORD, 0, "passed")                                                             \
    X(GRIPPER, GRIPPER, PASSED, INT, 0, "passed")                                                            \
    X(GRIPPERVAL, GRIPPERVAL, PASSED, INT, 0, "passed")                                                      \
    X(ARM_FIRST, ARM_LAST, PASSED, ANY, 40, "passed")                                                        \
    X(SIM_LRF_ENABLE, SIM_LRF_SET_RES, PASSED, INT, 100, "passed: a simulator's laser")                      \
    X(SIM_STAT, SIM_STAT, PASSED, INT, 40, "passed")

// A command as it was read.
typedef struct {
    const argus_packet_t *packet;
    uint8_t command;
    uint8_t topic;    // argus_topic_t
    uint16_t cost;    // bytes of the robot's line, both ways
    int32_t argument; // of an integer or a word, else 0
} argus_said_t;

// False: it is not on the list, or its argument is out of range; `topic` is ARGUS_TOPIC_REFUSED then.
bool argus_admit(const argus_packet_t *packet, argus_said_t *said);

#endif
