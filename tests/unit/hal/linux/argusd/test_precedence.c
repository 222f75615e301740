// SPDX-License-Identifier: MIT
// Rule: --realtime takes what the system grants; what it does not is named, with both ways to grant it.
#define _GNU_SOURCE // setresuid
#include "precedence.h"

#include <sched.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "unity.h"

#define NOBODY 65534

static char message[1024];
static char text[160];
static precedence_t granted;

void test_numbers_of_processors(void) {
    static const struct {
        const char *text;
        uint64_t cpus;
    } good[] = {
        {"0", 1}, {"1", 2}, {"0,2-3", 13}, {"3-3", 8}, {"63", UINT64_C(1) << 63}, {"0-63", UINT64_MAX}};
    static const char *const bad[] = {"",    ",",   "-",  "0,",    "64",  "3-2", "0-64", "a",
                                      " 1 ", "1 2", "-1", "0-1-2", "1;2", "1-",  "1000"};
    uint64_t cpus = 0;
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(precedence_parse_cpus(good[i].text, &cpus), good[i].text);
        TEST_ASSERT_EQUAL_UINT64_MESSAGE(good[i].cpus, cpus, good[i].text);
    }
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(precedence_parse_cpus(bad[i], &cpus), bad[i]);
    }
}

void test_what_is_not_asked_for_is_not_taken(void) {
    const precedence_options_t options = {.on = false, .cpus = 1};
    TEST_ASSERT_TRUE(precedence_take(&options, &granted, message, sizeof message));
    TEST_ASSERT_EQUAL_STRING("", message);
    TEST_ASSERT_EQUAL(0, granted.priority);
    TEST_ASSERT_FALSE(granted.locked);
    TEST_ASSERT_EQUAL(SCHED_OTHER, sched_getscheduler(0) & ~SCHED_RESET_ON_FORK);
    precedence_describe(&granted, text, sizeof text);
    TEST_ASSERT_EQUAL_STRING("not asked for (--realtime)", text);
}

void test_processors_that_there_are_not(void) {
    if (sysconf(_SC_NPROCESSORS_CONF) >= PRECEDENCE_CPUS) {
        TEST_IGNORE_MESSAGE("this machine has them all");
    }
    const precedence_options_t options = {.on = true, .cpus = UINT64_C(1) << (PRECEDENCE_CPUS - 1)};
    TEST_ASSERT_FALSE(precedence_take(&options, &granted, message, sizeof message));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, "--cpus: "), message);
}

void test_what_was_granted_is_told(void) {
    granted = (precedence_t){.asked = true, .priority = 40, .locked = true, .cpus = 0xB};
    precedence_describe(&granted, text, sizeof text);
    TEST_ASSERT_EQUAL_STRING("SCHED_FIFO 40, memory locked, processors 0-1,3", text);
    granted = (precedence_t){.asked = true, .cpus = 4};
    precedence_describe(&granted, text, sizeof text);
    TEST_ASSERT_EQUAL_STRING("SCHED_FIFO not granted, memory not locked, processors 2", text);
}

// Each in a process of its own, since what is taken stays. The number of the first step that went wrong.
static int in_child(int (*steps)(void)) {
    int status = 0;
    const pid_t pid = fork();
    if (pid == 0) {
        _exit(steps());
    }
    TEST_ASSERT_EQUAL(pid, waitpid(pid, &status, 0));
    TEST_ASSERT_TRUE(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void forgo(rlim_t priority) {
    const struct rlimit none = {0, 0};
    const struct rlimit most = {priority, priority};
    setrlimit(RLIMIT_RTPRIO, &most);
    setrlimit(RLIMIT_MEMLOCK, &none);
    if (geteuid() == 0 && setresuid(NOBODY, NOBODY, NOBODY) != 0) {
        _exit(99);
    }
}

// The address sanitizer answers mlockall() itself, always with success: what of it is not granted is not
// seen.
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define LOCKS_SEEN 0
#endif
#endif
#ifndef LOCKS_SEEN
#define LOCKS_SEEN 1
#endif

static int without_the_right(void) {
    const precedence_options_t options = {.on = true};
    forgo(0);
    if (!precedence_take(&options, &granted, message, sizeof message) || granted.priority != 0 ||
        granted.locked == LOCKS_SEEN) {
        return 1;
    }
    static const char *const named[] = {
        "SCHED_FIFO 40 is not granted", "CAP_SYS_NICE",   "`ulimit -r` is 0",     "it drives on without",
        "sudo setcap cap_sys_nice",     "LimitRTPRIO=40",
#if LOCKS_SEEN
        "memory is not locked",         "CAP_IPC_LOCK",   "LimitMEMLOCK=infinity"
#endif
    };
    for (int i = 0; i < (int)(sizeof named / sizeof named[0]); i++) {
        if (strstr(message, named[i]) == NULL) {
            return 2 + i;
        }
    }
    return 0;
}

void test_without_the_right_it_goes_on_and_names_what_is_missing(void) {
    TEST_ASSERT_EQUAL(0, in_child(without_the_right));
}

// A limit is enough for one, as the service has it; where it may not be raised, the capability is tried.
static bool may_raise(void) {
    const struct rlimit most = {7, 7};
    return setrlimit(RLIMIT_RTPRIO, &most) == 0;
}

static int with_the_right(void) {
    const precedence_options_t options = {.on = true, .priority = 7};
    int status = 0;
    if (may_raise()) {
        forgo(7);
    } else if (geteuid() != 0) {
        return 77;
    }
    if (!precedence_take(&options, &granted, message, sizeof message) || granted.priority != 7 ||
        sched_getscheduler(0) != (SCHED_FIFO | SCHED_RESET_ON_FORK)) {
        return 1;
    }
    if (strstr(message, "SCHED_FIFO 7") != NULL || (message[0] == '\0') != granted.locked) {
        return 2;
    }
    const pid_t pid = fork();
    if (pid == 0) {
        _exit(sched_getscheduler(0) == SCHED_OTHER ? 0 : 1);
    }
    waitpid(pid, &status, 0);
    return WEXITSTATUS(status) == 0 ? 0 : 3;
}

void test_with_the_right_it_is_before_others_and_its_children_are_not(void) {
    const int result = in_child(with_the_right);
    if (result == 77) {
        TEST_IGNORE_MESSAGE("this user may neither have nor raise it");
    }
    TEST_ASSERT_EQUAL(0, result);
}
