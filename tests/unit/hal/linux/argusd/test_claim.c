// SPDX-License-Identifier: MIT
// Rule: a name on disk is its living owner's, who is told of; one that a dead program left is anybody's.
#include "claim.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "unity.h"

#define RIVALS 8
#define ROUNDS 30

static char folder[64];
static char path[96];
static char lock[112];
static char message[512];
static claim_t claim;

void setUp(void) {
    snprintf(folder, sizeof folder, "/tmp/argus-claim-XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/name", folder);
    snprintf(lock, sizeof lock, "%s.lock", path);
    claim = (claim_t){0};
}

void tearDown(void) {
    claim_release(&claim);
    unlink(lock);
    rmdir(folder);
}

static bool is_there(void) {
    struct stat about;
    return lstat(lock, &about) == 0;
}

void test_the_second_is_told_of_the_first(void) {
    claim_t second = {0};
    char expected[64];
    TEST_ASSERT_TRUE(claim_take(&claim, "--state", path, message, sizeof message));
    TEST_ASSERT_FALSE(claim_take(&second, "--state", path, message, sizeof message));
    snprintf(expected, sizeof expected, "process %d has it", (int)getpid());
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, expected), message);
    TEST_ASSERT_EQUAL_STRING_LEN("--state /tmp/argus-claim-", message, 25);
    claim_release(&second); // had nothing, and takes nothing away
    TEST_ASSERT_TRUE(is_there());
    claim_release(&claim);
    TEST_ASSERT_FALSE(is_there());
    TEST_ASSERT_TRUE(claim_take(&claim, "--state", path, message, sizeof message));
}

void test_what_a_dead_one_left_is_free(void) {
    int ready[2];
    char byte = 0;
    TEST_ASSERT_EQUAL(0, pipe(ready));
    const pid_t pid = fork();
    if (pid == 0) {
        const bool taken = claim_take(&claim, "--state", path, message, sizeof message);
        _exit(!taken || write(ready[1], "!", 1) != 1 || pause());
    }
    TEST_ASSERT_EQUAL(1, read(ready[0], &byte, 1));
    TEST_ASSERT_FALSE(claim_take(&claim, "--state", path, message, sizeof message));
    kill(pid, SIGKILL);
    waitpid(pid, NULL, 0);
    TEST_ASSERT_TRUE(is_there());
    TEST_ASSERT_TRUE_MESSAGE(claim_take(&claim, "--state", path, message, sizeof message), message);
    close(ready[0]);
    close(ready[1]);
}

// Takes it, holds it for a moment, gives it back, again and again; tells whether two had it at once.
static int rival(const char *inside) {
    for (int i = 0; i < ROUNDS; i++) {
        claim_t mine = {0};
        if (!claim_take(&mine, "--state", path, message, sizeof message)) {
            continue;
        }
        if (mkdir(inside, 0700) != 0) {
            return 1;
        }
        usleep(100);
        rmdir(inside);
        claim_release(&mine);
    }
    return 0;
}

void test_never_two_at_once(void) {
    char inside[128];
    int both = 0;
    snprintf(inside, sizeof inside, "%s/inside", folder);
    for (int i = 0; i < RIVALS; i++) {
        if (fork() == 0) {
            _exit(rival(inside));
        }
    }
    for (int i = 0; i < RIVALS; i++) {
        int status = 0;
        wait(&status);
        both += status != 0;
    }
    TEST_ASSERT_EQUAL(0, both);
    TEST_ASSERT_FALSE(is_there());
}

void test_a_place_that_cannot_be_written_and_a_symlink(void) {
    char target[128];
    struct stat about;
    TEST_ASSERT_FALSE(claim_take(&claim, "--state", "/nonexistent/name", message, sizeof message));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, "/nonexistent/name.lock: No such file"), message);
    snprintf(target, sizeof target, "%s/precious", folder);
    TEST_ASSERT_EQUAL(0, symlink(target, lock));
    TEST_ASSERT_FALSE(claim_take(&claim, "--state", path, message, sizeof message));
    TEST_ASSERT_NOT_EQUAL(0, lstat(target, &about));
}
