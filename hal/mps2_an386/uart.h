// SPDX-License-Identifier: MIT
// The two UARTs of the MPS2 board, each with a ring in both directions.
#ifndef MPS2_UART_H
#define MPS2_UART_H

#include "board/ring.h"
#include "mps2_an386/registers.h"

typedef struct {
    mps2_uart_t *registers;
    board_ring_t in;
    board_ring_t out;
    uint32_t overruns; // bytes that came before the last one was fetched, monotonic
} mps2_uart_port_t;

extern mps2_uart_port_t mps2_robot;
extern mps2_uart_port_t mps2_console;

void mps2_uart_open(mps2_uart_port_t *self, uint32_t baud);
// Begins to send what was put into `out`.
void mps2_uart_kick(mps2_uart_port_t *self);

// Interrupts.
void mps2_uart_received(mps2_uart_port_t *self);
void mps2_uart_sent(mps2_uart_port_t *self);
void mps2_uart_overrun(mps2_uart_port_t *self);

#endif
