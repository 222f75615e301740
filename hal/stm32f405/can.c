// SPDX-License-Identifier: MIT
// Frames through the mailboxes, by looking: a FIFO of three holds what comes between two passes of the loop.
#include "stm32f405/can.h"

#include "stm32f405/registers.h"

#define TRIES 100000
#define BANK 0
#define MAILBOXES 3u
#define LENGTH_MASK 15u
#define LENGTH_MAX 8u

static bool waits_for(uint32_t value) {
    for (int i = 0; i < TRIES; i++) {
        if ((stm32_get(&STM32_CAN1->msr) & STM32_CAN_MSR_INIT) == value) {
            return true;
        }
    }
    return false;
}

// One filter of 32 bits: all bits of the id count, and that it is a plain one.
static void choose(uint16_t rx_id) {
    stm32_set(&STM32_CAN1->fmr, STM32_CAN_FMR_INIT);
    stm32_set(&STM32_CAN1->fa1r, 0);
    stm32_set(&STM32_CAN1->fs1r, 1u << BANK);
    stm32_set(&STM32_CAN1->fm1r, 0);
    stm32_set(&STM32_CAN1->ffa1r, 0);
    stm32_set(&STM32_CAN1->filter[BANK].r1, STM32_CAN_STANDARD(rx_id));
    stm32_set(&STM32_CAN1->filter[BANK].r2, STM32_CAN_STANDARD(0x7FFu) | STM32_CAN_I_NOT_PLAIN);
    stm32_set(&STM32_CAN1->fa1r, 1u << BANK);
    stm32_set(&STM32_CAN1->fmr, 0);
}

bool stm32_can_open(uint16_t rx_id) {
    stm32_set(&STM32_CAN1->mcr, STM32_CAN_MCR_INIT);
    if (!waits_for(STM32_CAN_MSR_INIT)) {
        return false;
    }
    stm32_set(&STM32_CAN1->btr, STM32_CAN_BTR_500K);
    choose(rx_id);
    stm32_set(&STM32_CAN1->mcr, STM32_CAN_MCR_IN_ORDER | STM32_CAN_MCR_RECOVER);
    return waits_for(0);
}

static uint32_t word_of(const uint8_t *data, unsigned count) {
    uint32_t word = 0;
    for (unsigned i = 0; i < count; i++) {
        word |= (uint32_t)data[i] << 8u * i;
    }
    return word;
}

bool stm32_can_send(uint16_t id, const uint8_t *data, uint8_t length) {
    const uint32_t state = stm32_get(&STM32_CAN1->tsr);
    for (unsigned i = 0; i < MAILBOXES; i++) {
        stm32_can_mailbox_t *const box = &STM32_CAN1->tx[i];
        if ((state & STM32_CAN_TSR_EMPTY(i)) != 0) {
            stm32_set(&box->dtr, length);
            stm32_set(&box->dlr, word_of(data, length < 4u ? length : 4u));
            stm32_set(&box->dhr, length > 4u ? word_of(data + 4, length - 4u) : 0);
            stm32_set(&box->ir, STM32_CAN_STANDARD(id) | STM32_CAN_TI_SEND);
            return true;
        }
    }
    return false;
}

int stm32_can_receive(uint8_t data[8]) {
    const stm32_can_mailbox_t *const box = &STM32_CAN1->rx[0];
    if ((stm32_get(&STM32_CAN1->rf0r) & STM32_CAN_RF_COUNT) == 0) {
        return -1;
    }
    const uint32_t length = stm32_get(&box->dtr) & LENGTH_MASK;
    const uint32_t low = stm32_get(&box->dlr);
    const uint32_t high = stm32_get(&box->dhr);
    for (unsigned i = 0; i < LENGTH_MAX; i++) {
        data[i] = (uint8_t)((i < 4u ? low : high) >> 8u * (i % 4u));
    }
    stm32_set(&STM32_CAN1->rf0r, STM32_CAN_RF_RELEASE);
    return (int)(length < LENGTH_MAX ? length : LENGTH_MAX);
}
