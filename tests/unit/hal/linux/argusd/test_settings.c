// SPDX-License-Identifier: MIT
// Attacks: every key of the firmware's table can be set over its whole range and no further, every bad line
// is named, S5's refusal shows its numbers, and the example file in docs/ is what argusd prints.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "robot/robot.h"
#include "settings.h"
#include "unity.h"

static settings_t settings;
static char message[1024];

static bool read_bytes(const char *text, size_t length) {
    FILE *const file = tmpfile();
    TEST_ASSERT_NOT_NULL(file);
    fwrite(text, 1, length, file);
    rewind(file);
    message[0] = '\0';
    const bool good = settings_read(&settings, file, "a.conf", message, sizeof message);
    fclose(file);
    return good;
}

static bool read_text(const char *text) {
    return read_bytes(text, strlen(text));
}

static void refused(const char *text, const char *expected) {
    TEST_ASSERT_FALSE_MESSAGE(read_text(text), text);
    TEST_ASSERT_EQUAL_STRING_LEN(expected, message, strlen(expected));
    TEST_ASSERT_NULL(strchr(message, '\n'));
}

void test_empty_is_the_defaults(void) {
    argus_config_t defaults;
    argus_config_default(&defaults);
    TEST_ASSERT_TRUE(read_text(""));
    TEST_ASSERT_EQUAL_MEMORY(&defaults, &settings.config, sizeof defaults);
    TEST_ASSERT_TRUE(read_text("# comment\n; another\n\n[argus]\n"));
    TEST_ASSERT_EQUAL_MEMORY(&defaults, &settings.config, sizeof defaults);
}

void test_forms_of_a_line(void) {
    TEST_ASSERT_TRUE_MESSAGE(
        read_text("step_mm=100\n  noise_mm : 7\r\npolicy = fewest ; why\nspeed_mm_s = 150"), message);
    TEST_ASSERT_EQUAL_INT32(100, settings.config.step_mm);
    TEST_ASSERT_EQUAL_INT32(7, settings.config.noise_mm);
    TEST_ASSERT_EQUAL_INT32(ARGUS_POLICY_FEWEST, settings.config.policy);
    TEST_ASSERT_EQUAL_INT32(150, settings.config.speed_mm_s);
    TEST_ASSERT_EQUAL_INT(4, settings.line[SETTINGS_speed_mm_s]);
    TEST_ASSERT_EQUAL_INT(0, settings.line[SETTINGS_baud]);
}

void test_a_remark_begins_behind_a_blank(void) {
    TEST_ASSERT_TRUE_MESSAGE(read_text("\xEF\xBB\xBF[argus]\nstep_mm = 100\t;why\n;step_mm = 1\n #no\n"),
                             message);
    TEST_ASSERT_EQUAL_INT32(100, settings.config.step_mm);
    refused("step_mm = 100;why\n", "a.conf:1: step_mm = '100;why': give a whole number");
    refused("step_mm ;= 100\n", "a.conf:1: malformed line");
    refused("step_mm = ; 100\n", "a.conf:1: step_mm = '': give a whole number");
    refused("= 100\n", "a.conf:1: unknown key ''");
    refused("step_mm = 100 : 200\n", "a.conf:1: step_mm = '100 : 200': give a whole number");
    refused("\n\xEF\xBB\xBFstep_mm = 100\n", "a.conf:2: unknown key ");
}

// The default of a number that follows the robot is a word.
void test_a_number_or_auto(void) {
    TEST_ASSERT_TRUE_MESSAGE(read_text("speed_mm_s = 150\nobject_range_mm = auto\n"), message);
    TEST_ASSERT_EQUAL_INT32(150, settings.config.speed_mm_s);
    TEST_ASSERT_EQUAL_INT32(ARGUS_AUTO, settings.config.object_range_mm);
    refused("speed_mm_s = aut\n",
            "a.conf:1: speed_mm_s = 'aut': give a whole number, 30 to 750 mm/s, or auto");
    refused("speed_mm_s = 0\n", "a.conf:1: speed_mm_s = 0 is out of range");
    refused("step_mm = auto\n", "a.conf:1: step_mm = 'auto': give a whole number, 50 to 200 mm");
}

static void try_key(const char *key, int value, bool good) {
    char text[96];
    snprintf(text, sizeof text, "%s = %d\n", key, value);
    TEST_ASSERT_EQUAL_INT_MESSAGE(good, read_text(text), text);
}

void test_every_number_over_its_range(void) {
#define TRY(key, def, min, max, unit, choices, meaning)    \
    if ((choices)[0] == '\0') {                            \
        try_key(#key, min, true);                          \
        TEST_ASSERT_EQUAL_INT32(min, settings.config.key); \
        try_key(#key, max, true);                          \
        TEST_ASSERT_EQUAL_INT32(max, settings.config.key); \
        try_key(#key, (min) - 1, false);                   \
        try_key(#key, (max) + 1, false);                   \
    } else {                                               \
        try_key(#key, def, false);                         \
    }
    ARGUS_CONFIG_TABLE(TRY)
#undef TRY
}

void test_refusals_name_the_line(void) {
    refused("step_mm = 100\nspeed_mm = 1\n", "a.conf:2: unknown key 'speed_mm'; did you mean speed_mm_s?");
    refused("frobnicate = 1\n", "a.conf:1: unknown key 'frobnicate'; argusd --list-config");
    refused("step_mm\n", "a.conf:1: malformed line; write key = value");
    refused("\n[argus\n", "a.conf:2: unknown section [argus");
    refused("[robot]\nstep_mm = 100\n", "a.conf:1: unknown section [robot]; use [argus] or none");
    refused("step_mm = 9999\n", "a.conf:1: step_mm = 9999 is out of range; give 50 to 200 mm");
    refused("step_mm = many\n", "a.conf:1: step_mm = 'many': give a whole number, 50 to 200 mm");
    refused("step_mm =\n", "a.conf:1: step_mm = '': give a whole number");
    refused("step_mm = 1e2\n", "a.conf:1: step_mm = '1e2': give a whole number");
    refused("policy = best\n",
            "a.conf:1: policy = 'best': choose one of paper|fewest|least-turn|ring|adaptive");
    refused("policy = pap\n",
            "a.conf:1: policy = 'pap': choose one of paper|fewest|least-turn|ring|adaptive");
    refused("policy = fewst\n", "a.conf:1: policy = 'fewst'; did you mean fewest? choose one of paper|");
    refused("policy =\n", "a.conf:1: policy = '': choose one of");
    refused("step_mm = 100\n\nstep_mm = 100\n", "a.conf:3: step_mm was given on line 1 already; keep one");
    refused("step_mm = 100\n  step_mm = 150\n", "a.conf:2: step_mm was given on line 1 already");
    refused("x\nstep_mm = 9999\n", "a.conf:1: malformed line");
    refused("step_mm = 9999\nx\n", "a.conf:1: step_mm = 9999");
    TEST_ASSERT_FALSE(read_bytes("step_mm = 1\00000\n", 15));
    TEST_ASSERT_EQUAL_STRING_LEN("a.conf:1: a NUL byte", message, 20);
}

void test_a_line_too_long_is_refused_not_split(void) {
    char text[2000];
    memset(text, ' ', sizeof text);
    memcpy(text, "step_mm = 100", 13);
    memcpy(text + sizeof text - 20, "\nspeed_mm_s = 150\n", 19);
    refused(text, "a.conf:1: the line is longer than ");
}

void test_missing_and_unreadable_files(void) {
    TEST_ASSERT_FALSE(settings_load(&settings, "/no/such/conf", message, sizeof message));
    TEST_ASSERT_EQUAL_STRING_LEN("/no/such/conf: cannot be opened: ", message, 33);
    TEST_ASSERT_FALSE(settings_load(&settings, "/tmp", message, sizeof message));
    TEST_ASSERT_EQUAL_STRING_LEN("/tmp: cannot be read: ", message, 22);
}

void test_a_robot_is_chosen_by_name(void) {
    char why[200];
    settings_default(&settings);
    TEST_ASSERT_TRUE(settings_choose(&settings, SETTINGS_robot, "amigo-sh", "--robot", why, sizeof why));
    TEST_ASSERT_EQUAL(argus_robot_choice(argus_robot_find("amigo-sh")), settings.config.robot);
    TEST_ASSERT_FALSE(settings_choose(&settings, SETTINGS_robot, "amigo", "--robot", why, sizeof why));
    TEST_ASSERT_NOT_NULL_MESSAGE(
        strstr(why, "--robot amigo; did you mean amigo-sh? choose one of by-subclass|p3dx-sh|"), why);
    TEST_ASSERT_EQUAL(argus_robot_choice(argus_robot_find("amigo-sh")), settings.config.robot);
}

// The PeopleBot's body goes farther ahead of its sonars than the others.
void test_s5_is_that_of_the_robot_chosen(void) {
    char why[400];
    settings_default(&settings);
    TEST_ASSERT_TRUE(settings_check(&settings, why, sizeof why));
    settings.config.robot = argus_robot_choice(argus_robot_find("peoplebot-sh"));
    TEST_ASSERT_TRUE(settings_check(&settings, why, sizeof why));
    settings.config.speed_mm_s = 300;
    TEST_ASSERT_FALSE(settings_check(&settings, why, sizeof why));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why, "overhang 91 "), why);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why, "object_range_mm = 300;"), why);
}

void test_s5_is_refused_with_its_numbers(void) {
    char expected[64];
    TEST_ASSERT_TRUE(read_text(""));
    TEST_ASSERT_TRUE(settings_check(&settings, message, sizeof message));
    TEST_ASSERT_TRUE(read_text("speed_mm_s = 300\n"));
    TEST_ASSERT_FALSE(settings_check(&settings, message, sizeof message));
    const argus_config_report_t report = argus_config_check(&settings.config);
    snprintf(expected, sizeof expected, "overhang %d + travel %d (300 mm/s x ", (int)report.overhang_mm,
             (int)report.travel_mm);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, expected), message);
    snprintf(expected, sizeof expected, "= %d mm must be less than object_range_mm = 250",
             (int)report.driving_mm);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, expected), message);
    TEST_ASSERT_TRUE(read_text("check_range_mm = 250\n"));
    TEST_ASSERT_FALSE(settings_check(&settings, message, sizeof message));
    const argus_config_report_t step = argus_config_check(&settings.config);
    snprintf(expected, sizeof expected, "reach of a 200 mm step %d + 3 x noise 5 + 20 = %d mm must",
             (int)step.reach_mm, (int)step.stepping_mm);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, expected), message);
}

void test_the_example_reads_back_as_the_defaults_and_gives_every_key(void) {
    argus_config_t defaults;
    argus_config_default(&defaults);
    FILE *const file = tmpfile();
    settings_example(file);
    rewind(file);
    TEST_ASSERT_TRUE_MESSAGE(settings_read(&settings, file, "example", message, sizeof message), message);
    fclose(file);
    TEST_ASSERT_EQUAL_MEMORY(&defaults, &settings.config, sizeof defaults);
    for (int i = 0; i < SETTINGS_COUNT; i++) {
        TEST_ASSERT_NOT_EQUAL(0, settings.line[i]);
    }
}

void test_the_example_in_docs_is_the_one_printed(void) {
    static char stored[32768];
    static char printed[32768];
    FILE *const docs = fopen(ARGUS_TEST_DATA "/../../docs/argusd.conf.example", "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(docs, "docs/argusd.conf.example is missing: argusd --example-config > it");
    stored[fread(stored, 1, sizeof stored - 1, docs)] = '\0';
    fclose(docs);
    FILE *const file = tmpfile();
    settings_example(file);
    rewind(file);
    printed[fread(printed, 1, sizeof printed - 1, file)] = '\0';
    fclose(file);
    TEST_ASSERT_TRUE_MESSAGE(strcmp(printed, stored) == 0,
                             "stale: argusd --example-config > docs/argusd.conf.example");
}

void test_the_list_has_every_key(void) {
    static char printed[32768];
    FILE *const file = tmpfile();
    settings_list(file);
    rewind(file);
    printed[fread(printed, 1, sizeof printed - 1, file)] = '\0';
    fclose(file);
#define LISTED(key, def, min, max, unit, choices, meaning) \
    TEST_ASSERT_NOT_NULL(strstr(printed, "\n" #key " "));
    ARGUS_CONFIG_TABLE(LISTED)
#undef LISTED
}

void test_any_bytes_are_survived(void) {
    static const char *const pieces[] = {"step_mm", "=", " ",    "\n", "[argus]", "100", "\n\n", "#", ";",
                                         "policy",  ":", "\xff", "\t", "fewest",  "]",   "[",    "\r"};
    srand(9);
    for (int round = 0; round < 5000; round++) {
        char text[400] = "";
        const int count = rand() % 30;
        for (int i = 0; i < count; i++) {
            strcat(text, pieces[rand() % (int)(sizeof pieces / sizeof pieces[0])]);
        }
        if (!read_text(text)) {
            TEST_ASSERT_EQUAL_STRING_LEN("a.conf:", message, 7);
        }
    }
}
