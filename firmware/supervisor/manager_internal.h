// SPDX-License-Identifier: MIT
// What the parts of the manager share: entering a mode, saying an event, commanding a motion under the
// invariants.
#ifndef ARGUS_MANAGER_INTERNAL_H
#define ARGUS_MANAGER_INTERNAL_H

#include "supervisor/manager.h"
#include "supervisor/robot_compat.h"

// Events.
void argus_say(argus_t *self, argus_event_id_t id, int sonar, int32_t value);

// Transitions.
void argus_enter(argus_t *self, argus_mode_t mode);
void argus_enter_waiting(argus_t *self, argus_wait_t why);
void argus_enter_checking(argus_t *self, bool full);
void argus_enter_verifying(argus_t *self, argus_mask_t suspects);
void argus_decide(argus_t *self); // a mode has ended well: what next?

// Motion, each under its invariant.
void argus_stop(argus_t *self, uint8_t command); // STOP or E_STOP, unless passive
void argus_halt(argus_t *self);                  // STOP, unless the robot stands and no motion is on its way
bool argus_may_turn(const argus_t *self);        // S7
bool argus_is_hemmed_in(const argus_t *self); // on its course, and has waited in vain to turn or to back away
bool argus_turn(
    argus_t *self,
    int32_t heading_cdeg); // false: S7 forbids it, and the manager reads again, waits or backs away
void argus_give_up_turn(argus_t *self); // it was commanded several times and not executed
bool argus_swing_is_blocked(const argus_t *self);
bool argus_may_translate(const argus_t *self);
bool argus_rear_is_watched(const argus_t *self); // by all its sonars, none of them out or named
bool argus_rear_is_clear(const argus_t *self);
void argus_back_off(argus_t *self, int32_t distance_mm);

// Health.
void argus_disable(argus_t *self, int sonar, argus_fault_kind_t kind);
void argus_replan(argus_t *self);
void argus_share_slots(argus_t *self); // POLLING for the present plan; again in each new session
argus_mask_t argus_open_suspects(const argus_t *self);
void argus_take_base(argus_t *self);                   // the present heading becomes the one to return to
argus_mask_t argus_wanted_sonars(const argus_t *self); // those of 1..6 that are not DISABLED
uint32_t argus_two_rounds_ms(const argus_t *self); // in which each sonar of an array has been listed twice
bool argus_health_check(argus_t *self); // the periodic one beside the main task; true when it took over
void argus_flag_suspects(argus_t *self, argus_mask_t suspects);

// Profile argus.
bool argus_judges(const argus_t *self);
void argus_judge(argus_t *self); // each SIP: convictions, names, rehabilitation
argus_mask_t argus_worth_a_look(argus_t *self);
bool argus_routine_is_due(const argus_t *self);
void argus_run_inquiry(argus_t *self);
void argus_foretell(argus_t *self); // each SIP: a sonar that gets worse

// Which robot it is.
void argus_meet_body(argus_t *self);  // a session is open: its geometry holds, and it may be driven or not
bool argus_say_barred(argus_t *self); // says why it may not be driven; false: it may

// Across missions.
void argus_meet_robot(argus_t *self); // a session is open: is it the robot of the record?

// What an operator asks of one sonar (RETEST and what follows it); false, and no event, when it cannot be
// done.
bool argus_serve(argus_t *self, argus_op_t op, int32_t sonar);

// One SIP in the present mode.
void argus_run_checking(argus_t *self);
void argus_run_verifying(argus_t *self);
void argus_run_driving(argus_t *self);
void argus_run_sweeping(argus_t *self);
void argus_run_stepping(argus_t *self);
void argus_run_backing(argus_t *self);
void argus_run_mode(argus_t *self);
void argus_react(argus_t *self, const argus_alarm_t *alarm);
void argus_wait_process(argus_t *self);

#endif
