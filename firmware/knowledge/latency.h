// SPDX-License-Identifier: MIT
// What a late link means for driving: slower (S5), no new motion while an order is overdue, and a stand.
#ifndef ARGUS_LATENCY_H
#define ARGUS_LATENCY_H

#include "arcos/roundtrip.h"
#include "knowledge/events.h"

// How late the link is; all zero: nothing is late.
typedef struct {
    argus_roundtrip_t trip;
    int32_t late_ms;   // beyond what S5 counts on anyway: of late the most
    int32_t before_ms; // ... in the last SIP
    int32_t most_ms;   // ... since some SIPs, and in as many before those
    int32_t then_ms;
    uint8_t sips;
    uint8_t level;     // said last: 0 prompt, 1 slower, 2 stands
    uint8_t calm_sips; // in a row with nothing overdue
    bool overdue;      // an order that was sent has not shown yet: no new motion
    bool stands;
} argus_latency_t;

typedef enum {
    ARGUS_LATE_AS_BEFORE,
    ARGUS_LATE_STANDS, // too much is overdue: what moves is stopped
    ARGUS_LATE_GOES_ON // after a stand; what was read meanwhile was not of its time
} argus_lateness_t;

// A session opens.
void argus_latency_open(argus_latency_t *mine, bool has_robot);

// With each SIP, after the round trip has seen it and before it is used; and whenever time passes.
argus_lateness_t argus_latency_sip(argus_latency_t *mine, const argus_config_t *config,
                                   argus_events_t *events);
argus_lateness_t argus_latency_process(argus_latency_t *mine, const argus_config_t *config,
                                       argus_events_t *events);

// By which the SIPs may be late, the last one too.
int32_t argus_latency_oldest_ms(const argus_latency_t *self);

// What the SIPs say is of now, and orders arrive: a mode may go on.
bool argus_latency_is_prompt(const argus_latency_t *self);

#endif
