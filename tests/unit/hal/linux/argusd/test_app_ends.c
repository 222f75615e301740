// SPDX-License-Identifier: MIT
// Attacks: argusd as a whole ends in order: on SIGTERM, on one wish delivered twice, without its link; and
// what is no orderly end is not called one. Apart from test_app.c, so that each waits for the robot's clock
// while the other does.
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "app_bench.h"

void setUp(void) {
    app_set_up();
}

void tearDown(void) {
    app_tear_down();
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

#define READ_TURNS 4
static bool ends_mute;
static uint8_t ends_with_mm_s;

// What it said before it fell mute has been read by the time of the wish.
static void signal_and_change(pid_t child, int turn) {
    if (turn > 0 && first == 0 && strstr(out, "HEALTH_CHECK") != NULL) {
        first = turn;
        mute = ends_mute;
        robot.vel_mm_s = ends_with_mm_s;
    }
    if (first > 0 && turn == first + (ends_mute ? READ_TURNS : 0)) {
        kill(child, SIGTERM);
    }
}

static void ends_unclean(const char *activity, const char *why) {
    char line[256];
    first = 0;
    during = signal_and_change;
    snprintf(line, sizeof line, "--link serial:%s --json --status 0 %s", name, activity);
    TEST_ASSERT_EQUAL_INT_MESSAGE(6, run(line, true, NULL), err);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(err, why), err);
    tearDown();
    setUp();
}

// A silence shows only after a while: that SIPs came up to the wish says nothing.
void test_a_robot_that_is_not_heard_after_the_wish_may_not_have_heard_it(void) {
    ends_mute = true;
    ends_with_mm_s = 0;
    ends_unclean("--active", "since the robot had gone silent, and may not have heard the end");
    ends_unclean("--passive", "since the robot had gone silent, and may not have heard the end");
}

void test_a_session_that_is_closed_in_motion_is_not_closed_in_order(void) {
    ends_mute = false;
    ends_with_mm_s = 100;
    ends_unclean("--active", "since the robot did not come to rest in time");
}

// Nothing that argusd commanded moves it: somebody pushes it.
void test_a_passive_robot_need_not_rest(void) {
    char line[256];
    first = 0;
    ends_mute = false;
    ends_with_mm_s = 100;
    during = signal_and_change;
    snprintf(line, sizeof line, "--link serial:%s --json --status 0", name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, run(line, true, NULL), err);
    TEST_ASSERT_FALSE(robot.open);
}

void test_a_summary_ends_the_lines_for_people(void) {
    char line[256];
    snprintf(line, sizeof line, "--link serial:%s --plain --status 0", name);
    TEST_ASSERT_EQUAL_INT(0, run(line, true, "HEALTH_CHECK"));
    const char *const last = strstr(out, " SUMMARY mission none; IsNormal; no sonar out of use; ");
    TEST_ASSERT_NOT_NULL_MESSAGE(last, out);
    TEST_ASSERT_EQUAL_PTR(out + strlen(out) - 1, strchr(last, '\n'));
}
