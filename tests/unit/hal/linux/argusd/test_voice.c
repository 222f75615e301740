// SPDX-License-Identifier: MIT
// Attacks: what an operator ordered is told from verdicts, a summary is for people only, and nothing is shown
// before it is due.
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "hal/fake_clock.h"
#include "unity.h"
#include "voice.h"

static voice_t voice;
static moment_t moment;
static int ends[2];
static int saved;
static char text[8192];

// Standard output is a pipe from here on.
static void begin(bool json, uint32_t status_ms) {
    const voice_options_t options = {.json = json, .plain = true, .status_ms = status_ms};
    fflush(stdout);
    TEST_ASSERT_EQUAL_INT(0, pipe(ends));
    saved = dup(STDOUT_FILENO);
    dup2(ends[1], STDOUT_FILENO);
    memset(&voice, 0, sizeof voice);
    moment = (moment_t){.now_ms = UINT32_MAX - 10};
    voice_begin(&voice, &options, &moment);
}

static const char *end(void) {
    hal_fake_clock_t time = {0};
    const hal_clock_t clock = hal_fake_clock(&time);
    voice_end(&voice, &clock);
    dup2(saved, STDOUT_FILENO);
    close(saved);
    close(ends[1]);
    const ssize_t got = read(ends[0], text, sizeof text - 1);
    close(ends[0]);
    text[got > 0 ? got : 0] = '\0';
    return text;
}

static void say(uint16_t id, int8_t sonar, int32_t value, uint32_t after_ms) {
    const argus_event_t event = {.t_ms = moment.now_ms + after_ms, .id = id, .sonar = sonar, .value = value};
    voice_event(&voice, &moment, &event);
}

static int lines(const char *part) {
    int found = 0;
    for (const char *at = strstr(text, part); at != NULL; at = strstr(at + 1, part)) {
        found++;
    }
    return found;
}

void test_what_the_operator_took_out_is_no_verdict(void) {
    begin(false, 0);
    say(ARGUS_EV_OPERATOR, ARGUS_NO_SONAR, ARGUS_OP_DISABLE, 0);
    say(ARGUS_EV_SONAR_DISABLED, 3, ARGUS_KIND_WRONG, 0);
    say(ARGUS_EV_SONAR_DISABLED, 4, ARGUS_KIND_STUCK, 100);
    say(ARGUS_EV_OPERATOR, ARGUS_NO_SONAR, ARGUS_OP_RECHECK, 200);
    say(ARGUS_EV_SONAR_DISABLED, 5, ARGUS_KIND_OFF, 200);
    end();
    TEST_ASSERT_EQUAL_INT_MESSAGE(1, lines(" (by the operator)"), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "OPERATOR DISABLE: "), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "OPERATOR RECHECK: "), text);
    TEST_ASSERT_EQUAL_INT(3, lines("SONAR_DISABLED"));
    TEST_ASSERT_TRUE(strstr(text, "(by the operator)") < strstr(text, "sonar/front/04"));
}

void test_a_summary_is_for_people(void) {
    static view_t view;
    view.status.waypoints = 1;
    view.status.mission = ARGUS_MISSION_FAILED;
    view.status.goal_mm = 1234;
    view.status.health[3] = ARGUS_DISABLED;
    view.status.kind[3] = ARGUS_KIND_OFF;
    view.status.health[11] = ARGUS_PROBATION;
    view.status.kind[11] = ARGUS_KIND_SLOW;
    view.status.failure = ARGUS_IS_MINOR;
    begin(false, 0);
    voice_summary(&voice, &view);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(end(),
                                        "SUMMARY mission failed, 1234 mm from the goal; IsMinor; out of use: "
                                        "sonar 3 (off), 11 (slow); "),
                                 text);
    begin(true, 0);
    voice_summary(&voice, &view);
    TEST_ASSERT_EQUAL_STRING("", end());
}

void test_status_lines_come_when_due_over_the_wrap_of_the_clock(void) {
    static view_t view;
    begin(false, 500);
    TEST_ASSERT_FALSE(voice_is_due(&voice, moment.now_ms + 499));
    TEST_ASSERT_EQUAL_UINT32(1, voice_wait_ms(&voice, moment.now_ms + 499, 1000));
    TEST_ASSERT_TRUE(voice_is_due(&voice, moment.now_ms + 500));
    moment_take(&moment, moment.now_ms + 500);
    TEST_ASSERT_EQUAL_UINT64(500, moment.t_ms);
    voice_show(&voice, &moment, &view);
    TEST_ASSERT_FALSE(voice_is_due(&voice, moment.now_ms));
    TEST_ASSERT_EQUAL_UINT32(100, voice_wait_ms(&voice, moment.now_ms, 100));
    TEST_ASSERT_NOT_NULL(strstr(end(), "STATUS OFFLINE"));
    begin(false, 0);
    TEST_ASSERT_FALSE(voice_is_due(&voice, moment.now_ms + 100000));
    end();
}
