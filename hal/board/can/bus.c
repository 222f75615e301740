// SPDX-License-Identifier: MIT
// Between the manager and a CAN controller.
#include "board/bus.h"

#include "hal/can_telemetry.h"

#define FRAMES_MAX 3 // in a pass: as many as a controller's mailboxes
#define ORDERS_MAX 3

static hal_telemetry_t telemetry;
static hal_telemetry_frame_t held; // one that the controller would not take yet
static bool holds;
static bool is_open;

void board_bus_open(const argus_config_t *config, uint32_t now_ms) {
    hal_telemetry_init(&telemetry, 0, (uint32_t)config->stale_ms, board_can_seed(), now_ms);
    holds = false;
    is_open = board_can_open(hal_telemetry_command_id(&telemetry));
}

void board_bus_event(const argus_t *core, const argus_event_t *event) {
    argus_status_t status;
    argus_status(core, &status);
    hal_telemetry_event(&telemetry, &status, event);
}

static void tell(const argus_t *core, uint32_t now_ms) {
    argus_status_t status;
    argus_status(core, &status);
    for (int i = 0; i < FRAMES_MAX; i++) {
        holds = holds || hal_telemetry_next(&telemetry, &status, now_ms, &held);
        if (!holds || !board_can_send(held.id, held.data, held.length)) {
            return;
        }
        holds = false;
    }
}

static void obey(argus_t *core, const hal_dbc_command_t *order, uint32_t now_ms) {
    static const uint8_t ops[] = {[HAL_DBC_ORDER_STOP] = ARGUS_OP_STOP,
                                  [HAL_DBC_ORDER_GO] = ARGUS_OP_GO,
                                  [HAL_DBC_ORDER_PASSIVE] = ARGUS_OP_PASSIVE,
                                  [HAL_DBC_ORDER_ACTIVE] = ARGUS_OP_ACTIVE,
                                  [HAL_DBC_ORDER_RETEST] = ARGUS_OP_RETEST};
    argus_operator(core, now_ms, (argus_op_t)ops[order->order], order->sonar);
}

void board_bus_process(argus_t *core, uint32_t now_ms) {
    uint8_t data[HAL_DBC_LENGTH];
    hal_dbc_command_t order;
    if (!is_open) {
        return;
    }
    tell(core, now_ms);
    for (int i = 0; i < ORDERS_MAX; i++) {
        const int length = board_can_receive(data);
        if (length < 0) {
            return;
        }
        if (hal_telemetry_take(&telemetry, data, (size_t)length, now_ms, &order) == HAL_TELEMETRY_TAKEN) {
            obey(core, &order, now_ms);
        }
    }
}
