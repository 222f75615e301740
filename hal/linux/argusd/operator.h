// SPDX-License-Identifier: MIT
// The operator's wishes, by key or by order over CAN, as what the manager is asked.
#ifndef ARGUSD_OPERATOR_H
#define ARGUSD_OPERATOR_H

#include "driver.h"
#include "hal/gen_argus_dbc.h"
#include "tui_key.h"

typedef struct {
    uint8_t sonar;    // the chosen one
    int32_t ahead_mm; // of one key
    int32_t back_mm;
    bool judges; // profile argus
    uint32_t now_ms;
    tui_key_t toggled; // the last key that goes to and fro, pressed at toggled_ms
    uint32_t toggled_ms;
    driver_t *driver;
} operator_t;

void operator_init(operator_t *self, driver_t *driver, const argus_config_t *config);

// Not for TUI_QUIT and TUI_GONE, which are the loop's. `answer`: the key and what it does, or why not.
void operator_key(operator_t *self, tui_key_t key, uint32_t now_ms, char *answer, size_t capacity);

// What stands against a wish.
typedef enum {
    OPERATOR_FREE,
    OPERATOR_PASSIVE,
    OPERATOR_NO_ROBOT,
    OPERATOR_NO_COURSE,
    OPERATOR_CHECKING, // as after each stop and turn: it passes
    OPERATOR_BUSY,
    OPERATOR_PINNED,
    OPERATOR_PAPER,
    OPERATOR_REFUSED // by the manager itself
} operator_obstacle_t;

// Asks the manager, if nothing stands against it.
operator_obstacle_t operator_ask(operator_t *self, argus_op_t op, int32_t argument, uint32_t now_ms);

// An order that was taken.
void operator_order(operator_t *self, const hal_dbc_command_t *order, uint32_t now_ms);

#endif
