// SPDX-License-Identifier: MIT
// Prints round trips and the way from a SIP with a dead reading to STOP, over CAN (kernel ISO-TP on vcan0)
// and over a pty, in turns in one run.
#define _GNU_SOURCE // ptys
#include <errno.h>
#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/isotp.h>
#include <linux/can/raw.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "../unit/support/robot.c"
#include "hal/isotp.h"

#define TIMES 1000
#define WARM_UP 20
#define PATIENCE_MS 3000

static const uint8_t stop[] = {0xFA, 0xFB, 0x03, ARCOS_CMD_STOP, 0x00, ARCOS_CMD_STOP};

typedef struct {
    double us[TIMES];
    int count;
} series_t;

static robot_t robot;
static argus_t driving;
static uint8_t sip[ARGUS_FRAME_TOTAL_MAX];
static size_t sip_length;
static int master, slave; // the pty
static hal_isotp_t isotp; // our end of the bus
static hal_link_t host;
static int far_end = -1; // the robot's
static int monitor = -1; // sees every frame
static series_t can_trip, pty_trip, can_stop, pty_stop, bus_stop;

__attribute__((noreturn)) static void fail(const char *const what) {
    fprintf(stderr, "can: %s\n", what);
    exit(1);
}

static double now_us(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e6 + (double)t.tv_nsec / 1e3;
}

static void note(series_t *const series, const double us) {
    if (series->count < TIMES) {
        series->us[series->count] = us;
    }
    series->count++;
}

static int compare_us(const void *const a, const void *const b) {
    const double difference = *(const double *)a - *(const double *)b;
    return difference < 0 ? -1 : difference > 0;
}

static void print(const char *const what, series_t *const series) {
    const int n = series->count < TIMES ? series->count : TIMES;
    if (n == 0) {
        fail("nothing was measured");
    }
    qsort(series->us, (size_t)n, sizeof series->us[0], compare_us);
    printf("%-52s median %8.1f  p99 %8.1f  max %8.1f us (%d times)\n", what, series->us[n / 2],
           series->us[n * 99 / 100], series->us[n - 1], n);
}

static void wait_for(const int fd) {
    struct pollfd wait = {.fd = fd, .events = POLLIN};
    if (poll(&wait, 1, PATIENCE_MS) != 1) {
        fail("nothing came in 3 s");
    }
}

// A manager in the middle of normal driving, to be copied for each trial.
static void prepare(void) {
    const argus_config_t config = robot_config();
    robot_init(&robot, &config, 0);
    if (!robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000) || !robot_goal(&robot, 3000, 0) ||
        !robot_until_mode(&robot, ARGUS_MODE_DRIVING, 8000)) {
        fail("the robot in memory does not drive");
    }
    robot_run(&robot, 3000);
    driving = robot.argus;
}

// A SIP in motion that lists six sonars, one of them dead.
static void make_sip(void) {
    static const uint8_t number[6] = {2, 10, 3, 11, 4, 12};
    uint8_t data[64] = {ARCOS_TYPE_SIP_MOVING};
    data[1] = (uint8_t)(driving.knowledge.x_raw & 0xFFu);
    data[2] = (uint8_t)(driving.knowledge.x_raw >> 8);
    data[7] = data[9] = 200; // both wheels, mm/s
    data[11] = 127;
    data[16] = 0x07; // motors and both arrays on
    data[19] = 6;
    for (size_t i = 0; i < 6; i++) {
        const unsigned range = number[i] == 3 ? (unsigned)argus_robot_default()->no_echo_mm : 2000u;
        data[20 + 3 * i] = number[i];
        data[21 + 3 * i] = (uint8_t)(range & 0xFFu);
        data[22 + 3 * i] = (uint8_t)(range >> 8);
    }
    sip_length = argus_frame_encode(sip, sizeof sip, data, 20 + 18 + 12);
}

static void open_pty(void) {
    struct termios raw;
    master = posix_openpt(O_RDWR | O_NOCTTY);
    if (master < 0 || grantpt(master) != 0 || unlockpt(master) != 0) {
        fail("no pty");
    }
    slave = open(ptsname(master), O_RDWR | O_NOCTTY);
    if (slave < 0 || tcgetattr(slave, &raw) != 0) {
        fail("no pty");
    }
    cfmakeraw(&raw);
    tcsetattr(slave, TCSANOW, &raw);
}

static void open_bus(const char *const interface) {
    hal_can_spec_t spec;
    char text[1024];
    const int on = 1;
    if (!hal_can_spec_parse(&spec, interface, text, sizeof text)) {
        fail(text);
    }
    hal_isotp_init(&isotp, &hal_can_sys);
    const hal_link_error_t error = hal_isotp_open(&isotp, &spec);
    if (error != HAL_LINK_OK) {
        hal_isotp_explain(error, &spec, text, sizeof text);
        fail(text);
    }
    host = hal_isotp_link(&isotp);
    struct sockaddr_can address = {.can_family = AF_CAN,
                                   .can_ifindex = isotp.index,
                                   .can_addr.tp = {.rx_id = spec.tx_id, .tx_id = spec.rx_id}};
    const struct can_isotp_options options = {.flags = CAN_ISOTP_TX_PADDING, .txpad_content = spec.padding};
    far_end = socket(PF_CAN, SOCK_DGRAM, CAN_ISOTP);
    monitor = socket(PF_CAN, SOCK_RAW, CAN_RAW);
    if (setsockopt(far_end, SOL_CAN_ISOTP, CAN_ISOTP_OPTS, &options, sizeof options) != 0 ||
        bind(far_end, (struct sockaddr *)&address, sizeof address) != 0) {
        fail("no second socket");
    }
    memset(&address.can_addr, 0, sizeof address.can_addr);
    if (bind(monitor, (struct sockaddr *)&address, sizeof address) != 0 ||
        setsockopt(monitor, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on) != 0) {
        fail("no socket that sees every frame");
    }
}

static void put(const int fd, const uint8_t *const bytes, const size_t count) {
    if (write(fd, bytes, count) != (ssize_t)count) {
        fail(strerror(errno));
    }
}

// Round trips
// ------------------------------------------------------------------------------------------------

static void trip_can(void) {
    uint8_t bytes[ARGUS_FRAME_TOTAL_MAX];
    const double start = now_us();
    put(far_end, sip, sip_length);
    wait_for(hal_link_fd(&host));
    const int got = hal_link_read(&host, bytes, sizeof bytes);
    if (got != (int)sip_length || hal_link_write(&host, bytes, sip_length) != got) {
        fail("a packet was not whole");
    }
    wait_for(far_end);
    if (read(far_end, bytes, sizeof bytes) != (ssize_t)sip_length || memcmp(bytes, sip, sip_length) != 0) {
        fail("a packet came back changed");
    }
    note(&can_trip, now_us() - start);
}

static void read_all(const int fd, uint8_t *const bytes, const size_t count) {
    size_t got = 0;
    while (got < count) {
        wait_for(fd);
        const ssize_t n = read(fd, bytes + got, count - got);
        if (n <= 0) {
            fail("read from the pty");
        }
        got += (size_t)n;
    }
}

static void trip_pty(void) {
    uint8_t bytes[ARGUS_FRAME_TOTAL_MAX];
    const double start = now_us();
    put(master, sip, sip_length);
    read_all(slave, bytes, sip_length);
    put(slave, bytes, sip_length);
    read_all(master, bytes, sip_length);
    note(&pty_trip, now_us() - start);
}

// From the SIP to STOP
// ---------------------------------------------------------------------------------------

static double stamp_of(struct msghdr *const message) {
    for (struct cmsghdr *at = CMSG_FIRSTHDR(message); at != NULL; at = CMSG_NXTHDR(message, at)) {
        if (at->cmsg_level == SOL_SOCKET && at->cmsg_type == SO_TIMESTAMPNS) {
            struct timespec t;
            memcpy(&t, CMSG_DATA(at), sizeof t);
            return (double)t.tv_sec * 1e6 + (double)t.tv_nsec / 1e3;
        }
    }
    fail("a frame has no time");
}

// Reads the frames that passed; the time from the last frame of the SIP to the one that carries STOP.
static double watch_bus(void) {
    double last_sip = 0;
    for (;;) {
        struct can_frame frame;
        char control[128];
        struct iovec data = {.iov_base = &frame, .iov_len = sizeof frame};
        struct msghdr message = {
            .msg_iov = &data, .msg_iovlen = 1, .msg_control = control, .msg_controllen = sizeof control};
        wait_for(monitor);
        if (recvmsg(monitor, &message, 0) != (ssize_t)sizeof frame) {
            fail("read from the bus");
        }
        if (frame.can_id == HAL_CAN_TO_HOST_ID) {
            last_sip = stamp_of(&message);
        } else if (frame.can_id == HAL_CAN_TO_ROBOT_ID && frame.data[0] == sizeof stop) { // a single frame
            if (memcmp(frame.data + 1, stop, sizeof stop) != 0) {
                fail("the first packet is not STOP");
            }
            return stamp_of(&message) - last_sip;
        }
    }
}

static void forget_frames(void) {
    struct can_frame frame;
    while (recv(monitor, &frame, sizeof frame, MSG_DONTWAIT) > 0) {
    }
}

static void stop_can(void) {
    argus_t argus = driving;
    uint8_t bytes[ARGUS_FRAME_TOTAL_MAX];
    forget_frames();
    const double start = now_us();
    put(far_end, sip, sip_length);
    wait_for(hal_link_fd(&host));
    const int got = hal_link_read(&host, bytes, sizeof bytes);
    if (got != (int)sip_length) {
        fail("a SIP was not whole");
    }
    argus_receive(&argus, argus.now_ms + 100, bytes, (size_t)got);
    const size_t out = argus_transmit(&argus, bytes, sizeof bytes);
    if (out != sizeof stop || hal_link_write(&host, bytes, out) != (int)out) {
        fail("no STOP in the same wake-up");
    }
    wait_for(far_end);
    if (read(far_end, bytes, sizeof bytes) != (ssize_t)sizeof stop || memcmp(bytes, stop, sizeof stop) != 0) {
        fail("the robot's end did not get STOP");
    }
    note(&can_stop, now_us() - start);
    note(&bus_stop, watch_bus());
}

static void stop_pty(void) {
    argus_t argus = driving;
    uint8_t bytes[ARGUS_FRAME_TOTAL_MAX];
    const double start = now_us();
    put(master, sip, sip_length);
    size_t got = 0;
    while (got < sip_length) {
        wait_for(slave);
        const ssize_t n = read(slave, bytes, sizeof bytes);
        if (n <= 0) {
            fail("read from the pty");
        }
        got += (size_t)n;
        argus_receive(&argus, argus.now_ms + 100, bytes, (size_t)n);
    }
    const size_t out = argus_transmit(&argus, bytes, sizeof bytes);
    if (out != sizeof stop) {
        fail("no STOP in the same wake-up");
    }
    put(slave, bytes, out);
    read_all(master, bytes, out);
    note(&pty_stop, now_us() - start);
    if (memcmp(bytes, stop, sizeof stop) != 0) {
        fail("the first packet is not STOP");
    }
}

int main(const int argc, char **const argv) {
    prepare();
    make_sip();
    open_pty();
    open_bus(argc > 1 ? argv[1] : "vcan0");
    for (int i = 0; i < TIMES + WARM_UP; i++) {
        if (i == WARM_UP) {
            can_trip.count = pty_trip.count = can_stop.count = pty_stop.count = bus_stop.count = 0;
        }
        trip_can();
        trip_pty();
        stop_can();
        stop_pty();
    }
    printf("a SIP of %zu bytes, %s\n", sip_length, hal_link_describe(&host));
    print("round trip, CAN", &can_trip);
    print("round trip, pty", &pty_trip);
    print("SIP sent to STOP received, CAN", &can_stop);
    print("SIP sent to STOP received, pty", &pty_stop);
    print("last frame of the SIP to STOP, on the bus", &bus_stop);
    return 0;
}
