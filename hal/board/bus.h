// SPDX-License-Identifier: MIT
// Telemetry and orders over CAN, with the frames of tools/argus.dbc; for a port that has a controller
// (ARGUS_CAN).
#ifndef BOARD_BUS_H
#define BOARD_BUS_H

#include "argus/argus.h"

// Of the port.
bool board_can_open(uint16_t rx_id);
bool board_can_send(uint16_t id, const uint8_t *data, uint8_t length); // false: not now
int board_can_receive(uint8_t data[8]);                                // a frame's length, -1: none
uint64_t board_can_seed(void);                                         // another one at each start

// Of bus.c; without it they do nothing (optional.c).
void board_bus_open(const argus_config_t *config, uint32_t now_ms);
void board_bus_event(const argus_t *core, const argus_event_t *event);
void board_bus_process(argus_t *core, uint32_t now_ms);

#endif
