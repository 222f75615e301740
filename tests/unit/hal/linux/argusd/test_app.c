// SPDX-License-Identifier: MIT
// Attacks: argusd as a whole, in a process of its own: every exit code with its one line, and a session with
// a robot on a real pty.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app_bench.h"

static char config_path[] = "/tmp/argus-app-XXXXXX";

void setUp(void) {
    app_set_up();
}

void tearDown(void) {
    app_tear_down();
}

static void write_config(const char *text) {
    strcpy(config_path, "/tmp/argus-app-XXXXXX");
    const int fd = mkstemp(config_path);
    TEST_ASSERT_TRUE(fd >= 0);
    TEST_ASSERT_EQUAL_INT((int)strlen(text), write(fd, text, strlen(text)));
    close(fd);
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

void test_a_wait_for_the_port_says_what_for(void) {
    TEST_ASSERT_EQUAL_INT(3, run("--link serial:/tmp/no-such-port-3 --wait 1", false, NULL));
    const char *const why = strstr(err, "/tmp/no-such-port-3: no such file");
    TEST_ASSERT_NOT_NULL_MESSAGE(why, err);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why, "; waiting for it\n"), err);
    const char *const again = strstr(strchr(why, '\n'), "no-such-port-3: no such file");
    TEST_ASSERT_NOT_NULL_MESSAGE(again, err); // the end says why, too, and that is all
    TEST_ASSERT_NULL_MESSAGE(strstr(strchr(again, '\n'), "no such file"), err);
}
