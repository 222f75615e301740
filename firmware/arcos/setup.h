// SPDX-License-Identifier: MIT
// Orders that set the robot up or stop it, and how each is known to have arrived (SPEC.md, Connection). None
// is taken for done because it was sent: what the robot reports confirms it, else it is sent again.
#ifndef ARGUS_SETUP_H
#define ARGUS_SETUP_H

#include "arcos/command.h"
#include "arcos/configpac.h"
#include "arcos/sip.h"

// X(name, command, sign, proof, again_ms). `sign`: the row is for arguments of that sign, 0 for all. `proof`:
// what confirms it. `again_ms`: unconfirmed, it is sent again after so long, and each time after twice as
// long.
//
//     SLOWING  the wheels turn slower than in the SIP before, until they rest
//     REST     the wheels turn no faster than rest
//     ORIGIN   the position is near zero
//     TOLD     a CONFIGpac has come since
//     SETTING  the field of a CONFIGpac that came since has the value
//     SPEED    likewise; or the wheels have come to turn at it
//     SONARS   FLAGS has an array on, or a reading is listed
//     MOTORS   FLAGS has the motors on or off as ordered
//     FIRING   sonars are listed as often as the order has them, not as the order before had them
#define ARGUS_SETUP_TABLE(X)               \
    X(STOP, STOP, 0, SLOWING, 100)         \
    X(E_STOP, E_STOP, 0, SLOWING, 100)     \
    X(HALT, VEL, 0, REST, 300)             \
    X(HALT_TURN, RVEL, 0, REST, 300)       \
    X(ZERO, SETO, 0, ORIGIN, 200)          \
    X(TELL, CONFIG, 0, TOLD, 500)          \
    X(SPEED, SETV, 0, SPEED, 500)          \
    X(ACCEL, SETA, 1, SETTING, 500)        \
    X(DECEL, SETA, -1, SETTING, 500)       \
    X(TURN_SPEED, SETRV, 0, SETTING, 500)  \
    X(TURN_ACCEL, SETRA, 1, SETTING, 500)  \
    X(TURN_DECEL, SETRA, -1, SETTING, 500) \
    X(CYCLE, SONAR_CYCLE, 0, SETTING, 500) \
    X(SONAR, SONAR, 0, SONARS, 300)        \
    X(ENABLE, ENABLE, 0, MOTORS, 300)      \
    X(POLLING, POLLING, 0, FIRING, 2500)

// The rows by number.
typedef enum {
#define ARGUS_SETUP_ROW(name, command, sign, proof, again_ms) ARGUS_SETUP_##name,
    ARGUS_SETUP_TABLE(ARGUS_SETUP_ROW)
#undef ARGUS_SETUP_ROW
        ARGUS_SETUP_ROWS
} argus_setup_row_t;

// One row at work.
typedef struct {
    uint32_t sent_ms;
    int16_t value;
    uint16_t wait_ms; // until it is sent again
    uint8_t again;    // times that it was
    bool open;        // sent, and not confirmed
    bool sent;        // in this session
    bool said;        // that it stays away
} argus_setup_order_t;

#define ARGUS_SETUP_SONARS (ARCOS_TIMING_ARRAYS_MAX * ARCOS_TIMING_TRANSDUCERS_PER_ARRAY)
#define ARGUS_SETUP_POLLING_MAX (ARCOS_TIMING_ARRAYS_MAX * ARCOS_TIMING_POLLING_MAX_PER_ARRAY)

typedef struct {
    argus_setup_order_t order[ARGUS_SETUP_ROWS];
    int32_t wheel_mm_s; // of the faster wheel, in the last SIP
    uint32_t told_ms;   // the last CONFIGpac
    bool told;          // there was one in this session
    bool follows;       // one had a value that was ordered, and not the one before
    bool lists_all;     // the server lists every sonar in every SIP
    uint8_t polling_count;
    uint8_t polling[ARGUS_SETUP_POLLING_MAX]; // the order at work, one-based
    uint8_t share[ARGUS_SETUP_SONARS];        // of each sonar in it
    uint8_t share_before[ARGUS_SETUP_SONARS]; // ... in the one before
    uint8_t listed[ARGUS_SETUP_SONARS];       // readings of each since it was sent
    uint16_t first[ARGUS_SETUP_ROWS];         // what the robot told before it was set up, 0: nothing
    uint16_t last[ARGUS_SETUP_ROWS];          // what it has told last
} argus_setup_t;

// A session begins: nothing was ordered yet.
void argus_setup_init(argus_setup_t *self);

// A packet goes out: if it is such an order it is confirmed from now on, whoever sent it.
void argus_setup_sent(argus_setup_t *self, uint32_t now_ms, const uint8_t *packet, size_t length);

// What the robot reports. `before`: the set-up has not been sent yet.
void argus_setup_sip(argus_setup_t *self, uint32_t now_ms, const argus_sip_t *sip);
void argus_setup_told(argus_setup_t *self, uint32_t now_ms, const argus_configpac_t *told, bool before);

// It is not wanted any more / was seen not to hold: it is due again.
void argus_setup_drop(argus_setup_t *self, argus_setup_row_t row);
void argus_setup_doubt(argus_setup_t *self, argus_setup_row_t row);

bool argus_setup_is_open(const argus_setup_t *self, argus_setup_row_t row);

// Sends what is due again, one order a call. `rows`: a mask of those that may be. Returns the number of a
// command that stays away, once, else -1. Call it each time that time passes.
int argus_setup_resend(argus_setup_t *self, argus_outbox_t *outbox, uint32_t now_ms, unsigned rows);

#endif
