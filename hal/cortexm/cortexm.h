// SPDX-License-Identifier: MIT
// What all Cortex-M boards share: start-up, faults, and a note that outlives a reset.
//
// Registers: ARMv7-M Architecture Reference Manual (ARM DDI 0403), sections in brackets.
#ifndef CORTEXM_H
#define CORTEXM_H

#include <stdint.h>

#include "board/board.h"

typedef volatile uint32_t cortexm_register_t;

#define CORTEXM_REGISTER(address) (*(cortexm_register_t *)(address))
#define CORTEXM_SYST_CSR CORTEXM_REGISTER(0xE000E010u) // [B3.3] SysTick: control, reload, value
#define CORTEXM_SYST_RVR CORTEXM_REGISTER(0xE000E014u)
#define CORTEXM_SYST_CVR CORTEXM_REGISTER(0xE000E018u)
#define CORTEXM_NVIC_ISER ((cortexm_register_t *)0xE000E100u) // [B3.4] interrupts: set enable
#define CORTEXM_SCB_AIRCR CORTEXM_REGISTER(0xE000ED0Cu)       // [B3.2] reset request
#define CORTEXM_SCB_CFSR CORTEXM_REGISTER(0xE000ED28u)        // [B3.2] fault status
#define CORTEXM_SCB_HFSR CORTEXM_REGISTER(0xE000ED2Cu)

#define CORTEXM_SYST_ON 7u // on, interrupt, processor clock
#define CORTEXM_AIRCR_RESET 0x05FA0004u

typedef void (*cortexm_vector_t)(void);

// Linker script.
extern uint32_t cortexm_stack_bottom[];
extern uint32_t cortexm_stack_top[];
void cortexm_initial_stack(void); // the same place as a vector: it is no function

// Vectors 0..15 are the processor's; a board's table goes on behind them.
void cortexm_reset(void);
void cortexm_fault(void);
void cortexm_watchdog(void);   // for a watchdog that warns before it resets
void cortexm_unexpected(void); // an interrupt that was not asked for: as a fault

// Called by cortexm_reset() before anything else runs, with no stack to speak of: clocks.
void cortexm_board_start(void);

// Why this life began, by the note of the last one; BOARD_RESET_POWER where there is none.
board_reset_t cortexm_noted_reason(void);

// Disables or restores interrupts; returns what it was.
static inline uint32_t cortexm_mask(void) {
    uint32_t before = 0;
    __asm volatile("mrs %0, primask\n\tcpsid i" : "=r"(before)::"memory");
    return before;
}

static inline void cortexm_unmask(uint32_t before) {
    __asm volatile("msr primask, %0" ::"r"(before) : "memory");
}

static inline void cortexm_enable(unsigned interrupt) {
    CORTEXM_NVIC_ISER[interrupt / 32u] = 1u << interrupt % 32u;
}

// Sleeps until an interrupt is pending, though it be masked.
static inline void cortexm_sleep(void) {
    __asm volatile("dsb\n\twfi" ::: "memory");
}

#endif
