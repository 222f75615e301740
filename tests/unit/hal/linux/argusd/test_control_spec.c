// SPDX-License-Identifier: MIT
// Attacks: no address beyond loopback is taken for loopback, no token that others could read is used, and
// only the whole token is the token.
#include "control_spec.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "unity.h"

static control_spec_t spec;
static control_token_t token;
static char message[1024];
static char path[] = "/tmp/argus-token-XXXXXX";

static void write_token(const char *text, mode_t mode) {
    strcpy(path, "/tmp/argus-token-XXXXXX");
    const int fd = mkstemp(path);
    TEST_ASSERT_TRUE(fd >= 0);
    TEST_ASSERT_EQUAL_INT((int)strlen(text), write(fd, text, strlen(text)));
    fchmod(fd, mode);
    close(fd);
}

static bool loads(const char *text, mode_t mode) {
    write_token(text, mode);
    const bool loaded = control_token_load(&token, path, message, sizeof message);
    unlink(path);
    return loaded;
}

void test_places_are_read(void) {
    static const struct {
        const char *text;
        int family;
        bool loopback;
    } rows[] = {
        {"unix:/run/x", AF_UNIX, true},         {"tcp:127.0.0.1:8200", AF_INET, true},
        {"tcp:localhost:0", AF_INET, true},     {"tcp:127.9.9.9:1", AF_INET, true},
        {"tcp:[::1]:8200", AF_INET6, true},     {"tcp:0.0.0.0:8200", AF_INET, false},
        {"tcp:[::]:8200", AF_INET6, false},     {"tcp:192.168.1.4:8200", AF_INET, false},
        {"tcp:128.0.0.1:8200", AF_INET, false}, {"tcp:[::ffff:127.0.0.1]:80", AF_INET6, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(control_spec_parse(&spec, rows[i].text, message, sizeof message), message);
        TEST_ASSERT_EQUAL_INT_MESSAGE(rows[i].family, spec.family, rows[i].text);
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].loopback, spec.loopback, rows[i].text);
    }
}

void test_what_is_no_place_is_refused_with_advice(void) {
    static char longest[200] = "unix:/";
    static const char *const bad[] = {"",
                                      "unix:",
                                      "/run/x",
                                      "tcp:",
                                      "tcp:127.0.0.1",
                                      "tcp:127.0.0.1:",
                                      "tcp::80",
                                      "tcp:robot.example:80",
                                      "tcp:127.0.0.1:65536",
                                      "tcp:127.0.0.1:-1",
                                      "tcp:127.0.0.1:80x",
                                      "udp:127.0.0.1:80",
                                      longest};
    memset(longest + 6, 'x', 150);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        message[0] = '\0';
        TEST_ASSERT_FALSE_MESSAGE(control_spec_parse(&spec, bad[i], message, sizeof message), bad[i]);
        TEST_ASSERT_TRUE_MESSAGE(strstr(message, "give ") != NULL || strstr(message, "longer than") != NULL,
                                 message);
        TEST_ASSERT_NULL(strchr(message, '\n'));
    }
}

void test_a_token_is_a_secret_of_one(void) {
    TEST_ASSERT_TRUE(loads("0123456789abcdef\nsecond line\n", 0600));
    TEST_ASSERT_EQUAL_STRING("0123456789abcdef", token.text);
    TEST_ASSERT_TRUE(loads("0123456789abcdef", 0400));
    TEST_ASSERT_FALSE(loads("0123456789abcdef", 0640));
    TEST_ASSERT_NOT_NULL(strstr(message, "chmod 600"));
    TEST_ASSERT_FALSE(loads("0123456789abcdef", 0604));
    TEST_ASSERT_FALSE(loads("0123456789abcde", 0600)); // short
    TEST_ASSERT_FALSE(loads("0123456789 abcdef", 0600));
    TEST_ASSERT_FALSE(loads("", 0600));
    TEST_ASSERT_FALSE(control_token_load(&token, "/nowhere/at/all", message, sizeof message));
    TEST_ASSERT_FALSE(control_token_load(&token, "/tmp", message, sizeof message));
    TEST_ASSERT_NOT_NULL(strstr(message, "no regular file"));
    char line[CONTROL_TOKEN_MAX + 2];
    memset(line, 'a', sizeof line);
    line[CONTROL_TOKEN_MAX] = '\0';
    TEST_ASSERT_TRUE(loads(line, 0600));
    TEST_ASSERT_TRUE(control_token_is(&token, line));
    line[CONTROL_TOKEN_MAX] = 'a';
    line[CONTROL_TOKEN_MAX + 1] = '\0';
    TEST_ASSERT_FALSE(loads(line, 0600));
}

void test_a_refusal_never_holds_the_token(void) {
    TEST_ASSERT_FALSE(loads("hush hush hush hush", 0600));
    TEST_ASSERT_NULL(strstr(message, "hush"));
    TEST_ASSERT_FALSE(loads("hushhushhushhush", 0644));
    TEST_ASSERT_NULL(strstr(message, "hush"));
}

void test_only_the_whole_token_is_right(void) {
    TEST_ASSERT_TRUE(loads("0123456789abcdef", 0600));
    TEST_ASSERT_TRUE(control_token_is(&token, "0123456789abcdef"));
    TEST_ASSERT_FALSE(control_token_is(&token, "0123456789abcdeF"));
    TEST_ASSERT_FALSE(control_token_is(&token, "0123456789abcde"));
    TEST_ASSERT_FALSE(control_token_is(&token, "0123456789abcdef0"));
    TEST_ASSERT_FALSE(control_token_is(&token, ""));
    char longer[400];
    memset(longer, 'a', sizeof longer);
    longer[sizeof longer - 1] = '\0';
    TEST_ASSERT_FALSE(control_token_is(&token, longer));
    memset(&token, 0, sizeof token);
    TEST_ASSERT_FALSE(control_token_is(&token, "")); // none was loaded
}
