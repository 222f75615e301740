// SPDX-License-Identifier: MIT
// The ring's indices run freely; their difference is what it holds.
#include "board/ring.h"

static uint16_t used(const board_ring_t *self) {
    const uint16_t head = atomic_load_explicit(&self->head, memory_order_acquire);
    const uint16_t tail = atomic_load_explicit(&self->tail, memory_order_acquire);
    return (uint16_t)(head - tail);
}

size_t board_ring_room(const board_ring_t *self) {
    return (size_t)self->size - used(self);
}

bool board_ring_is_empty(const board_ring_t *self) {
    return used(self) == 0;
}

static void lay(board_ring_t *self, uint16_t at, uint8_t byte) {
    self->bytes[at & (self->size - 1u)] = byte;
}

void board_ring_put(board_ring_t *self, uint8_t byte) {
    const uint16_t head = atomic_load_explicit(&self->head, memory_order_relaxed);
    if (board_ring_room(self) == 0) {
        self->lost++;
        return;
    }
    lay(self, head, byte);
    atomic_store_explicit(&self->head, (uint16_t)(head + 1u), memory_order_release);
}

bool board_ring_put_all(board_ring_t *self, const uint8_t *bytes, size_t count) {
    const uint16_t head = atomic_load_explicit(&self->head, memory_order_relaxed);
    if (board_ring_room(self) < count) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        lay(self, (uint16_t)(head + i), bytes[i]);
    }
    atomic_store_explicit(&self->head, (uint16_t)(head + count), memory_order_release);
    return true;
}

int board_ring_take(board_ring_t *self) {
    const uint16_t tail = atomic_load_explicit(&self->tail, memory_order_relaxed);
    if (board_ring_is_empty(self)) {
        return -1;
    }
    const uint8_t byte = self->bytes[tail & (self->size - 1u)];
    atomic_store_explicit(&self->tail, (uint16_t)(tail + 1u), memory_order_release);
    return byte;
}

size_t board_ring_take_some(board_ring_t *self, uint8_t *bytes, size_t capacity) {
    size_t count = 0;
    int byte = 0;
    while (count < capacity && (byte = board_ring_take(self)) >= 0) {
        bytes[count++] = (uint8_t)byte;
    }
    return count;
}
