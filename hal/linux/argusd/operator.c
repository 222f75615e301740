// SPDX-License-Identifier: MIT
// What each key and each order asks.
#include "operator.h"

#define TURN_DEG 20

void operator_init(operator_t *self, driver_t *driver, const argus_config_t *config) {
    *self = (operator_t){.driver = driver, .ahead_mm = config->step_mm, .back_mm = -config->backoff_mm};
}

static void ask(operator_t *self, argus_op_t op, int32_t argument) {
    argus_operator(self->driver->core, self->now_ms, op, argument);
    driver_transmit(self->driver);
}

static argus_status_t status_of(const operator_t *self) {
    argus_status_t status;
    argus_status(self->driver->core, &status);
    return status;
}

static void drive(operator_t *self, tui_key_t key) {
    if (key == TUI_LEFT || key == TUI_RIGHT) {
        ask(self, ARGUS_OP_TURN, key == TUI_LEFT ? TURN_DEG : -TURN_DEG);
    } else {
        ask(self, ARGUS_OP_MOVE, key == TUI_AHEAD ? self->ahead_mm : self->back_mm);
    }
}

// True when the key was for the chosen sonar.
static bool serve_sonar(operator_t *self, tui_key_t key) {
    const bool pinned = (status_of(self).pinned >> self->sonar & 1) != 0;
    switch (key) {
    case TUI_NEXT:
        self->sonar = (uint8_t)((self->sonar + 1) % ARGUS_SONARS);
        return true;
    case TUI_PREVIOUS:
        self->sonar = (uint8_t)((self->sonar + ARGUS_SONARS - 1) % ARGUS_SONARS);
        return true;
    case TUI_RETEST:
        ask(self, ARGUS_OP_RETEST, self->sonar);
        return true;
    case TUI_PIN:
        ask(self, pinned ? ARGUS_OP_UNPIN : ARGUS_OP_PIN, self->sonar);
        return true;
    case TUI_TAKE_OUT:
        ask(self, ARGUS_OP_DISABLE, self->sonar);
        return true;
    default:
        return false;
    }
}

void operator_key(operator_t *self, tui_key_t key, uint32_t now_ms) {
    self->now_ms = now_ms;
    if (serve_sonar(self, key)) {
        return;
    }
    switch (key) {
    case TUI_STOP:
        ask(self, ARGUS_OP_STOP, 0);
        break;
    case TUI_GO:
        ask(self, ARGUS_OP_GO, 0);
        break;
    case TUI_RECHECK:
        ask(self, ARGUS_OP_RECHECK, 0);
        break;
    case TUI_PASSIVE:
        ask(self, status_of(self).active ? ARGUS_OP_PASSIVE : ARGUS_OP_ACTIVE, 0);
        break;
    case TUI_AHEAD:
    case TUI_BACK:
    case TUI_LEFT:
    case TUI_RIGHT:
        drive(self, key);
        break;
    default:
        break;
    }
}

void operator_order(operator_t *self, const hal_dbc_command_t *order, uint32_t now_ms) {
    static const argus_op_t ops[] = {[HAL_DBC_ORDER_STOP] = ARGUS_OP_STOP,
                                     [HAL_DBC_ORDER_GO] = ARGUS_OP_GO,
                                     [HAL_DBC_ORDER_PASSIVE] = ARGUS_OP_PASSIVE,
                                     [HAL_DBC_ORDER_ACTIVE] = ARGUS_OP_ACTIVE,
                                     [HAL_DBC_ORDER_RETEST] = ARGUS_OP_RETEST};
    self->now_ms = now_ms;
    ask(self, ops[order->order], order->sonar);
}
