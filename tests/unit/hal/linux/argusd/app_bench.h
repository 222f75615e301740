// SPDX-License-Identifier: MIT
// What tests of argusd as a whole share: it runs in a process of its own, with a robot on a real pty.
#ifndef TEST_APP_BENCH_H
#define TEST_APP_BENCH_H

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "app.h"
#include "arguments.h"
#include "unity.h"
#include "wire_robot.h"

static char out[65536];
static char err[4096];
static int master = -1;
static int slave = -1;
static char name[64];
static robot_t robot;
static bool mute;                             // nothing passes between them any more
static void (*during)(pid_t child, int turn); // NULL: nothing happens besides
static int await_command = ARCOS_CMD_PULSE;   // SIGTERM waits until the robot has got one of these, too

static void app_set_up(void) {
    await_command = ARCOS_CMD_PULSE;
    TEST_ASSERT_EQUAL_INT(0, openpty(&master, &slave, name, NULL, NULL));
    fcntl(master, F_SETFL, O_NONBLOCK);
    robot_init(&robot);
    mute = false;
    during = NULL;
}

static void app_tear_down(void) {
    close(master);
    close(slave);
}

static pid_t start(const char *line, int ends[2][2]) {
    char *argv[ARGUMENTS_MAX];
    const int argc = arguments_of(line, argv);
    TEST_ASSERT_EQUAL_INT(0, pipe(ends[0]));
    TEST_ASSERT_EQUAL_INT(0, pipe(ends[1]));
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        dup2(ends[0][1], STDOUT_FILENO);
        dup2(ends[1][1], STDERR_FILENO);
        close(master);
        const int code = app_main(argc, argv);
        fflush(NULL);
        _exit(code);
    }
    close(ends[0][1]);
    close(ends[1][1]);
    fcntl(ends[0][0], F_SETFL, O_NONBLOCK);
    fcntl(ends[1][0], F_SETFL, O_NONBLOCK);
    return child;
}

static void gather(int fd, char *text, size_t capacity, size_t *used) {
    const ssize_t got = read(fd, text + *used, capacity - 1 - *used);
    *used += got > 0 ? (size_t)got : 0;
    text[*used] = '\0';
}

// The robot's part for one turn of at most 50 ms; a SIP each turn.
static void serve(bool present) {
    uint8_t bytes[256];
    struct pollfd wait = {.fd = master, .events = POLLIN};
    poll(&wait, 1, 50);
    const ssize_t got = read(master, bytes, sizeof bytes);
    if (!present || mute) {
        return;
    }
    robot_take(&robot, 0, bytes, got > 0 ? (size_t)got : 0);
    robot_sip(&robot);
    (void)!write(master, robot.out, robot.used);
    robot.used = 0;
}

enum { PATIENCE_S = 60 };

static time_t now_s(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec;
}

// Runs argusd; `signal_at` (or NULL): SIGTERM is sent once this text was on standard output. Returns the exit
// code, or the number of the signal that ended it, negative: -9 is this test's, whose patience is over.
static int run(const char *line, bool present, const char *signal_at) {
    int ends[2][2];
    int status = 0;
    size_t used[2] = {0, 0};
    const pid_t child = start(line, ends);
    bool ended = false;
    out[0] = err[0] = '\0';
    const time_t begin_s = now_s();
    for (int turns = 0; !ended && now_s() - begin_s < PATIENCE_S; turns++) {
        serve(present);
        if (during != NULL) {
            during(child, turns);
        }
        ended = waitpid(child, &status, WNOHANG) == child;
        gather(ends[0][0], out, sizeof out, &used[0]);
        gather(ends[1][0], err, sizeof err, &used[1]);
        const bool got = await_command == ARCOS_CMD_PULSE || robot.commands[await_command] > 0;
        if (signal_at != NULL && strstr(out, signal_at) != NULL && got) {
            kill(child, SIGTERM);
            signal_at = NULL;
        }
    }
    serve(present); // what was written last
    if (!ended) {
        kill(child, SIGKILL);
        waitpid(child, &status, 0);
    }
    close(ends[0][0]);
    close(ends[1][0]);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

#endif
