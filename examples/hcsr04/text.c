// SPDX-License-Identifier: MIT
// Lines of numbers over the USARTs of the STM32F405.
#include "text.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "board/word.h"
#include "cortexm/cortexm.h"
#include "stm32f405/clock.h"
#include "stm32f405/registers.h"
#include "stm32f405/usart.h"

#define BAUD 115200u
#define LINE_BYTES 160
#define PINS_ALTERNATE 0x002800A0u // PA2, PA3, PA9, PA10 in MODER
#define PINS_LOW 0x00007700u       // USART2 in AFRL
#define PINS_HIGH 0x00000770u      // USART1 in AFRH

static char line[LINE_BYTES];

void cortexm_board_start(void) {
}

void text_open(void) {
    stm32_clock_start();
    STM32_RCC->ahb1enr |= STM32_RCC_AHB1_GPIOA;
    STM32_RCC->apb1enr |= STM32_RCC_APB1_USART2;
    STM32_RCC->apb2enr |= STM32_RCC_APB2_USART1;
    STM32_GPIOA->afrl |= PINS_LOW;
    STM32_GPIOA->afrh |= PINS_HIGH;
    STM32_GPIOA->moder |= PINS_ALTERNATE;
    stm32_usart_open(&stm32_robot, stm32_clock_core_hz() / 4u, BAUD);
    stm32_usart_open(&stm32_console, stm32_clock_core_hz() / 2u, BAUD);
    cortexm_enable(STM32_IRQ_USART2);
    cortexm_enable(STM32_IRQ_USART1);
}

static size_t read_line(void) {
    size_t length = 0;
    for (int byte = 0; byte != '\n';) {
        const uint32_t before = cortexm_mask();
        byte = board_ring_take(&stm32_robot.in);
        if (byte < 0) {
            cortexm_sleep();
        }
        cortexm_unmask(before);
        if (byte >= 0 && byte != '\n' && length < LINE_BYTES) {
            line[length++] = (char)byte;
        }
    }
    return length;
}

static bool take(int32_t *figures, int count) {
    const char *at = line;
    const char *const end = line + read_line();
    for (int i = 0; i < count; i++) {
        const char *const stop = board_word_find(at, end, ' ');
        if (!board_word_number((board_word_t){at, (size_t)(stop - at)}, &figures[i])) {
            return false;
        }
        at = stop < end ? stop + 1 : end;
    }
    return at == end;
}

void text_wait(int32_t *figures, int count) {
    while (!take(figures, count)) {
    }
}

// A line is short, and the ring for it takes a thousand bytes: there is room as soon as it drains.
static void put(const char *text, size_t count) {
    while (!board_ring_put_all(&stm32_console.out, (const uint8_t *)text, count)) {
    }
    const uint32_t before = cortexm_mask();
    stm32_usart_kick(&stm32_console);
    cortexm_unmask(before);
}

static void put_number(int32_t value) {
    char digits[12];
    size_t at = sizeof digits;
    uint32_t rest = value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
    do {
        digits[--at] = (char)('0' + rest % 10u);
        rest /= 10u;
    } while (rest > 0);
    if (value < 0) {
        digits[--at] = '-';
    }
    digits[--at] = ' ';
    put(digits + at, sizeof digits - at);
}

void text_event(const char *name, int sonar, int32_t value) {
    put(name, strlen(name));
    put_number(sonar);
    put_number(value);
    put("\n", 1);
}

void text_number(const char *name, int32_t value) {
    put(name, strlen(name));
    put_number(value);
    put("\n", 1);
}
