// SPDX-License-Identifier: MIT
// Rule under attack: on the registers of bxCAN frames leave as they were given, through a mailbox that is
// free, and only those of the one id are let in.
#define STM32_FAKE 1
#include "stm32f405/can.c" // NOLINT(bugprone-suspicious-include): with registers that are the test's

#include <string.h>

#include "unity.h"

stm32_usart_t stm32_fake_usart[2];
stm32_flash_t stm32_fake_flash;
stm32_can_t stm32_fake_can;

typedef struct {
    uint32_t ir;
    uint32_t dtr;
    uint32_t dlr;
    uint32_t dhr;
} frame_t;

static bool is_deaf; // nothing is at the pins: the controller does not start
static frame_t inbox[8];
static int inbox_count;
static bool was_chosen; // the filter was changed while it was off, as it must be
static bool filters_off;

uint32_t stm32_get(const stm32_register_t *at) {
    stm32_can_t *const can = &stm32_fake_can;
    if (at == &can->msr) {
        const bool stays = is_deaf && can->btr != 0;
        return (can->mcr & STM32_CAN_MCR_INIT) != 0 || stays ? STM32_CAN_MSR_INIT : 0;
    }
    if (at == &can->rf0r) {
        return inbox_count < 3 ? (uint32_t)inbox_count : 3u;
    }
    if (at == &can->rx[0].dtr) {
        return inbox[0].dtr;
    }
    if (at == &can->rx[0].dlr) {
        return inbox[0].dlr;
    }
    if (at == &can->rx[0].dhr) {
        return inbox[0].dhr;
    }
    return *at;
}

void stm32_set(stm32_register_t *at, uint32_t value) {
    stm32_can_t *const can = &stm32_fake_can;
    if (at == &can->rf0r && (value & STM32_CAN_RF_RELEASE) != 0) {
        TEST_ASSERT_GREATER_THAN_INT(0, inbox_count);
        inbox_count--;
        memmove(inbox, inbox + 1, sizeof inbox - sizeof inbox[0]);
        return;
    }
    if (at == &can->btr) {
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(STM32_CAN_MCR_INIT, can->mcr & 3u,
                                        "the rate is set out of initialisation");
    }
    if (at == &can->fmr) {
        filters_off = value == STM32_CAN_FMR_INIT;
    }
    if (at == &can->filter[0].r1 || at == &can->filter[0].r2) {
        TEST_ASSERT_TRUE(filters_off);
        was_chosen = true;
    }
    for (unsigned i = 0; i < 3; i++) {
        if (at == &can->tx[i].ir && (value & STM32_CAN_TI_SEND) != 0) {
            TEST_ASSERT_BITS_HIGH_MESSAGE(STM32_CAN_TSR_EMPTY(i), can->tsr, "a mailbox is overwritten");
            can->tsr &= ~STM32_CAN_TSR_EMPTY(i);
        }
    }
    *at = value;
}

void setUp(void) {
    memset(&stm32_fake_can, 0, sizeof stm32_fake_can);
    stm32_fake_can.mcr = STM32_CAN_MCR_SLEEP; // as after a reset [32.9.2]
    stm32_fake_can.tsr = 7u << 26;
    is_deaf = false;
    inbox_count = 0;
    was_chosen = false;
}

// Whether a frame of this id passes, as the filter says [32.7.4].
static bool passes(uint32_t rir) {
    const uint32_t mask = stm32_fake_can.filter[0].r2;
    return (rir & mask) == (stm32_fake_can.filter[0].r1 & mask);
}

void test_it_starts_at_500_kbit_s(void) {
    TEST_ASSERT_TRUE(stm32_can_open(0x200));
    const uint32_t btr = stm32_fake_can.btr;
    const uint32_t quanta = 1 + ((btr >> 16 & 15) + 1) + ((btr >> 20 & 7) + 1);
    TEST_ASSERT_EQUAL_UINT32(500000, 42000000 / ((btr & 0x3FF) + 1) / quanta);
    TEST_ASSERT_EQUAL_HEX32(STM32_CAN_MCR_IN_ORDER | STM32_CAN_MCR_RECOVER, stm32_fake_can.mcr);
}

void test_without_a_bus_it_says_so(void) {
    is_deaf = true;
    TEST_ASSERT_FALSE(stm32_can_open(0x200));
}

void test_one_id_is_let_in(void) {
    TEST_ASSERT_TRUE(stm32_can_open(0x203));
    TEST_ASSERT_TRUE(was_chosen);
    TEST_ASSERT_EQUAL_HEX32(1, stm32_fake_can.fa1r);
    for (uint32_t id = 0; id < 0x800; id++) {
        TEST_ASSERT_EQUAL(id == 0x203, passes(id << 21));
    }
    TEST_ASSERT_FALSE(passes(0x203u << 21 | 4u)); // extended
    TEST_ASSERT_FALSE(passes(0x203u << 21 | 2u)); // remote
}

void test_frames_fill_the_mailboxes_as_they_are_free(void) {
    static const uint8_t data[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    TEST_ASSERT_TRUE(stm32_can_open(0x200));
    TEST_ASSERT_TRUE(stm32_can_send(0x500, data, 8));
    TEST_ASSERT_TRUE(stm32_can_send(0x080, data, 3));
    TEST_ASSERT_TRUE(stm32_can_send(0x507, data, 0));
    TEST_ASSERT_FALSE(stm32_can_send(0x501, data, 8));
    TEST_ASSERT_EQUAL_HEX32(0x500u << 21 | 1u, stm32_fake_can.tx[0].ir);
    TEST_ASSERT_EQUAL_HEX32(0x04030201, stm32_fake_can.tx[0].dlr);
    TEST_ASSERT_EQUAL_HEX32(0x08070605, stm32_fake_can.tx[0].dhr);
    TEST_ASSERT_EQUAL_UINT32(8, stm32_fake_can.tx[0].dtr);
    TEST_ASSERT_EQUAL_HEX32(0x00030201, stm32_fake_can.tx[1].dlr);
    TEST_ASSERT_EQUAL_UINT32(3, stm32_fake_can.tx[1].dtr);
    stm32_fake_can.tsr |= STM32_CAN_TSR_EMPTY(1);
    TEST_ASSERT_TRUE(stm32_can_send(0x501, data, 8));
    TEST_ASSERT_EQUAL_HEX32(0x501u << 21 | 1u, stm32_fake_can.tx[1].ir);
}

void test_frames_come_in_order_with_their_length(void) {
    uint8_t data[8];
    TEST_ASSERT_TRUE(stm32_can_open(0x200));
    TEST_ASSERT_EQUAL_INT(-1, stm32_can_receive(data));
    for (uint32_t i = 0; i < 5; i++) {
        inbox[i] = (frame_t){.dtr = i < 4 ? i : 15, .dlr = 0x03020100u + i, .dhr = 0x07060504u};
    }
    inbox_count = 5;
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL_INT(i < 4 ? i : 8, stm32_can_receive(data));
        TEST_ASSERT_EQUAL_UINT8(i, data[0]);
        TEST_ASSERT_EQUAL_UINT8(7, data[7]);
    }
    TEST_ASSERT_EQUAL_INT(-1, stm32_can_receive(data));
}
