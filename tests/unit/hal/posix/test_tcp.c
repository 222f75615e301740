// SPDX-License-Identifier: MIT
// Attacks: a TCP link connects over IPv4 and IPv6, says why when it cannot, notices a closed end, and can be
// given up.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <signal.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "hal/tcp.h"
#include "unity.h"

static hal_tcp_t tcp;
static int server;

void setUp(void) {
    hal_tcp_init(&tcp);
    server = -1;
}

void tearDown(void) {
    const hal_link_t link = hal_tcp_link(&tcp);
    hal_link_close(&link);
    if (server >= 0) {
        close(server);
    }
}

static uint16_t listen_v4(void) {
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t size = sizeof address;
    server = socket(AF_INET, SOCK_STREAM, 0);
    TEST_ASSERT_EQUAL_INT(0, bind(server, (struct sockaddr *)&address, size));
    TEST_ASSERT_EQUAL_INT(0, listen(server, 1));
    getsockname(server, (struct sockaddr *)&address, &size);
    return ntohs(address.sin_port);
}

void test_bytes_go_both_ways_and_a_closed_end_is_noticed(void) {
    const uint16_t port = listen_v4();
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_tcp_open(&tcp, "127.0.0.1", port, 1000, -1));
    const hal_link_t link = hal_tcp_link(&tcp);
    const int robot = accept(server, NULL, NULL);
    int yes = 0;
    socklen_t size = sizeof yes;
    getsockopt(hal_link_fd(&link), IPPROTO_TCP, TCP_NODELAY, &yes, &size);
    TEST_ASSERT_NOT_EQUAL(0, yes);

    uint8_t bytes[8] = {0};
    TEST_ASSERT_EQUAL_INT(0, hal_link_read(&link, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(5, hal_link_write(&link, (const uint8_t *)"hello", 5));
    TEST_ASSERT_EQUAL_INT(5, read(robot, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_MEMORY("hello", bytes, 5);
    close(robot);
    int got = 0;
    while (got == 0) {
        got = hal_link_read(&link, bytes, sizeof bytes);
    }
    TEST_ASSERT_EQUAL_INT(HAL_LINK_CLOSED, got);
    TEST_ASSERT_EQUAL_UINT32(5, hal_link_counters(&link).bytes_out);
}

void test_it_can_be_opened_again(void) {
    const uint16_t port = listen_v4();
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_tcp_open(&tcp, "localhost", port, 1000, -1));
        close(accept(server, NULL, NULL));
    }
}

// Where the reset is seen, in the connect or in a read, is a matter of chance, and must not matter.
void test_a_reset_after_the_handshake_is_a_link_that_the_other_end_closed(void) {
    const uint16_t port = listen_v4();
    const pid_t child = fork();
    while (child == 0) {
        const struct linger at_once = {.l_onoff = 1, .l_linger = 0};
        const int robot = accept(server, NULL, NULL);
        setsockopt(robot, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
        close(robot);
    }
    for (int i = 0; i < 200; i++) {
        uint8_t bytes[8];
        const hal_link_t link = hal_tcp_link(&tcp);
        int got = 0;
        TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_tcp_open(&tcp, "127.0.0.1", port, 10000, -1));
        while (got == 0) {
            got = hal_link_read(&link, bytes, sizeof bytes);
        }
        TEST_ASSERT_EQUAL_INT(HAL_LINK_CLOSED, got);
    }
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
}

void test_ipv6(void) {
    struct sockaddr_in6 address = {.sin6_family = AF_INET6, .sin6_addr = in6addr_loopback};
    socklen_t size = sizeof address;
    server = socket(AF_INET6, SOCK_STREAM, 0);
    if (server < 0 || bind(server, (struct sockaddr *)&address, size) != 0) {
        TEST_IGNORE_MESSAGE("this machine has no IPv6 loopback");
    }
    listen(server, 1);
    getsockname(server, (struct sockaddr *)&address, &size);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_tcp_open(&tcp, "::1", ntohs(address.sin6_port), 1000, -1));
    TEST_ASSERT_EQUAL_STRING_LEN("tcp:[::1]:", hal_tcp_link(&tcp).ops->describe(&tcp), 10);
}

void test_nobody_listens(void) {
    const uint16_t port = listen_v4();
    close(server);
    server = -1;
    TEST_ASSERT_EQUAL_INT(HAL_LINK_REFUSED, hal_tcp_open(&tcp, "127.0.0.1", port, 1000, -1));
    const hal_link_t link = hal_tcp_link(&tcp);
    TEST_ASSERT_EQUAL_INT(-1, hal_link_fd(&link));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_OPEN, hal_link_write(&link, (const uint8_t *)"x", 1));
}

void test_unknown_host_and_bad_arguments(void) {
    TEST_ASSERT_EQUAL_INT(HAL_LINK_UNRESOLVED, hal_tcp_open(&tcp, "no such host", 8101, 100, -1));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_BAD_ARGUMENT, hal_tcp_open(&tcp, "", 8101, 100, -1));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_BAD_ARGUMENT, hal_tcp_open(&tcp, "localhost", 0, 100, -1));
}

// A backlog that is full leaves a connection unanswered, which is as near to a dead host as loopback comes.
static uint16_t listen_full(int *fillers, int count) {
    const uint16_t port = listen_v4();
    listen(server, 0);
    struct sockaddr_in address = {
        .sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK), .sin_port = htons(port)};
    for (int i = 0; i < count; i++) {
        fillers[i] = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
        (void)!connect(fillers[i], (struct sockaddr *)&address, sizeof address);
    }
    return port;
}

void test_a_silent_host_times_out_and_can_be_cancelled(void) {
    int fillers[4];
    int cancel[2];
    const uint16_t port = listen_full(fillers, 4);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_TIMEOUT, hal_tcp_open(&tcp, "127.0.0.1", port, 50, -1));
    TEST_ASSERT_EQUAL_INT(0, pipe(cancel));
    TEST_ASSERT_EQUAL_INT(1, write(cancel[1], "x", 1));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_CANCELLED, hal_tcp_open(&tcp, "127.0.0.1", port, 60000, cancel[0]));
    for (int i = 0; i < 4; i++) {
        close(fillers[i]);
    }
    close(cancel[0]);
    close(cancel[1]);
}
