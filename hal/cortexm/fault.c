// SPDX-License-Identifier: MIT
// A fault leaves a note in memory that no start clears, and restarts; the robot is stopped by the silence
// that follows (loop.c).
#include "cortexm/cortexm.h"

#define MAGIC 0x41524753u // "ARGS": a note was left
#define FRAME_LR 5
#define FRAME_PC 6

typedef struct {
    uint32_t magic;
    uint32_t reason;
    board_note_t note;
} kept_t;

// Where the linker script puts what a reset does not touch.
static __attribute__((section(".noinit"))) kept_t kept;
static board_reset_t reason;
static board_note_t last;
static bool is_read;

// The note is read once, so that it is not taken for that of a later life.
static void read_note(void) {
    if (is_read) {
        return;
    }
    is_read = true;
    reason = BOARD_RESET_POWER;
    if (kept.magic == MAGIC && kept.reason <= BOARD_RESET_BROWN) {
        reason = (board_reset_t)kept.reason;
        last = kept.note;
    }
    kept = (kept_t){0};
}

board_reset_t cortexm_noted_reason(void) {
    read_note();
    return reason;
}

board_note_t board_last_note(void) {
    read_note();
    return last;
}

static BOARD_APART void keep(board_reset_t why) {
    kept.magic = MAGIC;
    kept.reason = (uint32_t)why;
    __asm volatile("dsb" ::: "memory"); // it is in memory, whether it seems to be read or not
}

static BOARD_APART void restart(void) {
    __asm volatile("dsb" ::: "memory");
    CORTEXM_SCB_AIRCR = CORTEXM_AIRCR_RESET;
    for (;;) {
    }
}

void board_restart(void) {
    read_note();
    keep(BOARD_RESET_ORDER);
    restart();
}

// What is not fed any more will bite; this says why.
void board_keep_invariant(int32_t number) {
    read_note();
    kept.note.invariant = number;
    keep(BOARD_RESET_WATCHDOG);
}

static bool is_in_stack(const uint32_t *frame) {
    return frame >= cortexm_stack_bottom && frame + FRAME_PC < cortexm_stack_top &&
           ((uintptr_t)frame & 3u) == 0;
}

static void keep_frame(const uint32_t *frame) {
    kept.note.pc = is_in_stack(frame) ? frame[FRAME_PC] : 0;
    kept.note.lr = is_in_stack(frame) ? frame[FRAME_LR] : 0;
    kept.note.cause = CORTEXM_SCB_CFSR;
}

void cortexm_fault_keep(const uint32_t *frame);
void cortexm_watchdog_keep(const uint32_t *frame);

__attribute__((used)) void cortexm_fault_keep(const uint32_t *frame) {
    kept = (kept_t){0};
    keep_frame(frame);
    keep(BOARD_RESET_FAULT);
    restart();
}

// An invariant that was noted stays so. The watchdog itself resets.
__attribute__((used)) void cortexm_watchdog_keep(const uint32_t *frame) {
    const int32_t invariant = kept.magic == MAGIC ? kept.note.invariant : 0;
    kept = (kept_t){.note = {.invariant = invariant}};
    keep_frame(frame);
    keep(BOARD_RESET_WATCHDOG);
    for (;;) {
    }
}

// What was the stack may be what is wrong with it: the handler takes a new one.
#define ON_A_NEW_STACK(function)                    \
    __asm volatile("mov r0, sp\n\t"                 \
                   "ldr r1, =cortexm_stack_top\n\t" \
                   "mov sp, r1\n\t"                 \
                   "b " function)

__attribute__((naked)) void cortexm_fault(void) {
    ON_A_NEW_STACK("cortexm_fault_keep");
}

__attribute__((naked)) void cortexm_watchdog(void) {
    ON_A_NEW_STACK("cortexm_watchdog_keep");
}

__attribute__((naked)) void cortexm_unexpected(void) {
    ON_A_NEW_STACK("cortexm_fault_keep");
}
