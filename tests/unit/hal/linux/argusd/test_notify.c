// SPDX-License-Identifier: MIT
// Rule: systemd is told READY once, signs of life in time and no oftener, and one line of status when it
// changes; what is wrong with its socket is told in a line and stops nothing.
#include "notify.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "unity.h"

#define USEC_PER_S "2000000"

static char folder[64];
static char path[96];
static char message[512];
static int manager = -1;
static notify_t notify;

static void listen_at(const char *name) {
    struct sockaddr_un to = {.sun_family = AF_UNIX};
    memcpy(to.sun_path, name, strlen(name));
    socklen_t length = sizeof to;
    if (name[0] == '@') {
        to.sun_path[0] = '\0';
        length = (socklen_t)(offsetof(struct sockaddr_un, sun_path) + strlen(name));
    }
    manager = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
    TEST_ASSERT_EQUAL(0, bind(manager, (struct sockaddr *)&to, length));
    setenv("NOTIFY_SOCKET", name, 1);
}

// The next message, "" when there is none.
static const char *heard(void) {
    static char text[1024];
    const ssize_t got = recv(manager, text, sizeof text - 1, 0);
    text[got > 0 ? got : 0] = '\0';
    return text;
}

static void open_it(void) {
    TEST_ASSERT_TRUE_MESSAGE(notify_open(&notify, message, sizeof message), message);
}

void setUp(void) {
    strcpy(folder, "/tmp/notify-XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/socket", folder);
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
    unsetenv("WATCHDOG_PID");
    message[0] = '\0';
}

void tearDown(void) {
    if (notify.on) {
        close(notify.fd);
    }
    notify = (notify_t){.on = false};
    if (manager >= 0) {
        close(manager);
    }
    manager = -1;
    unlink(path);
    rmdir(folder);
}

void test_without_a_socket_nothing_is_told(void) {
    setenv("WATCHDOG_USEC", USEC_PER_S, 1);
    open_it();
    TEST_ASSERT_FALSE(notify.on);
    notify_ready(&notify, 0, "up");
    notify_status(&notify, "well");
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, notify_alive(&notify, 5000));
    notify_stopping(&notify);
}

void test_ready_is_told_once_with_its_status(void) {
    listen_at(path);
    open_it();
    notify_ready(&notify, 0, "opening the link");
    notify_ready(&notify, 10, "opening the link");
    TEST_ASSERT_EQUAL_STRING("READY=1", heard());
    TEST_ASSERT_EQUAL_STRING("STATUS=opening the link", heard());
    TEST_ASSERT_EQUAL_STRING("", heard());
}

void test_an_abstract_name(void) {
    char name[64];
    snprintf(name, sizeof name, "@argus-test-%d", (int)getpid());
    listen_at(name);
    open_it();
    notify_ready(&notify, 0, "up");
    TEST_ASSERT_EQUAL_STRING("READY=1", heard());
}

void test_a_status_is_told_when_it_changes_and_is_one_line(void) {
    listen_at(path);
    open_it();
    notify_status(&notify, "a\nREADY=1");
    TEST_ASSERT_EQUAL_STRING("STATUS=a READY=1", heard());
    notify_status(&notify, "b");
    notify_status(&notify, "b");
    TEST_ASSERT_EQUAL_STRING("STATUS=b", heard());
    TEST_ASSERT_EQUAL_STRING("", heard());
}

void test_a_long_status_is_cut_and_told_once(void) {
    char text[2 * NOTIFY_STATUS_MAX];
    memset(text, 'x', sizeof text);
    text[sizeof text - 1] = '\0';
    listen_at(path);
    open_it();
    notify_status(&notify, text);
    notify_status(&notify, text);
    TEST_ASSERT_EQUAL(strlen("STATUS=") + NOTIFY_STATUS_MAX - 1, strlen(heard()));
    TEST_ASSERT_EQUAL_STRING("", heard());
}

void test_the_status_of_a_robot(void) {
    argus_status_t status = {.open = false, .sonars = 16, .robot_name = "Bob", .robot_subclass = "p3dx-sh"};
    listen_at(path);
    open_it();
    notify_robot(&notify, &status, 0);
    TEST_ASSERT_EQUAL_STRING("STATUS=no robot answers", heard());
    status.open = true;
    for (int i = 0; i < status.sonars; i++) {
        status.health[i] = i == 3 ? ARGUS_DISABLED : ARGUS_HEALTHY;
    }
    notify_robot(&notify, &status, 0);
    const char *const told = heard();
    TEST_ASSERT_NOT_NULL(strstr(told, "STATUS=Bob (p3dx-sh): IsNormal, 15 of 16 sonars healthy, passive"));
    notify_robot(&notify, &status, 1u << 3);
    TEST_ASSERT_NOT_NULL(strstr(heard(), "STATUS=INJECTED FAULT; Bob"));
}

// Half of what is allowed, so that a late one is still in time; the clock wraps.
void test_signs_of_life_come_twice_in_the_time_that_is_allowed(void) {
    const uint32_t start_ms = UINT32_MAX - 700;
    setenv("WATCHDOG_USEC", USEC_PER_S, 1);
    listen_at(path);
    open_it();
    notify_ready(&notify, start_ms, "up");
    heard();
    heard();
    TEST_ASSERT_EQUAL_UINT32(1, notify_alive(&notify, start_ms + 999));
    TEST_ASSERT_EQUAL_STRING("", heard());
    TEST_ASSERT_EQUAL_UINT32(1000, notify_alive(&notify, start_ms + 1000));
    TEST_ASSERT_EQUAL_STRING("WATCHDOG=1", heard());
    TEST_ASSERT_EQUAL_UINT32(400, notify_alive(&notify, start_ms + 1600));
    TEST_ASSERT_EQUAL_STRING("", heard());
}

void test_a_watchdog_for_another_process_is_not_fed(void) {
    char other[32];
    snprintf(other, sizeof other, "%d", (int)getpid() + 1);
    setenv("WATCHDOG_USEC", USEC_PER_S, 1);
    setenv("WATCHDOG_PID", other, 1);
    listen_at(path);
    open_it();
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, notify_alive(&notify, 60000));
    TEST_ASSERT_EQUAL_STRING("", heard());
}

void test_stopping_follows_ready_only(void) {
    listen_at(path);
    open_it();
    notify_stopping(&notify);
    TEST_ASSERT_EQUAL_STRING("", heard());
    notify_ready(&notify, 0, "up");
    notify_stopping(&notify);
    notify_stopping(&notify);
    heard();
    heard();
    TEST_ASSERT_EQUAL_STRING("STATUS=closing the robot's session", heard());
    TEST_ASSERT_EQUAL_STRING("STOPPING=1", heard());
    TEST_ASSERT_EQUAL_STRING("", heard());
}

// A manager that went away, or whose queue is full, takes nothing of argusd's time.
void test_a_manager_that_does_not_listen_stops_nothing(void) {
    listen_at(path);
    open_it();
    for (int i = 0; i < 5000; i++) {
        notify_status(&notify, i % 2 == 0 ? "even" : "odd");
    }
    close(manager);
    manager = -1;
    notify_status(&notify, "gone");
}

void test_what_is_wrong_with_the_socket_is_one_line(void) {
    char longer[200];
    memset(longer, 'x', sizeof longer);
    longer[0] = '/';
    longer[sizeof longer - 1] = '\0';
    const char *const names[] = {"relative", "/", "/no/such/socket", longer};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        setenv("NOTIFY_SOCKET", names[i], 1);
        TEST_ASSERT_FALSE(notify_open(&notify, message, sizeof message));
        TEST_ASSERT_NOT_NULL(strstr(message, names[i]));
        TEST_ASSERT_NOT_NULL(strstr(message, "; ignored"));
        TEST_ASSERT_FALSE(notify.on);
    }
}

void test_a_time_that_is_none_is_told(void) {
    const char *const times[] = {"", "-1", "soon", "1999", "99999999999999999999999"};
    listen_at(path);
    for (size_t i = 0; i < sizeof times / sizeof times[0]; i++) {
        setenv("WATCHDOG_USEC", times[i], 1);
        TEST_ASSERT_FALSE_MESSAGE(notify_open(&notify, message, sizeof message), times[i]);
        TEST_ASSERT_NOT_NULL(strstr(message, "WATCHDOG_USEC="));
        TEST_ASSERT_TRUE(notify.on);
        close(notify.fd);
    }
    notify.on = false;
}
