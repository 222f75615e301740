// SPDX-License-Identifier: MIT
// Rule under attack: on the registers of a USART every byte goes out and comes in once and in order, an
// overrun is counted, and the interrupt of an empty register is on only while there is something to send.
#define STM32_FAKE 1
#include "stm32f405/usart.c" // NOLINT(bugprone-suspicious-include): with registers that are the test's

#include <string.h>

#include "unity.h"

stm32_usart_t stm32_fake_usart[2];
stm32_flash_t stm32_fake_flash;
stm32_can_t stm32_fake_can;

static uint8_t line_in[512]; // what the other end sends
static size_t line_count;
static size_t line_next;
static size_t overrun_at; // before this byte one was lost
static char line_out[512];
static size_t out_count;
static unsigned empty_for; // bytes that the register takes now
static stm32_usart_port_t *port;

uint32_t stm32_get(const stm32_register_t *at) {
    stm32_usart_t *const usart = port->registers;
    if (at == &usart->sr) {
        const uint32_t received = line_next < line_count ? STM32_USART_SR_RECEIVED : 0;
        const uint32_t overrun = received != 0 && line_next == overrun_at ? STM32_USART_SR_OVERRUN : 0;
        return received | overrun | (empty_for > 0 ? STM32_USART_SR_EMPTY : 0);
    }
    if (at == &usart->dr) {
        TEST_ASSERT_LESS_THAN_size_t_MESSAGE(line_count, line_next, "a byte is read that is not there");
        return line_in[line_next++];
    }
    return *at;
}

void stm32_set(stm32_register_t *at, uint32_t value) {
    if (at == &port->registers->dr) {
        TEST_ASSERT_GREATER_THAN_MESSAGE(0, empty_for, "a byte is written over another");
        empty_for--;
        line_out[out_count++] = (char)value;
        return;
    }
    *at = value;
}

static bool is_interrupt_on(void) {
    return (port->registers->cr1 & STM32_USART_CR1_EMPTY_INTERRUPT) != 0;
}

void setUp(void) {
    memset(stm32_fake_usart, 0, sizeof stm32_fake_usart);
    line_count = line_next = out_count = 0;
    overrun_at = SIZE_MAX;
    empty_for = 0;
    port = &stm32_robot;
    while (board_ring_take(&port->in) >= 0) {
    }
    while (board_ring_take(&port->out) >= 0) {
    }
    port->overruns = 0;
    port->in.lost = 0;
    stm32_usart_open(port, 42000000u, 9600);
}

void test_the_rate_is_the_nearest_that_there_is(void) {
    TEST_ASSERT_EQUAL_UINT32(4375, port->registers->brr); // 42 MHz / 9600
    stm32_usart_open(port, 84000000u, 115200);
    TEST_ASSERT_EQUAL_UINT32(729, port->registers->brr); // 729.17
    TEST_ASSERT_FALSE(is_interrupt_on());
}

void test_a_packet_goes_out_byte_by_byte_and_the_interrupt_ends(void) {
    TEST_ASSERT_TRUE(board_ring_put_all(&port->out, (const uint8_t *)"0123456789", 10));
    empty_for = 2; // the shift register and the one behind it
    stm32_usart_kick(port);
    TEST_ASSERT_TRUE(is_interrupt_on());
    for (int i = 0; i < 8; i++) {
        TEST_ASSERT_EQUAL_size_t(2u + (size_t)i, out_count);
        TEST_ASSERT_TRUE(is_interrupt_on());
        empty_for = 1;
        stm32_usart_interrupt(port);
    }
    empty_for = 1;
    stm32_usart_interrupt(port);
    TEST_ASSERT_FALSE(is_interrupt_on());
    TEST_ASSERT_EQUAL_MEMORY("0123456789", line_out, 10);
    TEST_ASSERT_EQUAL_size_t(10, out_count);
}

void test_bytes_come_in_in_order(void) {
    uint8_t back[16];
    memcpy(line_in, "abcdef", 6);
    for (line_count = 1; line_count <= 6; line_count++) {
        stm32_usart_interrupt(port);
    }
    TEST_ASSERT_EQUAL_size_t(6, board_ring_take_some(&port->in, back, sizeof back));
    TEST_ASSERT_EQUAL_MEMORY("abcdef", back, 6);
    TEST_ASSERT_EQUAL_UINT32(0, port->overruns);
}

void test_an_overrun_is_counted_and_what_came_is_kept(void) {
    memcpy(line_in, "abc", 3);
    overrun_at = 1;
    line_count = 3;
    stm32_usart_interrupt(port);
    TEST_ASSERT_EQUAL_UINT32(1, port->overruns);
    TEST_ASSERT_EQUAL_INT('a', board_ring_take(&port->in));
    TEST_ASSERT_EQUAL_INT('b', board_ring_take(&port->in));
}

void test_a_flood_is_cut_and_counted(void) {
    line_count = sizeof line_in;
    stm32_usart_interrupt(port);
    TEST_ASSERT_EQUAL_UINT32(sizeof line_in - 256, port->in.lost);
    TEST_ASSERT_EQUAL_size_t(0, board_ring_room(&port->in));
}
