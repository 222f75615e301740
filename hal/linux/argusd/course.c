// SPDX-License-Identifier: MIT
// Reads course files.
#include "course.h"

#include <errno.h>
#include <string.h>

#include "argusd.h"
#include "text.h"

#define LINE_MAX_BYTES 256
#define LENGTH_MM 500 // of a P3-DX, nearly
#define DIGITS(number) DIGITS_OF(number)
#define DIGITS_OF(number) #number

bool course_parse_point(const char *text, argus_point_t *point, char *message, size_t capacity) {
    char x[32] = "";
    const char *const comma = strchr(text, ',');
    const size_t length = comma == NULL ? sizeof x : (size_t)(comma - text);
    if (length >= sizeof x) {
        return text_refuse(message, capacity, "'%.40s' is no waypoint; write x_mm,y_mm such as 1500,-300",
                           text);
    }
    memcpy(x, text, length);
    if (!text_length_mm(x, &point->x_mm) || !text_length_mm(comma + 1, &point->y_mm)) {
        return text_refuse(message, capacity,
                           "'%.40s' is no waypoint; write X,Y in whole mm, or with a unit as 2m,0", text);
    }
    const int32_t limit = ARGUS_COURSE_LIMIT_MM;
    if (point->x_mm < -limit || point->x_mm > limit || point->y_mm < -limit || point->y_mm > limit) {
        return text_refuse(message, capacity, "%d,%d is too far; a waypoint lies within %d mm in x and in y",
                           (int)point->x_mm, (int)point->y_mm, (int)limit);
    }
    return true;
}

const char *course_near(argus_point_t goal, argus_point_t from) {
    const int64_t x_mm = (int64_t)goal.x_mm - from.x_mm;
    const int64_t y_mm = (int64_t)goal.y_mm - from.y_mm;
    return x_mm * x_mm + y_mm * y_mm < (int64_t)LENGTH_MM * LENGTH_MM
               ? "the goal is within " DIGITS(LENGTH_MM) " mm of the robot, which is longer; numbers are mm"
               : NULL;
}

static void strip(char *line) {
    line[strcspn(line, "#")] = '\0';
    size_t length = strlen(line);
    while (length > 0 && strchr(" \t\r\n", line[length - 1]) != NULL) {
        line[--length] = '\0';
    }
}

static bool take_line(course_t *course, char *line, char *message, size_t capacity) {
    argus_point_t point;
    strip(line);
    if (line[strspn(line, " \t")] == '\0') {
        return true;
    }
    if (!course_parse_point(line, &point, message, capacity)) {
        return false;
    }
    if (course->count == ARGUS_WAYPOINTS_MAX) {
        return text_refuse(message, capacity, "more than %d waypoints; shorten the course",
                           ARGUS_WAYPOINTS_MAX);
    }
    course->point[course->count++] = point;
    return true;
}

bool course_read(course_t *course, FILE *file, const char *path, char *message, size_t capacity) {
    char line[LINE_MAX_BYTES];
    char problem[ARGUSD_MESSAGE_MAX / 2];
    memset(course, 0, sizeof *course);
    text_read_t found = text_read_line(file, line, sizeof line);
    for (int number = 1; found != TEXT_END; number++) {
        if (found != TEXT_LINE) {
            return text_refuse(message, capacity, "%s:%d: not a line of text; write x_mm,y_mm", path, number);
        }
        if (number == 1) {
            text_drop_mark(line);
        }
        if (!take_line(course, line, problem, sizeof problem)) {
            return text_refuse(message, capacity, "%s:%d: %s", path, number, problem);
        }
        found = text_read_line(file, line, sizeof line);
    }
    if (ferror(file)) {
        return text_refuse(message, capacity, "%s: cannot be read: %s", path, strerror(errno));
    }
    if (course->count == 0) {
        return text_refuse(message, capacity, "%s: holds no waypoint; write x_mm,y_mm, one per line", path);
    }
    return true;
}

bool course_load(course_t *course, const char *path, char *message, size_t capacity) {
    FILE *const file = fopen(path, "re");
    if (file == NULL) {
        return text_refuse(message, capacity, "%s: cannot be opened: %s; give the course file's path", path,
                           strerror(errno));
    }
    const bool good = course_read(course, file, path, message, capacity);
    fclose(file);
    return good;
}
