// SPDX-License-Identifier: MIT
// The vector table, and the handler of each interrupt.
#include "cortexm/cortexm.h"
#include "mps2_an386/registers.h"
#include "mps2_an386/uart.h"

#define INTERRUPTS 32
#define IRQ(number) [16 + (number)]

static void tick(void) { // wakes the loop, no more
}

static void robot_received(void) {
    mps2_uart_received(&mps2_robot);
}

static void robot_sent(void) {
    mps2_uart_sent(&mps2_robot);
}

static void console_received(void) {
    mps2_uart_received(&mps2_console);
}

static void console_sent(void) {
    mps2_uart_sent(&mps2_console);
}

static void overrun(void) {
    mps2_uart_overrun(&mps2_robot);
    mps2_uart_overrun(&mps2_console);
}

__attribute__((section(".vectors"), used)) static const cortexm_vector_t vectors[16 + INTERRUPTS] = {
    [0] = cortexm_initial_stack,
    [1] = cortexm_reset,
    [2] = cortexm_watchdog,
    [3] = cortexm_fault,
    [4] = cortexm_fault,
    [5] = cortexm_fault,
    [6] = cortexm_fault,
    [11] = cortexm_unexpected,
    [12] = cortexm_unexpected,
    [14] = cortexm_unexpected,
    [15] = tick,
    IRQ(MPS2_IRQ_UART0_RX) = robot_received,
    IRQ(MPS2_IRQ_UART0_TX) = robot_sent,
    IRQ(MPS2_IRQ_UART1_RX) = console_received,
    IRQ(MPS2_IRQ_UART1_TX) = console_sent,
    IRQ(MPS2_IRQ_UART_OVERRUN) = overrun,
};
