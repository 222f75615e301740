// SPDX-License-Identifier: MIT
// Orders at the control socket: what each needs and what it asks of the manager.
#ifndef ARGUSD_CONTROL_ORDERS_H
#define ARGUSD_CONTROL_ORDERS_H

#include "control_request.h"
#include "inject.h"
#include "operator.h"

typedef struct {
    operator_t *op;   // never NULL
    inject_t *inject; // never NULL
    uint32_t now_ms;
    bool ending;  // argusd ends already
    bool quits;   // ... or was ordered to
    bool ordered; // any order was carried out
    bool by_hand; // it moves, if it does, by step or turn
} control_hands_t;

// Carries out the order that the request names. False: `answer` says why not.
bool control_order(control_hands_t *self, const control_request_t *request, control_answer_t *answer);

// No client leads it any more: a motion by hand that goes on is stopped.
void control_let_go(control_hands_t *self);

#endif
