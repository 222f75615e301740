// SPDX-License-Identifier: MIT
// bxCAN 1 at 500 kbit/s: PB8 receives, PB9 sends, through a transceiver. It comes back from bus-off by
// itself.
#ifndef STM32_CAN_H
#define STM32_CAN_H

#include <stdbool.h>
#include <stdint.h>

// Takes frames of the one 11-bit id `rx_id`. False: the controller does not start, since nothing is at its
// pins.
bool stm32_can_open(uint16_t rx_id);

// False: all three mailboxes wait; `length` is at most 8.
bool stm32_can_send(uint16_t id, const uint8_t *data, uint8_t length);

// The length of the next frame, -1: none.
int stm32_can_receive(uint8_t data[8]);

#endif
