// SPDX-License-Identifier: MIT
// Clocks of the STM32F405, and the milliseconds.
#ifndef STM32_CLOCK_H
#define STM32_CLOCK_H

#include <stdint.h>

// 168 MHz from the crystal of ARGUS_HSE_MHZ; from the inner oscillator, which is good to 1 % only, when that
// does not swing. Says whether the crystal is in use.
void stm32_clock_start(void);
uint32_t stm32_clock_core_hz(void);

void stm32_clock_begin(void); // milliseconds, and a tick that wakes the loop

#endif
