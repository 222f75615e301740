// SPDX-License-Identifier: MIT
// UARTs of one byte each way: the interrupts do what a FIFO would.
#include "mps2_an386/uart.h"

#include "cortexm/cortexm.h"

static uint8_t robot_in[256];
static uint8_t robot_out[256];
static uint8_t console_in[128];
static uint8_t console_out[1024];

mps2_uart_port_t mps2_robot = {MPS2_UART0, BOARD_RING(robot_in), BOARD_RING(robot_out), 0};
mps2_uart_port_t mps2_console = {MPS2_UART1, BOARD_RING(console_in), BOARD_RING(console_out), 0};

void mps2_uart_open(mps2_uart_port_t *self, uint32_t baud) {
    self->registers->divider = MPS2_CLOCK_HZ / baud;
    self->registers->control = MPS2_UART_TX_ON | MPS2_UART_RX_ON | MPS2_UART_TX_INTERRUPT |
                               MPS2_UART_RX_INTERRUPT | MPS2_UART_RX_OVERRUN_INTERRUPT;
}

static void pump(mps2_uart_port_t *self) {
    while ((self->registers->state & MPS2_UART_TX_FULL) == 0) {
        const int byte = board_ring_take(&self->out);
        if (byte < 0) {
            return;
        }
        self->registers->data = (uint8_t)byte;
    }
}

void mps2_uart_kick(mps2_uart_port_t *self) {
    const uint32_t before = cortexm_mask();
    pump(self);
    cortexm_unmask(before);
}

// Cleared before the byte is fetched: one that comes in between raises it again.
void mps2_uart_received(mps2_uart_port_t *self) {
    self->registers->interrupt = MPS2_UART_RX_DONE;
    while ((self->registers->state & MPS2_UART_RX_FULL) != 0) {
        board_ring_put(&self->in, (uint8_t)self->registers->data);
    }
}

void mps2_uart_sent(mps2_uart_port_t *self) {
    self->registers->interrupt = MPS2_UART_TX_DONE;
    pump(self);
}

void mps2_uart_overrun(mps2_uart_port_t *self) {
    if ((self->registers->state & MPS2_UART_RX_OVERRUN) != 0) {
        self->registers->state = MPS2_UART_RX_OVERRUN;
        self->registers->interrupt = MPS2_UART_RX_OVERRUN_DONE;
        self->overruns++;
    }
}
