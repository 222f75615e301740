// SPDX-License-Identifier: MIT
// Attacks: a STOP is on the wire when the call that read the SIP returns; nothing is lost when the link is
// full; a lost link is said, opened again and never driven on blindly.
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <pty.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <unistd.h>

#include "driver.h"
#include "hal/fake_clock.h"
#include "hal/fake_link.h"
#include "supervisor/manager.h"
#include "unity.h"
#include "wire_robot.h"

static driver_t driver;
static hal_fake_clock_t time_;
static hal_fake_link_t fake;
static hal_clock_t clock_;
static hal_link_spec_t spec;
static hal_transport_t transport;
static robot_t robot;

void setUp(void) {
    argus_config_t config;
    argus_config_default(&config);
    config.profile = ARGUS_PROFILE_PAPER;                    // the robot below does not turn to look
    time_ = (hal_fake_clock_t){.now_ms = UINT32_MAX - 5000}; // the clock wraps in every test
    clock_ = hal_fake_clock(&time_);
    hal_fake_link_init(&fake, 1, &clock_);
    spec = (hal_link_spec_t){.scheme = &hal_serial_scheme};
    hal_transport_init(&transport);
    driver_init(&driver, &config, clock_, &spec, NULL);
    robot_init(&robot);
}

__attribute__((format(printf, 1, 2))) static void parse(const char *format, ...) {
    char text[128];
    char message[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    TEST_ASSERT_TRUE_MESSAGE(hal_link_spec_parse(&spec, text, message, sizeof message), message);
}

static void exchange(void) {
    uint8_t bytes[512];
    const size_t count = hal_fake_link_take(&fake, bytes, sizeof bytes);
    robot_take(&robot, time_.now_ms, bytes, count);
    hal_fake_link_put(&fake, robot.out, robot.used);
    robot.used = 0;
}

// Lets `ms` pass in steps of 10, a SIP each 100.
static void run(uint32_t ms) {
    for (uint32_t passed = 0; passed < ms; passed += 10) {
        time_.now_ms += 10;
        if (passed % 100 == 0) {
            robot_sip(&robot);
        }
        exchange();
        driver_receive(&driver);
        driver_process(&driver);
        exchange();
    }
}

static bool said(uint16_t id) {
    argus_event_t event;
    bool found = false;
    while (argus_next_event(driver.core, &event)) {
        found = found || event.id == id;
    }
    return found;
}

static void drive(void) {
    static const argus_point_t goal = {3000, 0};
    TEST_ASSERT_TRUE(argus_set_course(driver.core, &goal, 1));
    driver_attach(&driver, hal_fake_link(&fake));
    run(4000);
    TEST_ASSERT_TRUE(robot.open);
    TEST_ASSERT_EQUAL_INT(ARGUS_MODE_DRIVING, driver.core->mode);
    TEST_ASSERT_GREATER_THAN_UINT32(0, robot.commands[ARCOS_CMD_MOVE]);
}

void test_stop_leaves_in_the_wake_up_that_reads_the_sip(void) {
    drive();
    const uint32_t stops = robot.commands[ARCOS_CMD_STOP];
    for (int i = 0; i < 16; i++) {
        robot.reading_mm[i] = 5000;
    }
    robot.next = 1;
    robot_sip(&robot);
    exchange();
    driver_receive(&driver); // no process call, no time passes
    exchange();
    TEST_ASSERT_EQUAL_UINT32(stops + 1, robot.commands[ARCOS_CMD_STOP]);
    TEST_ASSERT_TRUE(said(ARGUS_EV_SONAR_DEAD));
}

// A robot on CAN may wait a second for flow control: what is said before could wake its old motion.
void test_on_can_nothing_is_said_before_a_sip_could_have_come(void) {
    driver.spec.scheme = &hal_can_scheme;
    driver_attach(&driver, hal_fake_link(&fake));
    run(1100);
    TEST_ASSERT_EQUAL_UINT32(0, hal_link_counters(&driver.link).bytes_out);
    TEST_ASSERT_FALSE(said(ARGUS_EV_LINK_UP));
    run(1000);
    TEST_ASSERT_TRUE(said(ARGUS_EV_LINK_UP));
    TEST_ASSERT_TRUE(robot.open);
}

void test_a_full_link_delays_and_loses_nothing(void) {
    fake.would_block_permille = 700;
    drive();
    TEST_ASSERT_GREATER_THAN_UINT32(0, hal_link_counters(&driver.link).would_block);
    TEST_ASSERT_EQUAL_UINT32(0, robot.parser.bad_checksums);
    TEST_ASSERT_EQUAL_UINT32(0, robot.parser.skipped_bytes);
}

void test_a_held_packet_asks_for_the_link_to_be_polled(void) {
    driver_attach(&driver, hal_fake_link(&fake));
    run(200);
    TEST_ASSERT_FALSE(driver_wants_write(&driver));
    fake.would_block_permille = 1000;
    time_.now_ms += 300;
    driver_process(&driver);
    TEST_ASSERT_TRUE(driver_wants_write(&driver));
    fake.would_block_permille = 0;
    driver_process(&driver);
    TEST_ASSERT_FALSE(driver_wants_write(&driver));
    exchange();
    TEST_ASSERT_EQUAL_UINT32(1, robot.commands[ARCOS_SYNC_SYNC0]);
}

void test_short_reads_and_a_noisy_wire_are_survived(void) {
    fake.read_max = 1;
    drive();
    fake.read_max = 0;
    fake.from_robot = (hal_fake_faults_t){.drop_permille = 5, .corrupt_permille = 5};
    for (int i = 0; i < 100; i++) {
        run(100);
        TEST_ASSERT_EQUAL_INT(0, argus_invariants_broken(driver.core));
    }
    TEST_ASSERT_GREATER_THAN_UINT32(0, driver.core->session.parser.bad_checksums);
}

void test_an_error_of_the_link_is_said_and_stops_the_use_of_it(void) {
    drive();
    fake.fail_read_at = fake.reads + 1;
    driver_receive(&driver);
    TEST_ASSERT_FALSE(driver.up);
    TEST_ASSERT_TRUE(fake.closed);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_GONE, driver.error);
    TEST_ASSERT_TRUE(said(ARGUS_EV_LINK_LOST));
    const uint32_t writes = fake.writes;
    for (int i = 0; i < 100; i++) {
        time_.now_ms += 100;
        driver_process(&driver);
        driver_receive(&driver);
    }
    TEST_ASSERT_EQUAL_UINT32(writes, fake.writes);
    TEST_ASSERT_EQUAL_UINT32(0, driver.reopened);
}

void test_an_error_while_writing_is_a_lost_link_too(void) {
    drive();
    fake.fail_write_at = fake.writes + 1;
    run(1000);
    TEST_ASSERT_FALSE(driver.up);
    TEST_ASSERT_TRUE(said(ARGUS_EV_LINK_LOST));
}

void test_no_translation_after_reconnecting_before_a_full_check(void) {
    static const argus_point_t again = {3000, 0};
    drive();
    fake.fail_read_at = fake.reads + 1;
    driver_receive(&driver);
    const uint32_t moves = robot.commands[ARCOS_CMD_MOVE];
    hal_fake_link_init(&fake, 2, &clock_);
    robot_init(&robot); // it restarted in motion, so the course is given up
    driver_attach(&driver, hal_fake_link(&fake));
    TEST_ASSERT_FALSE(driver.core->checked);
    for (int i = 0; i < 100 && !driver.core->checked; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, robot.commands[ARCOS_CMD_MOVE] + robot.commands[ARCOS_CMD_VEL2]);
        run(50);
    }
    TEST_ASSERT_TRUE(driver.core->checked);
    run(2000);
    TEST_ASSERT_EQUAL_INT(ARGUS_MISSION_FAILED, driver.core->mission);
    TEST_ASSERT_TRUE(argus_set_course(driver.core, &again, 1));
    run(2000);
    TEST_ASSERT_GREATER_THAN_UINT32(0, robot.commands[ARCOS_CMD_MOVE]);
    TEST_ASSERT_GREATER_THAN_UINT32(0, moves);
}

void test_shutdown_closes_in_order(void) {
    drive();
    argus_shutdown(driver.core, time_.now_ms);
    driver_transmit(&driver);
    run(3000);
    TEST_ASSERT_TRUE(argus_closed(driver.core));
    TEST_ASSERT_FALSE(robot.open);
    TEST_ASSERT_EQUAL_UINT8(ARCOS_CMD_CLOSE, robot.last[0]);
    TEST_ASSERT_GREATER_THAN_UINT32(0, robot.commands[ARCOS_CMD_STOP]);
}

static uint16_t listen_here(int *server) {
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t size = sizeof address;
    *server = socket(AF_INET, SOCK_STREAM, 0);
    TEST_ASSERT_EQUAL_INT(0, bind(*server, (struct sockaddr *)&address, size));
    TEST_ASSERT_EQUAL_INT(0, listen(*server, 4));
    getsockname(*server, (struct sockaddr *)&address, &size);
    return ntohs(address.sin_port);
}

void test_a_tcp_link_that_closes_is_opened_again_with_pauses(void) {
    int server = -1;
    argus_config_t config;
    argus_config_default(&config);
    parse("tcp:127.0.0.1:%u", (unsigned)listen_here(&server));
    driver_init(&driver, &config, clock_, &spec, &transport);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, driver_open(&driver, 1000));
    close(accept(server, NULL, NULL));
    while (driver.up) {
        driver_receive(&driver);
    }
    TEST_ASSERT_EQUAL_INT(HAL_LINK_CLOSED, driver.error);
    close(server);
    uint32_t attempts = 0;
    for (int i = 0; i < 1000; i++) { // 10 s without a server: pauses of 250, 500, 1000, 2000, 4000 ms
        const uint32_t before_ms = driver.lost_ms;
        time_.now_ms += 10;
        driver_process(&driver);
        attempts += driver.lost_ms != before_ms;
        TEST_ASSERT_FALSE(driver.up);
    }
    TEST_ASSERT_EQUAL_UINT32(5, attempts);
    parse("tcp:127.0.0.1:%u", (unsigned)listen_here(&server));
    driver.spec = spec;
    time_.now_ms += 4000;
    driver_process(&driver);
    TEST_ASSERT_TRUE(driver.up);
    TEST_ASSERT_EQUAL_UINT32(1, driver.reopened);
    driver_close(&driver);
    close(server);
}

static char reason[1024];

static int reasons(const char *part) {
    int told = 0;
    while (driver_reason(&driver, reason, sizeof reason)) {
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(reason, part), reason);
        TEST_ASSERT_NULL(strchr(reason, '\n'));
        told++;
    }
    return told;
}

static void pass(uint32_t ms) {
    for (uint32_t passed = 0; passed < ms; passed += 10) {
        time_.now_ms += 10;
        driver_process(&driver);
        driver_receive(&driver);
    }
}

void test_why_a_link_stays_away_is_told_once_and_again_when_it_changes(void) {
    char folder[] = "/tmp/argus-driver-XXXXXX";
    char device[64];
    char other[300];
    int master = -1;
    int slave = -1;
    argus_config_t config;
    argus_config_default(&config);
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    TEST_ASSERT_EQUAL_INT(0, openpty(&master, &slave, device, NULL, NULL));
    fcntl(master, F_SETFL, O_NONBLOCK);
    parse("serial:%s/ttyUSB0@9600", folder);
    snprintf(other, sizeof other, "%s/ttyUSB1", folder);
    TEST_ASSERT_EQUAL_INT(0, symlink(device, spec.target));
    driver_init(&driver, &config, clock_, &spec, &transport);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, driver_open(&driver, 0));
    TEST_ASSERT_EQUAL_INT(0, reasons(""));
    // The adapter comes back under the next number.
    unlink(spec.target);
    TEST_ASSERT_EQUAL_INT(0, symlink(device, other));
    close(master);
    pass(10000);
    TEST_ASSERT_EQUAL_INT(1, reasons("ttyUSB0: no such file; "));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(reason, other), reason);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(reason, "/dev/serial/by-id"), reason);
    pass(10000);
    TEST_ASSERT_EQUAL_INT(0, reasons(""));
    // Something else is wrong now.
    TEST_ASSERT_EQUAL_INT(0, symlink("/dev/null", spec.target));
    pass(5000);
    TEST_ASSERT_EQUAL_INT(1, reasons("not a serial port"));
    unlink(spec.target);
    close(slave);
    TEST_ASSERT_EQUAL_INT(0, openpty(&master, &slave, device, NULL, NULL));
    TEST_ASSERT_EQUAL_INT(0, symlink(device, spec.target));
    pass(5000);
    TEST_ASSERT_TRUE(driver.up);
    TEST_ASSERT_EQUAL_INT(1, reasons("open again"));
    driver_close(&driver);
    close(master);
    close(slave);
    unlink(spec.target);
    unlink(other);
    rmdir(folder);
}

// A server whose robot another client has. Each connection gets the words and is closed; returns how many
// did.
static int turn_away(int server, uint32_t ms, const char *words, int *told) {
    int accepted = 0;
    for (uint32_t passed = 0; passed < ms; passed += 10) {
        const int client = accept(server, NULL, NULL);
        if (client >= 0) {
            accepted++;
            (void)!write(client, words, strlen(words));
            close(client);
        }
        pass(10);
        *told += reasons("the other end accepts and closes before a robot answers");
    }
    return accepted;
}

static int await_client(int server) {
    int client = -1;
    for (int i = 0; i < 1000 && client < 0; i++) {
        pass(10);
        client = accept(server, NULL, NULL);
    }
    TEST_ASSERT_TRUE(client >= 0);
    return client;
}

static int open_to_server(void) {
    int server = -1;
    argus_config_t config;
    argus_config_default(&config);
    parse("tcp:127.0.0.1:%u", (unsigned)listen_here(&server));
    fcntl(server, F_SETFL, O_NONBLOCK);
    driver_init(&driver, &config, clock_, &spec, &transport);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, driver_open(&driver, 1000));
    return server;
}

static const char whole_packet[] = "\xFA\xFB\x03\x00\x00\x00";

static void turned_away_with(const char *words, const char *part) {
    int told = 0;
    const int server = open_to_server();
    const int accepted = turn_away(server, 20000, words, &told);
    TEST_ASSERT_EQUAL_INT(1, told);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(reason, part), reason);
    TEST_ASSERT_TRUE(driver_is_turned_away(&driver));
    TEST_ASSERT_TRUE_MESSAGE(accepted >= 4 && accepted <= 12, "pauses of 0.5, 1, 2, 4, 4 s");
    // The other client has gone: a robot answers. Words alone are no robot.
    const int client = await_client(server);
    TEST_ASSERT_EQUAL_INT(4, write(client, "xxxx", 4));
    pass(500);
    TEST_ASSERT_EQUAL_INT(0, reasons(""));
    TEST_ASSERT_TRUE(driver_is_turned_away(&driver));
    TEST_ASSERT_EQUAL_INT(6, write(client, whole_packet, 6));
    pass(500);
    TEST_ASSERT_EQUAL_INT(1, reasons("open again"));
    TEST_ASSERT_FALSE(driver_is_turned_away(&driver));
    driver_close(&driver);
    close(client);
    close(server);
}

void test_a_server_that_closes_at_once_is_told_once_and_asked_less_often(void) {
    turned_away_with("", "2 times so far: another client");
}

void test_a_server_that_says_a_word_and_closes_is_no_better(void) {
    turned_away_with("Port already in use\r\n",
                     "2 times so far, saying 'Port already in use': another client");
    turned_away_with("\033[31m busy\a\r\n\r\n-\n", "saying '[31m busy -': ");
    turned_away_with("\r\n\377\001", "2 times so far: another client");
    turned_away_with("0123456789abcdefghijklmnopqrstuvwxyz0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ",
                     "saying '0123456789abcdefghijklmnopqrstuvwxyz0123456789ABCDEFGHIJKLMNOPQR': ");
}

void test_a_link_that_was_of_use_is_no_refusal_and_lends_it_no_words(void) {
    int told = 0;
    const int server = open_to_server();
    const int client = await_client(server);
    TEST_ASSERT_EQUAL_INT(6, write(client, whole_packet, 6));
    pass(100);
    close(client);
    pass(100);
    TEST_ASSERT_FALSE(driver.up);
    TEST_ASSERT_EQUAL_UINT32(0, driver.fruitless);
    turn_away(server, 2000, "", &told);
    TEST_ASSERT_EQUAL_INT(1, told);
    TEST_ASSERT_NULL_MESSAGE(strstr(reason, "saying"), reason);
    driver_close(&driver);
    close(server);
}

void test_a_name_that_leads_elsewhere_is_followed_while_no_robot_answers(void) {
    char folder[] = "/tmp/argus-driver-XXXXXX";
    char device[2][64];
    int master[2];
    int slave[2];
    argus_config_t config;
    argus_config_default(&config);
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    parse("serial:%s/port@9600", folder);
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_EQUAL_INT(0, openpty(&master[i], &slave[i], device[i], NULL, NULL));
        fcntl(master[i], F_SETFL, O_NONBLOCK);
    }
    TEST_ASSERT_EQUAL_INT(0, symlink(device[0], spec.target));
    driver_init(&driver, &config, clock_, &spec, &transport);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, driver_open(&driver, 0));
    unlink(spec.target);
    TEST_ASSERT_EQUAL_INT(0, symlink(device[1], spec.target));
    for (int i = 0; i < 300; i++) {
        time_.now_ms += 10;
        driver_process(&driver);
    }
    uint8_t bytes[64];
    TEST_ASSERT_EQUAL_UINT32(1, driver.reopened);
    TEST_ASSERT_GREATER_THAN_INT(0, read(master[1], bytes, sizeof bytes));
    driver_close(&driver);
    for (int i = 0; i < 2; i++) {
        close(master[i]);
        close(slave[i]);
    }
    unlink(spec.target);
    rmdir(folder);
}

// A link over a queue that is full: poll() would call it writable at once, so the driver asks for time
// instead.
static uint32_t hold_ms;
static int writes_left;

static int full_write(void *context, const uint8_t *packet, size_t count) {
    (void)context;
    (void)packet;
    hold_ms = writes_left > 0 ? 0 : 2;
    return writes_left-- > 0 ? (int)count : 0;
}

static int no_bytes(void *context, uint8_t *bytes, size_t capacity) {
    (void)context;
    (void)bytes;
    (void)capacity;
    return 0;
}

static int nothing_kept(void *context) {
    (void)context;
    return 0;
}

static uint32_t full_hold_ms(const void *context) {
    (void)context;
    return hold_ms;
}

static void no_close(void *context) {
    (void)context;
}

void test_a_full_queue_is_waited_for_by_time_not_by_poll(void) {
    static const hal_link_ops_t ops = {.read = no_bytes,
                                       .write = full_write,
                                       .flush = nothing_kept,
                                       .hold_ms = full_hold_ms,
                                       .close = no_close};
    hold_ms = 0;
    writes_left = 0;
    driver_attach(&driver, (hal_link_t){.ops = &ops});
    uint32_t wait_ms = 100;
    for (int i = 0; i < 200 && wait_ms > 2; i++) {
        time_.now_ms += 10;
        wait_ms = driver_process(&driver);
    }
    TEST_ASSERT_EQUAL_UINT32(2, wait_ms);
    TEST_ASSERT_GREATER_THAN_size_t(0, driver.held);
    TEST_ASSERT_FALSE(driver_wants_write(&driver));
    writes_left = 100;
    driver_process(&driver);
    TEST_ASSERT_EQUAL_size_t(0, driver.held);
}

// As ser2net with "telnet" begins; packets pass nonetheless, but for those with a byte FF.
void test_a_telnet_server_is_named_once(void) {
    const int server = open_to_server();
    const int client = await_client(server);
    TEST_ASSERT_FALSE(driver_meets_telnet(&driver));
    TEST_ASSERT_EQUAL_INT(6, write(client, "\xFF\xFB\x00\xFF\xFD\x03", 6));
    TEST_ASSERT_EQUAL_INT(6, write(client, whole_packet, 6));
    pass(500);
    TEST_ASSERT_TRUE(driver_meets_telnet(&driver));
    TEST_ASSERT_EQUAL_INT(1, reasons("a telnet server is there"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(reason, "accepter"), reason);
    pass(500);
    TEST_ASSERT_EQUAL_INT(0, reasons(""));
    driver_close(&driver);
    close(client);
    close(server);
}

void test_a_byte_of_ff_in_a_packet_is_no_telnet(void) {
    const int server = open_to_server();
    const int client = await_client(server);
    TEST_ASSERT_EQUAL_INT(6, write(client, whole_packet, 6));
    TEST_ASSERT_EQUAL_INT(5, write(client, "\xFA\xFB\x05\xFF\x00", 5));
    pass(500);
    TEST_ASSERT_FALSE(driver_meets_telnet(&driver));
    driver_close(&driver);
    close(client);
    close(server);
}
