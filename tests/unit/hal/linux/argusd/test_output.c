// SPDX-License-Identifier: MIT
// Attacks: a reader that is slow or gone never makes the writer wait, and gets whole lines or none.
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "output.h"
#include "unity.h"

static output_t out;
static int ends[2];

// A reader that does not read: SIGALRM ends a test that waits for it.
void setUp(void) {
    signal(SIGPIPE, SIG_IGN);
    alarm(600);
    TEST_ASSERT_EQUAL_INT(0, pipe(ends));
}

void tearDown(void) {
    alarm(0);
    output_close(&out);
    close(ends[0]);
    close(ends[1]);
}

static uint32_t fill(void) {
    uint32_t taken = 0;
    char line[64];
    for (uint32_t i = 0; i < 20000; i++) {
        const int length = snprintf(line, sizeof line, "line %06u with some more text", (unsigned)i);
        taken += output_line(&out, line, (size_t)length);
    }
    return taken;
}

static void read_back(uint32_t taken, int fd) {
    static char all[2000000];
    size_t used = 0;
    fcntl(fd, F_SETFL, O_NONBLOCK);
    for (int idle = 0; idle < 3;) {
        const ssize_t got = read(fd, all + used, sizeof all - 1 - used);
        used += got > 0 ? (size_t)got : 0;
        idle = got > 0 ? 0 : idle + 1;
        output_flush(&out);
    }
    all[used] = '\0';
    uint32_t lines = 0;
    for (char *line = strtok(all, "\n"); line != NULL; line = strtok(NULL, "\n")) {
        TEST_ASSERT_EQUAL_size_t(31, strlen(line));
        TEST_ASSERT_EQUAL_STRING_LEN("line ", line, 5);
        TEST_ASSERT_EQUAL_UINT32(lines, (uint32_t)strtoul(line + 5, NULL, 10));
        lines++;
    }
    TEST_ASSERT_EQUAL_UINT32(taken, lines);
}

void test_a_pipe_nobody_reads(void) {
    output_init(&out, ends[1]);
    TEST_ASSERT_TRUE(out.own);
    TEST_ASSERT_EQUAL_INT(0, fcntl(ends[1], F_GETFL) & O_NONBLOCK);
    const uint32_t taken = fill();
    TEST_ASSERT_EQUAL_UINT32(20000, taken + out.dropped);
    TEST_ASSERT_GREATER_THAN_UINT32(0, out.dropped);
    TEST_ASSERT_TRUE(output_waits(&out));
    read_back(taken, ends[0]);
    TEST_ASSERT_FALSE(output_waits(&out));
}

void test_a_pipe_that_cannot_be_opened_again(void) {
    output_init(&out, ends[1]);
    output_close(&out);
    memset(&out, 0, sizeof out);
    out.fd = ends[1];
    const uint32_t taken = fill();
    TEST_ASSERT_GREATER_THAN_UINT32(0, out.dropped);
    read_back(taken, ends[0]);
}

void test_a_socket_nobody_reads(void) {
    int pair[2];
    TEST_ASSERT_EQUAL_INT(0, socketpair(AF_UNIX, SOCK_STREAM, 0, pair));
    output_init(&out, pair[0]);
    TEST_ASSERT_TRUE(out.is_socket);
    const uint32_t taken = fill();
    TEST_ASSERT_GREATER_THAN_UINT32(0, out.dropped);
    read_back(taken, pair[1]);
    close(pair[0]);
    close(pair[1]);
}

void test_a_reader_that_has_gone(void) {
    output_init(&out, ends[1]);
    close(ends[0]);
    output_line(&out, "x", 1);
    TEST_ASSERT_TRUE(out.broken);
    TEST_ASSERT_FALSE(output_line(&out, "y", 1));
    TEST_ASSERT_FALSE(output_waits(&out));
    ends[0] = open("/dev/null", O_RDONLY);
}

void test_a_file_takes_everything_where_it_stands(void) {
    FILE *const file = tmpfile();
    fputs("before\n", file);
    fflush(file);
    output_init(&out, fileno(file));
    TEST_ASSERT_EQUAL_UINT32(20000, fill());
    fseek(file, 0, SEEK_SET);
    char line[64];
    TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, file));
    TEST_ASSERT_EQUAL_STRING("before\n", line);
    fclose(file);
}

void test_a_closed_descriptor(void) {
    output_init(&out, -1);
    TEST_ASSERT_TRUE(out.broken);
    TEST_ASSERT_FALSE(output_line(&out, "x", 1));
}
