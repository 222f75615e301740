// SPDX-License-Identifier: MIT
// Attacks: every option does what the help says, and every bad or contradictory command line gives one line
// of advice.
#include <stdio.h>
#include <string.h>

#include "arguments.h"
#include "argusd.h"
#include "options.h"
#include "unity.h"

static options_t options;
static char message[512];

static bool parse(const char *line) {
    char *argv[ARGUMENTS_MAX];
    const int argc = arguments_of(line, argv);
    message[0] = '\0';
    return options_parse(&options, argc, argv, message, sizeof message);
}

static void refused(const char *line, const char *part) {
    TEST_ASSERT_FALSE_MESSAGE(parse(line), line);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, part), message);
    TEST_ASSERT_NULL(strchr(message, '\n'));
}

void test_everything_at_once(void) {
    TEST_ASSERT_TRUE_MESSAGE(
        parse("--link tcp:h:1 --config c --course d --state s --active --json --wait 5 --status 0"), message);
    TEST_ASSERT_EQUAL_INT(OPTIONS_RUN, options.action);
    TEST_ASSERT_EQUAL_STRING("h", options.link.target);
    TEST_ASSERT_EQUAL_STRING("c", options.config_path);
    TEST_ASSERT_EQUAL_STRING("d", options.course_path);
    TEST_ASSERT_EQUAL_STRING("s", options.state_path);
    TEST_ASSERT_TRUE(options.active && options.json && options.has_wait && options.has_status);
    TEST_ASSERT_FALSE(options.passive || options.plain || options.auto_baud || options.has_goal);
    TEST_ASSERT_EQUAL_UINT32(5000, options.wait_ms);
    TEST_ASSERT_EQUAL_UINT32(0, options.status_ms);
}

void test_single_options(void) {
    TEST_ASSERT_TRUE(
        parse("--link=serial:/dev/x --auto-baud --goal -100,200 --passive --plain --wait forever"));
    TEST_ASSERT_TRUE(options.auto_baud && options.has_goal && options.passive && options.plain);
    TEST_ASSERT_EQUAL_INT32(-100, options.goal.x_mm);
    TEST_ASSERT_EQUAL_INT32(200, options.goal.y_mm);
    TEST_ASSERT_EQUAL_UINT32(OPTIONS_WAIT_FOREVER, options.wait_ms);
    TEST_ASSERT_EQUAL_PTR(NULL, options.record_path);
    TEST_ASSERT_TRUE(parse("--link tcp:h --record r --record-max 5"));
    TEST_ASSERT_EQUAL_STRING("r", options.record_path);
    TEST_ASSERT_EQUAL_UINT64(5000000, options.record_max_bytes);
    TEST_ASSERT_TRUE(parse("--check --link tcp:h"));
    TEST_ASSERT_EQUAL_INT(OPTIONS_CHECK, options.action);
}

void test_control(void) {
    TEST_ASSERT_TRUE(parse("--link tcp:a --control unix:/run/x --inject"));
    TEST_ASSERT_EQUAL_INT(AF_UNIX, options.control.family);
    TEST_ASSERT_TRUE(options.inject);
    TEST_ASSERT_TRUE(
        parse("--link tcp:a --control tcp:192.168.0.1:82 --control-token t --control-beyond-loopback"));
    TEST_ASSERT_EQUAL_STRING("t", options.token_path);
    TEST_ASSERT_FALSE(options.control.loopback);
    TEST_ASSERT_TRUE(parse("--attach unix:/run/x --control-token t"));
    TEST_ASSERT_EQUAL_INT(OPTIONS_ATTACH, options.action);
    TEST_ASSERT_EQUAL_INT(AF_UNIX, options.attach.family);
}

void test_can(void) {
    TEST_ASSERT_TRUE_MESSAGE(parse("--link can:vcan0,robot=1 --active"), message);
    TEST_ASSERT_EQUAL_PTR(&hal_can_scheme, options.link.scheme);
    TEST_ASSERT_EQUAL_STRING("", options.telemetry.interface);
    TEST_ASSERT_FALSE(options.no_telemetry);
    TEST_ASSERT_TRUE(parse("--link serial:/dev/x --can-telemetry can1,robot=6"));
    TEST_ASSERT_EQUAL_STRING("can1", options.telemetry.interface);
    TEST_ASSERT_EQUAL_UINT8(6, options.telemetry.robot);
    TEST_ASSERT_TRUE(parse("--link can:can0 --can-telemetry none"));
    TEST_ASSERT_TRUE(options.no_telemetry);
    TEST_ASSERT_EQUAL_STRING("", options.telemetry.interface);
}

void test_guards(void) {
    TEST_ASSERT_TRUE_MESSAGE(parse("--link tcp:a --guard tcp:127.0.0.1:8101 --guard pty:/run/argus/robot"),
                             message);
    TEST_ASSERT_EQUAL_INT(2, options.guards.count);
    TEST_ASSERT_EQUAL_INT(GUARD_TCP, options.guards.at[0].kind);
    TEST_ASSERT_EQUAL_STRING("127.0.0.1", options.guards.at[0].name);
    TEST_ASSERT_EQUAL_UINT16(8101, options.guards.at[0].port);
    TEST_ASSERT_EQUAL_INT(GUARD_PTY, options.guards.at[1].kind);
    TEST_ASSERT_EQUAL_STRING("/run/argus/robot", options.guards.at[1].name);
    TEST_ASSERT_EQUAL_INT(ARGUS_READINGS_WITHHOLD, options.guards.readings);
    TEST_ASSERT_FALSE(options.guards.beyond);
    TEST_ASSERT_TRUE(
        parse("--link tcp:a --guard tcp:[::1]:1 --guard-readings cover --guard-beyond-loopback"));
    TEST_ASSERT_EQUAL_STRING("::1", options.guards.at[0].name);
    TEST_ASSERT_EQUAL_INT(ARGUS_READINGS_COVER, options.guards.readings);
    TEST_ASSERT_TRUE(options.guards.beyond);
}

void test_lists_need_no_link(void) {
    static const struct {
        const char *line;
        options_action_t action;
    } cases[] = {{"--help", OPTIONS_HELP},
                 {"-h", OPTIONS_HELP},
                 {"--version", OPTIONS_VERSION},
                 {"--list-events", OPTIONS_LIST_EVENTS},
                 {"--list-config", OPTIONS_LIST_CONFIG},
                 {"--example-config", OPTIONS_EXAMPLE_CONFIG}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(parse(cases[i].line), message);
        TEST_ASSERT_EQUAL_INT(cases[i].action, options.action);
    }
}

void test_refusals(void) {
    refused("", "no link is given; add --link");
    refused("--check", "no link is given");
    refused("--link", "--link needs a value");
    refused("--link foo", "unknown scheme");
    refused("--link tcp:a --link tcp:b", "given twice");
    refused("--link can:a --link can:b", "given twice");
    refused("--link tcp:a --control unix:/tmp/a --control unix:/tmp/b", "--control is given twice; keep one");
    refused("--link can:a --auto-baud", "for serial links");
    refused("--link can:a,robot=8", "from 0 to 7");
    refused("--link can:a --check --can-telemetry a", "leave out --can-telemetry");
    refused("--link tcp:a --can-telemetry a,fd", "--can-telemetry: can:a,fd: 'fd' is not for the telemetry");
    refused("--link tcp:a --guard serial:/dev/x", "give tcp:HOST:PORT");
    refused("--link tcp:a --guard tcp:host", "give tcp:HOST:PORT");
    refused("--link tcp:a --guard tcp:host:0", "give tcp:HOST:PORT");
    refused("--link tcp:a --guard tcp::1", "give tcp:HOST:PORT");
    refused("--link tcp:a --guard pty:", "or pty:PATH");
    refused("--link tcp:a --guard pty:a --guard pty:b --guard pty:c --guard pty:d --guard pty:e",
            "4 ports are the most");
    refused("--link tcp:a --guard pty:a --guard-readings some", "give withhold, cover or pass");
    refused("--link tcp:a --guard-readings cover", "for --guard PORT");
    refused("--link tcp:a --guard-beyond-loopback", "for --guard PORT");
    refused("--link tcp:a --check --guard pty:a", "leave out --guard");
    refused("--link tcp:a --frob", "unknown option --frob");
    refused("--link tcp:a -z", "unknown option");
    refused("--lnik tcp:a", "did you mean --link?");
    refused("--link tcp:a extra", "'extra' is not an option");
    refused("--link tcp:a --goal 1", "--goal: '1' is no waypoint");
    refused("--link tcp:a --goal 1,99999", "too far");
    refused("--link tcp:a --goal 1,1 --course c", "contradict");
    refused("--link tcp:a --active --passive", "contradict");
    refused("--link tcp:a --auto-baud", "for serial links");
    refused("--link serial:/dev/x@9600 --auto-baud", "leave out @BAUD");
    refused("--link tcp:a --control /run/x", "--control /run/x: give unix:PATH or tcp:127.0.0.1:PORT");
    refused("--link tcp:a --control tcp:127.0.0.1:82", "add --control-token FILE");
    refused("--link tcp:a --control tcp:0.0.0.0:82 --control-token t", "--control-beyond-loopback");
    refused("--link tcp:a --control-token t", "is for --control or --attach");
    refused("--link tcp:a --inject", "--inject is for orders at --control");
    refused("--link tcp:a --check --control unix:/x", "leave out --control");
    refused("--link tcp:a --attach unix:/x", "leave out --link");
    refused("--attach unix:/x --control unix:/y", "leave out --link and --control");
    refused("--attach x", "--attach x: give unix:PATH");
    refused("--link tcp:a --wait 0", "1 to 86400");
    refused("--link tcp:a --wait soon", "or 'forever'");
    refused("--link tcp:a --status 49", "50 to 3600000");
    refused("--link tcp:a --status x", "50 to 3600000");
    refused("--link tcp:a --record r --record-max 0", "1 to 100000");
    refused("--link tcp:a --record r --record-max 100001", "1 to 100000");
    refused("--link tcp:a --record-max 3", "--record-max is for --record");
}

void test_help_names_every_option_and_exit_code(void) {
    static char text[8192];
    static const char *const options_[] = {
        "--link",          "--auto-baud",      "--config",         "--course",
        "--goal",          "--passive",        "--active",         "--state",
        "--wait",          "--check",          "--json",           "--plain",
        "--status",        "--help",           "--version",        "--list-events",
        "--list-config",   "--example-config", "--record",         "--record-max",
        "--can-telemetry", "--guard",          "--guard-readings", "--guard-beyond-loopback",
        "examples:"};
    FILE *const file = tmpfile();
    options_help(file);
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    for (size_t i = 0; i < sizeof options_ / sizeof options_[0]; i++) {
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, options_[i]), options_[i]);
    }
#define NAMED(name, code, meaning) TEST_ASSERT_NOT_NULL(strstr(text, meaning));
    ARGUSD_EXIT_TABLE(NAMED)
#undef NAMED
}
