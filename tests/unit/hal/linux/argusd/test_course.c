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
