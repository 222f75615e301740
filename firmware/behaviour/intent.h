// SPDX-License-Identifier: MIT
// What a mode, a reflex or an order wants done. modes.c alone does it.
#ifndef ARGUS_INTENT_H
#define ARGUS_INTENT_H

#include "argus/argus.h"
#include "knowledge/echoes.h"

typedef enum {
    ARGUS_DO_NOTHING, // go on as it is
    // motions
    ARGUS_DO_HOLD,     // wait for rest, on whatever heading
    ARGUS_DO_BRAKE,    // a STOP that belongs to the way
    ARGUS_DO_TURN,     // to `cdeg`; where S7 forbids it: read again, back away or wait
    ARGUS_DO_DRIVE,    // `mm` ahead at the driving speed, and if `steers` the bearing `cdeg`
    ARGUS_DO_STEP,     // STEPPING: `mm` ahead at the speed of a step
    ARGUS_DO_CREEP,    // CREEPING: `mm` ahead at its speed, and if `steers` the bearing `cdeg`
    ARGUS_DO_BACK,     // BACKING: `mm` at `speed_mm_s`, if it may back away
    ARGUS_DO_ENABLE,   // motors on
    ARGUS_DO_END_TURN, // something is in the way at `at`: remembered, STOP, then a full check
    // modes
    ARGUS_DO_CHECK,      // CHECKING: `full`: as many rounds of readings as Algorithm 1 wants for a suspect
    ARGUS_DO_VERIFY,     // VERIFYING, for `sonars`
    ARGUS_DO_SWEEP,      // SWEEPING: the way must be seen
    ARGUS_DO_WAIT,       // WAITING, because of `why`
    ARGUS_DO_DECIDE,     // a mode has ended well: what next?
    ARGUS_DO_TURN_ABOUT, // the other end leads; then a full check
    ARGUS_DO_GIVE_UP,    // the course: failed; then a full check
    ARGUS_DO_GO_OFFLINE, // OFFLINE, or CLOSED when it is leaving
    ARGUS_DO_LEAVE,      // CLOSING
    ARGUS_DO_END,        // CLOSED
    // judgements
    ARGUS_DO_CHECK_BESIDE, // the periodic health check beside the main task
    ARGUS_DO_CONCLUDE,     // every sonar has reported: the health check is over
    ARGUS_DO_VERDICT,      // Algorithm 2 has come to one
    ARGUS_DO_LOOK,         // looks begin for `sonars`: turn to `cdeg`
    ARGUS_DO_LOOKED,       // they are over
    ARGUS_DO_LEAVE_OPEN,   // `sonars` are not to be looked at here
    ARGUS_DO_LOSE,         // `sonars` are dead, `silent` yield nothing: DISABLED
    ARGUS_DO_WATCH, // of `sonars`, that do not face forward, STALE ones report again, others do not any more
    ARGUS_DO_REACH  // the goal is reached
} argus_act_t;

typedef enum { ARGUS_STOP_NONE, ARGUS_STOP_HALT, ARGUS_STOP_STOP, ARGUS_STOP_E_STOP } argus_stop_t;
typedef enum { ARGUS_BASE_KEEP, ARGUS_BASE_TAKE, ARGUS_BASE_RENEW, ARGUS_BASE_DROP } argus_base_do_t;
typedef enum { ARGUS_WAY_KEEP, ARGUS_WAY_REFUSE, ARGUS_WAY_FORGIVE } argus_way_t;

// Done in this order: the event, the stop (HALT: only what moves or is about to), the way ahead, `unchecked`,
// the base heading, the act. All zero: nothing.
typedef struct {
    uint16_t event; // said first, about `sonar`; 0: none
    int8_t sonar;
    uint8_t stop;   // argus_stop_t
    uint8_t way;    // argus_way_t: the present heading is refused to the course, or all are tried again
    uint8_t base;   // argus_base_do_t: the present heading becomes the one to return to, if there is none, or
                    // anyway
    uint8_t act;    // argus_act_t
    uint8_t why;    // argus_wait_t
    uint8_t met;    // argus_contact_t: what the body met is remembered
    bool unchecked; // nothing translates before a full check
    bool full;
    bool all_round; // CHECK: a round of all sonars, not only of those that look ahead
    bool again;     // CHECK: it is an echo that is read once more before a turn
    bool moves_on;  // DRIVE, STEP, CREEP: the robot will stand somewhere else
    bool steers;
    bool more;     // the mode has more to do in this SIP
    int32_t value; // of the event
    int32_t mm;
    int32_t speed_mm_s;
    int32_t cdeg;
    argus_point_t at;
    argus_mask_t sonars;
    argus_mask_t silent;
} argus_intent_t;

// One is begun as nothing and filled in where it lies: dozens are made, and each copy of one costs code.
void argus_to_check(argus_intent_t *intent, bool full);
void argus_to_turn(argus_intent_t *intent, int32_t heading_cdeg);
void argus_to_wait(argus_intent_t *intent, argus_wait_t why);
void argus_to_say(argus_intent_t *intent, argus_event_id_t event, int sonar, int32_t value);

#endif
