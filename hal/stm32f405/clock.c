// SPDX-License-Identifier: MIT
// The PLL, timer 2 as a free-running counter, SysTick as an alarm clock.
#include "stm32f405/clock.h"

#include "board/board.h"
#include "cortexm/cortexm.h"
#include "stm32f405/registers.h"

#ifndef ARGUS_HSE_MHZ
#define ARGUS_HSE_MHZ 8u
#endif
#define HSI_MHZ 16u
#define CORE_HZ 168000000u
#define TRIES 100000 // several ms: longer than a crystal or the PLL takes
#define COUNTER_HZ 1000000u
#define TICKS_PER_MS (COUNTER_HZ / 1000u)
#define QEMU_TIMER_HZ 1000000000u

static uint32_t core_hz;
static uint32_t counted; // timer's ticks that are in `now_ms`
static uint32_t now_ms;

static bool becomes(const stm32_register_t *at, uint32_t mask, uint32_t value) {
    for (int i = 0; i < TRIES; i++) {
        if ((*at & mask) == value) {
            return true;
        }
    }
    return false;
}

static uint32_t pll_source(void) {
    STM32_RCC->cr |= STM32_RCC_HSE_ON;
    if (becomes(&STM32_RCC->cr, STM32_RCC_HSE_READY, STM32_RCC_HSE_READY)) {
        return STM32_RCC_PLL_HSE | STM32_RCC_PLL(ARGUS_HSE_MHZ, 336u, 7u);
    }
    return STM32_RCC_PLL(HSI_MHZ, 336u, 7u);
}

// An emulator without clocks (QEMU's) reads 0 where the inner oscillator is always ready after a reset; its
// processor runs at full speed.
static bool has_no_clocks(void) {
    return (STM32_RCC->cr & STM32_RCC_HSI_READY) == 0;
}

void stm32_clock_start(void) {
    core_hz = CORE_HZ;
    if (has_no_clocks()) {
        return;
    }
    STM32_RCC->pllcfgr = pll_source();
    STM32_RCC->cr |= STM32_RCC_PLL_ON;
    STM32_FLASH->acr = STM32_FLASH_ACR_5_WAITS | STM32_FLASH_ACR_CACHES;
    if (becomes(&STM32_RCC->cr, STM32_RCC_PLL_READY, STM32_RCC_PLL_READY)) {
        STM32_RCC->cfgr = STM32_RCC_DIVIDE | STM32_RCC_SWITCH_PLL;
    }
    if (!becomes(&STM32_RCC->cfgr, STM32_RCC_SWITCHED_MASK, STM32_RCC_SWITCHED_PLL)) {
        STM32_RCC->cfgr = STM32_RCC_DIVIDE;
        core_hz = HSI_MHZ * 1000000u;
    }
}

uint32_t stm32_clock_core_hz(void) {
    return core_hz;
}

void stm32_clock_begin(void) {
    STM32_RCC->apb1enr |= STM32_RCC_APB1_TIM2;
    // The timer's clock is half of the processor's, since APB1 is divided.
    STM32_TIM2->psc = (has_no_clocks() ? QEMU_TIMER_HZ : core_hz / 2u) / COUNTER_HZ - 1u;
    STM32_TIM2->arr = UINT32_MAX;
    STM32_TIM2->egr = STM32_TIMER_UPDATE; // takes the divider over
    STM32_TIM2->cr1 = STM32_TIMER_ON;
    CORTEXM_SYST_RVR = core_hz / 1000u - 1u;
    CORTEXM_SYST_CVR = 0;
    CORTEXM_SYST_CSR = CORTEXM_SYST_ON;
}

// The timer runs freely: ticks of SysTick are lost while flash is erased, and in QEMU on a busy host.
uint32_t board_now_ms(void) {
    const uint32_t passed = STM32_TIM2->cnt - counted;
    now_ms += passed / TICKS_PER_MS;
    counted += passed / TICKS_PER_MS * TICKS_PER_MS;
    return now_ms;
}
