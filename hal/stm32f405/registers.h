// SPDX-License-Identifier: MIT
// Peripherals of the STM32F405, from ST's reference manual RM0090 (sections in brackets) and, for sectors and
// pins, the data sheet DS8626.
#ifndef STM32_REGISTERS_H
#define STM32_REGISTERS_H

#include <stdint.h>

typedef volatile uint32_t stm32_register_t;

typedef struct { // [7.3] reset and clock control
    stm32_register_t cr, pllcfgr, cfgr, cir;
    stm32_register_t ahb1rstr, ahb2rstr, ahb3rstr, reserved0;
    stm32_register_t apb1rstr, apb2rstr, reserved1[2];
    stm32_register_t ahb1enr, ahb2enr, ahb3enr, reserved2;
    stm32_register_t apb1enr, apb2enr, reserved3[2];
    stm32_register_t ahb1lpenr, ahb2lpenr, ahb3lpenr, reserved4;
    stm32_register_t apb1lpenr, apb2lpenr, reserved5[2];
    stm32_register_t bdcr, csr;
} stm32_rcc_t;

typedef struct { // [8.4] ports
    stm32_register_t moder, otyper, ospeedr, pupdr, idr, odr, bsrr, lckr, afrl, afrh;
} stm32_gpio_t;

typedef struct { // [3.9] flash interface
    stm32_register_t acr, keyr, optkeyr, sr, cr, optcr;
} stm32_flash_t;

typedef struct { // [30.6] USART
    stm32_register_t sr, dr, brr, cr1, cr2, cr3, gtpr;
} stm32_usart_t;

typedef struct { // [18.4] timer
    stm32_register_t cr1, cr2, smcr, dier, sr, egr, ccmr1, ccmr2, ccer, cnt, psc, arr;
} stm32_timer_t;

typedef struct { // [21.4] independent watchdog
    stm32_register_t kr, pr, rlr, sr;
} stm32_iwdg_t;

typedef struct { // [24.4] random numbers
    stm32_register_t cr, sr, dr;
} stm32_rng_t;

typedef struct { // [32.9.3] a mailbox of bxCAN, to send or received
    stm32_register_t ir, dtr, dlr, dhr;
} stm32_can_mailbox_t;

typedef struct { // [32.9] bxCAN
    stm32_register_t mcr, msr, tsr, rf0r, rf1r, ier, esr, btr;
    stm32_register_t reserved0[88];
    stm32_can_mailbox_t tx[3];
    stm32_can_mailbox_t rx[2];
    stm32_register_t reserved1[12];
    stm32_register_t fmr, fm1r, reserved2, fs1r, reserved3, ffa1r, reserved4, fa1r;
    stm32_register_t reserved5[8];
    struct {
        stm32_register_t r1, r2;
    } filter[28];
} stm32_can_t;

#ifndef STM32_FAKE
#define STM32_RCC ((stm32_rcc_t *)0x40023800u)
#define STM32_GPIOA ((stm32_gpio_t *)0x40020000u)
#define STM32_GPIOB ((stm32_gpio_t *)0x40020400u)
#define STM32_FLASH ((stm32_flash_t *)0x40023C00u)
#define STM32_USART1 ((stm32_usart_t *)0x40011000u)
#define STM32_USART2 ((stm32_usart_t *)0x40004400u)
#define STM32_TIM2 ((stm32_timer_t *)0x40000000u)
#define STM32_IWDG ((stm32_iwdg_t *)0x40003000u)
#define STM32_RNG ((stm32_rng_t *)0x50060800u)
#define STM32_CAN1 ((stm32_can_t *)0x40006400u)
static inline uint32_t stm32_get(const stm32_register_t *at) {
    return *at;
}

static inline void stm32_set(stm32_register_t *at, uint32_t value) {
    *at = value;
}
#else // a test has them in its memory, and does what they do when they are read and written
extern stm32_flash_t stm32_fake_flash;
extern stm32_usart_t stm32_fake_usart[2];
extern stm32_can_t stm32_fake_can;
#define STM32_FLASH (&stm32_fake_flash)
#define STM32_USART1 (&stm32_fake_usart[0])
#define STM32_USART2 (&stm32_fake_usart[1])
#define STM32_CAN1 (&stm32_fake_can)
uint32_t stm32_get(const stm32_register_t *at);
void stm32_set(stm32_register_t *at, uint32_t value);
#endif

// RCC.
#define STM32_RCC_HSI_READY (1u << 1)
#define STM32_RCC_HSE_ON (1u << 16)
#define STM32_RCC_HSE_READY (1u << 17)
#define STM32_RCC_PLL_ON (1u << 24)
#define STM32_RCC_PLL_READY (1u << 25)
#define STM32_RCC_PLL_HSE (1u << 22)
#define STM32_RCC_PLL(m, n, q) ((m) | (n) << 6 | (q) << 24) // P is 2
#define STM32_RCC_DIVIDE (5u << 10 | 4u << 13)              // APB1 by 4, APB2 by 2
#define STM32_RCC_SWITCH_PLL 2u
#define STM32_RCC_SWITCHED_MASK (3u << 2)
#define STM32_RCC_SWITCHED_PLL (2u << 2)
#define STM32_RCC_AHB1_GPIOA (1u << 0)
#define STM32_RCC_AHB1_GPIOB (1u << 1)
#define STM32_RCC_AHB2_RNG (1u << 6)
#define STM32_RCC_APB1_TIM2 (1u << 0)
#define STM32_RCC_APB1_USART2 (1u << 17)
#define STM32_RCC_APB1_CAN1 (1u << 25)
#define STM32_RCC_APB2_USART1 (1u << 4)
#define STM32_RCC_CSR_FORGET (1u << 24)
#define STM32_RCC_CSR_BROWN (1u << 25)
#define STM32_RCC_CSR_PIN (1u << 26)
#define STM32_RCC_CSR_POWER (1u << 27)
#define STM32_RCC_CSR_WATCHDOG (1u << 29)

// Flash.
#define STM32_FLASH_ACR_5_WAITS 5u // at 168 MHz and 2.7 V to 3.6 V
#define STM32_FLASH_ACR_CACHES (7u << 8)
#define STM32_FLASH_ACR_DATA_CACHE (1u << 10)
#define STM32_FLASH_ACR_DATA_RESET (1u << 12)
#define STM32_FLASH_KEY_1 0x45670123u
#define STM32_FLASH_KEY_2 0xCDEF89ABu
#define STM32_FLASH_SR_ERRORS 0xF2u
#define STM32_FLASH_SR_BUSY (1u << 16)
#define STM32_FLASH_CR_PROGRAM 1u
#define STM32_FLASH_CR_ERASE 2u
#define STM32_FLASH_CR_SECTOR(number) ((number) << 3)
#define STM32_FLASH_CR_WORDS (2u << 8)
#define STM32_FLASH_CR_START (1u << 16)
#define STM32_FLASH_CR_LOCK (1u << 31)

// Timer.
#define STM32_TIMER_ON 1u
#define STM32_TIMER_UPDATE 1u

// USART.
#define STM32_USART_SR_OVERRUN (1u << 3)
#define STM32_USART_SR_RECEIVED (1u << 5)
#define STM32_USART_SR_EMPTY (1u << 7)
#define STM32_USART_CR1_ON (1u << 13 | 1u << 3 | 1u << 2 | 1u << 5) // both ways, interrupt of what arrives
#define STM32_USART_CR1_EMPTY_INTERRUPT (1u << 7)

// Random numbers.
#define STM32_RNG_ON (1u << 2)
#define STM32_RNG_READY 1u

// bxCAN.
#define STM32_CAN_MCR_INIT 1u
#define STM32_CAN_MCR_SLEEP 2u
#define STM32_CAN_MCR_IN_ORDER (1u << 2) // frames go out as they came in
#define STM32_CAN_MCR_RECOVER (1u << 6)  // comes back from bus-off by itself
#define STM32_CAN_MSR_INIT 1u
#define STM32_CAN_TSR_EMPTY(mailbox) (1u << (26u + (mailbox)))
#define STM32_CAN_RF_COUNT 3u
#define STM32_CAN_RF_RELEASE (1u << 5)
#define STM32_CAN_TI_SEND 1u
#define STM32_CAN_I_NOT_PLAIN 6u // an extended id, or a remote frame
#define STM32_CAN_STANDARD(id) ((uint32_t)(id) << 21)
#define STM32_CAN_BTR_500K (1u << 20 | 10u << 16 | 5u) // of 42 MHz: 6 x (1 + 11 + 2) quanta, sampled at 86 %
#define STM32_CAN_FMR_INIT 1u

// Interrupts.
#define STM32_IRQ_USART1 37u
#define STM32_IRQ_USART2 38u

#endif
