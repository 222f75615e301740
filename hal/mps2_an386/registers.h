// SPDX-License-Identifier: MIT
// Peripherals of the MPS2 AN386, from ARM DAI 0386 (memory map) and the Cortex-M System Design Kit's
// reference, ARM DDI 0479 (sections in brackets).
#ifndef MPS2_REGISTERS_H
#define MPS2_REGISTERS_H

#include <stdint.h>

#define MPS2_CLOCK_HZ 25000000u

typedef struct { // [4.1] APB timer: counts down
    volatile uint32_t control;
    volatile uint32_t value;
    volatile uint32_t reload;
    volatile uint32_t interrupt;
} mps2_timer_t;

typedef struct { // [4.3] APB UART
    volatile uint32_t data;
    volatile uint32_t state; // write 1 to clear the overruns
    volatile uint32_t control;
    volatile uint32_t interrupt; // write 1 to clear
    volatile uint32_t divider;   // at least 16
} mps2_uart_t;

typedef struct { // [4.5] APB watchdog: the first end of its count is an NMI, the second a reset
    volatile uint32_t load;
    volatile uint32_t value;
    volatile uint32_t control;
    volatile uint32_t clear;
    volatile uint32_t unused[764];
    volatile uint32_t lock;
} mps2_watchdog_t;

#define MPS2_TIMER0 ((mps2_timer_t *)0x40000000u)
#define MPS2_UART0 ((mps2_uart_t *)0x40004000u)
#define MPS2_UART1 ((mps2_uart_t *)0x40005000u)
#define MPS2_WATCHDOG ((mps2_watchdog_t *)0x40008000u)

#define MPS2_TIMER_ON 1u

#define MPS2_UART_TX_FULL 1u // state
#define MPS2_UART_RX_FULL 2u
#define MPS2_UART_RX_OVERRUN 8u
#define MPS2_UART_TX_ON 1u // control
#define MPS2_UART_RX_ON 2u
#define MPS2_UART_TX_INTERRUPT 4u
#define MPS2_UART_RX_INTERRUPT 8u
#define MPS2_UART_RX_OVERRUN_INTERRUPT 32u
#define MPS2_UART_TX_DONE 1u // interrupt
#define MPS2_UART_RX_DONE 2u
#define MPS2_UART_RX_OVERRUN_DONE 8u

#define MPS2_WATCHDOG_UNLOCK 0x1ACCE551u
#define MPS2_WATCHDOG_ON 3u // interrupt and reset

// Interrupts.
#define MPS2_IRQ_UART0_RX 0u
#define MPS2_IRQ_UART0_TX 1u
#define MPS2_IRQ_UART1_RX 2u
#define MPS2_IRQ_UART1_TX 3u
#define MPS2_IRQ_UART_OVERRUN 12u

#endif
