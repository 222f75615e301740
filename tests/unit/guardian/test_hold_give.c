// SPDX-License-Identifier: MIT
// Rule under attack: what a client wants is given to the robot once and as far as it may be; what the outbox
// has no room for stays due, and looks that a client has not asked for end where they may not be made.
#include "guardian/hold.h"

#include <string.h>

#include "client.h"
#include "health.h"
#include "unity.h"

static robot_t robot;
static client_t client;
static argus_t *core;
static argus_outbox_t out;
static argus_hold_client_t hold;
static argus_grant_t grant;

void setUp(void) {
    robot_in_box(&robot, ARGUS_PROFILE_ARGUS, -4000, -4000, 4000, 4000);
    client_init(&client, &robot);
    client_run(&client, 4000, false);
    client_open(&client);
    client_say(&client, ARCOS_CMD_VEL, 1);
    client_run(&client, 2000, true);
    core = &robot.argus;
    memset(&hold, 0, sizeof hold);
    memset(&out, 0, sizeof out);
    hold.setv_mm_s = 300;
    grant = (argus_grant_t){core, &out, &core->events, &core->motion, &core->knowledge};
}

// The next that goes out: command and argument, -1: nothing.
static int fetch(int32_t *argument) {
    uint8_t packet[ARGUS_PACKET_MAX];
    const size_t count = argus_outbox_fetch(&out, packet, sizeof packet);
    *argument = count == 9 ? (packet[5] | packet[6] << 8) * (packet[4] == ARCOS_ARG_NEGATIVE ? -1 : 1) : 0;
    return count > 0 ? packet[3] : -1;
}

static void expect(int command, int32_t argument) {
    int32_t said = 0;
    TEST_ASSERT_EQUAL(command, fetch(&said));
    TEST_ASSERT_EQUAL_INT32(argument, said);
}

static void expect_nothing(void) {
    int32_t said = 0;
    TEST_ASSERT_EQUAL(-1, fetch(&said));
}

static void fill(void) {
    while (argus_outbox_plain(&out, ARCOS_CMD_PULSE)) {
    }
    out.refused = 0;
}

static void want(argus_wish_way_t way, int32_t mm_s) {
    hold.wish.way = (uint8_t)way;
    hold.wish.mm_s = mm_s;
}

void test_a_speed_is_given_as_a_way_that_is_seen(void) {
    int32_t mm = 0;
    want(ARGUS_WISH_VEL, 250);
    argus_hold_way(&grant, &hold);
    expect(ARCOS_CMD_SETV, 250);
    TEST_ASSERT_EQUAL(ARCOS_CMD_MOVE, fetch(&mm));
    TEST_ASSERT_GREATER_THAN_INT32(1000, mm);
    expect_nothing();
    TEST_ASSERT_TRUE(hold.given.rolls && hold.given.moves);
    TEST_ASSERT_FALSE(hold.way_due);
}

// Nothing is taken for given that did not go out, and all of it goes out with the next SIP.
void test_what_the_outbox_has_no_room_for_stays_due(void) {
    fill();
    want(ARGUS_WISH_VEL, 250);
    argus_hold_way(&grant, &hold);
    TEST_ASSERT_TRUE(hold.way_due);
    TEST_ASSERT_FALSE(hold.given.rolls || hold.given.moves);
    TEST_ASSERT_EQUAL_INT32(0, hold.given.setv_mm_s);
    argus_outbox_clear(&out);
    argus_hold_watch(&grant, &hold);
    TEST_ASSERT_FALSE(hold.way_due);
    TEST_ASSERT_TRUE(hold.given.rolls);
    fill();
    want(ARGUS_WISH_VEL, 0);
    argus_hold_way(&grant, &hold);
    TEST_ASSERT_TRUE(hold.way_due && hold.given.rolls); // a stop that did not go out stops nothing
    argus_outbox_clear(&out);
    argus_hold_watch(&grant, &hold);
    TEST_ASSERT_FALSE(hold.way_due || hold.given.rolls);
}

void test_a_pair_that_has_no_room_stays_due(void) {
    fill();
    hold.wish.paired = true;
    want(ARGUS_WISH_VEL, 200);
    argus_hold_way(&grant, &hold);
    TEST_ASSERT_TRUE(hold.way_due);
    TEST_ASSERT_EQUAL(0, hold.given.right + hold.given.left);
}

// A turn about one wheel rolls, too.
void test_a_pair_with_one_wheel_at_rest_rolls(void) {
    for (int side = -1; side <= 1; side += 2) {
        setUp();
        hold.wish.paired = true;
        want(ARGUS_WISH_VEL, 40);
        hold.wish.half_mm_s = side * 40;
        argus_hold_way(&grant, &hold);
        TEST_ASSERT_EQUAL(side > 0 ? 4 : 0, hold.given.right);
        TEST_ASSERT_EQUAL(side > 0 ? 0 : 4, hold.given.left);
        TEST_ASSERT_TRUE(hold.given.rolls);
    }
}

// A robot without motors has not taken the order: it is given again when they are on.
void test_without_motors_no_way_counts_as_given(void) {
    want(ARGUS_WISH_VEL, 250);
    argus_hold_way(&grant, &hold);
    core->knowledge.flags = (uint16_t)(core->knowledge.flags & ~(unsigned)ARCOS_FLAG_MOTORS);
    argus_hold_watch(&grant, &hold);
    TEST_ASSERT_FALSE(hold.given.moves);
    argus_outbox_clear(&out);
    argus_hold_watch(&grant, &hold); // not each SIP again
    TEST_ASSERT_EQUAL(0, out.length);
    core->knowledge.flags = (uint16_t)(core->knowledge.flags | ARCOS_FLAG_MOTORS);
    argus_hold_watch(&grant, &hold);
    TEST_ASSERT_TRUE(hold.given.moves);
}

void test_a_stall_is_one_stop_and_nothing_is_wanted_any_more(void) {
    want(ARGUS_WISH_VEL, 250);
    argus_hold_way(&grant, &hold);
    argus_outbox_clear(&out);
    core->knowledge.stall_left = true;
    argus_hold_watch(&grant, &hold);
    expect(ARCOS_CMD_STOP, 0);
    TEST_ASSERT_EQUAL(ARGUS_WISH_REST, hold.wish.way);
    argus_hold_watch(&grant, &hold);
    expect_nothing();
}

// ---- looks

void test_a_straight_wish_repeated_does_not_end_the_looks(void) {
    hold.given.weave.side = 1;
    argus_hold_turn(&grant, &hold);
    expect_nothing();
    hold.wish.turn = ARGUS_WISH_RVEL; // another turn does
    hold.wish.deg_s = 10;
    argus_hold_turn(&grant, &hold);
    expect(ARCOS_CMD_RVEL, 10);
}

// The heading is turned back to where it was; where that may not be, the turn is ended.
void test_looks_end_on_the_heading_that_they_began_on(void) {
    want(ARGUS_WISH_VEL, 0);
    hold.given.weave.side = 1;
    hold.given.base_cdeg = core->knowledge.pose.heading_cdeg + 900;
    argus_hold_watch(&grant, &hold);
    int32_t deg = 0;
    TEST_ASSERT_EQUAL(ARCOS_CMD_HEAD, fetch(&deg));
    TEST_ASSERT_INT_WITHIN(1, 9, deg);
    TEST_ASSERT_EQUAL(0, hold.given.weave.side);
}

void test_looks_that_may_not_be_made_are_ended_where_the_heading_is(void) {
    want(ARGUS_WISH_VEL, 0);
    hold.given.weave.side = 1;
    hold.given.base_cdeg = core->knowledge.pose.heading_cdeg + 900;
    core->orders.stay = ARGUS_STAY_OPERATOR;
    argus_hold_watch(&grant, &hold);
    int32_t deg_s = 0;
    int orders = 0;
    for (int command = fetch(&deg_s); command >= 0; command = fetch(&deg_s), orders++) {
        TEST_ASSERT_EQUAL(ARCOS_CMD_RVEL, command);
        TEST_ASSERT_EQUAL_INT32(0, deg_s);
    }
    TEST_ASSERT_GREATER_THAN(0, orders);
    TEST_ASSERT_EQUAL(0, hold.given.weave.side);
    argus_hold_watch(&grant, &hold);
    expect_nothing();
}

void test_a_pair_or_a_turn_ends_the_looks_without_another_order(void) {
    for (int paired = 0; paired < 2; paired++) {
        setUp();
        hold.given.weave.side = 1;
        hold.given.base_cdeg = core->knowledge.pose.heading_cdeg + 900;
        hold.wish.paired = paired != 0;
        hold.wish.turn = paired != 0 ? ARGUS_WISH_STRAIGHT : ARGUS_WISH_RVEL;
        argus_hold_watch(&grant, &hold);
        TEST_ASSERT_EQUAL(0, hold.given.weave.side);
        int32_t deg = 0;
        for (int command = fetch(&deg); command >= 0; command = fetch(&deg)) {
            TEST_ASSERT_NOT_EQUAL(ARCOS_CMD_HEAD, command);
        }
    }
}

// ---- what is given stays while it may

static int32_t bound_with_ahead_mm(int32_t mm) {
    for (int i = 0; i < core->knowledge.sonars; i++) {
        if (argus_robot_looks_ahead(core->knowledge.robot, i)) {
            core->knowledge.sonar[i].reading_mm = (uint16_t)mm;
            core->knowledge.sonar[i].odometer_mm = core->knowledge.odometer_mm;
        }
    }
    return argus_bound_way(core, true).speed_mm_s;
}

// Raised in steps only, and lowered only where it must be.
void test_a_speed_between_two_steps_is_kept_where_it_is_within_the_bound(void) {
    int32_t most_mm_s = 0;
    for (int32_t mm = 900; most_mm_s % 25 < 2; mm += 10) {
        most_mm_s = bound_with_ahead_mm(mm);
        TEST_ASSERT_GREATER_THAN_INT32(25, most_mm_s);
    }
    for (int32_t has_mm_s = most_mm_s - 1; has_mm_s <= most_mm_s + 1; has_mm_s++) {
        hold.setv_mm_s = 1000;
        want(ARGUS_WISH_VEL, most_mm_s + 50);
        hold.given.mm_s = has_mm_s;
        argus_hold_way(&grant, &hold);
        TEST_ASSERT_EQUAL_INT32(has_mm_s <= most_mm_s ? has_mm_s : most_mm_s / 25 * 25, hold.given.mm_s);
    }
}

void test_a_pair_goes_out_again_where_one_wheel_alone_is_another(void) {
    hold.wish.paired = true;
    want(ARGUS_WISH_VEL, 200);
    argus_hold_way(&grant, &hold);
    TEST_ASSERT_EQUAL(10, hold.given.left);
    argus_outbox_clear(&out);
    argus_hold_watch(&grant, &hold);
    TEST_ASSERT_EQUAL(0, out.length);
    hold.wish.mm_s = 190;
    hold.wish.half_mm_s = 10;
    argus_hold_watch(&grant, &hold);
    TEST_ASSERT_EQUAL(ARCOS_CMD_VEL2, out.bytes[3]);
    TEST_ASSERT_EQUAL(10, hold.given.right);
    TEST_ASSERT_EQUAL(9, hold.given.left);
}

// A robot that turns about one wheel does something; one that stands for long has lost its order.
void test_an_order_is_lost_where_both_wheels_rest(void) {
    static const int wheels_mm_s[][2] = {{0, 0}, {0, 60}, {60, 0}};
    for (int i = 0; i < 3; i++) {
        setUp();
        want(ARGUS_WISH_VEL, 250);
        argus_hold_way(&grant, &hold);
        argus_outbox_clear(&out);
        core->knowledge.vel_left_mm_s = (int16_t)wheels_mm_s[i][0];
        core->knowledge.vel_right_mm_s = (int16_t)wheels_mm_s[i][1];
        hold.given.move_ms = core->now_ms - 5000;
        argus_hold_watch(&grant, &hold);
        TEST_ASSERT_EQUAL(i == 0, out.length > 0);
    }
}

static void want_move(int32_t mm) {
    hold.wish.way = ARGUS_WISH_MOVE;
    hold.wish.left_mm = mm;
    hold.wish.odometer_mm = core->knowledge.odometer_mm;
}

void test_a_move_of_nothing_stands(void) {
    want_move(0);
    argus_hold_way(&grant, &hold);
    expect(ARCOS_CMD_VEL, 0);
    expect_nothing();
}

// What of a MOVE is left when its way was closed is given when that is open again.
void test_a_move_goes_on_where_the_way_opens_again(void) {
    want_move(1000);
    argus_hold_way(&grant, &hold);
    TEST_ASSERT_TRUE(hold.given.moves);
    bound_with_ahead_mm(core->config.object_range_mm);
    argus_hold_watch(&grant, &hold);
    TEST_ASSERT_FALSE(hold.given.rolls || hold.given.moves);
    argus_outbox_clear(&out);
    bound_with_ahead_mm(3000);
    argus_hold_watch(&grant, &hold);
    TEST_ASSERT_TRUE(hold.given.rolls && hold.given.moves);
    int32_t mm = 0;
    TEST_ASSERT_EQUAL(ARCOS_CMD_MOVE, fetch(&mm));
    TEST_ASSERT_EQUAL_INT32(1000, mm);
}

// A way that slanted into a wall is closed as long as the robot has neither gone from there nor turned away.
void test_another_heading_is_another_way_than_the_one_that_slanted(void) {
    for (int32_t turned_cdeg = -400; turned_cdeg <= 400; turned_cdeg += 100) {
        setUp();
        hold.given.slanted = true;
        hold.given.slant_mm = core->knowledge.odometer_mm;
        hold.given.slant_cdeg = core->knowledge.pose.heading_cdeg - turned_cdeg;
        want(ARGUS_WISH_VEL, 200);
        argus_hold_way(&grant, &hold);
        TEST_ASSERT_EQUAL(turned_cdeg < -300 || turned_cdeg > 300, hold.given.rolls);
    }
}

// A turn that was ended is not ended with each SIP again.
void test_a_look_that_stays_held_is_ended_once(void) {
    put_health(&core->knowledge.sonar[3], ARGUS_DISABLED, ARGUS_KIND_OFF, core->now_ms);
    want(ARGUS_WISH_VEL, 200);
    core->knowledge.bumpers_rear = 4; // no turn, and the way ahead is open
    hold.given.bumpers = 0xFFFF;
    int ends = 0;
    for (int i = 0; i < 5; i++) {
        argus_hold_watch(&grant, &hold);
        int32_t deg_s = 0;
        for (int command = fetch(&deg_s); command >= 0; command = fetch(&deg_s)) {
            ends += command == ARCOS_CMD_RVEL && deg_s == 0;
            TEST_ASSERT_NOT_EQUAL(ARCOS_CMD_HEAD, command);
        }
    }
    TEST_ASSERT_EQUAL(1, ends);
    TEST_ASSERT_NOT_EQUAL(0, hold.given.weave.side);
}
