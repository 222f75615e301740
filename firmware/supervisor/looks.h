// SPDX-License-Identifier: MIT
// Which sonars are worth a look, and what the looks have shown (profile argus).
#ifndef ARGUS_LOOKS_H
#define ARGUS_LOOKS_H

#include "supervisor/core.h"

// What is worth a stop now: evidence that a look can settle, a lost echo ahead, a bearing unseen for too
// long.
argus_mask_t argus_worth_a_look(const argus_t *self);

// A look at all of them is due.
bool argus_routine_is_due(const argus_t *self);

// The looks are over: whoever was asked is acquitted, or left open.
void argus_conclude_looks(argus_t *self);

// They are not to be looked at in this place, and covered for like those that are out.
void argus_leave_open(argus_t *self, argus_mask_t sonars);

// An operator wants it looked at: its acquittals are forgotten.
void argus_forget_acquittals(argus_t *self, int sonar);

#endif
