// SPDX-License-Identifier: MIT
// USARTs by interrupt.
#include "stm32f405/usart.h"

static uint8_t robot_in[256];
static uint8_t robot_out[256];
static uint8_t console_in[128];
static uint8_t console_out[1024];

stm32_usart_port_t stm32_robot = {STM32_USART2, BOARD_RING(robot_in), BOARD_RING(robot_out), 0};
stm32_usart_port_t stm32_console = {STM32_USART1, BOARD_RING(console_in), BOARD_RING(console_out), 0};

void stm32_usart_open(stm32_usart_port_t *self, uint32_t clock_hz, uint32_t baud) {
    stm32_set(&self->registers->brr, (clock_hz + baud / 2u) / baud);
    stm32_set(&self->registers->cr1, STM32_USART_CR1_ON);
}

// The interrupt of an empty register is on as long as there is something to send. QEMU 7.2 never raises it,
// but there the register is always empty.
void stm32_usart_kick(stm32_usart_port_t *self) {
    while ((stm32_get(&self->registers->sr) & STM32_USART_SR_EMPTY) != 0) {
        const int byte = board_ring_take(&self->out);
        if (byte < 0) {
            stm32_set(&self->registers->cr1, STM32_USART_CR1_ON);
            return;
        }
        stm32_set(&self->registers->dr, (uint32_t)byte);
    }
    stm32_set(&self->registers->cr1, STM32_USART_CR1_ON | STM32_USART_CR1_EMPTY_INTERRUPT);
}

// Reading the byte after the status clears an overrun, too; the byte that was lost is the later one.
void stm32_usart_interrupt(stm32_usart_port_t *self) {
    uint32_t state = stm32_get(&self->registers->sr);
    while ((state & (STM32_USART_SR_RECEIVED | STM32_USART_SR_OVERRUN)) != 0) {
        const uint8_t byte = (uint8_t)stm32_get(&self->registers->dr);
        if ((state & STM32_USART_SR_RECEIVED) != 0) {
            board_ring_put(&self->in, byte);
        }
        if ((state & STM32_USART_SR_OVERRUN) != 0) {
            self->overruns++;
        }
        state = stm32_get(&self->registers->sr);
    }
    stm32_usart_kick(self);
}
