// SPDX-License-Identifier: MIT
// Attacks: each key answers with its name and what it does, or why it does not; nothing is asked that is
// refused in silence.
#include <string.h>

#include "hal/fake_clock.h"
#include "operator.h"
#include "unity.h"

static driver_t driver;
static hal_fake_clock_t time_;
static operator_t operator_;
static char answer[256];

static void begin(int32_t profile, int32_t active) {
    argus_config_t config;
    const hal_link_spec_t spec = {.scheme = &hal_tcp_scheme};
    argus_config_default(&config);
    config.profile = profile;
    config.active = active;
    driver_init(&driver, &config, hal_fake_clock(&time_), &spec, NULL);
    operator_init(&operator_, &driver, &config);
}

static void press(tui_key_t key, const char *part) {
    answer[0] = '\0';
    operator_key(&operator_, key, time_.now_ms, answer, sizeof answer);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(answer, part), answer);
    TEST_ASSERT_EQUAL_STRING_LEN("> ", answer, 2);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(answer, tui_keys_of(key)), answer);
}

static int count(uint16_t id) {
    argus_event_t event;
    int found = 0;
    while (argus_next_event(driver.core, &event)) {
        found += event.id == id;
    }
    return found;
}

void test_what_is_not_done_while_passive_says_so(void) {
    begin(ARGUS_PROFILE_ARGUS, 0);
    press(TUI_AHEAD, "one step ahead: not while passive; p makes it active");
    press(TUI_BACK, "not while passive");
    press(TUI_LEFT, "not while passive");
    press(TUI_GO, "not while passive");
    TEST_ASSERT_EQUAL_INT(0, count(ARGUS_EV_OPERATOR));
    press(TUI_STOP, "stop, and stay");
    TEST_ASSERT_EQUAL_INT(1, count(ARGUS_EV_OPERATOR));
    press(TUI_PASSIVE, "p: active: drives");
    TEST_ASSERT_EQUAL_INT(1, count(ARGUS_EV_ACTIVE));
    press(TUI_PASSIVE, "twice within a second is once");
    TEST_ASSERT_EQUAL_INT(0, count(ARGUS_EV_PASSIVE));
    time_.now_ms += 1000;
    press(TUI_PASSIVE, "p: passive: stops");
    TEST_ASSERT_EQUAL_INT(1, count(ARGUS_EV_PASSIVE));
}

void test_without_a_robot_nothing_is_driven(void) {
    static const argus_point_t goal = {1000, 0};
    begin(ARGUS_PROFILE_ARGUS, 1);
    press(TUI_AHEAD, "not without a robot");
    press(TUI_GO, "not without a robot");
    press(TUI_RETEST, "sonar 0: test the chosen sonar again: not without a robot");
    TEST_ASSERT_EQUAL_INT(0, count(ARGUS_EV_OPERATOR));
    TEST_ASSERT_TRUE(argus_set_course(driver.core, &goal, 1));
    press(TUI_GO, "not without a robot");
}

void test_sonars_are_chosen_round_and_pinned(void) {
    begin(ARGUS_PROFILE_ARGUS, 0);
    press(TUI_PREVIOUS, "sonar 15 is chosen");
    press(TUI_NEXT, "sonar 0 is chosen");
    press(TUI_NEXT, "sonar 1 is chosen");
    press(TUI_PIN, "k: sonar 1: keeps its health until unpinned");
    press(TUI_TAKE_OUT, "it is pinned; k ends that");
    time_.now_ms += 1000;
    press(TUI_PIN, "k: sonar 1: the evidence decides again");
    press(TUI_TAKE_OUT, "x: sonar 1: take it out of use, pinned");
    TEST_ASSERT_EQUAL_INT(1, count(ARGUS_EV_SONAR_DISABLED));
}

void test_profile_paper_has_no_pins(void) {
    begin(ARGUS_PROFILE_PAPER, 0);
    press(TUI_PIN, "not with profile paper");
    press(TUI_TAKE_OUT, "not with profile paper");
    TEST_ASSERT_EQUAL_INT(0, count(ARGUS_EV_OPERATOR));
}

void test_a_key_that_means_nothing_is_answered_too(void) {
    begin(ARGUS_PROFILE_ARGUS, 1);
    press(TUI_UNKNOWN, "no such key; ? shows the keys");
    TEST_ASSERT_EQUAL_INT(0, count(ARGUS_EV_OPERATOR));
}

void test_every_order_of_the_bus_is_carried_out(void) {
    static const argus_op_t ops[] = {[HAL_DBC_ORDER_STOP] = ARGUS_OP_STOP,
                                     [HAL_DBC_ORDER_GO] = ARGUS_OP_GO,
                                     [HAL_DBC_ORDER_PASSIVE] = ARGUS_OP_PASSIVE,
                                     [HAL_DBC_ORDER_ACTIVE] = ARGUS_OP_ACTIVE};
    begin(ARGUS_PROFILE_ARGUS, 1);
    for (uint8_t order = HAL_DBC_ORDER_STOP; order <= HAL_DBC_ORDER_ACTIVE; order++) {
        argus_event_t event;
        const hal_dbc_command_t command = {.order = order};
        operator_order(&operator_, &command, time_.now_ms);
        TEST_ASSERT_TRUE(argus_next_event(driver.core, &event));
        TEST_ASSERT_EQUAL_UINT16(ARGUS_EV_OPERATOR, event.id);
        TEST_ASSERT_EQUAL_INT32(ops[order], event.value);
        count(0);
    }
}
