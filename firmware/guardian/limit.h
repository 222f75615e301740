// SPDX-License-Identifier: MIT
// How much a client may say: so that no flood delays a STOP or a SIP on the robot's line, which may be one of
// 9600 baud.
#ifndef ARGUS_LIMIT_H
#define ARGUS_LIMIT_H

#include <stdbool.h>
#include <stdint.h>

// All zero: nothing was said.
typedef struct {
    uint32_t filled_ms; // when `used` was last lowered
    uint32_t second_ms; // the second that runs
    uint32_t used;      // thousandths of bytes of the robot's line
    uint8_t orders;     // to the wheels since the last SIP
    uint8_t words;      // refusals that were said in this second
    uint32_t dropped;   // commands in this second
} argus_limit_t;

// Whether an order to the wheels goes out at once. Else the last of them does, with the next SIP.
bool argus_limit_order(argus_limit_t *self);
void argus_limit_sip(argus_limit_t *self);

// Whether something passes that takes so many bytes of the robot's line; false: it is counted.
bool argus_limit_pass(argus_limit_t *self, uint32_t now_ms, uint16_t bytes);

// Whether a refusal is an event: some in a second, so that others are seen beside them.
bool argus_limit_word(argus_limit_t *self);

// Once a second; commands that were dropped in it.
uint32_t argus_limit_second(argus_limit_t *self, uint32_t now_ms);

#endif
