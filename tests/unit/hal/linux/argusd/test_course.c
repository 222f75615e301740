// SPDX-License-Identifier: MIT
// Attacks: a course is read as written, and every malformed one is refused with file, line and advice.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "course.h"
#include "unity.h"

static course_t course;
static char message[512];

static bool read_bytes(const char *text, size_t length) {
    FILE *const file = tmpfile();
    TEST_ASSERT_NOT_NULL(file);
    fwrite(text, 1, length, file);
    rewind(file);
    message[0] = '\0';
    const bool good = course_read(&course, file, "c.csv", message, sizeof message);
    fclose(file);
    return good;
}

static void refused(const char *text, const char *expected) {
    TEST_ASSERT_FALSE_MESSAGE(read_bytes(text, strlen(text)), text);
    TEST_ASSERT_EQUAL_STRING_LEN(expected, message, strlen(expected));
    TEST_ASSERT_NULL(strchr(message, '\n'));
}

void test_a_course_is_read(void) {
    const char text[] = "# a course\n1000,0\n\n 2000 , -500 # corner\r\n\t# nothing\n-30000,30000";
    TEST_ASSERT_TRUE_MESSAGE(read_bytes(text, sizeof text - 1), message);
    TEST_ASSERT_EQUAL_UINT16(3, course.count);
    TEST_ASSERT_EQUAL_INT32(1000, course.point[0].x_mm);
    TEST_ASSERT_EQUAL_INT32(-500, course.point[1].y_mm);
    TEST_ASSERT_EQUAL_INT32(-30000, course.point[2].x_mm);
    TEST_ASSERT_EQUAL_INT32(30000, course.point[2].y_mm);
}

// As argusctl takes them.
void test_units_are_read(void) {
    const char text[] = "2m,0\n1.5m,-20cm\n+300mm, -.25m \n0.0014m,0.0016m\n-2.5cm,7.m\n";
    static const argus_point_t expected[] = {{2000, 0}, {1500, -200}, {300, -250}, {1, 2}, {-25, 7000}};
    TEST_ASSERT_TRUE_MESSAGE(read_bytes(text, sizeof text - 1), message);
    TEST_ASSERT_EQUAL_UINT16(5, course.count);
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL_INT32(expected[i].x_mm, course.point[i].x_mm);
        TEST_ASSERT_EQUAL_INT32(expected[i].y_mm, course.point[i].y_mm);
    }
    refused("m,0\n", "c.csv:1: 'm,0' is no waypoint");
    refused("-m,0\n", "c.csv:1: '-m,0' is no waypoint");
    refused(".m,0\n", "c.csv:1: '.m,0' is no waypoint");
    refused("1..5m,0\n", "c.csv:1: '1..5m,0' is no waypoint");
    refused("1-5m,0\n", "c.csv:1: '1-5m,0' is no waypoint");
    refused("2 m m,0\n", "c.csv:1: '2 m m,0' is no waypoint");
    refused("2km,0\n", "c.csv:1: '2km,0' is no waypoint");
    refused("1e3m,0\n", "c.csv:1: '1e3m,0' is no waypoint");
    refused("31m,0\n", "c.csv:1: 31000,0 is too far");
    refused("999999999m,0\n", "c.csv:1: '999999999m,0' is no waypoint");
    refused("0000000000001m,0\n", "c.csv:1: '0000000000001m,0' is no waypoint");
}

// As editors of Windows begin a text.
void test_a_mark_of_utf8_is_none_of_the_course(void) {
    const char text[] = "\xEF\xBB\xBF"
                        "1000,0\r\n1500,-200\r\n";
    TEST_ASSERT_TRUE_MESSAGE(read_bytes(text, sizeof text - 1), message);
    TEST_ASSERT_EQUAL_UINT16(2, course.count);
    TEST_ASSERT_EQUAL_INT32(1000, course.point[0].x_mm);
    TEST_ASSERT_EQUAL_INT32(-200, course.point[1].y_mm);
    refused("\xEF\xBB\xBF", "c.csv: holds no waypoint");
    refused("1,2\n\xEF\xBB\xBF"
            "3,4\n",
            "c.csv:2: ");
}

void test_refusals_name_the_line(void) {
    refused("", "c.csv: holds no waypoint");
    refused("# only a comment\n", "c.csv: holds no waypoint");
    refused("1,2\n3\n", "c.csv:2: '3' is no waypoint; write x_mm,y_mm");
    refused("1,2\n\n#\nx,4\n", "c.csv:4: 'x,4' is no waypoint");
    refused("1,\n", "c.csv:1: '1,' is no waypoint");
    refused(",1\n", "c.csv:1: ',1' is no waypoint");
    refused("1,2,3\n", "c.csv:1: '1,2,3' is no waypoint");
    refused("1.5,2\n", "c.csv:1: '1.5,2' is no waypoint");
    refused("30001,0\n", "c.csv:1: 30001,0 is too far");
    refused("0,-30001\n", "c.csv:1: 0,-30001 is too far");
    refused("99999999999,0\n", "c.csv:1: '99999999999,0' is no waypoint");
    TEST_ASSERT_FALSE(read_bytes("1,2\n3\0,4\n", 9));
    TEST_ASSERT_EQUAL_STRING_LEN("c.csv:2: not a line of text", message, 27);
}

void test_one_waypoint_too_many(void) {
    char text[(ARGUS_WAYPOINTS_MAX + 1) * 4 + 1] = "";
    for (int i = 0; i < ARGUS_WAYPOINTS_MAX; i++) {
        strcat(text, "1,2\n");
    }
    TEST_ASSERT_TRUE(read_bytes(text, strlen(text)));
    TEST_ASSERT_EQUAL_UINT16(ARGUS_WAYPOINTS_MAX, course.count);
    strcat(text, "1,2\n");
    refused(text, "c.csv:65: more than 64 waypoints");
}

void test_missing_and_unreadable_files(void) {
    TEST_ASSERT_FALSE(course_load(&course, "/no/such/course", message, sizeof message));
    TEST_ASSERT_EQUAL_STRING_LEN("/no/such/course: cannot be opened: ", message, 35);
    TEST_ASSERT_FALSE(course_load(&course, "/tmp", message, sizeof message));
    TEST_ASSERT_EQUAL_STRING_LEN("/tmp: cannot be read: ", message, 22);
}

void test_any_bytes_are_survived(void) {
    srand(3);
    for (int round = 0; round < 3000; round++) {
        char text[600];
        static const char alphabet[] = "0123456789,,-+ \n#x\r\t\0\xff";
        const int length = rand() % (int)sizeof text;
        for (int i = 0; i < length; i++) {
            text[i] = alphabet[rand() % (int)(sizeof alphabet - 1)];
        }
        if (!read_bytes(text, (size_t)length)) {
            TEST_ASSERT_EQUAL_STRING_LEN("c.csv:", message, 6);
        }
        TEST_ASSERT_TRUE(course.count <= ARGUS_WAYPOINTS_MAX);
    }
}
