// SPDX-License-Identifier: MIT
// The ARCOS session: find the robot, open it, keep it, find it again, leave it in order (SPEC.md,
// Connection).
#ifndef ARGUS_SESSION_H
#define ARGUS_SESSION_H

#include "arcos/command.h"
#include "arcos/configpac.h"
#include "arcos/copies.h"
#include "arcos/identity.h"
#include "arcos/setup.h"
#include "arcos/sip.h"
#include "argus/argus.h"

typedef enum {
    ARGUS_SESSION_DOWN,     // no transport
    ARGUS_SESSION_PAUSE,    // waits before the next attempt
    ARGUS_SESSION_LISTEN,   // 250 ms, each attempt begins so: is an old session still reporting?
    ARGUS_SESSION_HALT,     // VEL 0, RVEL 0 sent; the old session tells where the robot comes to rest, 3 s at
                            // most
    ARGUS_SESSION_DISLODGE, // VEL 0, RVEL 0, CLOSE sent; 100 ms of flushing
    ARGUS_SESSION_SYNC0,
    ARGUS_SESSION_SYNC1,
    ARGUS_SESSION_SYNC2,
    ARGUS_SESSION_OPENING, // OPEN sent; CONFIG asked for, at most 1 s; waits for the first SIP
    ARGUS_SESSION_OPEN,    // set up, SIPs are coming
    ARGUS_SESSION_LEAVING, // SONAR 0, STOP, CLOSE sent; no SIP may come any more
    ARGUS_SESSION_CLOSED
} argus_session_state_t;

// What a call on the session brought about; several bits may be set.
enum {
    ARGUS_SESSION_GOT_SIP = 1 << 0, // self->sip is new
    ARGUS_SESSION_DID_OPEN = 1 << 1,
    ARGUS_SESSION_DID_LOSE =
        1 << 2, // no SIP for link_lost_ms, or the robot was reset: starts again by itself
    ARGUS_SESSION_DID_STALL = 1 << 3,  // no SIP for link_stall_ms
    ARGUS_SESSION_DID_RESUME = 1 << 4, // a SIP after a stall: VEL 0 and RVEL 0 go out before all but E_STOP
    ARGUS_SESSION_NO_ANSWER = 1 << 5,  // one attempt failed
    ARGUS_SESSION_DID_DISLODGE = 1 << 6,
    ARGUS_SESSION_DID_CLOSE = 1 << 7,
    ARGUS_SESSION_OTHER_ROBOT = 1 << 8, // than in the session before
    ARGUS_SESSION_GOT_COPY = 1 << 9     // a SIP of before came once more, and was passed over
};

typedef struct {
    argus_session_state_t state;
    bool has_robot;
    uint8_t differs; // in which part it was not the one before, see argus_identity_meet()
    bool stalled;
    bool closed_said;
    bool observed;        // no ARCOS: nothing is ever said
    bool origin_due;      // a SETO is on its way since: positions may be counted from there
    uint32_t since_ms;    // entry into the state
    uint32_t tried_ms;    // last CONFIG sent
    uint32_t spoke_ms;    // last packet handed out
    uint32_t heard_ms;    // last SIP
    uint32_t gap_ms;      // length of the last stall
    uint32_t pause_ms;    // this back-off, or the next
    uint16_t attempts;    // since the link came up or the last session ended, this one included
    uint8_t dislodged;    // old sessions closed in this attempt
    uint8_t opening_sips; // since OPEN
    uint8_t zeros_due;    // 2: VEL 0 and RVEL 0 are to be sent, 1: RVEL 0
    uint32_t sips;        // monotonic counters
    uint32_t unknown_packets;
    uint32_t bad_sips;         // right checksum, wrong inside
    argus_identity_t identity; // of the last robot met
    argus_sip_t sip;           // the last one
    argus_copies_t copies;     // of this session
    argus_outbox_t outbox;
    argus_setup_t setup;       // orders of this session, and what has come of them
    char name[ARGUS_NAME_MAX]; // from the SYNC2 reply
    char robot_class[ARGUS_NAME_MAX];
    char subclass[ARGUS_NAME_MAX];
    argus_configpac_t
        robot; // zero until a CONFIGpac came; its settings are the robot's own, 0 if it came late
    argus_parser_t parser;
} argus_session_t;

void argus_session_init(argus_session_t *self);

// The transport is open: begins to listen. / is gone: everything waiting is dropped.
void argus_session_link_up(argus_session_t *self, uint32_t now_ms);
void argus_session_link_down(argus_session_t *self);

// Takes bytes until the first packet that sets a bit, so that no SIP is overwritten unseen; `*taken` says how
// many. Several packets can be complete. So call again with the rest, which may be none, until all bytes are
// taken and no bit is set. With OPEN go VEL 0, RVEL 0, SETO and CONFIG. The second SIP after that counts its
// position from SETO. With it and CONFIGpac, which is waited for at most 1 s, the rest of the set-up goes
// out. That is SETV, SETA +-, SETRV, SETRA +-, SONAR 1, and SONAR_CYCLE when it is not known to be the
// robot's. The motors are enabled by the code that knows the robot. Before ARGUS_SESSION_DID_OPEN no SIP is
// reported but the one of an old session that is found when listening.
unsigned argus_session_receive(argus_session_t *self, const argus_config_t *config, uint32_t now_ms,
                               const uint8_t *bytes, size_t count, size_t *taken);

// Timers: 500 ms per SYNC, back-off 500 ms doubling to retry_max_ms, PULSE, stall, loss. Returns bits as
// above (a packet released by the parser's time rules too, GOT_SIP). Call at least every 100 ms, until it
// returns 0. During a stall STOP goes out before each PULSE, or the first PULSE that gets through would set
// the robot moving again.
unsigned argus_session_process(argus_session_t *self, const argus_config_t *config, uint32_t now_ms);

// self->sip was filled in by another than the robot. Opens a session of its own where there is none; bits as
// above, 0 once it is left.
unsigned argus_session_observe(argus_session_t *self, const argus_config_t *config, uint32_t now_ms);

// Sends again what the robot does not report, in an open session. `rows`: a mask of the orders that may be.
// Returns the number of a command that stays away, once, else -1.
int argus_session_resend(argus_session_t *self, uint32_t now_ms, unsigned rows);

// Orderly end: SONAR 0, STOP, ENABLE 0, CLOSE, if a session is open. The robot should be at rest by then.
// Final: ARGUS_SESSION_DID_CLOSE comes from argus_session_process(), after which only argus_session_init()
// starts anew.
void argus_session_leave(argus_session_t *self, uint32_t now_ms);

// Next packet for the wire; remembers the time for PULSE. While nothing may be said (DOWN, PAUSE, LISTEN,
// CLOSED) what was queued is dropped.
size_t argus_session_transmit(argus_session_t *self, uint32_t now_ms, uint8_t *packet, size_t capacity);

bool argus_session_is_open(const argus_session_t *self);
// Thousandths of a mm per position unit: `usual_um`, or 485 for the older controller, "p3dx" in any letter
// case.
int32_t argus_session_distance_um(const argus_session_t *self, int32_t usual_um);

#endif
