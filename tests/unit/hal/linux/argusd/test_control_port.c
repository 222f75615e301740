// SPDX-License-Identifier: MIT
// Attacks: the socket file is argusd's user's alone from its first moment, what somebody else has there
// stays, and what is left by the dead is replaced.
#define _GNU_SOURCE
#include "control_port.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "unity.h"

static char folder[64];
static char path[96];
static char message[1024];
static control_spec_t spec;
static control_port_t port;

void setUp(void) {
    char text[128];
    strcpy(folder, "/tmp/argus-port-XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/s", folder);
    snprintf(text, sizeof text, "unix:%s", path);
    TEST_ASSERT_TRUE(control_spec_parse(&spec, text, message, sizeof message));
    port.fd = -1;
}

void tearDown(void) {
    control_port_close(&port);
    unlink(path);
    rmdir(folder);
}

static int connect_to(void) {
    const int fd = socket(AF_UNIX, SOCK_STREAM, 0);
    if (connect(fd, &spec.address.any, spec.length) != 0) {
        close(fd);
        return -1;
    }
    return fd;
}

static bool opens(void) {
    message[0] = '\0';
    return control_port_open(&port, &spec, message, sizeof message);
}

void test_the_file_is_ours_alone_whatever_the_umask(void) {
    struct stat about;
    const mode_t before = umask(0);
    TEST_ASSERT_TRUE_MESSAGE(opens(), message);
    umask(before);
    TEST_ASSERT_EQUAL_INT(0, lstat(path, &about));
    TEST_ASSERT_EQUAL_HEX(0600, about.st_mode & 07777);
    control_port_close(&port);
    TEST_ASSERT_EQUAL_INT(-1, lstat(path, &about));
}

void test_a_peer_is_let_in_and_never_waits(void) {
    char byte = 0;
    TEST_ASSERT_TRUE_MESSAGE(opens(), message);
    TEST_ASSERT_EQUAL_INT(-1, control_port_accept(&port));
    const int far = connect_to();
    const int near = control_port_accept(&port);
    TEST_ASSERT_TRUE(far >= 0 && near >= 0);
    TEST_ASSERT_EQUAL_INT(-1, recv(near, &byte, 1, 0)); // would wait
    TEST_ASSERT_TRUE((fcntl(near, F_GETFD) & FD_CLOEXEC) != 0);
    close(far);
    close(near);
}

// Only root can play somebody else.
void test_a_peer_of_another_user_is_turned_away(void) {
    if (geteuid() != 0) {
        TEST_IGNORE_MESSAGE("needs root to be another user");
    }
    TEST_ASSERT_TRUE_MESSAGE(opens(), message);
    chmod(folder, 0755);
    chmod(path, 0666); // even where the mode of the file would let him in
    const pid_t child = fork();
    if (child == 0) {
        char byte = 0;
        const int fd = setuid(65534) == 0 ? connect_to() : -1;
        _exit(fd >= 0 && read(fd, &byte, 1) == 0 ? 0 : 1); // closed at once
    }
    int status = -1;
    for (int i = 0; i < 500 && waitpid(child, &status, WNOHANG) == 0; i++) {
        TEST_ASSERT_EQUAL_INT(-1, control_port_accept(&port));
        usleep(10000);
    }
    TEST_ASSERT_TRUE(WIFEXITED(status));
    TEST_ASSERT_EQUAL_INT(0, WEXITSTATUS(status));
}

void test_what_the_dead_have_left_is_replaced(void) {
    const int dead = socket(AF_UNIX, SOCK_STREAM, 0);
    TEST_ASSERT_EQUAL_INT(0, bind(dead, &spec.address.any, spec.length));
    close(dead);
    TEST_ASSERT_TRUE_MESSAGE(opens(), message);
}

void test_what_is_served_or_no_socket_stays(void) {
    struct stat about;
    control_port_t first = {.fd = -1};
    TEST_ASSERT_TRUE(control_port_open(&first, &spec, message, sizeof message));
    TEST_ASSERT_FALSE(opens());
    TEST_ASSERT_NOT_NULL(strstr(message, "another program serves it (process "));
    TEST_ASSERT_EQUAL_INT(0, lstat(path, &about));
    control_port_close(&first);
    close(open(path, O_CREAT | O_WRONLY, 0600));
    TEST_ASSERT_FALSE(opens());
    TEST_ASSERT_NOT_NULL(strstr(message, "no socket"));
    TEST_ASSERT_EQUAL_INT(0, lstat(path, &about));
}

void test_a_file_that_is_not_ours_any_more_is_not_taken_away(void) {
    struct stat about;
    control_port_t second = {.fd = -1};
    TEST_ASSERT_TRUE_MESSAGE(opens(), message);
    unlink(path);
    TEST_ASSERT_TRUE(control_port_open(&second, &spec, message, sizeof message));
    control_port_close(&port);
    TEST_ASSERT_EQUAL_INT(0, lstat(path, &about));
    control_port_close(&second);
}

void test_a_tcp_port_tells_its_number(void) {
    char where[96];
    TEST_ASSERT_TRUE(control_spec_parse(&spec, "tcp:127.0.0.1:0", message, sizeof message));
    TEST_ASSERT_TRUE_MESSAGE(opens(), message);
    control_port_describe(&port, where, sizeof where);
    TEST_ASSERT_EQUAL_STRING_LEN("tcp:127.0.0.1:", where, 14);
    TEST_ASSERT_TRUE(atoi(where + 14) > 0);
}

void test_a_place_that_cannot_be_is_told(void) {
    TEST_ASSERT_TRUE(control_spec_parse(&spec, "unix:/nowhere/at/all", message, sizeof message));
    TEST_ASSERT_FALSE(opens());
    TEST_ASSERT_EQUAL_STRING("--control unix:/nowhere/at/all: No such file or directory", message);
}
