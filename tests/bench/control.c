// SPDX-License-Identifier: MIT
// Prints how long argusd takes from a SIP with a pressed bumper to E_STOP, alone and with ten readers at its
// control socket that ask for everything and read nothing, in turns in one run. Ends with 1 when they slow
// it.
#define _GNU_SOURCE // ptys
#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "../unit/hal/linux/argusd/wire_robot.h"

#define TIMES 200
#define READERS 10
#define FILL_MS 8000    // until nothing more goes into a reader's socket
#define WORST_RATIO 1.5 // of the medians,
#define NOISE_US 300.0  // ... beyond what a busy machine makes of them
#define PATIENCE_US 5e6
#define SIP_MS 20

typedef struct {
    pid_t pid;
    int master;
    char socket[64];
    robot_t robot;
    double us[TIMES];
} side_t;

static side_t alone, watched;
static int reader[READERS];

__attribute__((noreturn)) static void fail(const char *const what) {
    fprintf(stderr, "control: %s\n", what);
    kill(alone.pid, SIGKILL);
    kill(watched.pid, SIGKILL);
    exit(1);
}

static double now_us(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e6 + (double)t.tv_nsec / 1e3;
}

static void start(side_t *const side, const char *const program) {
    struct termios raw;
    char link[96];
    char place[96];
    side->master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (side->master < 0 || grantpt(side->master) != 0 || unlockpt(side->master) != 0 ||
        tcgetattr(side->master, &raw) != 0) {
        fail("no pty");
    }
    cfmakeraw(&raw);
    tcsetattr(side->master, TCSANOW, &raw);
    snprintf(link, sizeof link, "serial:%s@115200", ptsname(side->master));
    snprintf(side->socket, sizeof side->socket, "/tmp/argus-bench-%d-%d.sock", (int)getpid(), side->master);
    snprintf(place, sizeof place, "unix:%s", side->socket);
    robot_init(&side->robot);
    side->pid = fork();
    if (side->pid == 0) {
        const int nowhere = open("/dev/null", O_RDWR);
        dup2(nowhere, STDIN_FILENO);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        execl(program, program, "--link", link, "--active", "--json", "--control", place, (char *)NULL);
        _exit(127);
    }
}

// What argusd has written since.
static void take(side_t *const side) {
    uint8_t bytes[512];
    for (;;) {
        const ssize_t got = read(side->master, bytes, sizeof bytes);
        if (got <= 0) {
            return;
        }
        robot_take(&side->robot, 0, bytes, (size_t)got);
    }
}

static void put(side_t *const side) {
    if (side->robot.used > 0 &&
        write(side->master, side->robot.out, side->robot.used) != (ssize_t)side->robot.used) {
        fail("write to the pty");
    }
    side->robot.used = 0;
}

static void put_sip(side_t *const side, const bool pressed) {
    robot_t *const robot = &side->robot;
    put(side);
    robot_sip(robot);
    if (pressed && robot->used > 5) {
        robot->out[ARCOS_SIP_OFFSET_STALL_RIGHT] = 0x08; // the middle segment in front
        const uint16_t sum = argus_frame_checksum(robot->out + 3, robot->used - 5);
        robot->out[robot->used - 2] = (uint8_t)(sum >> 8);
        robot->out[robot->used - 1] = (uint8_t)(sum & 0xFFu);
    }
    put(side);
}

// Both robots live for so long.
static void live(const int ms) {
    const double end = now_us() + ms * 1e3;
    while (now_us() < end) {
        side_t *const sides[] = {&alone, &watched};
        for (int i = 0; i < 2; i++) {
            take(sides[i]);
            put_sip(sides[i], false);
        }
        usleep(SIP_MS * 1000);
    }
}

static double once(side_t *const side) {
    const uint32_t before = side->robot.commands[ARCOS_CMD_E_STOP];
    take(side);
    put_sip(side, true);
    const double began = now_us();
    double passed = 0;
    while (side->robot.commands[ARCOS_CMD_E_STOP] == before) {
        struct pollfd wait = {.fd = side->master, .events = POLLIN};
        poll(&wait, 1, 100);
        take(side);
        passed = now_us() - began;
        if (passed > PATIENCE_US) {
            fail("no E_STOP");
        }
    }
    return passed;
}

static void stall(void) {
    static const char want[] =
        "{\"do\":\"watch\",\"topics\":[\"events\",\"state\",\"readings\",\"evidence\"],"
        "\"period_ms\":50}\n";
    struct sockaddr_un to = {.sun_family = AF_UNIX};
    snprintf(to.sun_path, sizeof to.sun_path, "%s", watched.socket);
    for (int i = 0; i < READERS; i++) {
        reader[i] = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (connect(reader[i], (struct sockaddr *)&to, sizeof to) != 0 ||
            write(reader[i], want, sizeof want - 1) != (ssize_t)sizeof want - 1) {
            fail("no control socket");
        }
    }
}

// The ones that were closed for reading nothing come again.
static void stall_again(void) {
    for (int i = 0; i < READERS; i++) {
        close(reader[i]);
    }
    stall();
}

static int compare(const void *const a, const void *const b) {
    const double difference = *(const double *)a - *(const double *)b;
    return difference < 0 ? -1 : difference > 0;
}

static double report(const char *const name, side_t *const side) {
    qsort(side->us, TIMES, sizeof side->us[0], compare);
    printf("bumper to E_STOP, %-18s median %7.1f  p99 %7.1f  max %7.1f us (%d times)\n", name,
           side->us[TIMES / 2], side->us[TIMES * 99 / 100], side->us[TIMES - 1], TIMES);
    return side->us[TIMES / 2];
}

static void stop(side_t *const side) {
    kill(side->pid, SIGTERM);
    for (int i = 0; i < 500 && waitpid(side->pid, NULL, WNOHANG) == 0; i++) {
        take(side);
        put_sip(side, false);
        usleep(10000);
    }
    kill(side->pid, SIGKILL);
    unlink(side->socket);
}

int main(int argc, char **argv) {
    char program[4096];
    (void)argc;
    snprintf(program, sizeof program, "%s", argv[0]);
    strncat(dirname(program), "/argusd", 16);
    signal(SIGPIPE, SIG_IGN);
    start(&alone, program);
    start(&watched, program);
    for (int i = 0; i < 200 && (!alone.robot.open || !watched.robot.open); i++) {
        live(100);
    }
    if (!alone.robot.open || !watched.robot.open) {
        fail("argusd opens no session");
    }
    live(2000);
    for (int i = 0; i < TIMES; i++) {
        if (i % (TIMES / 2) == 0) {
            if (i == 0) {
                stall();
            } else {
                stall_again();
            }
            live(FILL_MS);
        }
        side_t *const first = i % 2 == 0 ? &alone : &watched;
        side_t *const second = i % 2 == 0 ? &watched : &alone;
        first->us[i] = once(first);
        second->us[i] = once(second);
        live(2 * SIP_MS);
    }
    const double without = report("alone", &alone);
    const double with = report("ten stalled", &watched);
    printf("ratio of the medians: %.2f\n", with / without);
    stop(&alone);
    stop(&watched);
    return with > without * WORST_RATIO && with > without + NOISE_US;
}
