// SPDX-License-Identifier: MIT
// A port to fill: the six functions that a board must give (docs/porting.md).
//
// It compiles as it is and does nothing: no robot is heard, no time passes.
#include "board/board.h"

// Opens the robot's UART: 8 data bits, no parity, 1 stop bit, no flow control.
void board_open(uint32_t baud) {
    (void)baud;
}

// A free-running count of milliseconds: from a counter that no lost interrupt holds up.
uint32_t board_now_ms(void) {
    return 0;
}

// Takes what the robot has sent. An interrupt puts bytes into a board_ring_t; this takes them out
// (board_ring_take_some()).
// NOLINTNEXTLINE(readability-non-const-parameter): yours writes there
size_t board_receive(uint8_t *bytes, size_t capacity) {
    (void)bytes;
    (void)capacity;
    return 0;
}

// Bytes that board_send() would take now: board_ring_room() of a ring of 256.
size_t board_room(void) {
    return 0;
}

// Takes a packet that fits the room: board_ring_put_all(), and the interrupt that sends is switched on.
void board_send(const uint8_t *packet, size_t count) {
    (void)packet;
    (void)count;
}

// Sleeps for at most so long, less when a byte arrives. To return at once is allowed.
void board_wait(uint32_t ms) {
    (void)ms;
}

// Clocks and pins first; then the loop, which never returns.
int main(void) {
    board_run();
}
