// SPDX-License-Identifier: MIT
// Argus on the STM32F405: USART2 is the robot's, USART1 the operator's and the boot loader's.
#include "board/board.h"
#include "board/bus.h"
#include "cortexm/cortexm.h"
#include "stm32f405/can.h"
#include "stm32f405/clock.h"
#include "stm32f405/registers.h"
#include "stm32f405/usart.h"

#define CONSOLE_BAUD 115200u
#define PIN_ALTERNATE 2u // in 2 bits of MODER
#define PIN_PULL_UP 1u   // in 2 bits of PUPDR: an open line is at rest
#define PIN_USART 7u     // in 4 bits of AFR
#define PIN_CAN 9u
#define RANDOM_TRIES 1000
#define WATCHDOG_START 0xCCCCu
#define WATCHDOG_UNLOCK 0x5555u
#define WATCHDOG_FEED 0xAAAAu
#define WATCHDOG_BY_64 4u
#define WATCHDOG_COUNT 1000u // 2 s at 32 kHz; 1.4 s to 3.8 s, as its oscillator is

void cortexm_board_start(void) {
}

static BOARD_APART void give_pin(stm32_gpio_t *port, unsigned pin, uint32_t function) {
    stm32_register_t *const afr = pin < 8u ? &port->afrl : &port->afrh;
    *afr = (*afr & ~(15u << pin % 8u * 4u)) | function << pin % 8u * 4u;
    port->pupdr = (port->pupdr & ~(3u << pin * 2u)) | PIN_PULL_UP << pin * 2u;
    port->moder = (port->moder & ~(3u << pin * 2u)) | PIN_ALTERNATE << pin * 2u;
}

static void open_console(void) {
    STM32_RCC->ahb1enr |= STM32_RCC_AHB1_GPIOA;
    STM32_RCC->apb2enr |= STM32_RCC_APB2_USART1;
    give_pin(STM32_GPIOA, 9, PIN_USART);
    give_pin(STM32_GPIOA, 10, PIN_USART);
    stm32_usart_open(&stm32_console, stm32_clock_core_hz() / 2u, CONSOLE_BAUD);
    cortexm_enable(STM32_IRQ_USART1);
}

void board_open(uint32_t baud) {
    STM32_RCC->apb1enr |= STM32_RCC_APB1_USART2;
    give_pin(STM32_GPIOA, 2, PIN_USART);
    give_pin(STM32_GPIOA, 3, PIN_USART);
    stm32_usart_open(&stm32_robot, stm32_clock_core_hz() / 4u, baud > 0 ? baud : CONSOLE_BAUD);
    cortexm_enable(STM32_IRQ_USART2);
    STM32_IWDG->kr = WATCHDOG_START;
    STM32_IWDG->kr = WATCHDOG_UNLOCK;
    STM32_IWDG->pr = WATCHDOG_BY_64;
    STM32_IWDG->rlr = WATCHDOG_COUNT;
    STM32_IWDG->kr = WATCHDOG_FEED;
}

void board_feed(void) {
    STM32_IWDG->kr = WATCHDOG_FEED;
}

size_t board_receive(uint8_t *bytes, size_t capacity) {
    return board_ring_take_some(&stm32_robot.in, bytes, capacity);
}

size_t board_room(void) {
    return board_ring_room(&stm32_robot.out);
}

static void kick(stm32_usart_port_t *port) {
    const uint32_t before = cortexm_mask();
    stm32_usart_kick(port);
    cortexm_unmask(before);
}

void board_send(const uint8_t *packet, size_t count) {
    board_ring_put_all(&stm32_robot.out, packet, count);
    kick(&stm32_robot);
}

static bool is_quiet(void) {
    return board_ring_is_empty(&stm32_robot.in) && board_ring_is_empty(&stm32_console.in);
}

// Looking and sleeping are one: a byte that comes in between ends the sleep, since it is pending.
void board_wait(uint32_t ms) {
    const uint32_t start_ms = board_now_ms();
    while (is_quiet() && board_now_ms() - start_ms < ms) {
        const uint32_t before = cortexm_mask();
        if (is_quiet()) {
            cortexm_sleep();
        }
        cortexm_unmask(before);
    }
}

board_ring_t *board_console_out(void) {
    return &stm32_console.out;
}

void board_console_kick(void) {
    kick(&stm32_console);
}

size_t board_console_read(uint8_t *bytes, size_t capacity) {
    return board_ring_take_some(&stm32_console.in, bytes, capacity);
}

bool board_can_open(uint16_t rx_id) {
    STM32_RCC->ahb1enr |= STM32_RCC_AHB1_GPIOB;
    STM32_RCC->apb1enr |= STM32_RCC_APB1_CAN1;
    give_pin(STM32_GPIOB, 8, PIN_CAN);
    give_pin(STM32_GPIOB, 9, PIN_CAN);
    return stm32_can_open(rx_id);
}

bool board_can_send(uint16_t id, const uint8_t *data, uint8_t length) {
    return stm32_can_send(id, data, length);
}

int board_can_receive(uint8_t data[8]) {
    return stm32_can_receive(data);
}

static uint32_t random_word(void) {
    for (int i = 0; i < RANDOM_TRIES; i++) {
        if ((STM32_RNG->sr & STM32_RNG_READY) != 0) {
            return STM32_RNG->dr;
        }
    }
    return board_now_ms(); // it has failed: nonces begin as they did at some start before
}

uint64_t board_can_seed(void) {
    STM32_RCC->ahb2enr |= STM32_RCC_AHB2_RNG;
    STM32_RNG->cr = STM32_RNG_ON;
    const uint64_t high = random_word();
    return high << 32 | random_word();
}

// What the software left a note of is known best; the rest is as the chip says.
static board_reset_t reason_of(uint32_t flags) {
    const board_reset_t noted = cortexm_noted_reason();
    if (noted != BOARD_RESET_POWER) {
        return noted;
    }
    if ((flags & STM32_RCC_CSR_WATCHDOG) != 0) {
        return BOARD_RESET_WATCHDOG;
    }
    if ((flags & STM32_RCC_CSR_POWER) != 0) {
        return BOARD_RESET_POWER;
    }
    if ((flags & STM32_RCC_CSR_BROWN) != 0) {
        return BOARD_RESET_BROWN;
    }
    return (flags & STM32_RCC_CSR_PIN) != 0 ? BOARD_RESET_PIN : BOARD_RESET_POWER;
}

static board_reset_t reason;

board_reset_t board_reset_reason(void) {
    return reason;
}

const char *board_name(void) {
    return "stm32f405";
}

int main(void) {
    reason = reason_of(STM32_RCC->csr);
    STM32_RCC->csr |= STM32_RCC_CSR_FORGET;
    stm32_clock_start();
    stm32_clock_begin();
    open_console();
    board_run();
}
