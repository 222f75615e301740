// SPDX-License-Identifier: MIT
// Course files: a waypoint per line, x_mm,y_mm; '#' begins a comment.
#ifndef ARGUSD_COURSE_H
#define ARGUSD_COURSE_H

#include <stdbool.h>
#include <stdio.h>

#include "argus/argus.h"

typedef struct {
    argus_point_t point[ARGUS_WAYPOINTS_MAX];
    uint16_t count;
} course_t;

// "X,Y" in mm, each at most ARGUS_COURSE_LIMIT_MM from 0. False: `message` says what is wrong with it.
bool course_parse_point(const char *text, argus_point_t *point, char *message, size_t capacity);

// What is to be reported of a goal so near to `from` that mostly metres were meant; NULL where it is farther.
const char *course_near(argus_point_t goal, argus_point_t from);

// False: `message` is FILE:LINE: what is wrong, what to do.
bool course_read(course_t *course, FILE *file, const char *path, char *message, size_t capacity);
bool course_load(course_t *course, const char *path, char *message, size_t capacity);

#endif
