// SPDX-License-Identifier: MIT
// Rule: nothing moves that one of the reasons bars, whoever asks and whatever is asked for; where none holds
// it may. Each reason alone, for both movers.
#include "behaviour/permit.h"

#include <stdio.h>

#include "behaviour/state.h"
#include "robot.h"
#include "unity.h"

static robot_t robot;

void setUp(void) {
    robot_in_box(&robot, ARGUS_PROFILE_ARGUS, -4000, -3000, 4000, 3000);
    robot_run(&robot, 4000);
}

static argus_permit_t ask(argus_mover_t mover, argus_wants_t wants, int32_t by_cdeg) {
    robot.argus.orders.passive = mover == ARGUS_MOVER_CLIENT;
    return argus_permit(&robot.argus, (argus_ask_t){mover, wants, by_cdeg});
}

static void check_all(argus_permit_t motions, argus_permit_t motors_of_manager,
                      argus_permit_t motors_of_client) {
    char text[60];
    for (int mover = 0; mover <= ARGUS_MOVER_CLIENT; mover++) {
        for (int wants = 0; wants <= ARGUS_WANTS_TURN; wants++) {
            const argus_permit_t of_motors =
                mover == ARGUS_MOVER_MANAGER ? motors_of_manager : motors_of_client;
            snprintf(text, sizeof text, "mover %d wants %d", mover, wants);
            TEST_ASSERT_EQUAL_INT_MESSAGE(wants == ARGUS_WANTS_MOTORS ? of_motors : motions,
                                          ask((argus_mover_t)mover, (argus_wants_t)wants, 3000), text);
        }
    }
}

void test_where_nothing_bars_it_may(void) {
    check_all(ARGUS_PERMIT_GIVEN, ARGUS_PERMIT_GIVEN, ARGUS_PERMIT_GIVEN);
}

void test_without_sips_nothing_may(void) {
    robot.argus.stalled = true;
    check_all(ARGUS_PERMIT_NO_ROBOT, ARGUS_PERMIT_NO_ROBOT, ARGUS_PERMIT_NO_ROBOT);
}

void test_while_it_is_being_left_nothing_may(void) {
    robot.argus.orders.shutdown = true;
    check_all(ARGUS_PERMIT_NO_ROBOT, ARGUS_PERMIT_NO_ROBOT, ARGUS_PERMIT_NO_ROBOT);
}

void test_over_a_late_link_only_the_motors(void) {
    robot.argus.latency.stands = true;
    check_all(ARGUS_PERMIT_NO_ROBOT, ARGUS_PERMIT_GIVEN, ARGUS_PERMIT_GIVEN);
}

void test_an_operators_stop_holds_both(void) {
    robot.argus.orders.stay = ARGUS_STAY_OPERATOR;
    check_all(ARGUS_PERMIT_STOPPED, ARGUS_PERMIT_GIVEN, ARGUS_PERMIT_STOPPED);
}

void test_after_another_order_it_holds_a_client_alone(void) {
    robot.argus.orders.stay = ARGUS_STAY_HELD;
    TEST_ASSERT_EQUAL_INT(ARGUS_PERMIT_GIVEN, ask(ARGUS_MOVER_MANAGER, ARGUS_WANTS_AHEAD, 0));
    for (int wants = 0; wants <= ARGUS_WANTS_TURN; wants++) {
        TEST_ASSERT_EQUAL_INT(ARGUS_PERMIT_STOPPED, ask(ARGUS_MOVER_CLIENT, (argus_wants_t)wants, 100));
    }
}

void test_settings_that_are_refused_bar_all(void) {
    robot.argus.orders.locked = true;
    check_all(ARGUS_PERMIT_BODY, ARGUS_PERMIT_BODY, ARGUS_PERMIT_BODY);
}

void test_who_has_not_got_the_robot_may_not(void) {
    const argus_ask_t client = {ARGUS_MOVER_CLIENT, ARGUS_WANTS_AHEAD, 0};
    const argus_ask_t manager = {ARGUS_MOVER_MANAGER, ARGUS_WANTS_AHEAD, 0};
    robot.argus.orders.passive = false;
    TEST_ASSERT_EQUAL_INT(ARGUS_PERMIT_OTHER, argus_permit(&robot.argus, client));
    robot.argus.orders.passive = true;
    TEST_ASSERT_EQUAL_INT(ARGUS_PERMIT_OTHER, argus_permit(&robot.argus, manager));
}

void test_a_bumper_bars_the_way_to_it_and_each_turn(void) {
    robot.argus.knowledge.bumpers_front = 8;
    for (int mover = 0; mover <= ARGUS_MOVER_CLIENT; mover++) {
        TEST_ASSERT_EQUAL_INT(ARGUS_PERMIT_BUMPER, ask((argus_mover_t)mover, ARGUS_WANTS_AHEAD, 0));
        TEST_ASSERT_EQUAL_INT(ARGUS_PERMIT_GIVEN, ask((argus_mover_t)mover, ARGUS_WANTS_BACK, 0));
        TEST_ASSERT_EQUAL_INT(ARGUS_PERMIT_BUMPER, ask((argus_mover_t)mover, ARGUS_WANTS_TURN, 1));
    }
    robot.argus.knowledge.bumpers_front = 0;
    robot.argus.knowledge.bumpers_rear = 8;
    for (int mover = 0; mover <= ARGUS_MOVER_CLIENT; mover++) {
        TEST_ASSERT_EQUAL_INT(ARGUS_PERMIT_GIVEN, ask((argus_mover_t)mover, ARGUS_WANTS_AHEAD, 0));
        TEST_ASSERT_EQUAL_INT(ARGUS_PERMIT_BUMPER, ask((argus_mover_t)mover, ARGUS_WANTS_BACK, 0));
        TEST_ASSERT_EQUAL_INT(ARGUS_PERMIT_BUMPER, ask((argus_mover_t)mover, ARGUS_WANTS_TURN, 1));
    }
}

void test_without_a_session_nothing_may(void) {
    robot.argus.session.state = ARGUS_SESSION_SYNC1;
    check_all(ARGUS_PERMIT_NO_ROBOT, ARGUS_PERMIT_NO_ROBOT, ARGUS_PERMIT_NO_ROBOT);
}

// A way that is remembered bars a client's turn only by the rules that remember: the paper's go by what is
// heard.
void test_a_profile_without_memory_asks_the_echoes_of_now(void) {
    const argus_config_t paper = robot_config_of(ARGUS_PROFILE_PAPER);
    robot.argus.rules = argus_profile(&paper);
    TEST_ASSERT_EQUAL(ARGUS_PERMIT_GIVEN, ask(ARGUS_MOVER_CLIENT, ARGUS_WANTS_TURN, 3000));
    for (int i = 0; i < 8; i++) {
        robot.argus.knowledge.sonar[i].reading_mm = 120;
    }
    TEST_ASSERT_NOT_EQUAL(ARGUS_PERMIT_GIVEN, ask(ARGUS_MOVER_CLIENT, ARGUS_WANTS_TURN, 3000));
}
