// SPDX-License-Identifier: MIT
// Rule under attack: a ring gives back what was put, in order, over the wrap of its indices, and what has no
// room is counted and breaks nothing.
#include "board/ring.h"

#include "unity.h"

static uint8_t storage[16];
static board_ring_t ring;

void setUp(void) {
    ring = (board_ring_t)BOARD_RING(storage);
}

void test_empty_at_first(void) {
    TEST_ASSERT_TRUE(board_ring_is_empty(&ring));
    TEST_ASSERT_EQUAL_size_t(16, board_ring_room(&ring));
    TEST_ASSERT_EQUAL_INT(-1, board_ring_take(&ring));
}

void test_order_is_kept_over_the_wrap_of_the_indices(void) {
    uint8_t next = 0;
    atomic_store(&ring.head, UINT16_MAX - 20);
    atomic_store(&ring.tail, UINT16_MAX - 20);
    for (int i = 0; i < 200; i++) {
        board_ring_put(&ring, (uint8_t)i);
        if (i >= 12) {
            TEST_ASSERT_EQUAL_INT(next++, board_ring_take(&ring));
        }
    }
    TEST_ASSERT_EQUAL_UINT32(0, ring.lost);
}

void test_what_has_no_room_is_counted(void) {
    for (int i = 0; i < 20; i++) {
        board_ring_put(&ring, (uint8_t)i);
    }
    TEST_ASSERT_EQUAL_UINT32(4, ring.lost);
    TEST_ASSERT_EQUAL_size_t(0, board_ring_room(&ring));
    for (int i = 0; i < 16; i++) {
        TEST_ASSERT_EQUAL_INT(i, board_ring_take(&ring));
    }
}

void test_a_packet_goes_in_whole_or_not_at_all(void) {
    uint8_t back[16];
    TEST_ASSERT_TRUE(board_ring_put_all(&ring, (const uint8_t *)"0123456789", 10));
    TEST_ASSERT_FALSE(board_ring_put_all(&ring, (const uint8_t *)"abcdefg", 7));
    TEST_ASSERT_TRUE(board_ring_put_all(&ring, (const uint8_t *)"abcdef", 6));
    TEST_ASSERT_EQUAL_size_t(4, board_ring_take_some(&ring, back, 4));
    TEST_ASSERT_EQUAL_MEMORY("0123", back, 4);
    TEST_ASSERT_EQUAL_size_t(12, board_ring_take_some(&ring, back, sizeof back));
    TEST_ASSERT_EQUAL_MEMORY("456789abcdef", back, 12);
}
