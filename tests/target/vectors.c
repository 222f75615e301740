// SPDX-License-Identifier: MIT
// The vectors of a test that runs on a board: it begins in the C library, and a fault ends it.
#include <stdint.h>

#define SYS_EXIT_EXTENDED 0x20u // Arm's semihosting specification
#define STOPPED 0x20026u
#define FAULT_STATUS 99u

typedef void (*vector_t)(void);

void target_stack(void); // of the linker script: it is no function
void _start(void);

static void fault(void) {
    const uint32_t block[2] = {STOPPED, FAULT_STATUS};
    register uint32_t operation __asm("r0") = SYS_EXIT_EXTENDED;
    register const uint32_t *argument __asm("r1") = block;
    __asm volatile("bkpt 0xAB" : "+r"(operation) : "r"(argument) : "memory");
    for (;;) {
    }
}

__attribute__((section(".vectors"), used)) static const vector_t vectors[16] = {
    target_stack, _start, fault, fault, fault, fault, fault,
};
