// SPDX-License-Identifier: MIT
// SIPs as a client gets them: without the readings of sonars that are out, or with what others heard there.
#ifndef ARGUS_REWRITE_H
#define ARGUS_REWRITE_H

#include "behaviour/core.h"

#define ARGUS_ANALOG_PORTS 8

// The analog ports as the robot has shown them last; a client sees its own, whichever the robot shows now.
typedef struct {
    uint8_t value[ARGUS_ANALOG_PORTS];
    uint8_t known; // bit k: port k was shown
    uint8_t wants; // what the client has chosen
    uint8_t shows; // what it is shown: that, once it is known
    bool begun;
} argus_analog_t;

// What a client wants of a SIP.
typedef struct {
    argus_readings_t readings;
    uint8_t arrays; // bit k: it wants the sonars of array k, from 0
    const argus_analog_t *analog;
} argus_rewrite_t;

// With each SIP of the robot, whether a client is there or not.
void argus_rewrite_note_analog(argus_analog_t *analog, const uint8_t *data, size_t count);

// Data of a SIP to data for the client, which are never longer; returns how many, 0: it is no SIP that is
// whole. Readings of sonars beyond those that are managed, and all else, stay as they are. Cost: one pass;
// `cover`: one over the ray log for each reading that is covered.
size_t argus_rewrite_sip(const argus_t *self, const argus_rewrite_t *how, const uint8_t *data, size_t count,
                         uint8_t *out);

// The reading that covers for a sonar that is out: from its transducer to the nearest echo within its cone. A
// trusted sonar heard that in the last 2 s, within 2 m of itself. 0: there is none.
int32_t argus_rewrite_cover_mm(const argus_t *self, int sonar);

#endif
