// SPDX-License-Identifier: MIT
// What each key and each order asks, and what is answered.
#include "operator.h"

#include <stdio.h>

#define TURN_DEG 20
#define REPEAT_MS 1000u // a key that is held or bounces asks once

void operator_init(operator_t *self, driver_t *driver, const argus_config_t *config) {
    *self = (operator_t){.driver = driver,
                         .ahead_mm = config->step_mm,
                         .back_mm = -config->backoff_mm,
                         .judges = config->profile == ARGUS_PROFILE_ARGUS};
}

static bool ask(operator_t *self, argus_op_t op, int32_t argument) {
    const bool taken = argus_operator(self->driver->core, self->now_ms, op, argument);
    driver_transmit(self->driver);
    return taken;
}

// What a key asks of the manager; false: nothing, it is the screen's.
static bool wish_of(const operator_t *self, const argus_status_t *status, tui_key_t key, argus_op_t *op,
                    int32_t *argument) {
    const bool pinned = (status->pinned >> self->sonar & 1) != 0;
    const struct {
        tui_key_t key;
        argus_op_t op;
        int32_t argument;
    } wishes[] = {
        {TUI_AHEAD, ARGUS_OP_MOVE, self->ahead_mm},
        {TUI_BACK, ARGUS_OP_MOVE, self->back_mm},
        {TUI_LEFT, ARGUS_OP_TURN, TURN_DEG},
        {TUI_RIGHT, ARGUS_OP_TURN, -TURN_DEG},
        {TUI_STOP, ARGUS_OP_STOP, 0},
        {TUI_GO, ARGUS_OP_GO, 0},
        {TUI_RECHECK, ARGUS_OP_RECHECK, 0},
        {TUI_PASSIVE, status->active ? ARGUS_OP_PASSIVE : ARGUS_OP_ACTIVE, 0},
        {TUI_RETEST, ARGUS_OP_RETEST, self->sonar},
        {TUI_PIN, pinned ? ARGUS_OP_UNPIN : ARGUS_OP_PIN, self->sonar},
        {TUI_TAKE_OUT, ARGUS_OP_DISABLE, self->sonar},
    };
    for (size_t i = 0; i < sizeof wishes / sizeof wishes[0]; i++) {
        if (wishes[i].key == key) {
            *op = wishes[i].op;
            *argument = wishes[i].argument;
            return true;
        }
    }
    return false;
}

static bool is_of_sonar(argus_op_t op) {
    return op >= ARGUS_OP_RETEST;
}

static operator_obstacle_t obstacle_to_motion(const argus_status_t *status, argus_op_t op) {
    const bool drives = op == ARGUS_OP_MOVE || op == ARGUS_OP_TURN;
    if (!drives && op != ARGUS_OP_GO) {
        return OPERATOR_FREE;
    }
    if (!status->active) {
        return OPERATOR_PASSIVE;
    }
    if (!status->online) {
        return OPERATOR_NO_ROBOT;
    }
    if (op == ARGUS_OP_GO) {
        return status->waypoints == 0 ? OPERATOR_NO_COURSE : OPERATOR_FREE;
    }
    if (status->mode == ARGUS_MODE_CHECKING) {
        return OPERATOR_CHECKING;
    }
    return status->mode != ARGUS_MODE_IDLE ? OPERATOR_BUSY : OPERATOR_FREE;
}

static operator_obstacle_t obstacle_to(const operator_t *self, const argus_status_t *status, argus_op_t op,
                                       int sonar) {
    if (!is_of_sonar(op)) {
        return obstacle_to_motion(status, op);
    }
    const bool pinned = (status->pinned >> sonar & 1) != 0;
    if (op == ARGUS_OP_RETEST) {
        return !status->open ? OPERATOR_NO_ROBOT : pinned ? OPERATOR_PINNED : OPERATOR_FREE;
    }
    if (!self->judges) {
        return OPERATOR_PAPER;
    }
    return op == ARGUS_OP_DISABLE && pinned ? OPERATOR_PINNED : OPERATOR_FREE;
}

operator_obstacle_t operator_ask(operator_t *self, argus_op_t op, int32_t argument, uint32_t now_ms) {
    argus_status_t status;
    self->now_ms = now_ms;
    argus_status(self->driver->core, &status);
    const operator_obstacle_t obstacle = obstacle_to(self, &status, op, argument);
    if (obstacle != OPERATOR_FREE) {
        return obstacle;
    }
    return ask(self, op, argument) ? OPERATOR_FREE : OPERATOR_REFUSED;
}

// In words for who has keys.
static const char *words_of(operator_obstacle_t obstacle) {
    static const char *const words[] = {[OPERATOR_FREE] = "",
                                        [OPERATOR_PASSIVE] = "not while passive; p makes it active",
                                        [OPERATOR_NO_ROBOT] = "not without a robot",
                                        [OPERATOR_NO_COURSE] = "there is no course",
                                        [OPERATOR_CHECKING] =
                                            "it turns or checks its sonars; again in a moment",
                                        [OPERATOR_BUSY] = "not while it is busy; space stops it",
                                        [OPERATOR_PINNED] = "it is pinned; k ends that",
                                        [OPERATOR_PAPER] = "not with profile paper",
                                        [OPERATOR_REFUSED] = "it was refused"};
    return words[obstacle];
}

static const char *effect_of(tui_key_t key, argus_op_t op) {
    switch (op) {
    case ARGUS_OP_PASSIVE:
        return "passive: stops, then only reports";
    case ARGUS_OP_ACTIVE:
        return "active: drives";
    case ARGUS_OP_PIN:
        return "keeps its health until unpinned";
    case ARGUS_OP_UNPIN:
        return "the evidence decides again";
    default:
        return tui_effect_of(key);
    }
}

// A key that goes to and fro would undo itself.
static bool is_repeated(operator_t *self, tui_key_t key) {
    const bool toggles = key == TUI_PASSIVE || key == TUI_PIN;
    const bool repeated = toggles && self->toggled == key && self->now_ms - self->toggled_ms < REPEAT_MS;
    if (toggles && !repeated) {
        self->toggled = key;
        self->toggled_ms = self->now_ms;
    }
    return repeated;
}

// Round those that the robot has.
static void choose(operator_t *self, int step) {
    argus_status_t status;
    argus_status(self->driver->core, &status);
    const int sonars = status.sonars > 0 ? status.sonars : ARGUS_SONARS;
    self->sonar = (uint8_t)((self->sonar + sonars + step) % sonars);
}

static void answer_screen(operator_t *self, tui_key_t key, char *answer, size_t capacity) {
    if (key == TUI_NEXT || key == TUI_PREVIOUS) {
        choose(self, key == TUI_NEXT ? 1 : -1);
        snprintf(answer, capacity, "> %s: sonar %d is chosen", tui_keys_of(key), self->sonar);
    } else {
        snprintf(answer, capacity, "> no such key; ? shows the keys");
    }
}

void operator_key(operator_t *self, tui_key_t key, uint32_t now_ms, char *answer, size_t capacity) {
    argus_status_t status;
    argus_op_t op = ARGUS_OP_STOP;
    int32_t argument = 0;
    char whom[16] = "";
    self->now_ms = now_ms;
    argus_status(self->driver->core, &status);
    if (!wish_of(self, &status, key, &op, &argument)) {
        answer_screen(self, key, answer, capacity);
        return;
    }
    if (is_repeated(self, key)) {
        snprintf(answer, capacity, "> %s: twice within a second is once", tui_keys_of(key));
        return;
    }
    if (is_of_sonar(op)) {
        snprintf(whom, sizeof whom, "sonar %d: ", self->sonar);
    }
    const operator_obstacle_t obstacle = operator_ask(self, op, argument, now_ms);
    if (obstacle != OPERATOR_FREE) {
        snprintf(answer, capacity, "> %s: %s%s: %s", tui_keys_of(key), whom, effect_of(key, op),
                 words_of(obstacle));
    } else {
        snprintf(answer, capacity, "> %s: %s%s", tui_keys_of(key), whom, effect_of(key, op));
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
