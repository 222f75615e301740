// SPDX-License-Identifier: MIT
// Questions on the state of the manager that several of its parts ask. Nothing is changed.
#ifndef ARGUS_STATE_H
#define ARGUS_STATE_H

#include "adjustment/guard.h"
#include "behaviour/core.h"
#include "behaviour/intent.h"

// Which rules run.
static inline const argus_profile_t *argus_rules(const argus_t *const self) {
    return self->rules;
}

// The safety rules, asked of the present state.
argus_guard_t argus_guard(const argus_t *self);

// The robot touched something while no sonar ahead had heard an echo, and none has since.
bool argus_is_shown_blind(const argus_t *self, const argus_guard_t *guard);

// No sonar sees the way: none is left that could look, or they are shown to be blind.
bool argus_is_unseen(const argus_t *self, const argus_guard_t *guard);

// Which planner: the paper's rules know no adaptive one.
argus_policy_t argus_policy(const argus_t *self);

bool argus_is_active(const argus_t *self);
bool argus_is_stopped(const argus_t *self); // by an operator or a client, and nothing was ordered since
bool argus_is_open(const argus_t *self);

// The heading to return to; the present one where none is taken.
int32_t argus_base_cdeg(const argus_t *self);

// Forward-facing sonars that are in use; suspects not verified in this place, also those whose verification
// was broken off or could not be begun.
argus_mask_t argus_wanted_sonars(const argus_t *self);
argus_mask_t argus_open_suspects(const argus_t *self);

// On its course, and has waited in vain to turn or to back away.
bool argus_is_hemmed_in(const argus_t *self);

// True when the robot stands on the base heading, which is then taken. Else what leads there is in `intent`.
// `again`: an echo that forbade to turn has been read once more.
bool argus_is_home(const argus_t *self, bool again, argus_intent_t *intent);

// A turn was commanded several times and not executed.
void argus_turn_failed(const argus_t *self, argus_intent_t *intent);

// One new echo is all that forbids to turn. The sonar would hear it again were something there, so it is read
// once more.
bool argus_may_be_crosstalk(const argus_t *self, const argus_guard_t *guard);

// What is done instead of a turn that S7 forbids.
void argus_instead_of_turn(const argus_t *self, argus_intent_t *intent);

#endif
