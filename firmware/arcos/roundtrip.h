// SPDX-License-Identifier: MIT
// How long it takes from an order to its effect in what the robot reports, measured all the time: it shows
// the number of the analog port that ADSEL has chosen last. One that does not is asked for its CONFIGpac.
#ifndef ARGUS_ROUNDTRIP_H
#define ARGUS_ROUNDTRIP_H

#include "arcos/session.h"

#define ARGUS_ROUNDTRIP_PORTS 8

// All zero: not begun.
typedef struct {
    uint32_t sent_ms[ARGUS_ROUNDTRIP_PORTS]; // of the order with this number
    uint32_t seen_ms;                        // when the newest order was sent of which the effect is seen
    uint32_t last_ms;                        // the last one was sent
    uint32_t begun_ms;                       // the first one was
    uint32_t asked_ms;                       // CONFIG was asked for; the first time, where no answer came
    uint32_t again_ms;                       // ... the last time
    uint32_t took_ms;                        // the last CONFIG took so long
    uint8_t newest;                          // number of the last order sent
    uint8_t waiting;                         // orders sent of which no effect is seen yet
    bool begun;                              // since the session opened
    bool shows;                              // the robot shows the port
    bool mute;                               // it does not
    bool answers;                            // it answers CONFIG
    bool asks;                               // an answer is waited for
} argus_roundtrip_t;

// A session has opened: the CONFIGpac of the opening shows that the robot answers.
void argus_roundtrip_begin(argus_roundtrip_t *self, bool answers);

// With each SIP: sees which orders have arrived, and sends the next one. One or two packets of 9 bytes.
void argus_roundtrip_sip(argus_roundtrip_t *self, argus_session_t *session, const argus_config_t *config,
                         uint32_t now_ms);

// The robot shows something of what it was sent.
bool argus_roundtrip_is_known(const argus_roundtrip_t *self);

// No more than this is the age of the newest order that is known to have arrived. So it bounds both the age
// of what the last SIP says and the time that an order takes. 0: not known.
int32_t argus_roundtrip_ms(const argus_roundtrip_t *self, uint32_t now_ms);

// The same on a link without delay: cycles, and what the wire takes.
int32_t argus_roundtrip_usual_ms(const argus_roundtrip_t *self, const argus_config_t *config);

#endif
