// SPDX-License-Identifier: MIT
// Attacks: argusd as a whole, in a process of its own: every exit code with its one line, a session with a
// robot on a real pty, and an orderly end on SIGTERM.
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
#include "unity.h"
#include "wire_robot.h"

#define ARGUMENTS_MAX 24

static char out[65536];
static char err[4096];
static char config_path[] = "/tmp/argus-app-XXXXXX";
static int master = -1;
static int slave = -1;
static char name[64];
static robot_t robot;
static void (*during)(pid_t child, int turn); // NULL: nothing happens besides
static int await_command = ARCOS_CMD_PULSE;   // SIGTERM waits until the robot has got one of these, too

void setUp(void) {
    await_command = ARCOS_CMD_PULSE;
    TEST_ASSERT_EQUAL_INT(0, openpty(&master, &slave, name, NULL, NULL));
    fcntl(master, F_SETFL, O_NONBLOCK);
    robot_init(&robot);
    during = NULL;
}

void tearDown(void) {
    close(master);
    close(slave);
}

static void write_config(const char *text) {
    strcpy(config_path, "/tmp/argus-app-XXXXXX");
    const int fd = mkstemp(config_path);
    TEST_ASSERT_TRUE(fd >= 0);
    TEST_ASSERT_EQUAL_INT((int)strlen(text), write(fd, text, strlen(text)));
    close(fd);
}

static pid_t start(const char *line, int ends[2][2]) {
    static char copy[1024];
    static char program[] = "argusd";
    char *argv[ARGUMENTS_MAX] = {program};
    int argc = 1;
    snprintf(copy, sizeof copy, "%s", line);
    for (char *word = strtok(copy, " "); word != NULL && argc < ARGUMENTS_MAX - 1; word = strtok(NULL, " ")) {
        argv[argc++] = word;
    }
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
    if (!present) {
        return;
    }
    robot_take(&robot, 0, bytes, got > 0 ? (size_t)got : 0);
    robot_sip(&robot);
    (void)!write(master, robot.out, robot.used);
    robot.used = 0;
}

// Runs argusd; `signal_at` (or NULL): SIGTERM is sent once this text was on standard output. Returns the exit
// code.
static int run(const char *line, bool present, const char *signal_at) {
    int ends[2][2];
    int status = 0;
    size_t used[2] = {0, 0};
    const pid_t child = start(line, ends);
    bool ended = false;
    out[0] = err[0] = '\0';
    for (int turns = 0; !ended && turns < 600; turns++) {
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
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static void refused(const char *line, int code, const char *part) {
    TEST_ASSERT_EQUAL_INT_MESSAGE(code, run(line, false, NULL), line);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(err, part), err);
    TEST_ASSERT_EQUAL_STRING_LEN("argusd: ", err, 8);
    TEST_ASSERT_EQUAL_PTR_MESSAGE(err + strlen(err) - 1, strchr(err, '\n'), err);
    TEST_ASSERT_EQUAL_STRING("", out);
}

static void refused_config(const char *text, const char *link, const char *part) {
    char line[256];
    write_config(text);
    snprintf(line, sizeof line, "--link %s --config %s", link, config_path);
    refused(line, 2, part);
    TEST_ASSERT_NOT_NULL(strstr(err, config_path));
    unlink(config_path);
}

void test_bad_arguments_and_files(void) {
    refused("", 2, "no link is given");
    refused("--link tcp:localhost --config /no/such/file", 2, "/no/such/file: cannot be opened");
    refused("--link tcp:localhost --course /no/such/file", 2, "/no/such/file: cannot be opened");
    refused("--link tcp:localhost --record /no/such/file", 2, "--record /no/such/file: No such file");
    refused_config("speed_mm_s = 1\n", "tcp:localhost", ":1: speed_mm_s = 1 is out of range");
    refused_config("speed_mm_s = 500\n", "tcp:localhost", "driving would be unsafe (S5): overhang 44");
    refused_config("\nbaud = 38400\n", "serial:/dev/x@9600", ":2: baud = 38400, but --link says @9600");
    refused_config("baud = 9601\n", "serial:/dev/x", ":1: baud = 9601: the rates of a serial link are 9600");
}

void test_links_that_cannot_be_opened(void) {
    refused("--link serial:/dev/no-such-port --active", 3, "/dev/no-such-port: no such file");
    refused("--link serial:/dev/null --active", 3, "/dev/null: not a serial port");
    refused("--link tcp:127.0.0.1:1", 3, "127.0.0.1 port 1: nobody listens there");
}

void test_no_robot(void) {
    char line[256];
    snprintf(line, sizeof line, "--link serial:%s --check --wait 1", name);
    refused(line, 4, "no robot answered in 1 s: nothing was received");
    snprintf(line, sizeof line, "--link serial:%s --active --json --status 0 --wait 1", name);
    TEST_ASSERT_EQUAL_INT(4, run(line, false, NULL));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(err, "no robot answered"), err);
}

void test_lists(void) {
    TEST_ASSERT_EQUAL_INT(0, run("--version", false, NULL));
    TEST_ASSERT_EQUAL_STRING_LEN("argusd ", out, 7);
    TEST_ASSERT_EQUAL_INT(0, run("--list-config", false, NULL));
    TEST_ASSERT_NOT_NULL(strstr(out, "object_range_mm"));
}

void test_check_tells_who_is_there(void) {
    char line[256];
    snprintf(line, sizeof line, "--link serial:%s@9600 --check", name);
    TEST_ASSERT_EQUAL_INT(0, run(line, true, NULL));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(out, "robot     name 'Robot', class 'Pioneer', subclass 'p3dx-sh'"),
                                 out);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(out, "rate      9600 bit/s"), out);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(out, "sonars    16 of 16 seen: 0 1 2"), out);
    TEST_ASSERT_FALSE(robot.open);
    // Looking is not touching: no motors, no motion.
    TEST_ASSERT_EQUAL_UINT32(0, robot.commands[ARCOS_CMD_MOVE] + robot.commands[ARCOS_CMD_HEAD]);
}

void test_a_serial_link_starts_passive_and_says_why_and_sigterm_closes_in_order(void) {
    char line[256];
    snprintf(line, sizeof line, "--link serial:%s --goal 1000,0 --json --status 100", name);
    TEST_ASSERT_EQUAL_INT(0, run(line, true, "HEALTH_CHECK"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(err, "passive, since a real robot may be at the end"), err);
    TEST_ASSERT_NOT_NULL(strstr(out, "\"event\":\"SESSION_CLOSED\""));
    TEST_ASSERT_NOT_NULL(strstr(out, "\"active\":false"));
    TEST_ASSERT_FALSE(robot.open);
    TEST_ASSERT_EQUAL_UINT8(ARCOS_CMD_CLOSE, robot.last[0]);
    TEST_ASSERT_EQUAL_UINT32(0, robot.commands[ARCOS_CMD_MOVE] + robot.commands[ARCOS_CMD_HEAD]);
}

void test_active_drives(void) {
    char line[256];
    write_config("profile = paper\n"); // the robot of this test does not turn to look
    snprintf(line, sizeof line, "--link serial:%s --active --goal 1000,0 --plain --status 50 --config %s",
             name, config_path);
    await_command = ARCOS_CMD_MOVE;
    TEST_ASSERT_EQUAL_INT(0, run(line, true, "STATUS DRIVING"));
    unlink(config_path);
    TEST_ASSERT_GREATER_THAN_UINT32(0, robot.commands[ARCOS_CMD_MOVE]);
    TEST_ASSERT_GREATER_THAN_UINT32(0, robot.commands[ARCOS_CMD_STOP]);
    TEST_ASSERT_EQUAL_STRING("", err);
    TEST_ASSERT_FALSE(robot.open);
}

static int first; // turn of the first signal
static int pause_ms;
static int second;

static void signal_twice(pid_t child, int turn) {
    if (first == 0 && strstr(out, "HEALTH_CHECK") != NULL) {
        const struct timespec pause = {.tv_nsec = pause_ms * 1000000L};
        first = turn;
        kill(child, SIGTERM);
        nanosleep(&pause, NULL);
        kill(child, second);
    }
}

// A wrapper and the terminal deliver one wish to end twice.
static void deliver_twice(int signal, int ms) {
    char line[256];
    first = 0;
    pause_ms = ms;
    second = signal;
    during = signal_twice;
    snprintf(line, sizeof line, "--link serial:%s --json --status 0", name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, run(line, true, NULL), err);
    TEST_ASSERT_TRUE(first > 0);
    TEST_ASSERT_NOT_NULL(strstr(out, "\"event\":\"SESSION_CLOSED\""));
    TEST_ASSERT_NULL_MESSAGE(strstr(err, "not closed in order"), err);
    TEST_ASSERT_FALSE(robot.open);
}

void test_one_wish_to_end_delivered_twice_is_one(void) {
    deliver_twice(SIGTERM, 0);
    tearDown();
    setUp();
    deliver_twice(SIGTERM, 5);
    tearDown();
    setUp();
    deliver_twice(SIGHUP, 50);
    tearDown();
    setUp();
    deliver_twice(SIGINT, 300);
}

static void cut_and_signal(pid_t child, int turn) {
    static int cut;
    cut = turn == 0 ? 0 : cut;
    if (cut == 0 && strstr(out, "HEALTH_CHECK") != NULL) {
        cut = turn;
        close(master); // the other end of the line is gone
        close(slave);
        master = slave = -1;
    } else if (cut > 0 && turn == cut + 10) {
        kill(child, SIGTERM);
    }
}

void test_an_end_without_the_link_is_not_clean_and_has_its_own_code(void) {
    char line[256];
    during = cut_and_signal;
    snprintf(line, sizeof line, "--link serial:%s --json --status 0", name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(6, run(line, true, NULL), err);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(err, "not closed in order, since the link was down"), err);
    TEST_ASSERT_NULL(strstr(out, "SESSION_CLOSED"));
    setUp(); // for tearDown()
}

void test_a_summary_ends_the_lines_for_people(void) {
    char line[256];
    snprintf(line, sizeof line, "--link serial:%s --plain --status 0", name);
    TEST_ASSERT_EQUAL_INT(0, run(line, true, "HEALTH_CHECK"));
    const char *const last = strstr(out, " SUMMARY mission none; IsNormal; no sonar out of use; ");
    TEST_ASSERT_NOT_NULL_MESSAGE(last, out);
    TEST_ASSERT_EQUAL_PTR(out + strlen(out) - 1, strchr(last, '\n'));
}

void test_a_wait_for_the_port_says_what_for(void) {
    TEST_ASSERT_EQUAL_INT(3, run("--link serial:/tmp/no-such-port-3 --wait 1", false, NULL));
    const char *const why = strstr(err, "/tmp/no-such-port-3: no such file");
    TEST_ASSERT_NOT_NULL_MESSAGE(why, err);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why, "; waiting for it\n"), err);
    const char *const again = strstr(strchr(why, '\n'), "no-such-port-3: no such file");
    TEST_ASSERT_NOT_NULL_MESSAGE(again, err); // the end says why, too, and that is all
    TEST_ASSERT_NULL_MESSAGE(strstr(strchr(again, '\n'), "no such file"), err);
}
