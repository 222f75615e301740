// SPDX-License-Identifier: MIT
// Attacks: on a real pty a serial link is raw, exclusive, of the asked rate, notices the far end's death, and
// leaves the settings as it found them.
#include <fcntl.h>
#include <pty.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "hal/serial.h"
#include "unity.h"

static hal_serial_t serial;
static hal_link_t link_;
static int master;
static int slave; // held open, as the emulator does, so that settings outlive the client
static char name[64];

void setUp(void) {
    TEST_ASSERT_EQUAL_INT(0, openpty(&master, &slave, name, NULL, NULL));
    fcntl(master, F_SETFL, O_NONBLOCK);
    hal_serial_init(&serial);
    link_ = hal_serial_link(&serial);
}

void tearDown(void) {
    hal_link_close(&link_);
    close(master);
    close(slave);
}

void test_every_byte_value_passes_unchanged_both_ways(void) {
    uint8_t all[256];
    uint8_t got[256] = {0};
    for (int i = 0; i < 256; i++) {
        all[i] = (uint8_t)i;
    }
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_serial_open(&serial, name, 9600));
    TEST_ASSERT_EQUAL_INT(256, hal_link_write(&link_, all, 256));
    TEST_ASSERT_EQUAL_INT(256, read(master, got, 256));
    TEST_ASSERT_EQUAL_MEMORY(all, got, 256);
    memset(got, 0, sizeof got);
    TEST_ASSERT_EQUAL_INT(256, write(master, all, 256));
    int count = 0;
    while (count < 256) {
        const int more = hal_link_read(&link_, got + count, sizeof got - (size_t)count);
        TEST_ASSERT_TRUE(more >= 0);
        count += more;
    }
    TEST_ASSERT_EQUAL_MEMORY(all, got, 256);
    TEST_ASSERT_EQUAL_INT(0, hal_link_read(&link_, got, sizeof got));
}

void test_every_rate_is_set_and_others_are_refused(void) {
    static const struct {
        uint32_t baud;
        speed_t speed;
    } rates[] = {{9600, B9600}, {19200, B19200}, {38400, B38400}, {57600, B57600}, {115200, B115200}};
    TEST_ASSERT_EQUAL_UINT8(5, hal_baud_count);
    for (int i = 0; i < 5; i++) {
        struct termios now;
        TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_serial_open(&serial, name, rates[i].baud));
        tcgetattr(slave, &now);
        TEST_ASSERT_EQUAL_UINT32(rates[i].speed, cfgetospeed(&now));
        TEST_ASSERT_EQUAL_UINT32(rates[i].speed, cfgetispeed(&now));
        TEST_ASSERT_EQUAL_UINT32(0, now.c_lflag & (ICANON | ECHO | ISIG));
        TEST_ASSERT_EQUAL_UINT32(0, now.c_cflag & (PARENB | CSTOPB | CRTSCTS));
        TEST_ASSERT_EQUAL_UINT32(CS8, now.c_cflag & CSIZE);
        TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_serial_set_baud(&serial, rates[4 - i].baud));
        tcgetattr(slave, &now);
        TEST_ASSERT_EQUAL_UINT32(rates[4 - i].speed, cfgetospeed(&now));
        hal_link_close(&link_);
    }
    TEST_ASSERT_EQUAL_INT(HAL_LINK_BAD_BAUD, hal_serial_open(&serial, name, 4800));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_OPEN, hal_serial_set_baud(&serial, 9600));
}

void test_settings_are_put_back(void) {
    struct termios before;
    struct termios after;
    tcgetattr(slave, &before);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_serial_open(&serial, name, 115200));
    hal_link_close(&link_);
    hal_link_close(&link_);
    tcgetattr(slave, &after);
    TEST_ASSERT_EQUAL_UINT32(before.c_lflag, after.c_lflag);
    TEST_ASSERT_EQUAL_UINT32(before.c_iflag, after.c_iflag);
    TEST_ASSERT_EQUAL_UINT32(before.c_cflag, after.c_cflag);
    TEST_ASSERT_EQUAL_UINT32(cfgetospeed(&before), cfgetospeed(&after));
}

void test_a_second_user_is_refused_and_leaves_the_first_alone(void) {
    static hal_serial_t second;
    struct termios now;
    hal_serial_init(&second);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_serial_open(&serial, name, 38400));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_BUSY, hal_serial_open(&second, name, 9600));
    tcgetattr(slave, &now);
    TEST_ASSERT_EQUAL_UINT32(B38400, cfgetospeed(&now));
    hal_link_close(&link_);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_serial_open(&second, name, 9600));
    const hal_link_t other = hal_serial_link(&second);
    hal_link_close(&other);
}

void test_a_killed_holder_does_not_lock_the_port(void) {
    int ready[2];
    TEST_ASSERT_EQUAL_INT(0, pipe(ready));
    const pid_t child = fork();
    if (child == 0) {
        const uint8_t result = hal_serial_open(&serial, name, 9600) == HAL_LINK_OK;
        (void)!write(ready[1], &result, 1);
        alarm(600);
        pause();
        _exit(0);
    }
    uint8_t opened = 0;
    TEST_ASSERT_EQUAL_INT(1, read(ready[0], &opened, 1));
    TEST_ASSERT_EQUAL_UINT8(1, opened);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_BUSY, hal_serial_open(&serial, name, 9600));
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    // Not as root: root may open an exclusive terminal anyway.
    const pid_t user = fork();
    if (user == 0) {
        const int changed =
            getuid() != 0 || (fchmod(slave, 0666) == 0 && setgid(65534) == 0 && setuid(65534) == 0);
        _exit(changed && hal_serial_open(&serial, name, 9600) == HAL_LINK_OK ? 0 : 1);
    }
    int status = 0;
    waitpid(user, &status, 0);
    TEST_ASSERT_EQUAL_INT(0, status);
    close(ready[0]);
    close(ready[1]);
}

void test_what_waited_before_opening_is_thrown_away(void) {
    uint8_t bytes[16];
    struct termios raw;
    tcgetattr(slave, &raw);
    cfmakeraw(&raw);
    tcsetattr(slave, TCSANOW, &raw);
    TEST_ASSERT_EQUAL_INT(5, write(master, "stale", 5));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_serial_open(&serial, name, 9600));
    TEST_ASSERT_EQUAL_INT(0, hal_link_read(&link_, bytes, sizeof bytes));
}

void test_death_of_the_far_end_is_noticed(void) {
    uint8_t bytes[16];
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_serial_open(&serial, name, 9600));
    close(master);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_GONE, hal_link_read(&link_, bytes, sizeof bytes));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_GONE, hal_link_write(&link_, (const uint8_t *)"x", 1));
    master = open("/dev/null", O_RDONLY);
}

void test_a_full_port_takes_no_part_of_a_packet_as_lost(void) {
    uint8_t packet[200];
    uint32_t taken = 0;
    memset(packet, 0xAB, sizeof packet);
    TEST_ASSERT_EQUAL_INT(HAL_LINK_OK, hal_serial_open(&serial, name, 9600));
    while (hal_link_write(&link_, packet, sizeof packet) > 0) {
        taken += sizeof packet;
        TEST_ASSERT_LESS_THAN_UINT32(10000000, taken);
    }
    TEST_ASSERT_GREATER_THAN_UINT32(0, hal_link_counters(&link_).would_block);
    uint32_t got = 0;
    for (int idle = 0; idle < 1000;) {
        const ssize_t more = read(master, packet, sizeof packet);
        got += more > 0 ? (uint32_t)more : 0;
        idle = more > 0 ? 0 : idle + 1;
        TEST_ASSERT_TRUE(hal_link_flush(&link_) >= 0);
    }
    TEST_ASSERT_EQUAL_UINT32(taken, got);
}

void test_wrong_kinds_of_file(void) {
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_FOUND, hal_serial_open(&serial, "/dev/no-such-port", 9600));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_SERIAL, hal_serial_open(&serial, "/dev/null", 9600));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_NOT_SERIAL, hal_serial_open(&serial, "/tmp", 9600));
    TEST_ASSERT_EQUAL_INT(HAL_LINK_BAD_ARGUMENT, hal_serial_open(&serial, "", 9600));
    TEST_ASSERT_EQUAL_INT(-1, hal_link_fd(&link_));
}

void test_explanations_say_what_to_do(void) {
    char text[512];
    hal_serial_explain(HAL_LINK_NOT_FOUND, "/dev/ttyUSB7", text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "/dev/ttyUSB7: no such file; "), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "/dev/"), text);
    hal_serial_explain(HAL_LINK_DENIED, "/dev/ttyUSB7", text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "/dev/ttyUSB7: no permission; "), text);
    hal_serial_explain(HAL_LINK_BAD_BAUD, name, text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, HAL_BAUD_LIST), text);
    hal_serial_explain(HAL_LINK_NOT_SERIAL, "/dev/null", text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "not a serial port"), text);
    char small[12] = "xxxxxxxxxxx";
    hal_serial_explain(HAL_LINK_NOT_FOUND, "/dev/ttyUSB7", small, sizeof small - 1);
    TEST_ASSERT_EQUAL_STRING("/dev/ttyUS", small);
}

// One file, of some user and group, with some mode.
static void denied(uid_t user, gid_t group, mode_t mode, const char *part) {
    char path[] = "/tmp/argus-serial-XXXXXX";
    char text[512];
    const int file = mkstemp(path);
    TEST_ASSERT_TRUE(file >= 0);
    TEST_ASSERT_EQUAL_INT(0, fchown(file, user, group));
    TEST_ASSERT_EQUAL_INT(0, fchmod(file, mode));
    close(file);
    hal_serial_explain(HAL_LINK_DENIED, path, text, sizeof text);
    unlink(path);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, part), text);
}

void test_permission_is_explained_as_owner_and_mode_really_are(void) {
    denied(geteuid(), getegid(), 0040,
           "mode 040 (owner: nothing, group: read, others: nothing): you own it, but may not read and write "
           "it: chmod u+rw /tmp/");
    denied(geteuid(), getegid(), 0600, "something else forbids it");
    if (geteuid() != 0) {
        TEST_IGNORE_MESSAGE("the rest gives files away, which only root may");
    }
    static const char *const others[] = {"chmod g+rw /tmp/", "and join the group, or a udev rule"};
    static const struct {
        mode_t mode;
        const char *part;
    } cases[] = {
        {0000, "mode 000 (owner: nothing, group: nothing, others: nothing): you are one of the others: "},
        {0600, "mode 600 (owner: read and write, group: nothing, others: nothing): you are one of the "},
        {0604, "mode 604 (owner: read and write, group: nothing, others: read): you are one of the others: "},
        {0642, "mode 642 (owner: read and write, group: read, others: write): you are one of the others: "},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        denied(12345, 23456, cases[i].mode, cases[i].part);
        denied(12345, 23456, cases[i].mode, others[0]);
        denied(12345, 23456, cases[i].mode, others[1]);
    }
    denied(12345, 23456, 0660, "it belongs to user 12345 and group 23456, mode 660 (owner: read and write, ");
    denied(12345, 23456, 0660, "others: nothing): join the group: ");
    denied(12345, 23456, 0660, "usermod -aG 23456 \"$USER\", then log in again");
    denied(12345, 23456, 0606, "something else forbids it");
    denied(12345, getegid(), 0600, "you are in that group, which may not read and write it: ");
    denied(12345, getegid(), 0606, "you are in that group, which may not read and write it: ");
    denied(12345, getegid(), 0660, "something else forbids it");
}

void test_missing_names_its_siblings_and_where_a_dangling_name_leads(void) {
    char folder[] = "/tmp/argus-serial-XXXXXX";
    char path[3][96];
    char text[1024];
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(path[0], sizeof path[0], "%s/ttyXYZ0", folder);
    snprintf(path[1], sizeof path[1], "%s/ttyXYZ12", folder);
    snprintf(path[2], sizeof path[2], "%s/robot", folder);
    close(open(path[1], O_CREAT | O_RDWR, 0600));
    TEST_ASSERT_EQUAL_INT(0, symlink("ttyXYZ0", path[2]));
    hal_serial_explain(HAL_LINK_NOT_FOUND, path[0], text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, path[1]), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "give its name under /dev/serial/by-id"), text);
    hal_serial_explain(HAL_LINK_NOT_FOUND, path[2], text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "it is a name for ttyXYZ0, which is not there"), text);
    unlink(path[1]);
    unlink(path[2]);
    rmdir(folder);
}

void test_busy_names_the_process_that_holds_the_port(void) {
    char text[512];
    const pid_t child = fork();
    if (child == 0) {
        alarm(600);
        pause();
        _exit(0);
    }
    // The child inherited the slave.
    hal_serial_explain(HAL_LINK_BUSY, name, text, sizeof text);
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    char expected[32];
    snprintf(expected, sizeof expected, "process %d (", (int)child);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, expected), text);
}
