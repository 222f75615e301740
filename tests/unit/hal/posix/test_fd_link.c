// SPDX-License-Identifier: MIT
// Attacks: a packet leaves whole or not at all, in order, whatever part of it the transport takes; full is
// not an error.
#include <fcntl.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "hal/fd_link.h"
#include "unity.h"

static hal_fd_link_t link_;
static int far_;

void setUp(void) {
    int pair[2];
    TEST_ASSERT_EQUAL_INT(0, socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, pair));
    const int small = 1; // the kernel rounds up to its least
    setsockopt(pair[0], SOL_SOCKET, SO_SNDBUF, &small, sizeof small);
    hal_fd_link_init(&link_);
    link_.fd = pair[0];
    far_ = pair[1];
}

void tearDown(void) {
    close(link_.fd);
    close(far_);
}

void test_nothing_to_read_is_0_and_a_closed_end_is_an_error(void) {
    uint8_t bytes[8];
    TEST_ASSERT_EQUAL_INT(0, hal_fd_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(3, write(far_, "abc", 3));
    TEST_ASSERT_EQUAL_INT(2, hal_fd_link_read(&link_, bytes, 2));
    TEST_ASSERT_EQUAL_INT(1, hal_fd_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_UINT32(3, link_.counters.bytes_in);
    shutdown(far_, SHUT_RDWR);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_CLOSED, hal_fd_link_read(&link_, bytes, sizeof bytes));
}

void test_bad_arguments_are_refused(void) {
    uint8_t bytes[HAL_LINK_PACKET_MAX + 1] = {0};
    TEST_ASSERT_EQUAL_INT(HAL_LINK_BAD_ARGUMENT, hal_fd_link_read(&link_, bytes, 0));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_BAD_ARGUMENT, hal_fd_link_write(&link_, bytes, 0));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_TOO_LONG, hal_fd_link_write(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_PACKET_MAX, hal_fd_link_write(&link_, bytes, HAL_LINK_PACKET_MAX));
}

void test_packets_stay_whole_and_in_order_through_a_full_transport(void) {
    uint8_t next_in = 0;
    uint32_t next_out = 0;
    uint32_t blocked = 0;
    for (uint32_t packet = 0; packet < 20000;) {
        uint8_t bytes[HAL_LINK_PACKET_MAX];
        const size_t count = 1 + (packet * 37u) % HAL_LINK_PACKET_MAX;
        for (size_t i = 0; i < count; i++) {
            bytes[i] = (uint8_t)(next_out + i);
        }
        const int taken = hal_fd_link_write(&link_, bytes, count);
        TEST_ASSERT_TRUE(taken == 0 || taken == (int)count);
        if (taken > 0) {
            next_out += (uint32_t)taken;
            packet++;
            continue;
        }
        blocked++;
        const ssize_t got = read(far_, bytes, 200);
        for (ssize_t i = 0; i < got; i++) {
            TEST_ASSERT_EQUAL_UINT8(next_in, bytes[i]);
            next_in++;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(0, blocked);
    TEST_ASSERT_EQUAL_UINT32(blocked, link_.counters.would_block);
    TEST_ASSERT_EQUAL_UINT32(20000, link_.counters.writes);
}

void test_a_part_that_was_not_taken_goes_first(void) {
    // Whether a transport takes a part is the kernel's choice, so the state after one is set by hand.
    memcpy(link_.rest, "tail", 4);
    link_.kept = 4;
    TEST_ASSERT_EQUAL_INT(4, hal_fd_link_write(&link_, (const uint8_t *)"next", 4));
    char got[16] = {0};
    TEST_ASSERT_EQUAL_INT(8, read(far_, got, sizeof got));
    TEST_ASSERT_EQUAL_STRING("tailnext", got);
    TEST_ASSERT_EQUAL_INT(0, hal_fd_link_flush(&link_));
}

void test_an_error_of_the_system_keeps_its_meaning(void) {
    hal_fd_link_t bad;
    uint8_t byte = 0;
    hal_fd_link_init(&bad);
    bad.fd = open("/dev/null", O_RDONLY);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_IO, hal_fd_link_write(&bad, &byte, 1));
    close(bad.fd);
}
