// SPDX-License-Identifier: MIT
// What a microcontroller's port gives to the common loop (docs/porting.md).
//
// The first six functions are the port. The others have defaults (optional.c): no second UART, no store, no
// watchdog. All are called by the loop alone, never by an interrupt, and none waits but board_wait() and
// flash.
#ifndef BOARD_BOARD_H
#define BOARD_BOARD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "board/ring.h"

// Never a part of its callers: one copy of its code, and what it has on the stack is gone when others go
// deep.
#define BOARD_APART __attribute__((noinline))

// The six ---------------------------------------------------------------------------------------------------

// Opens the robot's UART: 8 data bits, no parity, 1 stop bit, no flow control. Called once.
void board_open(uint32_t baud);
// A free-running count of milliseconds; wraps at 32 bits and never stands still.
uint32_t board_now_ms(void);
// Takes what the robot has sent, at most `capacity` bytes; 0: nothing.
size_t board_receive(uint8_t *bytes, size_t capacity);
// Bytes that board_send() would take now.
size_t board_room(void);
// Takes a packet that fits the room; it goes out by itself.
void board_send(const uint8_t *packet, size_t count);
// Sleeps for at most so long, less when a byte arrives.
void board_wait(uint32_t ms);

// For a watchdog --------------------------------------------------------------------------------------------

// Called as long as all is well, at least every 100 ms but while the store is written.
void board_feed(void);

// For a second UART -----------------------------------------------------------------------------------------

// Where the lines for it are put, of 1024 bytes at least; NULL: there is none.
board_ring_t *board_console_out(void);
// A whole line was put.
void board_console_kick(void);
size_t board_console_read(uint8_t *bytes, size_t capacity);

// For a start that tells why --------------------------------------------------------------------------------

typedef enum {
    BOARD_RESET_POWER,    // the supply came, or it is not known
    BOARD_RESET_PIN,      // the reset button, a programmer
    BOARD_RESET_ORDER,    // an operator
    BOARD_RESET_WATCHDOG, // the watchdog was not fed
    BOARD_RESET_FAULT,    // the processor met what it could not do
    BOARD_RESET_BROWN     // the supply sagged
} board_reset_t;

// What the life before this one ended with; all 0: nothing is known.
typedef struct {
    uint32_t pc;
    uint32_t lr;
    uint32_t cause; // the processor's fault status
    int32_t invariant;
} board_note_t;

board_reset_t board_reset_reason(void);
board_note_t board_last_note(void);
// Kept for the next life: the invariant that does not hold.
void board_keep_invariant(int32_t number);
// Starts anew; does not return.
void board_restart(void);
// Bytes of the stack that no call has reached so far; 0: not known.
uint32_t board_stack_left(void);
// Of a port; static text.
const char *board_name(void);

// The loop --------------------------------------------------------------------------------------------------

// Runs the fault manager for ever. The port's clock, interrupts and second UART are ready.
_Noreturn void board_run(void);

#endif
