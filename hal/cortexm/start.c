// SPDX-License-Identifier: MIT
// From reset to main(): memory is laid out, the stack is painted so that its use can be measured.
#include "cortexm/cortexm.h"

#define PAINT 0xC0DEC0DE

extern uint32_t cortexm_data_from[];
extern uint32_t cortexm_data[];
extern uint32_t cortexm_data_end[];
extern uint32_t cortexm_bss[];
extern uint32_t cortexm_bss_end[];

int main(void);
void cortexm_start(void);

// Written so that no compiler makes a call to memcpy() or memset() of it, whose memory is not ready yet.
#define STEP __asm volatile("" ::: "memory")

__attribute__((used)) void cortexm_start(void) {
    const uint32_t *from = cortexm_data_from;
    cortexm_board_start();
    // cppcheck-suppress comparePointers ; both ends of one section, from the linker
    for (uint32_t *to = cortexm_data; to < cortexm_data_end; to++) {
        *to = *from++;
        STEP;
    }
    // cppcheck-suppress comparePointers ; likewise
    for (uint32_t *to = cortexm_bss; to < cortexm_bss_end; to++) {
        *to = 0;
        STEP;
    }
    main();
    board_restart();
}

#define TEXT_OF(macro) TEXT(macro)
#define TEXT(macro) #macro

// A debugger may start it with any stack pointer. The stack is painted while nothing is on it.
__attribute__((naked)) void cortexm_reset(void) {
    __asm volatile("cpsid i\n\t"
                   "ldr r0, =cortexm_stack_bottom\n\t"
                   "ldr r1, =cortexm_stack_top\n\t"
                   "ldr r2, =" TEXT_OF(PAINT) "\n\t"
                                              "mov sp, r1\n"
                                              "1: cmp r0, r1\n\t"
                                              "itt lo\n\t"
                                              "strlo r2, [r0], #4\n\t"
                                              "blo 1b\n\t"
                                              "cpsie i\n\t"
                                              "b cortexm_start");
}

uint32_t board_stack_left(void) {
    const uint32_t *word = cortexm_stack_bottom;
    // cppcheck-suppress comparePointers ; likewise
    while (word < cortexm_stack_top && *word == PAINT) {
        word++;
    }
    return (uint32_t)(word - cortexm_stack_bottom) * (uint32_t)sizeof *word;
}
