// SPDX-License-Identifier: MIT
// Prints how long argusd takes from a SIP with a pressed bumper to E_STOP: alone, with ten readers at its
// control socket that ask for everything and read nothing, and with these and a client that drives by its
// guard port; in turns in one run. Ends with 1 when any of that slows it.
#define _GNU_SOURCE // ptys
#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <netinet/in.h>
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
#define SIDES 3
#define CLIENT_TALKS 10 // SIPs between two orders of the guarded client
#define CLIENT_MM_S 200

typedef struct {
    const char *name;
    bool stalled; // readers that read nothing
    bool guarded; // a client at a guard port
    pid_t pid;
    int master;
    char socket[64];
    uint16_t port;
    int reader[READERS];
    int client;
    unsigned talks;
    unsigned long client_bytes;
    robot_t robot;
    double us[TIMES];
} side_t;

static side_t side[SIDES] = {
    {.name = "alone", .client = -1},
    {.name = "ten stalled", .stalled = true, .client = -1},
    {.name = "ten stalled, guarded", .stalled = true, .guarded = true, .client = -1}};

__attribute__((noreturn)) static void fail(const char *const what) {
    fprintf(stderr, "control: %s\n", what);
    for (int i = 0; i < SIDES; i++) {
        if (side[i].pid > 0) {
            kill(side[i].pid, SIGKILL);
        }
    }
    exit(1);
}

static double now_us(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e6 + (double)t.tv_nsec / 1e3;
}

static uint16_t free_port(void) {
    struct sockaddr_in at = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t size = sizeof at;
    const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (bind(fd, (struct sockaddr *)&at, size) != 0 || getsockname(fd, (struct sockaddr *)&at, &size) != 0) {
        fail("no free port");
    }
    close(fd);
    return ntohs(at.sin_port);
}

static void start(side_t *const self, const char *const program) {
    struct termios raw;
    char link[96];
    char place[96];
    char guard[32];
    self->master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (self->master < 0 || grantpt(self->master) != 0 || unlockpt(self->master) != 0 ||
        tcgetattr(self->master, &raw) != 0) {
        fail("no pty");
    }
    cfmakeraw(&raw);
    tcsetattr(self->master, TCSANOW, &raw);
    snprintf(link, sizeof link, "serial:%s@115200", ptsname(self->master));
    snprintf(self->socket, sizeof self->socket, "/tmp/argus-bench-%d-%d.sock", (int)getpid(), self->master);
    snprintf(place, sizeof place, "unix:%s", self->socket);
    self->port = free_port();
    snprintf(guard, sizeof guard, "tcp:127.0.0.1:%u", (unsigned)self->port);
    robot_init(&self->robot);
    self->pid = fork();
    if (self->pid == 0) {
        const int nowhere = open("/dev/null", O_RDWR);
        dup2(nowhere, STDIN_FILENO);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        execl(program, program, "--link", link, "--active", "--json", "--control", place,
              self->guarded ? "--guard" : (char *)NULL, guard, (char *)NULL);
        _exit(127);
    }
}

// What argusd has written since.
static void take(side_t *const self) {
    uint8_t bytes[512];
    for (;;) {
        const ssize_t got = read(self->master, bytes, sizeof bytes);
        if (got <= 0) {
            return;
        }
        robot_take(&self->robot, 0, bytes, (size_t)got);
    }
}

static void put(side_t *const self) {
    if (self->robot.used > 0 &&
        write(self->master, self->robot.out, self->robot.used) != (ssize_t)self->robot.used) {
        fail("write to the pty");
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

// The guarded client ---------------------------------------------------------------------------------------

static void order(const side_t *const self, const uint8_t command, const int value) {
    uint8_t packet[16];
    const uint8_t data[] = {command, 0x3B, (uint8_t)(value & 0xFF), (uint8_t)(value >> 8)};
    const size_t count = argus_frame_encode(packet, sizeof packet, data, command < 3 ? 1 : sizeof data);
    if (send(self->client, packet, count, MSG_NOSIGNAL) != (ssize_t)count) {
        fail("the guard port takes no order");
    }
}

// Reads what comes, and goes on driving: after each contact it has to say so again.
static void talk(side_t *const self) {
    uint8_t bytes[1024];
    ssize_t got = 0;
    if (self->client < 0) {
        return;
    }
    while ((got = recv(self->client, bytes, sizeof bytes, MSG_DONTWAIT)) > 0) {
        self->client_bytes += (unsigned long)got;
    }
    if (got == 0) {
        fail("the guard port was closed");
    }
    if (self->talks++ % CLIENT_TALKS == 0) {
        order(self, ARCOS_CMD_VEL, CLIENT_MM_S);
    }
}

// ----------------------------------------------------------------------------------------------------------

// All robots live for so long.
static void live(const int ms) {
    const double end = now_us() + ms * 1e3;
    while (now_us() < end) {
        for (int i = 0; i < SIDES; i++) {
            take(&side[i]);
            talk(&side[i]);
            put_sip(&side[i], false);
        }
        usleep(SIP_MS * 1000);
    }
}

static void come(side_t *const self) {
    struct sockaddr_in to = {.sin_family = AF_INET, .sin_port = htons(self->port)};
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    self->client = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (connect(self->client, (struct sockaddr *)&to, sizeof to) != 0) {
        fail("no guard port");
    }
    self->talks = 1; // no order before the session
    for (uint8_t sync = 0; sync < 3; sync++) {
        order(self, sync, 0);
        live(200);
        self->talks = 1;
    }
    order(self, ARCOS_CMD_OPEN, 1);
    order(self, ARCOS_CMD_ENABLE, 1);
    live(500);
}

static double once(side_t *const self) {
    const uint32_t before = self->robot.commands[ARCOS_CMD_E_STOP];
    take(self);
    put_sip(self, true);
    const double began = now_us();
    double passed = 0;
    while (self->robot.commands[ARCOS_CMD_E_STOP] == before) {
        struct pollfd wait = {.fd = self->master, .events = POLLIN};
        poll(&wait, 1, 100);
        take(self);
        passed = now_us() - began;
        if (passed > PATIENCE_US) {
            fail("no E_STOP");
        }
    }
    return passed;
}

// Those that were closed for reading nothing come again.
static void stall(side_t *const self) {
    static const char want[] =
        "{\"do\":\"watch\",\"topics\":[\"events\",\"state\",\"readings\",\"evidence\"],"
        "\"period_ms\":50}\n";
    struct sockaddr_un to = {.sun_family = AF_UNIX};
    snprintf(to.sun_path, sizeof to.sun_path, "%s", self->socket);
    for (int i = 0; i < READERS; i++) {
        if (self->reader[i] > 0) {
            close(self->reader[i]);
        }
        self->reader[i] = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (connect(self->reader[i], (struct sockaddr *)&to, sizeof to) != 0 ||
            write(self->reader[i], want, sizeof want - 1) != (ssize_t)sizeof want - 1) {
            fail("no control socket");
        }
    }
}

static int compare(const void *const a, const void *const b) {
    const double difference = *(const double *)a - *(const double *)b;
    return difference < 0 ? -1 : difference > 0;
}

static double report(side_t *const self) {
    qsort(self->us, TIMES, sizeof self->us[0], compare);
    printf("bumper to E_STOP, %-20s median %7.1f  p99 %7.1f  max %7.1f us (%d times)\n", self->name,
           self->us[TIMES / 2], self->us[TIMES * 99 / 100], self->us[TIMES - 1], TIMES);
    return self->us[TIMES / 2];
}

static void stop(side_t *const self) {
    kill(self->pid, SIGTERM);
    for (int i = 0; i < 500 && waitpid(self->pid, NULL, WNOHANG) == 0; i++) {
        take(self);
        put_sip(self, false);
        usleep(10000);
    }
    kill(self->pid, SIGKILL);
    unlink(self->socket);
}

static bool all_open(void) {
    for (int i = 0; i < SIDES; i++) {
        if (!side[i].robot.open) {
            return false;
        }
    }
    return true;
}

static void begin(const char *const program) {
    for (int i = 0; i < SIDES; i++) {
        start(&side[i], program);
    }
    for (int i = 0; i < 200 && !all_open(); i++) {
        live(100);
    }
    if (!all_open()) {
        fail("argusd opens no session");
    }
    live(2000);
    for (int i = 0; i < SIDES; i++) {
        if (side[i].guarded) {
            come(&side[i]);
        }
    }
}

static void stall_all(void) {
    for (int i = 0; i < SIDES; i++) {
        if (side[i].stalled) {
            stall(&side[i]);
        }
    }
    live(FILL_MS);
}

static bool slows(side_t *const self, const double without) {
    const double with = report(self);
    printf("ratio of the medians: %.2f\n", with / without);
    return with > without * WORST_RATIO && with > without + NOISE_US;
}

int main(int argc, char **argv) {
    char program[4096];
    bool slow = false;
    (void)argc;
    snprintf(program, sizeof program, "%s", argv[0]);
    strncat(dirname(program), "/argusd", 16);
    signal(SIGPIPE, SIG_IGN);
    begin(program);
    for (int i = 0; i < TIMES; i++) {
        if (i % (TIMES / 2) == 0) {
            stall_all();
        }
        for (int k = 0; k < SIDES; k++) {
            side_t *const next = &side[(i + k) % SIDES]; // each is first as often as the others
            next->us[i] = once(next);
        }
        live(2 * SIP_MS);
    }
    const double without = report(&side[0]);
    for (int i = 1; i < SIDES; i++) {
        slow = slows(&side[i], without) || slow;
    }
    for (int i = 0; i < SIDES; i++) {
        if (side[i].guarded &&
            (side[i].client_bytes == 0 || side[i].robot.commands[ARCOS_CMD_VEL] < TIMES / 10)) {
            fail("the guarded client was not served");
        }
        stop(&side[i]);
    }
    return slow;
}
