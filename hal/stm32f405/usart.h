// SPDX-License-Identifier: MIT
// The two USARTs of the STM32F405, each with a ring in both directions.
#ifndef STM32_USART_H
#define STM32_USART_H

#include "board/ring.h"
#include "stm32f405/registers.h"

typedef struct {
    stm32_usart_t *registers;
    board_ring_t in;
    board_ring_t out;
    uint32_t overruns; // bytes that came before the last one was fetched, monotonic
} stm32_usart_port_t;

extern stm32_usart_port_t stm32_robot;   // USART2: PA2 sends, PA3 receives
extern stm32_usart_port_t stm32_console; // USART1: PA9 sends, PA10 receives

void stm32_usart_open(stm32_usart_port_t *self, uint32_t clock_hz, uint32_t baud);
// Begins to send what was put into `out`. Interrupts are masked by the caller.
void stm32_usart_kick(stm32_usart_port_t *self);
void stm32_usart_interrupt(stm32_usart_port_t *self);

#endif
