// SPDX-License-Identifier: MIT
// Tells a SIP that a link delivers a second time, behind newer ones, from one of now.
#ifndef ARGUS_COPIES_H
#define ARGUS_COPIES_H

#include "arcos/frame.h"

#define ARGUS_COPIES_KEPT 32 // SIPs, some 3 s

// Where a SIP says that the robot is, and the checksum over all that it says.
typedef struct {
    uint16_t x, y, heading, sum;
} argus_sip_mark_t;

// All zero: none has come.
typedef struct {
    argus_sip_mark_t kept[ARGUS_COPIES_KEPT];
    uint8_t count;           // of those kept
    uint8_t last;            // the newest one
    bool passing;            // the last one was a copy,
    argus_sip_mark_t passed; // ... this one
    uint32_t found;
} argus_copies_t;

// True: the same SIP has come before, others have come since, and the last of them was farther away than a
// robot goes that comes to rest where it was. Of less a copy tells nothing that is wrong: at rest all SIPs
// are alike. Nor is the next one of the same place: the robot was put back, and is there. Cost: one pass over
// those kept, where the step is so large.
bool argus_copies_has(argus_copies_t *self, const argus_packet_t *packet);

#endif
