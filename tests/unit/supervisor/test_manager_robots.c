// SPDX-License-Identifier: MIT
// Rule under attack: robots and emulators that differ from a P3-DX in what they report, in what they answer,
// or in what they obey are driven safely all the same, or not at all.
#include "supervisor/manager.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "knowledge/config.h"
#include "robot.h"
#include "unity.h"

static robot_t robot;
static char message[200];

static void start(void) {
    argus_config_t config = robot_config();
    config.baud = 0;
    robot_init(&robot, &config, 0xFFFFF000u); // the clock wraps
}

static void start_idle(void) {
    start();
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_IDLE, 8000));
}

static void start_driving(void) {
    start_idle();
    TEST_ASSERT_TRUE(robot_goal(&robot, 4000, 0));
    TEST_ASSERT_TRUE(robot_until_mode(&robot, ARGUS_MODE_DRIVING, 5000));
    robot_run(&robot, 2000);
}

static uint32_t now(void) {
    return robot.start_ms + robot.t_ms;
}

static double pose_error_mm(void) {
    return hypot(robot.argus.knowledge.pose.x_mm - robot.x, robot.argus.knowledge.pose.y_mm - robot.y);
}

static void finish(const char *name) {
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", robot.violation, name);
    TEST_ASSERT_EQUAL_MESSAGE(0, robot.argus.session.outbox.refused, name);
    TEST_ASSERT_EQUAL_MESSAGE(0, robot.argus.session.parser.bad_checksums, name);
}

// ------------------------------------------------------------------------------------------------ the script

static size_t after_readings(const uint8_t *data) {
    return 20 + 3 * (size_t)data[19];
}

static size_t always_at_rest(uint8_t *data, size_t count) {
    data[0] = 0x32;
    return count;
}

static size_t end_at_digout(uint8_t *data, size_t count) {
    (void)count;
    return after_readings(data) + 5;
}

static size_t end_at_charge(uint8_t *data, size_t count) {
    (void)count;
    return after_readings(data) + 8;
}

static size_t end_at_readings(uint8_t *data, size_t count) {
    (void)count;
    return after_readings(data);
}

static size_t longer_tail(uint8_t *data, size_t count) {
    memset(data + count, 0xFB, 12);
    return count + 12;
}

// Rings beyond the sixteen we know, and all of them see something quite near.
static size_t add_readings(uint8_t *data, size_t count, unsigned upto) {
    const size_t at = after_readings(data);
    const size_t more = 3 * (size_t)(upto - 16);
    memmove(data + at + more, data + at, count - at);
    for (unsigned k = 16; k < upto; k++) {
        uint8_t *reading = data + at + (size_t)3 * (k - 16);
        reading[0] = (uint8_t)k;
        reading[1] = 120;
        reading[2] = 0;
    }
    data[19] = (uint8_t)(data[19] + upto - 16);
    return count + more;
}

static size_t with_24_sonars(uint8_t *data, size_t count) {
    return add_readings(data, count, 24);
}

static size_t with_32_sonars(uint8_t *data, size_t count) {
    return add_readings(data, count, 32);
}

static size_t keep_readings(uint8_t *data, size_t count, unsigned below) {
    uint8_t tail[ROBOT_SIP_MAX];
    const size_t at = after_readings(data);
    const size_t readings = data[19];
    size_t kept = 0;
    memcpy(tail, data + at, count - at);
    for (size_t k = 0; k < readings; k++) {
        if (data[20 + 3 * k] < below) {
            memmove(data + 20 + 3 * kept++, data + 20 + 3 * k, 3);
        }
    }
    data[19] = (uint8_t)kept;
    memcpy(data + 20 + 3 * kept, tail, count - at);
    return 20 + 3 * kept + count - at;
}

static size_t with_8_sonars(uint8_t *data, size_t count) {
    return keep_readings(data, count, 8);
}

static size_t with_no_sonars(uint8_t *data, size_t count) {
    return keep_readings(data, count, 0);
}

static void mix_in_lasers(robot_t *r) {
    uint8_t data[ROBOT_SIP_MAX];
    for (unsigned type = 0x60; type <= 0x96; type += 0x36) {
        for (size_t i = 0; i < sizeof data; i++) {
            data[i] = (uint8_t)(i * 7 + r->sips);
        }
        data[0] = (uint8_t)type;
        robot_say(r, data, 20 + robot_random(r, sizeof data - 20));
    }
}

static void mix_in_unknown(robot_t *r) {
    uint8_t data[40] = {0};
    do {
        data[0] = (uint8_t)robot_random(r, 0xFE); // two reset notices are left
    } while (data[0] == 0x32 || data[0] == 0x33);
    data[1] = (uint8_t)robot_random(r, 256);
    robot_say(r, data, 1 + robot_random(r, sizeof data));
}

static void say_config_early(robot_t *r) {
    if (r->sips < 3) {
        robot_say(r, r->config, r->config_count);
    }
}

static const uint8_t config_whole[] =
    "\x20Pioneer\0p3dx-sh\0P3DX0001\0\0h\x01\xDC\x05,\x01\xD0\x07\xF4\x01P3DX_0001\0d\0\0\0\0\x01"
    "\0\x01s\0\xBA@\xD0\x07\0\xC8\0d\0\xEE\x02"
    "2\0d\0\xEE\x02"
    "d\0d\0(\0\x14\0\0\0,\x01,\x01(\0\x1E"
    "\0\0\0\0\0\0(\x02\0\0\0\0\0\x80\0n\0"
    "2.6\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0";

typedef struct {
    const char *name;
    size_t (*alter_sip)(uint8_t *data, size_t count);
    void (*before_sip)(robot_t *robot);
    size_t config_count; // 0: none
    uint16_t position_mask;
    const char *subclass;
    bool lists_all;
} script_t;

static const script_t scripts[] = {
    {"only new readings", NULL, NULL, 0, 0, NULL, false},
    {"all 16 in every SIP", NULL, NULL, 0, 0, NULL, true},
    {"type always 0x32", always_at_rest, NULL, 0, 0, NULL, false},
    {"type always 0x32, all 16", always_at_rest, NULL, 0, 0, NULL, true},
    {"15-bit positions", NULL, NULL, 0, 0x7FFF, NULL, false},
    {"tail ends at DIGOUT", end_at_digout, NULL, 0, 0, NULL, false},
    {"tail ends at CHARGESTATE", end_at_charge, NULL, 0, 0, NULL, true},
    {"no tail", end_at_readings, NULL, 0, 0, NULL, false},
    {"longer tail", longer_tail, NULL, 0, 0, NULL, false},
    {"8 sonars", with_8_sonars, NULL, 0, 0, NULL, false},
    {"24 sonars", with_24_sonars, NULL, 0, 0, NULL, false},
    {"32 sonars, all", with_32_sonars, NULL, 0, 0, NULL, true},
    {"laser packets", NULL, mix_in_lasers, 0, 0, NULL, false},
    {"unknown packets", NULL, mix_in_unknown, 0, 0, NULL, false},
    {"CONFIGpac whole", NULL, NULL, sizeof config_whole - 1 - 12, 0, NULL, false},
    {"CONFIGpac with what newer robots append", NULL, NULL, sizeof config_whole - 1, 0, NULL, false},
    {"CONFIGpac cut inside a word", NULL, NULL, 60, 0, NULL, false},
    {"CONFIGpac cut inside its name", NULL, NULL, 42, 0, NULL, false},
    {"CONFIGpac without its strings", NULL, NULL, 10, 0, NULL, false},
    {"CONFIGpac again and again", NULL, say_config_early, sizeof config_whole - 1, 0, NULL, false},
    {"subclass in capitals", NULL, NULL, 0, 0, "P3DX-SH", false},
};

static void follow(const script_t *script) {
    start();
    robot.alter_sip = script->alter_sip;
    robot.before_sip = script->before_sip;
    robot.config = script->config_count > 0 ? config_whole : NULL;
    robot.config_count = script->config_count;
    robot.position_mask = script->position_mask != 0 ? script->position_mask : robot.position_mask;
    robot.subclass = script->subclass != NULL ? script->subclass : robot.subclass;
    robot.lists_all = script->lists_all;
}

// A build that manages more sonars than a P3-DX has sees that this is none.
static bool more_than_a_p3dx_has(const script_t *script) {
    return ARGUS_SONARS > 16 && (script->alter_sip == with_24_sonars || script->alter_sip == with_32_sonars);
}

// A wrong sonar must be found and the goal behind a turn reached, in failure mode, for every script.
void test_every_scripted_robot_is_diagnosed_and_driven(void) {
    for (size_t i = 0; i < sizeof scripts / sizeof scripts[0]; i++) {
        follow(&scripts[i]);
        if (more_than_a_p3dx_has(&scripts[i])) {
            continue; // waits for an operator: below
        }
        robot.x = robot.x0 = -200; // 15-bit positions wrap at zero
        robot.fault[4] = ROBOT_SCALE;
        robot.fault_value[4] = 50;
        TEST_ASSERT_TRUE(robot_goal(&robot, -300, -400));
        snprintf(message, sizeof message, "%s", scripts[i].name);
        const bool reached = robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 150000);
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", robot.violation, message);
        TEST_ASSERT_TRUE_MESSAGE(reached, message);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(1u << 4, argus_disabled(&robot.argus.knowledge), message);
        TEST_ASSERT_TRUE_MESSAGE(hypot(robot.x + 500, robot.y + 400) <= 150, message);
        TEST_ASSERT_EQUAL_MESSAGE(1, robot_count_events(&robot, ARGUS_EV_SESSION_OPEN, 0), message);
        TEST_ASSERT_EQUAL_MESSAGE(0, robot_count_events(&robot, ARGUS_EV_SUBCLASS_UNKNOWN, 0), message);
        TEST_ASSERT_EQUAL_MESSAGE(0, robot_count_events(&robot, ARGUS_EV_LINK_STALLED, 0), message);
        finish(message);
    }
}

void test_a_configpac_before_open_does_no_harm(void) {
    for (int when = 0; when < 4; when++) {
        start();
        robot.config = config_whole;
        robot.config_count = sizeof config_whole - 1;
        robot.config_before_sync2 = when % 2 == 0;
        robot.config_after_sync2 = when % 2 == 1;
        robot.ignores[ARCOS_CMD_CONFIG] = when < 2;
        TEST_ASSERT_TRUE(robot_goal(&robot, 400, 0));
        TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000));
        TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_SESSION_OPEN, 0));
        TEST_ASSERT_EQUAL(when != 0, robot.argus.session.has_robot);
        finish("CONFIGpac early");
    }
}

void test_a_robot_without_sonars_is_never_driven(void) {
    start();
    robot.alter_sip = with_no_sonars;
    TEST_ASSERT_TRUE(robot_goal(&robot, 1000, 0));
    robot_run(&robot, 60000);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, 0));
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_SESSION_OPEN, 0));
    TEST_ASSERT_EQUAL_HEX16(0x7E, argus_disabled(&robot.argus.knowledge));
    finish("no sonars");
}

void test_an_array_that_is_never_listed_is_absent(void) {
    start();
    robot.argus.config.profile = ARGUS_PROFILE_ARGUS;
    robot.argus.rules = argus_profile(&robot.argus.config);
    robot.alter_sip = with_8_sonars;
    TEST_ASSERT_TRUE(robot_goal(&robot, 2000, 0));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000));
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_SONAR_DISABLED, 0));
    for (int sonar = 8; sonar < 16; sonar++) {
        TEST_ASSERT_EQUAL(ARGUS_ABSENT, robot.argus.knowledge.sonar[sonar].health);
    }
    robot.alter_sip = NULL; // it was switched off
    TEST_ASSERT_TRUE(robot_goal(&robot, -2000, 0));
    robot_run(&robot, 60000);
    TEST_ASSERT_EQUAL_HEX16(0, argus_with_health(&robot.argus.knowledge, ARGUS_ABSENT));
    finish("no rear array");
}

static void expect_no_motion(const char *name) {
    TEST_ASSERT_EQUAL_MESSAGE(0, robot_count_commands(&robot, ARCOS_CMD_ENABLE, 0), name);
    TEST_ASSERT_EQUAL_MESSAGE(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, 0), name);
    TEST_ASSERT_EQUAL_MESSAGE(0, robot_count_commands(&robot, ARCOS_CMD_HEAD, 0), name);
}

void test_an_unknown_subclass_is_said_once_and_never_moved(void) {
    static const char *const names[] = {"powerbot-sh", "seekur", "", "p3dx-shx", "p3at", "amigo"};
    for (size_t i = 0; i < 2 * sizeof names / sizeof names[0]; i++) {
        const char *name = names[i / 2];
        start();
        robot.argus.config.profile = i % 2 == 0 ? ARGUS_PROFILE_PAPER : ARGUS_PROFILE_ARGUS;
        robot.argus.rules = argus_profile(&robot.argus.config);
        robot.subclass = name;
        TEST_ASSERT_TRUE_MESSAGE(robot_goal(&robot, 600, 0), name);
        robot_run(&robot, 20000);
        TEST_ASSERT_EQUAL_MESSAGE(1, robot_count_events(&robot, ARGUS_EV_SUBCLASS_UNKNOWN, 0), name);
        TEST_ASSERT_EQUAL_MESSAGE(0, robot_count_events(&robot, ARGUS_EV_SONAR_DISABLED, 0), name);
        TEST_ASSERT_EQUAL_MESSAGE(0, robot_count_events(&robot, ARGUS_EV_GOAL_REACHED, 0), name);
        for (int sonar = 0; sonar < ARGUS_SONARS; sonar++) {
            TEST_ASSERT_EQUAL_MESSAGE(ARGUS_ABSENT, robot.argus.knowledge.sonar[sonar].health, name);
        }
        argus_operator(&robot.argus, now(), ARGUS_OP_ACTIVE, 0); // that does not say what body it is
        robot_run(&robot, 10000);
        TEST_ASSERT_EQUAL_MESSAGE(2, robot_count_events(&robot, ARGUS_EV_SUBCLASS_UNKNOWN, 0), name);
        expect_no_motion(name);
        finish(name);
    }
}

void test_no_p3dx_is_one_that_lists_more_sonars(void) {
    for (size_t i = 0; i < sizeof scripts / sizeof scripts[0]; i++) {
        if (!more_than_a_p3dx_has(&scripts[i])) {
            continue;
        }
        follow(&scripts[i]);
        TEST_ASSERT_TRUE(robot_goal(&robot, 600, 0));
        robot_run(&robot, 20000);
        TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_SONARS_BEYOND, 0));
        TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, 0));
        TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_HEAD, 0));
        finish(scripts[i].name);
    }
}

void test_a_robot_that_lists_what_its_subclass_lacks_waits_for_an_operator(void) {
    start();
    robot.subclass = "amigo-sh"; // which has eight
    TEST_ASSERT_TRUE(robot_goal(&robot, 600, 0));
    robot_run(&robot, 20000);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_SONARS_BEYOND, 0));
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, 0));
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_HEAD, 0));
    argus_operator(&robot.argus, now(), ARGUS_OP_ACTIVE, 0);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000));
    finish("sixteen of eight");
}

void test_the_operator_says_which_body_it_is(void) {
    static const char *const names[] = {"powerbot-sh", "", "p3at-sh"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        start();
        robot.subclass = names[i];
        robot.argus.config.robot = argus_robot_choice(argus_robot_default());
        TEST_ASSERT_TRUE_MESSAGE(robot_goal(&robot, 600, 0), names[i]);
        TEST_ASSERT_TRUE_MESSAGE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000), names[i]);
        TEST_ASSERT_EQUAL_MESSAGE(0, robot_count_events(&robot, ARGUS_EV_SUBCLASS_UNKNOWN, 0), names[i]);
        TEST_ASSERT_TRUE_MESSAGE(hypot(robot.x - 600, robot.y) <= 150, names[i]);
        finish(names[i]);
    }
}

// Another robot than before waits for an operator, as any other one does.
void test_a_known_robot_after_an_unknown_one_drives_on_order(void) {
    start();
    robot.subclass = "seekur";
    TEST_ASSERT_TRUE(robot_goal(&robot, 600, 0));
    robot_run(&robot, 5000);
    expect_no_motion("seekur");
    argus_link_lost(&robot.argus, now());
    robot.subclass = "p3dx-sh";
    argus_link_up(&robot.argus, now());
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_OTHER_ROBOT, 10000));
    robot_run(&robot, 5000);
    expect_no_motion("seekur, then p3dx-sh");
    argus_operator(&robot.argus, now(), ARGUS_OP_ACTIVE, 0);
    argus_operator(&robot.argus, now(), ARGUS_OP_GO, 0);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000));
    finish("seekur, then p3dx-sh");
}

static void start_with(const argus_config_t *config) {
    robot_init(&robot, config, 1000);
}

static void expect_failed(argus_bar_t bar) {
    argus_status_t status;
    argus_status(&robot.argus, &status);
    TEST_ASSERT_EQUAL(ARGUS_MISSION_FAILED, status.mission);
    TEST_ASSERT_EQUAL(bar, status.bar);
}

// S5 for the body that answers, of settings that are given: a P3-DX stops in time from 200 mm/s at 9600 baud,
// a PeopleBot has more before its sonars. The course fails, and again when it is started anew.
void test_settings_that_are_unsafe_for_the_robot_bar_it(void) {
    argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    config.baud = 9600;
    config.speed_mm_s = 200;
    config.object_range_mm = 250;
    TEST_ASSERT_EQUAL(ARGUS_CONFIG_OK, argus_config_check(&config).fault);
    start_with(&config);
    robot.subclass = "peoplebot-sh";
    TEST_ASSERT_TRUE(robot_goal(&robot, 600, 0));
    robot_run(&robot, 10000);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_ROBOT_UNSAFE, 0));
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_MISSION_FAILED, 0));
    expect_failed(ARGUS_BAR_UNSAFE);
    argus_operator(&robot.argus, now(), ARGUS_OP_GO, 0);
    robot_run(&robot, 2000);
    expect_failed(ARGUS_BAR_UNSAFE);
    TEST_ASSERT_TRUE(robot_goal(&robot, 500, 0));
    robot_run(&robot, 2000);
    expect_failed(ARGUS_BAR_UNSAFE);
    TEST_ASSERT_EQUAL(ARGUS_SONARS < 32, robot_count_events(&robot, ARGUS_EV_SONARS_BEYOND, 0));
    expect_no_motion("peoplebot-sh");
    finish("peoplebot-sh");
}

// With the settings as they are built every robot drives, at any rate of its line, and so does its other end.
void test_the_built_settings_are_safe_for_every_robot(void) {
    static const int32_t bauds[] = {0, 9600, 19200, 38400, 57600, 115200};
    for (size_t i = 0; i < 2 * sizeof bauds / sizeof bauds[0]; i++) {
        for (int k = 1; k <= ARGUS_ROBOTS; k++) {
            argus_config_t config = robot_config_of((int32_t)(i % 2));
            config.baud = bauds[i / 2];
            config.robot = k;
            const argus_config_report_t report = argus_config_check(&config);
            TEST_ASSERT_EQUAL_MESSAGE(ARGUS_CONFIG_OK, report.fault, argus_robot_chosen(k)->name);
            TEST_ASSERT_EQUAL_MESSAGE(200, report.speed_mm_s, argus_robot_chosen(k)->name);
            const argus_robot_t *const other = argus_robot_other_end(argus_robot_chosen(k));
            argus_config_follow(&config, argus_config_follows(&config), argus_robot_chosen(k));
            TEST_ASSERT_TRUE(other == NULL ||
                             argus_config_check_for(&config, other).fault == ARGUS_CONFIG_OK);
        }
    }
}

// What is asked of the manager follows the robot that answers, and the next one.
void test_settings_follow_the_robot_that_answers(void) {
    argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    start_with(&config);
    robot.subclass = "peoplebot-sh";
    TEST_ASSERT_EQUAL(250, robot.argus.config.object_range_mm);
    TEST_ASSERT_TRUE(robot_goal(&robot, 600, 0));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000));
    TEST_ASSERT_EQUAL(300, robot.argus.config.object_range_mm);
    argus_link_lost(&robot.argus, now());
    robot.subclass = "p3dx-sh";
    argus_link_up(&robot.argus, now());
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_OTHER_ROBOT, 10000));
    TEST_ASSERT_EQUAL(250, robot.argus.config.object_range_mm);
    finish("peoplebot-sh, then p3dx-sh");
}

// The speed follows a range that is given, and a range that no speed is slow enough for is refused.
void test_the_speed_follows_the_range_that_is_given(void) {
    argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    int32_t before_mm_s = 30;
    for (config.object_range_mm = 150; config.object_range_mm <= 400; config.object_range_mm += 10) {
        const argus_config_report_t report = argus_config_check(&config);
        TEST_ASSERT_EQUAL(ARGUS_CONFIG_OK, report.fault);
        TEST_ASSERT_TRUE(report.speed_mm_s >= before_mm_s && report.speed_mm_s <= 200);
        TEST_ASSERT_EQUAL(config.object_range_mm, report.object_range_mm);
        before_mm_s = report.speed_mm_s;
    }
    TEST_ASSERT_EQUAL(200, before_mm_s);
    config.object_range_mm = 150;
    config.sonar_cycle_ms = 120;
    config.decel_mm_s2 = 50;
    config.robot = argus_robot_choice(argus_robot_find("peoplebot-sh"));
    config.baud = 1200;
    TEST_ASSERT_EQUAL(ARGUS_CONFIG_DRIVING, argus_config_check(&config).fault);
}

// The AmigoBot has eight sonars: the others are absent, whatever is listed, and none of them is given up.
void test_a_sonar_that_the_robot_has_not_got_is_absent(void) {
    for (int profile = 0; profile < 2; profile++) {
        start();
        robot.argus.config.profile = profile;
        robot.argus.rules = argus_profile(&robot.argus.config);
        robot.subclass = "amigo-sh";
        robot_run(&robot, 20000);
        argus_status_t status;
        argus_status(&robot.argus, &status);
        TEST_ASSERT_EQUAL(8, status.sonars);
        for (int i = 0; i < ARGUS_SONARS; i++) {
            TEST_ASSERT_EQUAL(i >= 8, status.health[i] == ARGUS_ABSENT);
            TEST_ASSERT_TRUE(i < 8 || (status.age_ms[i] == UINT32_MAX && status.reading_mm[i] == 0));
            TEST_ASSERT_FALSE(i >= 8 && argus_operator(&robot.argus, now(), ARGUS_OP_RETEST, i));
        }
        TEST_ASSERT_EQUAL(0, argus_out(&robot.argus.knowledge) >> 8);
        for (int i = 0; i < robot.events; i++) {
            TEST_ASSERT_TRUE(robot.event[i].sonar < 8);
        }
        finish("amigo-sh");
    }
}

// ------------------------------------------------------------------------------------------------
// disobedience

// Whatever one command does not do: no flood of packets, nothing refused, no rule broken.
void test_a_robot_that_ignores_any_one_command_is_not_flooded(void) {
    static const uint8_t commands[] = {
        ARCOS_CMD_POLLING, ARCOS_CMD_ENABLE,      ARCOS_CMD_SETA, ARCOS_CMD_SETV,  ARCOS_CMD_MOVE,
        ARCOS_CMD_SETRV,   ARCOS_CMD_VEL,         ARCOS_CMD_HEAD, ARCOS_CMD_RVEL,  ARCOS_CMD_SETRA,
        ARCOS_CMD_SONAR,   ARCOS_CMD_SONAR_CYCLE, ARCOS_CMD_STOP, ARCOS_CMD_E_STOP};
    for (size_t i = 0; i < 2 * sizeof commands; i++) {
        start();
        robot.ignores[commands[i / 2]] = true;
        robot.fault[2] = i % 2 == 1 ? ROBOT_SCALE : ROBOT_OK; // so that it turns, polls and steps, or drives
        robot.fault_value[2] = 50;
        TEST_ASSERT_TRUE(robot_goal(&robot, 900, 900));
        robot_run(&robot, 60000);
        snprintf(message, sizeof message, "ignores command %d: %d packets, %d events, mode %s",
                 commands[i / 2], robot.commands, robot.events,
                 argus_name(ARGUS_NAME_MODE, robot.argus.mode));
        TEST_ASSERT_LESS_THAN_MESSAGE(60 * 8, robot.commands, message);
        TEST_ASSERT_LESS_THAN_MESSAGE(60 * 5, robot.events, message);
        TEST_ASSERT_EQUAL_MESSAGE(1, robot_count_events(&robot, ARGUS_EV_SESSION_OPEN, 0), message);
        finish(message);
    }
}

void test_head_never_executed_is_said_and_waited_for(void) {
    start_idle();
    robot.ignores[ARCOS_CMD_HEAD] = true;
    TEST_ASSERT_TRUE(robot_goal(&robot, 0, 1000));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_TURN_FAILED, 20000));
    TEST_ASSERT_EQUAL(ARGUS_MODE_WAITING, robot.argus.mode);
    robot_run(&robot, 60000);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, 0));
    TEST_ASSERT_LESS_THAN(40, robot_count_commands(&robot, ARCOS_CMD_HEAD, 0));
    TEST_ASSERT_LESS_THAN(40, robot_count_events(&robot, ARGUS_EV_TURN_FAILED, 0));
    finish("HEAD ignored");
}

void test_move_ignored_is_not_repeated_without_end(void) {
    start_idle();
    robot.ignores[ARCOS_CMD_MOVE] = true;
    TEST_ASSERT_TRUE(robot_goal(&robot, 1000, 0));
    robot_run(&robot, 60000);
    const int moves = robot_count_commands(&robot, ARCOS_CMD_MOVE, 0);
    snprintf(message, sizeof message, "%d times MOVE in 60 s", moves);
    TEST_ASSERT_TRUE_MESSAGE(moves >= 1 && moves < 360, message);
    TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_WAITING, 0) >= 1);
    TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_STOP, 0) >= 1);
    robot.ignores[ARCOS_CMD_MOVE] = false;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000));
    finish("MOVE ignored");
}

// What it stands for after a MOVE that has ended is no disobedience.
void test_a_move_that_ended_long_ago_is_no_disobedience(void) {
    start_idle();
    argus_operator(&robot.argus, now(), ARGUS_OP_MOVE, 100);
    robot_run(&robot, 20000);
    TEST_ASSERT_TRUE(robot.x > 80);
    TEST_ASSERT_TRUE(robot_goal(&robot, 1000, 0));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 20000));
    TEST_ASSERT_EQUAL(0, robot_count_events(&robot, ARGUS_EV_WAITING, 0));
    finish("jog, then course");
}

// ------------------------------------------------------------------------------------------------ buttons

void test_e_stop_pressed_and_released(void) {
    start_driving();
    robot.stop_button = true;
    robot.motors = false;
    const int from = robot.commands;
    robot_run(&robot, 5000);
    const argus_event_t *off = robot_last_event(&robot, ARGUS_EV_MOTORS_OFF);
    TEST_ASSERT_NOT_NULL(off);
    TEST_ASSERT_TRUE((off->value & ARCOS_FLAG_ESTOP) != 0);
    TEST_ASSERT_EQUAL(ARGUS_MODE_WAITING, robot.argus.mode);
    robot.stop_button = false; // released: the motors stay off until somebody enables them
    robot_run(&robot, 5000);
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_MOVE, from));
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_HEAD, from));
    TEST_ASSERT_EQUAL(0, robot_count_commands(&robot, ARCOS_CMD_ENABLE, from));
    argus_operator(&robot.argus, now(), ARGUS_OP_GO, 0);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000));
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_MOTORS_ON, 0));
    finish("E-stop");
}

// ------------------------------------------------------------------------------------------------ gaps

static void expect_zeros_first(int from) {
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_TRUE(from + i < robot.commands);
        TEST_ASSERT_EQUAL(i == 0 ? ARCOS_CMD_VEL : ARCOS_CMD_RVEL, robot.command[from + i].command);
        TEST_ASSERT_TRUE(robot.command[from + i].has_argument);
        TEST_ASSERT_EQUAL(0, robot.command[from + i].argument);
    }
}

static const uint8_t vel_0[] = {0xFA, 0xFB, 6, 11, 0x3B, 0, 0, 11, 0x3B};

void test_sips_that_stall_for_3_s_end_in_a_full_check(void) {
    for (uint32_t offset = 0; offset < 100; offset += 10) {
        start_driving();
        robot_run(&robot, offset);
        robot.mute = true;
        robot_run(&robot, 3000);
        TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_LINK_STALLED, 0));
        TEST_ASSERT_TRUE(robot_count_commands(&robot, ARCOS_CMD_STOP, 0) >= 1);
        const int from = robot.commands;
        const int checks = robot_count_events(&robot, ARGUS_EV_HEALTH_CHECK, 0);
        robot.mute = false;
        TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_LINK_RESUMED, 200));
        TEST_ASSERT_INT_WITHIN(120, 3000, robot_last_event(&robot, ARGUS_EV_LINK_RESUMED)->value);
        int at = from; // what was said before the SIP came is still part of the gap
        while (at < robot.commands && (robot.command[at].command == ARCOS_CMD_STOP ||
                                       robot.command[at].command == ARCOS_CMD_PULSE)) {
            at++;
        }
        TEST_ASSERT_TRUE(at - from <= 2);
        expect_zeros_first(at);
        TEST_ASSERT_EQUAL_MEMORY(vel_0, robot.reply, sizeof vel_0);
        TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000));
        TEST_ASSERT_TRUE(robot_count_events(&robot, ARGUS_EV_HEALTH_CHECK, 0) > checks);
        TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_SESSION_OPEN, 0));
        finish("stall");
    }
}

// Our own host stands still: the robot goes on, and its SIPs are read in one go. No timer saw the gap.
void test_our_own_host_suspended_for_3_s_is_a_gap_too(void) {
    start_driving();
    robot.host_asleep = true;
    robot_run(&robot, 3000);
    const int from = robot.commands;
    const uint32_t sips = robot.argus.session.sips;
    robot.checked = false;
    robot_wake(&robot);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_LINK_STALLED, 0));
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_LINK_RESUMED, 0));
    TEST_ASSERT_INT_WITHIN(120, 3000, robot_last_event(&robot, ARGUS_EV_LINK_RESUMED)->value);
    TEST_ASSERT_EQUAL(30, robot.argus.session.sips - sips);
    expect_zeros_first(from);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000));
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_LINK_STALLED, 0));
    TEST_ASSERT_TRUE(pose_error_mm() < 10);
    finish("suspended");
}

// A bumper hit that the first SIP after a gap shows is more urgent than the old set points.
void test_e_stop_goes_before_the_zeros_after_a_gap(void) {
    start_driving();
    robot.mute = true;
    robot_run(&robot, 1500);
    robot.bumpers_front = 2;
    const int from = robot.commands;
    robot.mute = false;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_LINK_RESUMED, 200));
    int at = from;
    while (at < robot.commands && robot.command[at].command != ARCOS_CMD_E_STOP) {
        TEST_ASSERT_TRUE(robot.command[at].command == ARCOS_CMD_STOP ||
                         robot.command[at].command == ARCOS_CMD_PULSE);
        at++;
    }
    expect_zeros_first(at + 1);
    finish("bumper in the gap");
}

// The robot drove on while nobody listened; its old session tells where it got to.
void test_the_pose_catches_up_with_an_old_session(void) {
    start_driving();
    const double before_mm = robot.x;
    robot.mute = true;
    robot_run(&robot, 6000);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_LINK_LOST, 0));
    TEST_ASSERT_TRUE_MESSAGE(robot.x - before_mm > 200, "it did not move on unseen");
    robot.mute = false;
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SESSION_DISLODGED, 20000));
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_SESSION_OPEN, 5000));
    TEST_ASSERT_TRUE(pose_error_mm() < 30);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000));
    TEST_ASSERT_TRUE(hypot(robot.x - 4000, robot.y) <= 150);
    finish("old session");
}

// The P3-DX's own ring and body, given by the caller under another name.
static argus_sonar_mount_t mounts[16];

static argus_ring_t callers_ring(void) {
    const argus_robot_t *const like = argus_robot_default();
    for (int i = 0; i < argus_robot_sonars(like) && i < 16; i++) {
        const argus_sonar_pose_t at = argus_robot_pose(like, i);
        const bool ahead = (like->ahead_mask >> i & 1u) != 0, astern = (like->astern_mask >> i & 1u) != 0;
        const uint8_t role = ahead ? ARGUS_ROLE_AHEAD : astern ? ARGUS_ROLE_ASTERN : ARGUS_ROLE_ABEAM;
        mounts[i] = (argus_sonar_mount_t){at.x_mm, at.y_mm, at.heading_deg, role};
    }
    return (argus_ring_t){.name = "mine",
                          .front_mm = 210,
                          .rear_mm = 301,
                          .width_mm = 425,
                          .track_mm = 330,
                          .mounts = mounts,
                          .sonars = (uint8_t)argus_robot_sonars(like),
                          .forward = {1, 2, 3, 4, 5, 6},
                          .forward_count = 6};
}

void test_a_ring_of_the_callers_own_stands_above_what_the_robot_says(void) {
    static const char *const names[] = {"powerbot-sh", "", "p3at-sh"};
    static argus_robot_storage_t storage;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        start();
        const argus_ring_t ring = callers_ring();
        TEST_ASSERT_EQUAL(ARGUS_RING_OK, argus_set_ring(&robot.argus, &storage, &ring).fault);
        robot.subclass = names[i];
        TEST_ASSERT_TRUE_MESSAGE(robot_goal(&robot, 600, 0), names[i]);
        TEST_ASSERT_TRUE_MESSAGE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000), names[i]);
        TEST_ASSERT_EQUAL_MESSAGE(0, robot_count_events(&robot, ARGUS_EV_SUBCLASS_UNKNOWN, 0), names[i]);
        argus_status_t status;
        argus_status(&robot.argus, &status);
        TEST_ASSERT_EQUAL_STRING("mine", status.robot_body);
        TEST_ASSERT_EQUAL(ARGUS_BAR_NONE, status.bar);
        finish(names[i]);
    }
}

// An AmigoBot has eight of the ring's sixteen sonars.
void test_a_ring_with_sonars_that_the_robot_has_not_got_waits_for_an_operator(void) {
    static argus_robot_storage_t storage;
    start();
    const argus_ring_t ring = callers_ring();
    TEST_ASSERT_EQUAL(ARGUS_RING_OK, argus_set_ring(&robot.argus, &storage, &ring).fault);
    robot.subclass = "amigo-sh";
    TEST_ASSERT_TRUE(robot_goal(&robot, 600, 0));
    robot_run(&robot, 10000);
    TEST_ASSERT_EQUAL(1, robot_count_events(&robot, ARGUS_EV_SONARS_BEYOND, 0));
    expect_failed(ARGUS_BAR_SONARS);
    expect_no_motion("amigo-sh");
    argus_operator(&robot.argus, now(), ARGUS_OP_ACTIVE, 0);
    TEST_ASSERT_TRUE(robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 60000));
    finish("a ring of sixteen on eight");
}

// A P3-DX would meet what it sees at 250 mm before it stands from 250 mm/s; its ring on a shorter body does
// not. What is out of its range bars any body.
void test_settings_are_judged_by_the_ring_that_is_given(void) {
    static argus_robot_storage_t storage;
    argus_config_t config = robot_config_of(ARGUS_PROFILE_ARGUS);
    config.speed_mm_s = 250;
    config.object_range_mm = 250;
    TEST_ASSERT_EQUAL(ARGUS_CONFIG_DRIVING, argus_config_check(&config).fault);
    for (int i = 0; i < 2; i++) {
        start_with(&config);
        argus_ring_t ring = callers_ring();
        ring.front_mm = 170;
        TEST_ASSERT_EQUAL(ARGUS_RING_OK, argus_set_ring(&robot.argus, &storage, &ring).fault);
        robot.subclass = "";
        TEST_ASSERT_TRUE(robot_goal(&robot, 600, 0));
        TEST_ASSERT_EQUAL(i == 0, robot_until_event(&robot, ARGUS_EV_GOAL_REACHED, 30000));
        finish("250 mm/s");
        config.backoff_mm = -1;
    }
    expect_no_motion("a setting out of its range");
}

void test_a_ring_that_the_settings_are_unsafe_for_changes_nothing(void) {
    static argus_robot_storage_t storage;
    start();
    argus_ring_t ring = callers_ring();
    ring.front_mm = 900; // its sonars stand 734 mm behind the front
    robot.argus.follows.object_range = false;
    TEST_ASSERT_EQUAL(ARGUS_RING_UNSAFE, argus_set_ring(&robot.argus, &storage, &ring).fault);
    TEST_ASSERT_EQUAL_PTR(argus_robot_default(), robot.argus.knowledge.robot);
    TEST_ASSERT_EQUAL(ARGUS_RING_OK, argus_set_ring(NULL, &storage, &ring).fault); // with others it would do
    robot_run(&robot, 5000);
    finish("unsafe");
}
