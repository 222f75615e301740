// SPDX-License-Identifier: MIT
// Attacks: on a real pty the probe finds a robot that answers at one rate only, one that still reports, and
// nothing else.
#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "probe.h"
#include "unity.h"
#include "wire_robot.h"

static hal_transport_t transport;
static hal_link_t port;
static int master;
static int slave;
static char name[64];
static pid_t child;

void setUp(void) {
    TEST_ASSERT_EQUAL_INT(0, openpty(&master, &slave, name, NULL, NULL));
    char text[80];
    char message[256];
    hal_link_spec_t spec;
    snprintf(text, sizeof text, "serial:%s@9600", name);
    TEST_ASSERT_TRUE(hal_link_spec_parse(&spec, text, message, sizeof message));
    hal_transport_init(&transport);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_transport_open(&transport, &spec, 0, -1, &port));
}

void tearDown(void) {
    hal_link_close(&port);
    if (child > 0) {
        kill(child, SIGKILL);
        waitpid(child, NULL, 0);
        child = 0;
    }
    close(master);
    close(slave);
}

// As a wire does, bytes at another rate than the robot's become other bytes.
static void serve(speed_t speed, bool reporting) {
    static robot_t robot;
    robot_init(&robot);
    robot.open = reporting;
    const pid_t test = getppid();
    while (getppid() == test) { // a test that was killed leaves nothing behind
        uint8_t bytes[64];
        struct termios now;
        struct pollfd wait = {.fd = master, .events = POLLIN};
        const int ready = poll(&wait, 1, 100);
        tcgetattr(slave, &now);
        const bool right = cfgetospeed(&now) == speed;
        if (ready > 0) {
            const ssize_t got = read(master, bytes, sizeof bytes);
            if (got <= 0) {
                _exit(0);
            }
            robot_take(&robot, 0, bytes, right ? (size_t)got : 0);
        }
        robot_sip(&robot);
        for (size_t i = 0; i < robot.used; i++) {
            robot.out[i] = right ? robot.out[i] : (uint8_t)(robot.out[i] * 7u + 3u);
        }
        (void)!write(master, robot.out, robot.used);
        robot.used = 0;
    }
    _exit(0);
}

static probe_t probe_robot(speed_t speed, bool reporting) {
    const hal_clock_t clock = hal_clock_monotonic();
    child = fork();
    if (child == 0) {
        serve(speed, reporting);
    }
    return probe_baud(&transport, &port, &clock, -1);
}

void test_a_robot_at_the_third_rate(void) {
    const probe_t probe = probe_robot(B115200, false);
    TEST_ASSERT_EQUAL_UINT32(115200, probe.baud);
    TEST_ASSERT_NOT_NULL(strstr(hal_link_describe(&port), "@115200"));
    TEST_ASSERT_FALSE(probe.reporting);
}

void test_a_robot_that_still_reports(void) {
    const probe_t probe = probe_robot(B38400, true);
    TEST_ASSERT_EQUAL_UINT32(38400, probe.baud);
    TEST_ASSERT_TRUE(probe.reporting);
}

void test_nobody_there(void) {
    const hal_clock_t clock = hal_clock_monotonic();
    const probe_t probe = probe_baud(&transport, &port, &clock, -1);
    TEST_ASSERT_EQUAL_UINT32(0, probe.baud);
    TEST_ASSERT_EQUAL_UINT32(0, probe.bytes);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, probe.error);
    // It asked, at the start and the end of the list alike: two SYNC0 of six bytes at each of five rates.
    uint8_t bytes[256];
    fcntl(master, F_SETFL, O_NONBLOCK);
    TEST_ASSERT_GREATER_OR_EQUAL_INT(6, read(master, bytes, sizeof bytes));
}

void test_a_port_that_dies_and_one_who_gives_up(void) {
    const hal_clock_t clock = hal_clock_monotonic();
    int cancel[2];
    TEST_ASSERT_EQUAL_INT(0, pipe(cancel));
    TEST_ASSERT_EQUAL_INT(1, write(cancel[1], "x", 1));
    TEST_ASSERT_TRUE(probe_baud(&transport, &port, &clock, cancel[0]).cancelled);
    close(cancel[0]);
    close(cancel[1]);
    close(master);
    const probe_t probe = probe_baud(&transport, &port, &clock, -1);
    TEST_ASSERT_EQUAL_UINT32(0, probe.baud);
    TEST_ASSERT_NOT_EQUAL(HAL_LINK_OK, probe.error);
    master = open("/dev/null", O_RDONLY);
}
