// SPDX-License-Identifier: MIT
// Attacks: why no robot answered is told apart: silence, garbage, and packets that lead nowhere.
#include <string.h>

#include "check.h"
#include "hal/fake_clock.h"
#include "hal/fake_link.h"
#include "unity.h"

static driver_t driver;
static hal_fake_clock_t time_;
static hal_fake_link_t fake;
static char text[512];

static void start(const hal_scheme_t *scheme) {
    argus_config_t config;
    argus_config_default(&config);
    const hal_link_spec_t spec = {.scheme = scheme};
    const hal_clock_t clock = hal_fake_clock(&time_);
    hal_fake_link_init(&fake, 1, NULL);
    driver_init(&driver, &config, clock, &spec, NULL);
    driver_attach(&driver, hal_fake_link(&fake));
}

static void hear(const char *bytes, size_t count) {
    hal_fake_link_put(&fake, (const uint8_t *)bytes, count);
    driver_receive(&driver);
}

static void explained(const char *part) {
    check_explain_silence(&driver, 10000, text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, part), text);
    TEST_ASSERT_NULL(strchr(text, '\n'));
}

void test_silence(void) {
    start(&hal_serial_scheme);
    explained("fake: no robot answered in 10 s: nothing was received");
    explained("--auto-baud");
    start(&hal_tcp_scheme);
    explained("nothing was received");
    explained("Is another client using it?");
    TEST_ASSERT_NULL(strstr(text, "--auto-baud"));
    start(&hal_can_scheme);
    explained("is the robot on and connected? Do ids and fd agree at both ends?");
}

void test_garbage(void) {
    start(&hal_serial_scheme);
    hear("\x01\x02\x03\x04\x05", 5);
    explained("5 bytes of garbage were received, no packet among them; the rate is wrong");
    start(&hal_tcp_scheme);
    hear("HTTP/1.1 400\r\n", 14);
    explained("this is no ARCOS server");
    start(&hal_can_scheme);
    time_.now_ms += 2000;
    driver_process(&driver);
    hear("\x01\x02\x03", 3);
    explained("check the two ids");
}

void test_packets_that_lead_nowhere(void) {
    start(&hal_serial_scheme);
    hear("\xFA\xFB\x03\x00\x00\x00", 6);
    explained("1 packets and 0 bad checksums were received, but no session opened");
}
