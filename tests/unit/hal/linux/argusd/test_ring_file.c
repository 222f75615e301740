// SPDX-License-Identifier: MIT
// Rule under attack: argusd reads the files of rings as the other programs do: the known robots' and the
// samples are what they are, and what is wrong is told with file, line and reason.
#include "ring_file.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "robot/robot.h"
#include "unity.h"

#define ROOT ARGUS_TEST_DATA "/../.."

static ring_file_t file;
static argus_robot_storage_t storage;
static char message[512];
static char path[512];

static const char good[] = "[identity]\nsubclass = \"mine\"\n"
                           "[body]\nfront_mm = 150 # ahead\nrear_mm = 150\nwidth_mm = 300\n"
                           "[sonar]\nforward = [1,\n  2, # left to right\n]\n"
                           "[[sonar.pose]]\nx_mm = 0\ny_mm = 140\nheading_deg = 90\nrole = \"abeam\"\n"
                           "[[sonar.pose]]\nx_mm = 100\ny_mm = 50\nheading_deg = 20\nrole = 'ahead'\n"
                           "[[sonar.pose]]\nx_mm = 100\ny_mm = -50\nheading_deg = -20\nrole = \"ahead\"\n";

static bool load(const char *from) {
    message[0] = '\0';
    if (!ring_file_load(&file, from, message, sizeof message)) {
        return false;
    }
    const argus_ring_report_t report = argus_set_ring(NULL, &storage, &file.ring);
    if (report.fault != ARGUS_RING_OK) {
        ring_file_explain(&file, from, report, message, sizeof message);
    }
    return report.fault == ARGUS_RING_OK;
}

static bool load_text(const char *text) {
    snprintf(path, sizeof path, "%s", "/tmp/argus-ring-XXXXXX");
    const int fd = mkstemp(path);
    TEST_ASSERT_TRUE(fd >= 0);
    TEST_ASSERT_EQUAL(strlen(text), write(fd, text, strlen(text)));
    close(fd);
    const bool loaded = load(path);
    unlink(path);
    return loaded;
}

// The good one, with the first `from` in it changed.
static bool load_changed(const char *from, const char *to) {
    char text[sizeof good + 200];
    const char *const at = strstr(good, from);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, from);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - good), good, to, at + strlen(from));
    return load_text(text);
}

void test_a_good_one_is_read(void) {
    TEST_ASSERT_TRUE_MESSAGE(load_text(good), message);
    TEST_ASSERT_EQUAL_STRING("mine", file.ring.name);
    TEST_ASSERT_EQUAL(3, file.ring.sonars);
    TEST_ASSERT_EQUAL(2, file.ring.forward_count);
    TEST_ASSERT_EQUAL(2, file.ring.forward[1]);
    TEST_ASSERT_EQUAL(-50, file.ring.mounts[2].y_mm);
    TEST_ASSERT_EQUAL(ARGUS_ROLE_ABEAM, file.ring.mounts[0].role);
}

void test_the_known_robots_are_such_files(void) {
    for (int choice = 1; choice <= ARGUS_ROBOTS; choice++) {
        const argus_robot_t *const robot = argus_robot_chosen(choice);
        snprintf(path, sizeof path, "%s/hil_sim/tables/robots/%s.toml", ROOT, robot->name);
        if (robot->sonars > ARGUS_SONARS) {
            TEST_ASSERT_FALSE(load(path));
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, "this build manages"), message);
            continue;
        }
        TEST_ASSERT_TRUE_MESSAGE(load(path), message);
        TEST_ASSERT_EQUAL_STRING(robot->name, file.ring.name);
        TEST_ASSERT_EQUAL(robot->sonars, file.ring.sonars);
        TEST_ASSERT_EQUAL(robot->forward_count, file.ring.forward_count);
        TEST_ASSERT_EQUAL_MEMORY(robot->forward, file.ring.forward, robot->forward_count);
#define SAME(key, section, def, min, max, meaning) TEST_ASSERT_EQUAL_MESSAGE(robot->key, file.ring.key, #key);
        ARGUS_RING_BODY_TABLE(SAME)
#undef SAME
        for (int i = 0; i < robot->sonars; i++) {
            const argus_sonar_pose_t at = argus_robot_pose(robot, i);
            TEST_ASSERT_EQUAL(at.x_mm, file.ring.mounts[i].x_mm);
            TEST_ASSERT_EQUAL(at.y_mm, file.ring.mounts[i].y_mm);
            TEST_ASSERT_EQUAL(at.heading_deg, file.ring.mounts[i].heading_deg);
        }
    }
}

void test_the_sample_is_one(void) {
    TEST_ASSERT_TRUE_MESSAGE(load(ROOT "/docs/samples/rings/roundbot.toml"), message);
    TEST_ASSERT_EQUAL(4000, file.ring.no_echo_mm);
}

void test_one_may_inherit_another_beside_it(void) {
    // amigo-sh does not stand there: it says what to do.
    TEST_ASSERT_FALSE(load(ROOT "/docs/samples/rings/amigobot.toml"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, "argus-log ring"), message);
    TEST_ASSERT_FALSE(load_text("inherits = \"no-such-ring\"\n"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, ":1: inherits: "), message);
}

void test_what_is_wrong_is_told_with_its_line(void) {
    static const struct {
        const char *from, *to;
        int line;
        const char *why;
    } bad[] = {
        {"front_mm = 150", "front_mm = far", 4, "whole number"},
        {"front_mm = 150", "front_mm = 150.5", 4, "whole number"},
        {"front_mm = 150", "front_mm 150", 4, "write key = value"},
        {"front_mm = 150", "front_mm = 5000", 4, "[body] front_mm: the figure is missing"},
        {"width_mm", "widht_mm", 6, "no such key"},
        {"[body]", "[bodi]", 3, "no such section"},
        {"[body]", "[[body]]", 3, "no such section"},
        {"[body]", "[body", 3, "a list has no end"},
        {"\"mine\"", "mine", 2, "in quotes"},
        {"\"mine\"", "\"a name of many letters\"", 2, "in quotes"},
        {"\"mine\"", "\"\"", 0, "1 to 15 letters"},
        {"[1,\n  2, # left to right\n]", "[1, 2, 1, 2, 1, 2, 1]", 8, "2 to 6 sonars"},
        {"[1,\n  2, # left to right\n]", "[1, two]", 8, "whole number"},
        {"[1,\n  2, # left to right\n]", "[1]", 8, "2 to 6 sonars"},
        {"x_mm = 0", "x_mm = 151", 11, "sonar 0: the sonar stands beside"},
        {"y_mm = 140\n", "", 11, "must be given"},
        {"\"abeam\"", "\"sideways\"", 15, "role must be one of"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        char place[600];
        TEST_ASSERT_FALSE_MESSAGE(load_changed(bad[i].from, bad[i].to), bad[i].to);
        if (bad[i].line > 0) {
            snprintf(place, sizeof place, "%s:%d: ", path, bad[i].line);
            TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(place, message, strlen(place), message);
        }
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, bad[i].why), message);
    }
}

void test_no_text_is_a_crash(void) {
    // Each beginning of the good one, and each byte of it changed.
    char text[sizeof good];
    for (size_t i = 0; i + 1 < sizeof good; i += 7) {
        memcpy(text, good, sizeof good);
        text[i] = '\0';
        (void)load_text(text);
        memcpy(text, good, sizeof good);
        text[i] = (char)('!' + i % 90);
        (void)load_text(text);
    }
    TEST_ASSERT_FALSE(load_text(""));
    TEST_ASSERT_FALSE(load("/nonexistent/ring.toml"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, "cannot be opened"), message);
}

// The corpus that argus-log judges, too (tests/tools/test_ring.py): the same verdict, told with the file.
void test_the_verdicts_are_those_of_the_other_programs(void) {
    DIR *const folder = opendir(ARGUS_TEST_DATA "/rings");
    int count = 0;
    TEST_ASSERT_NOT_NULL(folder);
    for (const struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
        if (entry->d_name[0] == '.') {
            continue;
        }
        snprintf(path, sizeof path, "%s/rings/%s", ARGUS_TEST_DATA, entry->d_name);
        const bool is_good = strncmp(entry->d_name, "good-", 5) == 0;
        TEST_ASSERT_EQUAL_MESSAGE(is_good, load(path), entry->d_name);
        TEST_ASSERT_TRUE_MESSAGE(is_good || strncmp(message, path, strlen(path)) == 0, message);
        count++;
    }
    closedir(folder);
    TEST_ASSERT_GREATER_THAN_INT(40, count);
}
