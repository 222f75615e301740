// SPDX-License-Identifier: MIT
// Prints how long it takes from the read of a SIP with a dead reading to the write of STOP, through a real
// pty.
#define _GNU_SOURCE // ptys
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "../unit/support/robot.c"

#define TIMES 10000

static robot_t robot;
static argus_t driving;

static double now_us(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e6 + (double)t.tv_nsec / 1e3;
}

static int compare_us(const void *const a, const void *const b) {
    const double difference = *(const double *)a - *(const double *)b;
    return difference < 0 ? -1 : difference > 0;
}

static void fail(const char *const what) {
    fprintf(stderr, "reaction: %s\n", what);
    exit(1);
}

static int open_pty(int *const slave) {
    const int master = posix_openpt(O_RDWR | O_NOCTTY);
    if (master < 0 || grantpt(master) != 0 || unlockpt(master) != 0) {
        fail("no pty");
    }
    *slave = open(ptsname(master), O_RDWR | O_NOCTTY);
    struct termios raw;
    if (*slave < 0 || tcgetattr(*slave, &raw) != 0) {
        fail("no pty");
    }
    cfmakeraw(&raw);
    tcsetattr(*slave, TCSANOW, &raw);
    return master;
}

// A manager in the middle of normal driving, to be copied for each trial.
static void prepare(void) {
    const argus_config_t config = robot_config();
    robot_init(&robot, &config, 0);
    if (!robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000) || !robot_goal(&robot, 3000, 0)) {
        fail("the robot in memory does not start");
    }
    if (!robot_until_mode(&robot, ARGUS_MODE_DRIVING, 8000)) {
        fail("the robot in memory does not drive");
    }
    robot_run(&robot, 3000);
    driving = robot.argus;
}

// A SIP in motion that lists six sonars, one of them dead.
static size_t dead_sip(uint8_t *const packet) {
    uint8_t data[64] = {ARCOS_TYPE_SIP_MOVING};
    data[1] = (uint8_t)(driving.knowledge.x_raw & 0xFFu);
    data[2] = (uint8_t)(driving.knowledge.x_raw >> 8);
    data[7] = data[9] = 200; // both wheels, mm/s
    data[11] = 127;
    data[16] = 0x07; // motors and both arrays on
    static const uint8_t number[6] = {2, 10, 3, 11, 4, 12};
    data[19] = 6;
    for (size_t i = 0; i < 6; i++) {
        const unsigned range = number[i] == 3 ? (unsigned)argus_robot_default()->no_echo_mm : 2000u;
        data[20 + 3 * i] = number[i];
        data[21 + 3 * i] = (uint8_t)(range & 0xFFu);
        data[22 + 3 * i] = (uint8_t)(range >> 8);
    }
    return argus_frame_encode(packet, ARGUS_FRAME_TOTAL_MAX, data, 20 + 18 + 12);
}

static double once(const int master, const int slave, const uint8_t *const sip, const size_t length) {
    static const uint8_t stop[] = {0xFA, 0xFB, 0x03, ARCOS_CMD_STOP, 0x00, ARCOS_CMD_STOP};
    argus_t argus = driving;
    uint8_t bytes[ARGUS_FRAME_TOTAL_MAX];
    if (write(master, sip, length) != (ssize_t)length) {
        fail("write to the pty");
    }
    size_t got = 0;
    const double start = now_us();
    while (got < length) {
        const ssize_t n = read(slave, bytes, sizeof bytes);
        if (n <= 0) {
            fail("read from the pty");
        }
        got += (size_t)n;
        argus_receive(&argus, argus.now_ms + 100, bytes, (size_t)n);
    }
    const size_t out = argus_transmit(&argus, bytes, sizeof bytes);
    if (out != sizeof stop || write(slave, bytes, out) != (ssize_t)out) {
        fail("no STOP in the same wake-up");
    }
    const double took = now_us() - start;
    if (memcmp(bytes, stop, sizeof stop) != 0 || read(master, bytes, sizeof bytes) != (ssize_t)out) {
        fail("the first packet is not STOP");
    }
    return took;
}

int main(void) {
    static double us[TIMES];
    uint8_t sip[ARGUS_FRAME_TOTAL_MAX];
    int slave = -1;
    prepare();
    const size_t length = dead_sip(sip);
    const int master = open_pty(&slave);
    for (int i = 0; i < TIMES; i++) {
        us[i] = once(master, slave, sip, length);
    }
    qsort(us, TIMES, sizeof us[0], compare_us);
    printf("SIP read to STOP written, pty    median %6.1f  p99 %6.1f  max %6.1f us (%d times, SIP of %zu "
           "bytes)\n",
           us[TIMES / 2], us[TIMES * 99 / 100], us[TIMES - 1], TIMES, length);
    return 0;
}
