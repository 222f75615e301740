// SPDX-License-Identifier: MIT
// What a late link means for driving: slower (S5), no new motion while an order is overdue, and a stand.
#ifndef ARGUS_LATENCY_H
#define ARGUS_LATENCY_H

#include "arcos/roundtrip.h"

// The manager's; all zero: nothing is late.
typedef struct {
    argus_roundtrip_t trip;
    int32_t late_ms;   // beyond what S5 counts on anyway: of late the most, fading
    int32_t before_ms; // ... in the last SIP
    uint8_t level;     // said last: 0 prompt, 1 slower, 2 stands
    uint8_t calm_sips; // in a row with nothing overdue
    bool overdue;      // an order that was sent has not shown yet: no new motion
    bool stands;
} argus_latency_t;

struct argus;

// A session opens.
void argus_latency_open(struct argus *self);

// With each SIP, before it is used; and whenever time passes: STOP once too much is overdue.
void argus_latency_sip(struct argus *self);
void argus_latency_process(struct argus *self);

// By which the SIPs may be late, the last one too.
int32_t argus_latency_oldest_ms(const argus_latency_t *self);

// What the SIPs say is of now, and orders arrive: a mode may go on.
bool argus_latency_is_prompt(const argus_latency_t *self);

#endif
