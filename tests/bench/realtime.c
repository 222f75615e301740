// SPDX-License-Identifier: MIT
// Prints how long argusd takes from a SIP with a pressed bumper to E_STOP on a busy machine, with --realtime
// and without, in turns in one run: every processor has two programs that compute and write to memory all the
// time. The robot is a program of a higher SCHED_FIFO priority, so its own waiting does not count. By TCP the
// bytes go straight from one program to the other. On a pty, as on a serial line, the kernel hands them on in
// a worker that waits for its turn like any program: a program of the same priority that only sends a byte
// back shows how long that takes. Ends with 1 when the p99 with --realtime is above the bar by TCP, or on the
// pty above what that program takes and the bar; with 77 where SCHED_FIFO may not be had.
#define _GNU_SOURCE // ptys
#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "../unit/hal/linux/argusd/wire_robot.h"

#define TIMES 400
#define P99_MS 5.0
#define ROBOT_PRIORITY 60 // above argusd's
#define ARGUSD_PRIORITY 40
#define LOADS 2 // for each processor
#define LOADS_MAX 256
#define LOAD_BYTES (8u << 20)
#define PATIENCE_MS 20e3
#define SIP_MS 20
#define SIDES 5
#define SENDS_BACK 4
#define NO_RIGHT 77

typedef struct {
    const char *name;
    bool by_tcp;
    bool realtime;
    bool echoes; // no argusd
    pid_t pid;
    int wire;
    robot_t robot;
    double ms[TIMES];
} side_t;

// The same link with --realtime follows the one without.
static side_t side[SIDES] = {{.name = "tcp", .by_tcp = true},
                             {.name = "tcp, --realtime", .by_tcp = true, .realtime = true},
                             {.name = "pty"},
                             {.name = "pty, --realtime", .realtime = true},
                             {.name = "pty, a byte back", .echoes = true}};
static pid_t load[LOADS_MAX];
static int loads;

static void end_all(void) {
    for (int i = 0; i < SIDES; i++) {
        if (side[i].pid > 0) {
            kill(side[i].pid, SIGKILL);
        }
    }
    for (int i = 0; i < loads; i++) {
        kill(load[i], SIGKILL);
        waitpid(load[i], NULL, 0);
    }
}

__attribute__((noreturn)) static void fail(const char *const what, const int code) {
    fprintf(stderr, "realtime: %s\n", what);
    end_all();
    exit(code);
}

static double now_ms(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec / 1e6;
}

__attribute__((noreturn)) static void compute(void) {
    const struct sched_param none = {0};
    volatile char *const memory = malloc(LOAD_BYTES);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    sched_setscheduler(0, SCHED_OTHER, &none);
    for (size_t at = 0;; at = (at + 4099) % LOAD_BYTES) {
        memory[at]++;
    }
}

static void load_machine(void) {
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    while (loads < LOADS * processors && loads < LOADS_MAX) {
        const pid_t pid = fork();
        if (pid == 0) {
            compute();
        }
        load[loads++] = pid;
    }
    printf("%d programs compute on %ld processors\n", loads, processors);
    fflush(stdout);
}

__attribute__((noreturn)) static void send_back(const char *const path) {
    const struct sched_param wanted = {.sched_priority = ARGUSD_PRIORITY};
    const int fd = open(path, O_RDWR | O_NOCTTY);
    uint8_t bytes[512];
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    sched_setscheduler(0, SCHED_FIFO, &wanted);
    while (read(fd, bytes, sizeof bytes) > 0 && write(fd, "!", 1) == 1) {
    }
    _exit(1);
}

static void open_pty(side_t *const self, char *const link, const size_t size) {
    struct termios raw;
    self->wire = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (self->wire < 0 || grantpt(self->wire) != 0 || unlockpt(self->wire) != 0 ||
        tcgetattr(self->wire, &raw) != 0) {
        fail("no pty", 1);
    }
    cfmakeraw(&raw);
    tcsetattr(self->wire, TCSANOW, &raw);
    snprintf(link, size, "serial:%s@115200", ptsname(self->wire));
}

static int listen_here(char *const link, const size_t size) {
    struct sockaddr_in at = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t length = sizeof at;
    const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (bind(fd, (struct sockaddr *)&at, length) != 0 || listen(fd, 1) != 0 ||
        getsockname(fd, (struct sockaddr *)&at, &length) != 0) {
        fail("no port", 1);
    }
    snprintf(link, size, "tcp:127.0.0.1:%u", (unsigned)ntohs(at.sin_port));
    return fd;
}

static void meet(side_t *const self, const int listener) {
    const int on = 1;
    struct pollfd come = {.fd = listener, .events = POLLIN};
    poll(&come, 1, 10000);
    self->wire = accept4(listener, NULL, NULL, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (self->wire < 0) {
        fail("argusd does not come", 1);
    }
    setsockopt(self->wire, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    close(listener);
}

static void start(side_t *const self, const char *const program) {
    char link[96];
    int listener = -1;
    if (self->by_tcp) {
        listener = listen_here(link, sizeof link);
    } else {
        open_pty(self, link, sizeof link);
    }
    robot_init(&self->robot);
    self->robot.open = self->echoes;
    self->pid = fork();
    if (self->pid == 0) {
        if (self->echoes) {
            send_back(ptsname(self->wire));
        }
        const struct sched_param none = {0};
        const int nowhere = open("/dev/null", O_RDWR);
        sched_setscheduler(0, SCHED_OTHER, &none);
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        dup2(nowhere, STDIN_FILENO);
        dup2(nowhere, STDOUT_FILENO);
        execl(program, program, "--link", link, "--active", "--json",
              self->realtime ? "--realtime" : (char *)NULL, (char *)NULL);
        _exit(127);
    }
    if (self->by_tcp) {
        meet(self, listener);
    }
}

// What argusd has written since.
static void take(side_t *const self) {
    uint8_t bytes[512];
    for (;;) {
        const ssize_t got = read(self->wire, bytes, sizeof bytes);
        if (got <= 0) {
            return;
        }
        if (self->echoes) {
            self->robot.commands[ARCOS_CMD_E_STOP]++;
        } else {
            robot_take(&self->robot, 0, bytes, (size_t)got);
        }
    }
}

static void put(side_t *const self) {
    if (self->robot.used > 0 &&
        write(self->wire, self->robot.out, self->robot.used) != (ssize_t)self->robot.used) {
        fail("write to the pty", 1);
    }
    self->robot.used = 0;
}

static void put_sip(side_t *const self, const bool pressed) {
    robot_t *const robot = &self->robot;
    put(self);
    robot_sip(robot);
    if (pressed && robot->used > 5) {
        robot->out[ARCOS_SIP_OFFSET_STALL_RIGHT] = 0x08; // the middle segment in front
        const uint16_t sum = argus_frame_checksum(robot->out + 3, robot->used - 5);
        robot->out[robot->used - 2] = (uint8_t)(sum >> 8);
        robot->out[robot->used - 1] = (uint8_t)(sum & 0xFFu);
    }
    put(self);
}

// All robots live for so long.
static void live(const int ms) {
    const double end = now_ms() + ms;
    while (now_ms() < end) {
        for (int i = 0; i < SIDES; i++) {
            take(&side[i]);
            put_sip(&side[i], false);
        }
        usleep(SIP_MS * 1000);
    }
}

// From the write of the SIP to the read of E_STOP.
static double once(side_t *const self) {
    take(self);
    const uint32_t before = self->robot.commands[ARCOS_CMD_E_STOP];
    const double began = now_ms();
    put_sip(self, true);
    while (self->robot.commands[ARCOS_CMD_E_STOP] == before) {
        struct pollfd wait = {.fd = self->wire, .events = POLLIN};
        poll(&wait, 1, 100);
        take(self);
        if (now_ms() - began > PATIENCE_MS) {
            fail("no E_STOP", 1);
        }
    }
    return now_ms() - began;
}

static int compare(const void *const a, const void *const b) {
    const double difference = *(const double *)a - *(const double *)b;
    return difference < 0 ? -1 : difference > 0;
}

static double report(side_t *const self) {
    qsort(self->ms, TIMES, sizeof self->ms[0], compare);
    const double p99 = self->ms[TIMES * 99 / 100];
    printf("bumper to E_STOP, %-16s median %7.2f  p99 %7.2f  max %7.2f ms (%d times)\n", self->name,
           self->ms[TIMES / 2], p99, self->ms[TIMES - 1], TIMES);
    return p99;
}

static bool all_open(void) {
    bool open = true;
    for (int i = 0; i < SIDES; i++) {
        open = open && (side[i].echoes || side[i].robot.open);
    }
    return open;
}

static void take_turn(void) {
    const struct sched_param wanted = {.sched_priority = ROBOT_PRIORITY};
    if (sched_setscheduler(0, SCHED_FIFO, &wanted) != 0) {
        fail("SCHED_FIFO is not granted: run it as root, or with `ulimit -r 60`", NO_RIGHT);
    }
    if (mlockall(MCL_CURRENT) != 0) {
        fprintf(stderr, "realtime: memory is not locked: %s\n", strerror(errno));
    }
}

int main(int argc, char **argv) {
    char program[4096];
    (void)argc;
    snprintf(program, sizeof program, "%s", argv[0]);
    strncat(dirname(program), "/argusd", 16);
    signal(SIGPIPE, SIG_IGN);
    take_turn();
    for (int i = 0; i < SIDES; i++) {
        start(&side[i], program);
    }
    for (int i = 0; i < 200 && !all_open(); i++) {
        live(100);
    }
    if (!all_open()) {
        fail("argusd opens no session", 1);
    }
    live(2000);
    load_machine();
    live(1000);
    for (int i = 0; i < TIMES; i++) {
        for (int k = 0; k < SIDES; k++) {
            side_t *const next = &side[(i + k) % SIDES]; // each is first as often as the other
            next->ms[i] = once(next);
        }
        live(2 * SIP_MS);
    }
    const double kernel_ms = report(&side[SENDS_BACK]);
    bool slow = false;
    for (int i = 0; i < SENDS_BACK; i += 2) {
        const double without = report(&side[i]);
        const double with = report(&side[i + 1]);
        const double bar = side[i].by_tcp ? P99_MS : P99_MS + kernel_ms;
        printf("ratio of the p99: %.1f; bar: %.1f ms with --realtime\n", without / with, bar);
        slow = slow || with > bar;
    }
    end_all();
    return slow;
}
