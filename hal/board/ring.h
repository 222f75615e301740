// SPDX-License-Identifier: MIT
// A ring of bytes between an interrupt and the loop: one side puts, the other takes, neither waits or locks.
#ifndef BOARD_RING_H
#define BOARD_RING_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    uint8_t *bytes;
    uint16_t size;         // a power of 2, at most 32768
    _Atomic uint16_t head; // bytes put, modulo 65536; written by the putting side
    _Atomic uint16_t tail; // bytes taken, likewise; written by the taking side
    uint32_t lost;         // bytes for which there was no room, monotonic; written by the putting side
} board_ring_t;

#define BOARD_RING(storage) {.bytes = (storage), .size = sizeof(storage)}

// For the side that puts.
size_t board_ring_room(const board_ring_t *self);
void board_ring_put(board_ring_t *self, uint8_t byte); // counts it as lost when there is no room
// All of them, or, when there is no room for that, none.
bool board_ring_put_all(board_ring_t *self, const uint8_t *bytes, size_t count);

// For the side that takes.
int board_ring_take(board_ring_t *self); // the next byte, -1: none
size_t board_ring_take_some(board_ring_t *self, uint8_t *bytes, size_t capacity);

bool board_ring_is_empty(const board_ring_t *self);

#endif
