// SPDX-License-Identifier: MIT
// The vector table, and the handler of each interrupt.
#include "cortexm/cortexm.h"
#include "stm32f405/registers.h"
#include "stm32f405/usart.h"

#define INTERRUPTS (STM32_IRQ_USART2 + 1) // up to the last one that is ever enabled
#define IRQ(number) [16 + (number)]

static void tick(void) { // wakes the loop, no more
}

static void console(void) {
    stm32_usart_interrupt(&stm32_console);
}

static void robot(void) {
    stm32_usart_interrupt(&stm32_robot);
}

__attribute__((section(".vectors"), used)) static const cortexm_vector_t vectors[16 + INTERRUPTS] = {
    [0] = cortexm_initial_stack,
    [1] = cortexm_reset,
    [2] = cortexm_fault,
    [3] = cortexm_fault,
    [4] = cortexm_fault,
    [5] = cortexm_fault,
    [6] = cortexm_fault,
    [11] = cortexm_unexpected,
    [12] = cortexm_unexpected,
    [14] = cortexm_unexpected,
    [15] = tick,
    IRQ(STM32_IRQ_USART1) = console,
    IRQ(STM32_IRQ_USART2) = robot,
};
